#!/usr/bin/env python3
"""Puts the page together: assemble.py OUT MODULE.wasm FIRST

FIRST is the folder with the first picture, left.png and right.png.
With PAGE_ADDRESS in the environment links to the page have a picture: page.png, beside the page.
One HTML file that needs nothing else. The engine, the scripts and what the first screen does not need are packed, the rest
stands as it is. Prints what takes the room. ZOPFLI=off packs by gzip even where there is a zopfli, which takes longer.
"""

import base64
import gzip
import html
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile


def read(*paths):
    return "\n".join(path.read_text().strip() for path in paths if path.exists())


def minified(text, loader):
    """A script or a style sheet without comments and unneeded blanks."""
    command = [web / "node_modules/.bin/esbuild", "--minify", f"--loader={loader}"]
    return subprocess.run(command, input=text, check=True, capture_output=True, text=True).stdout.strip()


def bundle(root):
    """One module of `root` and all that it imports: a page that opens from a disk cannot load modules from there."""
    command = [web / "node_modules/.bin/esbuild", "--bundle", "--minify", "--format=esm", root]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def pack(data):
    """Bytes as browsers unpack them, as short as can be: zopfli finds 4 % more than gzip does."""
    if os.environ.get("ZOPFLI") == "off" or not shutil.which("zopfli"):
        return gzip.compress(data, 9, mtime=0)
    with tempfile.NamedTemporaryFile() as file:
        file.write(data)
        file.flush()
        return subprocess.run(["zopfli", "-c", file.name], check=True, capture_output=True).stdout


def in_base64(data):
    return base64.b64encode(data).decode()


def data_address(picture):
    return f"data:image/png;base64,{in_base64(picture.read_bytes())}"


def address_tags(address):
    """The data about the page's address that link previews need."""
    folder = address.rsplit("/", 1)[0]
    tags = {"og:url": address, "og:image": f"{folder}/page.png"}
    return "\n".join(f'<meta property="{name}" content="{html.escape(value)}">' for name, value in tags.items())


web = pathlib.Path(__file__).parent
page, text, shared = web / "page", web / "text", web.parent / "lab/src/cost/report/shared"
out, module, first = map(pathlib.Path, sys.argv[1:])
packed = {
    "wasm": module.read_bytes(),
    "worker": bundle(page / "worker.js").encode(),
    "page": bundle(page / "page.js").encode(),
    # The parts that the first screen does not need.
    "style": minified(read(shared / "figures.css", text / "text.css"), "css").encode(),
    "text": read(text / "text.html").encode(),
}
parts = {
    "style": minified(read(shared / "tokens.css", page / "style.css"), "css"),
    "parts": json.dumps({name: len(part) for name, part in packed.items()}),
    "begin": minified(read(page / "begin.js"), "js"),
    "packed": in_base64(pack(b"".join(packed.values()))),
    **{side: data_address(first / f"{side}.png") for side in ("left", "right")},
}
address = os.environ.get("PAGE_ADDRESS")
parts["address"] = address_tags(address) if address else ""
whole = (page / "index.html").read_text()
for name, content in parts.items():
    for mark in (f"/*{{{name}}}*/", f"<!--{{{name}}}-->"):
        whole = whole.replace(mark, content)
out.parent.mkdir(parents=True, exist_ok=True)
out.write_text(whole)
size = len(whole.encode())
print(f"{'bytes':>9}  {'by gzip':>9}")
for name, part in packed.items():
    print(f"{len(part):9,}  {len(in_base64(gzip.compress(part))):9,}  {name}")
for name in ("style", "begin", "left", "right"):
    print(f"{len(parts[name].encode()):9,}  {'':9}  {name}")
print(f"{size:9,}  {'':9}  {out}")
