#!/usr/bin/env python3
"""Puts the page together: assemble.py OUT MODULE.wasm

With PAGE_ADDRESS in the environment links to the page have a picture: page.png, beside the page.
One HTML file that needs nothing else. The engine and the scripts are packed by LZMA, the rest stands as it is. Prints what
takes the room.
"""

import html
import json
import lzma
import os
import pathlib
import re
import sys

# Printable letters without <, which could end a script, & and \.
LETTERS = "".join(letter for letter in map(chr, range(33, 127)) if letter not in "<&\\")


def read(*paths):
    return "\n".join(path.read_text().strip() for path in paths if path.exists())


def pack(data):
    """LZMA of a known size, with the settings that do best for WebAssembly."""
    settings = {"id": lzma.FILTER_LZMA1, "preset": 9 | lzma.PRESET_EXTREME, "lc": 4, "lp": 0, "pb": 0}
    packed = lzma.compress(data, lzma.FORMAT_ALONE, filters=[settings | {"dict_size": 1 << 22}])
    return packed[:5] + len(data).to_bytes(8, "little") + packed[13:]


def in_letters(data):
    """13 bits in two of 91 letters: 23 % longer than the bytes, where base64 is 33 %."""
    bits, count, letters = 0, 0, []
    for byte in data + b"\0":
        bits |= byte << count
        count += 8
        if count >= 13:
            high, low = divmod(bits & 8191, 91)
            letters += (LETTERS[low], LETTERS[high])
            bits >>= 13
            count -= 13
    high, low = divmod(bits, 91)
    return "".join([*letters, LETTERS[low], LETTERS[high]])


def without_comments(script):
    """A script without the lines that are comments alone."""
    return re.sub(r"^ *(//.*|/\*\*.*\*/)\n", "", script, flags=re.MULTILINE)


def address_tags(address):
    """What a preview of a link needs to know of where the page stands."""
    folder = address.rsplit("/", 1)[0]
    tags = {"og:url": address, "og:image": f"{folder}/page.png"}
    return "\n".join(f'<meta property="{name}" content="{html.escape(value)}">' for name, value in tags.items())


def scripts(folder, *names):
    return read(*(folder / f"{name}.js" for name in names))


web = pathlib.Path(__file__).parent
page, text, shared = web / "page", web / "text", web.parent / "lab/src/cost/report/shared"
out, module = map(pathlib.Path, sys.argv[1:])
figures = sorted((text / "figures").glob("*.js"))
packed = {
    "wasm": module.read_bytes(),
    "engine": scripts(page, "engine", "stopwatch"),
    "worker": scripts(page, "worker"),
    "page": "\n".join(
        [
            scripts(page, "elements", "background", "picture"),
            scripts(shared, "chart", "divider"),
            scripts(page, "stops", "versus", "accuracy", "curve", "plan", "magnifier", "mini", "scenes", "link", "save", "page"),
        ]
    ),
    "figures": read(*figures),
    # What the first screen does not need.
    "style": read(shared / "figures.css", text / "text.css"),
    "text": read(text / "text.html"),
}
packed = {name: part if isinstance(part, bytes) else without_comments(part).encode() for name, part in packed.items()}
parts = {
    "style": read(shared / "tokens.css", page / "style.css"),
    "parts": json.dumps({name: len(part) for name, part in packed.items()}),
    "letters": json.dumps(LETTERS),
    "unpack": scripts(page, "lzma", "begin"),
    "packed": in_letters(pack(b"".join(packed.values()))),
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
print(f"{'bytes':>9}  {'packed':>9}")
for name, part in packed.items():
    print(f"{len(part):9,}  {round(1.231 * len(pack(part))):9,}  {name}")
for name in ("style", "unpack"):
    print(f"{len(parts[name].encode()):9,}  {'':9}  {name}")
print(f"{size:9,}  {'':9}  {out}")
