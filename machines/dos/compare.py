"""Compares the contents of a VGA with an indexed PNG of the same frame.

    compare.py SCREEN.BIN FRAME.png               video memory and DAC, as the program for DOS writes them
    compare.py VIDEO.BIN SCREEN.ppm FRAME.png     video memory, and the picture that QEMU shows, twice as large
"""

import struct
import sys
import zlib


def png(path):
    """The bytes and the 256 colours of an indexed PNG without interlacing, 320 x 200."""
    data, at, packed, colors = open(path, "rb").read(), 8, b"", b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at : at + 8])
        body = data[at + 8 : at + 8 + length]
        if kind == b"IHDR":
            assert struct.unpack(">IIBBBBB", body) == (320, 200, 8, 3, 0, 0, 0), "320 x 200 bytes of a palette"
        packed += body if kind == b"IDAT" else b""
        colors = body if kind == b"PLTE" else colors
        at += 12 + length
    rows, above, pixels = zlib.decompress(packed), bytes(320), b""
    for y in range(200):
        kind, row = rows[y * 321], bytearray(rows[y * 321 + 1 : y * 321 + 321])
        for x in range(320):
            left, corner = (row[x - 1], above[x - 1]) if x else (0, 0)
            near = left + above[x] - corner
            nearest = min((abs(near - left), 0, left), (abs(near - above[x]), 1, above[x]), (abs(near - corner), 2, corner))
            row[x] = (row[x] + [0, left, above[x], (left + above[x]) // 2, nearest[2]][kind]) % 256
        above = bytes(row)
        pixels += above
    return pixels, colors.ljust(768, b"\0")


screen = open(sys.argv[1], "rb").read()
pixels, colors = png(sys.argv[-1])
dac = bytes(part >> 2 for part in colors)
if len(sys.argv) == 4:
    shown = open(sys.argv[2], "rb").read()
    assert shown[:15] == b"P6\n640 400\n255\n", "640 x 400 colours"
    places = (((y * 640 + x) * 3 + 15, 3 * pixels[y // 2 * 320 + x // 2]) for y in range(400) for x in range(640))
    colors_wrong = sum(bytes(c >> 2 for c in shown[at : at + 3]) != dac[i : i + 3] for at, i in places)
    length = 64000
else:
    colors_wrong = sum(a != b for a, b in zip(screen[64000:], dac))
    length = 64768
wrong = sum(a != b for a, b in zip(screen, pixels))
if len(screen) != length or wrong or colors_wrong:
    sys.exit(f"{len(screen)} bytes; {wrong} pixels and {colors_wrong} colours or parts of them differ")
print("video memory and DAC match the picture")
