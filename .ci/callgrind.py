"""Instructions of the program `frames` (benches/frames), counted by valgrind's callgrind."""

import os
import re
import subprocess
import sys
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def finish(wrong, message):
    """Ends the program: with the list of what is wrong, or with a message if nothing is."""
    print("\n".join(wrong) or message)
    sys.exit(bool(wrong))


def run(*words, **options):
    return subprocess.run(list(map(str, words)), cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True, **options).stdout


def build(*profile, copy=None, **environment):
    """The program, built by a profile; copied to a file, if the next build replaces it."""
    words = ["cargo", "build", "-q", *(profile or ["--release", "-p", "mode13h-cli"]), "-p", "frames", "--message-format", "json"]
    program = Path(re.findall(r'"executable":"([^"]*/frames)"', run(*words, env={**os.environ, **environment}))[-1])
    if copy:
        copy.parent.mkdir(parents=True, exist_ok=True)
        copy.write_bytes(program.read_bytes())
        copy.chmod(0o755)
    return copy or program


def in_parallel(function, items):
    """A dictionary from each item to what the function returns for it."""
    with ThreadPoolExecutor(max_workers=os.cpu_count()) as pool:
        return dict(zip(items, pool.map(function, items)))


class Count:
    """Instructions by function, of the frames from the second on (`next_frame`) or of others of its functions.

    The first frame allocates memory and makes tables. `arguments` are those of the program: scene, number of frames,
    kernel, and what else it takes.
    """

    def __init__(self, program, arguments, functions=("next_frame",)):
        out = ROOT / "target/callgrind" / "-".join([program.name, *arguments, *functions])
        out.parent.mkdir(parents=True, exist_ok=True)
        toggles = [f"--toggle-collect=frames::{function}*" for function in functions]
        valgrind = ["valgrind", "-q", "--tool=callgrind", f"--callgrind-out-file={out}", "--compress-strings=no", *toggles]
        said = [line.split() for line in run(*valgrind, program, *arguments).splitlines()]
        self.hash = said[0][1]
        self.effects = {word for what, word in said if what == "on"}
        # What a function took itself. The line behind `calls=` is what the function that it calls took.
        self.functions, self.in_libc, function, library, is_call = Counter(), 0, None, "", False
        for line in out.read_text().splitlines():
            if line.startswith("ob="):
                library = line
            elif line.startswith("fn="):
                function = line[3:]
            elif function and re.match(r"[+*\d-]", line) and not is_call and (instructions := int(line.split()[1])):
                self.functions[function] += instructions
                self.in_libc += instructions if "/libc" in library else 0
            is_call = line.startswith("calls=")
        if not self.functions:
            sys.exit(f"{' '.join(arguments)}: no instruction counted")
        self.frames = int(arguments[1]) - 1
        self.total = self.functions.total() / self.frames
