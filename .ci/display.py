"""An X display (Xvfb), and programs that open windows on it. Needs xvfb, xdotool and ImageMagick."""

import os
import re
import subprocess
import sys
import tempfile
import time
from contextlib import contextmanager


@contextmanager
def display(size):
    """Starts Xvfb on the first free number, with a screen such as 1280x1024."""
    read, write = os.pipe()
    # Without -noreset it restarts, refusing clients, when xdotool, for a moment its only client, leaves.
    words = ["Xvfb", "-displayfd", str(write), "-noreset", "-screen", "0", f"{size}x24"]
    server = subprocess.Popen(words, pass_fds=[write], stderr=subprocess.DEVNULL)
    os.close(write)
    os.environ["DISPLAY"] = ":" + os.fdopen(read).readline().strip()
    try:
        yield
    finally:
        server.terminate()
        server.wait()


def check(holds, message):
    if not holds:
        sys.exit(f"{sys.argv[0]}: {message}")


def until(holds, seconds, message):
    """Waits until `holds()` is true, and returns what it returned."""
    end = time.monotonic() + seconds
    while not (value := holds()):
        check(time.monotonic() < end, message)
        time.sleep(0.05)
    return value


def xdotool(*words):
    return subprocess.run(["xdotool", *map(str, words)], capture_output=True, text=True).stdout.strip()


def pixels(window="root", *options):
    """The colours of a window's pixels, three bytes each."""
    words = ["import", "-silent", "-window", window, *options, "-depth", "8", "ppm:-"]
    picture = subprocess.run(words, capture_output=True, check=True).stdout
    picture = picture[re.match(rb"P6\s+\d+\s+\d+\s+255\s", picture).end() :]
    return list(zip(picture[::3], picture[1::3], picture[2::3]))


class Window:
    """A running program and its window, found by its title."""

    def __init__(self, title, *command, **options):
        self.errors = tempfile.TemporaryFile("w+")
        self.program = subprocess.Popen(command, stderr=self.errors, **options)
        find = lambda: self.is_running() and xdotool("search", "--name", title)
        self.id = until(find, 20, f"no window {title}").split()[-1]

    def said(self):
        self.errors.seek(0)
        return self.errors.read()

    def is_running(self):
        check(self.program.poll() is None, f"{self.program.args[0]} ended: {self.said()}")
        return True

    def stop(self):
        """Stops the program, which must be running."""
        self.is_running()
        self.program.kill()
        self.program.wait()
