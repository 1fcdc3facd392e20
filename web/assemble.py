#!/usr/bin/env python3
"""Puts the page together: assemble.py OUT SIMD128.wasm [PLAIN.wasm]

One HTML file that needs nothing else. Prints what takes the room.
"""

import base64
import gzip
import pathlib
import sys

web = pathlib.Path(__file__).parent
figures = web.parent / "lab/src/cost/report/figures"
out, *modules = map(pathlib.Path, sys.argv[1:])


def read(*paths):
    return "\n".join(path.read_text().strip() for path in paths if path.exists())


page = web / "page"
text = web / "text"
parts = {
    "style": read(page / "style.css", figures / "figures.css", text / "text.css"),
    "text": read(text / "text.html"),
    "engine": read(page / "engine.js"),
    "worker": read(page / "worker.js"),
    "page": read(
        *(page / f"{name}.js" for name in ["elements", "background", "picture"]),
        *(figures / f"{name}.js" for name in ["chart", "divider"]),
        *(page / f"{name}.js" for name in ["accuracy", "plan", "magnifier", "scenes", "link", "save"]),
        *sorted((text / "figures").glob("*.js")),
        page / "page.js",
    ),
}
names = ["wasm-simd128", "wasm-plain"]
parts["data"] = "\n".join(
    f'<script id="{name}" type="text/plain">{base64.b64encode(gzip.compress(path.read_bytes(), 9, mtime=0)).decode()}</script>'
    for name, path in zip(names, modules)
)
html = (page / "index.html").read_text()
for name, content in parts.items():
    for mark in (f"/*{{{name}}}*/", f"<!--{{{name}}}-->"):
        html = html.replace(mark, content)
out.write_text(html)
for name, content in parts.items():
    print(f"{len(content.encode()):9,}  {name}")
print(f"{len(html.encode()):9,}  {out}")
if len(html.encode()) > 800_000:
    sys.exit(f"{out}: more than 800,000 bytes")
