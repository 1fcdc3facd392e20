"""Compares what a VGA held, SCREEN.BIN of the program for DOS, with an indexed PNG of that frame.

    compare.py SCREEN.BIN FRAME.png
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
pixels, colors = png(sys.argv[2])
dac = bytes(part >> 2 for part in colors)
wrong = sum(a != b for a, b in zip(screen[:64000], pixels)), sum(a != b for a, b in zip(screen[64000:], dac))
if len(screen) != 64768 or any(wrong):
    sys.exit(f"{len(screen)} bytes; {wrong[0]} pixels and {wrong[1]} parts of colours differ")
print("video memory and DAC are those of the picture")
