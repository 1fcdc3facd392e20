#!/usr/bin/env python3
"""Puts ES modules together as one: bundle.py ROOT.js

A page that opens from a disk cannot load modules from there, so they go into it. Each becomes a function of its own, called
after those that it imports, and the root's exports are those of the whole. Imports and exports must be of the plain kinds:
`import { name, other as another } from "./file.js";`, `import * as all from "./file.js";`, `import "./file.js";`, and `export`
before a function, class or constant.
"""

import pathlib
import re
import sys

IMPORT = re.compile(r'^import (?:(\{[^}]*\}|\* as \w+) from )?"(\.[^"]+)";\n', re.MULTILINE)
EXPORT = re.compile(r"^export ((?:async )?(?:function\*?|class|const) (\w+))", re.MULTILINE)
# Lines that are comments alone.
COMMENT = re.compile(r"^ *(?://.*|/\*\*(?:(?!\*/)[\s\S])*\*/)\n", re.MULTILINE)


class Wrong(Exception):
    """What the bundle cannot do."""


def bundle(root):
    """The text of one module: `root`, and all that it imports."""
    root = pathlib.Path(root).resolve()
    texts, exports, begun = [], {}, []

    def name(path):
        return f"m{list(exports).index(path)}_{re.sub(r'[^a-zA-Z0-9]', '_', path.stem)}"

    def add(path):
        if path in exports:
            return
        if path in begun:
            raise Wrong(f"{path}: imports itself by way of {begun[-1].name}")
        begun.append(path)
        source = COMMENT.sub("", path.read_text())
        imports = [(names, (path.parent / file).resolve()) for names, file in IMPORT.findall(source)]
        for _, file in imports:
            add(file)
        lines = [take(path, names, file) for names, file in imports if names]
        body = EXPORT.sub(r"\1", IMPORT.sub("", source))
        if left := re.search(r"^(?:import|export)\b.*", body, re.MULTILINE):
            raise Wrong(f"{path}: not understood: {left[0]}")
        exports[path] = [exported for _, exported in EXPORT.findall(source)]
        begun.pop()
        answer = f"return {{ {', '.join(exports[path])} }};\n" if exports[path] else ""
        texts.append(f"const {name(path)} = (() => {{\n{''.join(lines)}{body.strip()}\n{answer}}})();\n")

    def take(path, names, file):
        if names.startswith("*"):
            return f"const {names.split()[-1]} = {name(file)};\n"
        parts = [part.strip() for part in names.strip("{}").split(",") if part.strip()]
        pairs = [re.fullmatch(r"(\w+)(?: as (\w+))?", part) for part in parts]
        for pair in pairs:
            if not pair or pair[1] not in exports[file]:
                raise Wrong(f"{path}: {file.name} does not export {pair[1] if pair else names}")
        taken = ", ".join(f"{pair[1]}: {pair[2]}" if pair[2] else pair[1] for pair in pairs)
        return f"const {{ {taken} }} = {name(file)};\n"

    add(root)
    if exports[root]:
        texts.append(f"export const {{ {', '.join(exports[root])} }} = {name(root)};\n")
    return "".join(texts)


if __name__ == "__main__":
    try:
        print(bundle(sys.argv[1]), end="")
    except (Wrong, OSError) as error:
        sys.exit(f"bundle: {error}")
