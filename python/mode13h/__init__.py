"""Meshes to frames of 320 × 200 bytes in a palette of 256 colours, without a display or a GPU.

    import mode13h
    frame, palette = mode13h.render(vertices, faces)    # of a trimesh: mesh.vertices, mesh.faces
    mode13h.save_png("model.png", frame, palette)
    picture = mode13h.to_rgb(frame, palette)            # (200, 320, 3), for matplotlib: imshow(picture, aspect=1.2)

The bytes are the same on every machine. Bad input is a ValueError of one line.
"""

from __future__ import annotations

import os
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _engine

__all__ = ["Palette", "Shading", "render", "save_png", "to_rgb"]

Shading = Literal[
    "gouraud",
    "flat",
    "gouraud-vintage",
    "gouraud-8.8",
    "gouraud-8.8-reseeded",
    "gouraud-16.16",
    "gouraud-hyperbolic",
    "gouraud-tessellated",
    "phong-table",
    "phong",
    "gouraud-float",
]
"""How shades vary over a face; `gouraud` is `gouraud-8.8-reseeded`."""

Palette = Literal[
    "grey",
    "silver",
    "copper",
    "phosphor",
    "materials-4x64",
    "materials-8x32",
    "materials-16x16",
    "cube",
    "bios",
]
"""The built-in palettes."""


def render(
    vertices: ArrayLike,
    faces: ArrayLike,
    *,
    normals: ArrayLike | None = None,
    direction: ArrayLike | None = None,
    up: ArrayLike = (0.0, 1.0, 0.0),
    eye: ArrayLike | None = None,
    target: ArrayLike | None = None,
    field_of_view: float = 40.0,
    light: ArrayLike = (0.4, 0.6, 1.0),
    shading: Shading = "gouraud",
    max_error: float | None = None,
    palette: Palette | ArrayLike = "grey",
) -> tuple[NDArray[np.uint8], NDArray[np.uint8]]:
    """Draws a triangle mesh.

    Coordinates are right-handed; faces are counter-clockwise seen from outside. Hidden surfaces are
    removed by whatever method the mesh needs, a depth buffer if no cheaper one is right.

    Args:
        vertices: (n, 3) positions, finite, in any unit and as far from the origin as you like.
        faces: (m, 3) integers, each 0 to n - 1, at least one face. A vertex that faces share is
            shaded smoothly across them; list it once for each face, or take `shading="flat"`, for edges.
        normals: (n, 3) normals of the vertices, of any length but 0; otherwise those of the faces
            around each vertex, averaged by angle.
        direction: (3,) from the model towards the eye; otherwise from the front, a little from the
            right and above. The eye is where the model fills nine tenths of the picture, or less in
            a field of view so wide that the eye would be too near.
        up: (3,) up in the picture; (0, 0, 1) for a model whose z points up. Along `direction` it
            has no effect.
        eye: (3,) the eye's position, if you place it yourself instead of giving a `direction`.
        target: (3,) what that eye looks at; otherwise the middle of the model.
        field_of_view: degrees from the upper to the lower edge of the picture, above 0, below 180.
        light: (3,) towards the sun, as the eye sees it: to the right, up, towards the eye.
        shading: how shades run over a face.
        max_error: shades, of 255, that may be wrong, above 0: each face is drawn by the cheapest shading
            that is proved to stay within, whatever `shading` says.
        palette: a name, or (256, 3) integers, 0 to 255: red, green, blue. The model takes the first ramp
            from dark to light that it has.

    Returns:
        The frame, uint8 of shape (200, 320): indices of the palette, row 0 on top. Its pixels are 5:6,
        so that it fills a 4:3 screen.
        The palette, uint8 of shape (256, 3): the colours that a VGA shows, of 6 bits a channel.

    Raises:
        ValueError: for a wrong shape or type, a number that is not finite or out of range, a face that
            refers to a vertex that does not exist, an unknown name. Nothing is drawn then.
    """
    points = _numbers("vertices", vertices, ("n", 3))
    _finite("vertex", points)
    indices = _indices(faces, len(points))
    # Vertices of no face have no part in the picture, nor in the model's size.
    used = np.zeros(len(points), bool)
    used[indices] = True
    indices = (np.cumsum(used, dtype=indices.dtype) - 1).astype(indices.dtype)[indices]
    given, points = len(points), points[used]
    # Into the unit cube around the origin, before anything is rounded to float32. Scaling by a power of two is exact.
    low, high = points.min(axis=0), points.max(axis=0)
    middle = low / 2 + high / 2
    exponent = -int(np.frexp((high / 2 - low / 2).max())[1])

    def moved(array: NDArray[np.float64]) -> NDArray[np.float64]:
        with np.errstate(over="ignore"):
            result: NDArray[np.float64] = np.ldexp(array - middle, exponent)
        return result

    if eye is not None and direction is not None:
        raise ValueError("give either an eye or a direction")
    if eye is None and target is not None:
        raise ValueError("a target needs an eye")
    view = {
        "direction": None if direction is None else _numbers("direction", direction, (3,)).tolist(),
        "up": _numbers("up", up, (3,)).tolist(),
        "eye": None if eye is None else moved(_numbers("eye", eye, (3,))).tolist(),
        "target": [0.0] * 3 if target is None else moved(_numbers("target", target, (3,))).tolist(),
        "field_of_view": float(_numbers("field_of_view", field_of_view, ())),
    }
    look = {
        "light": _numbers("light", light, (3,)).tolist(),
        "shading": _text("shading", shading),
        "max_error": None if max_error is None else float(_numbers("max_error", max_error, ())),
        "palette": _text("palette", palette) if isinstance(palette, str) else _bytes("palette", palette, (256, 3)).tobytes(),
    }
    own = None if normals is None else _numbers("normals", normals, (given, 3))
    if own is not None:
        _finite("the normal of vertex", own)
        zero = np.flatnonzero(used & ~own.any(axis=1))
        if zero.size:
            raise ValueError(f"the normal of vertex {zero[0]} is zero")
        own = own[used]
        # Lengths whose squares 32 bits cannot hold.
        longest = np.abs(own).max(axis=1, keepdims=True)
        is_ordinary = (longest == 0) | (longest > 1e-18) & (longest < 1e18)
        own = own / np.where(is_ordinary, 1, longest)
    normal_bytes = None if own is None else _floats(own)
    frame, colors = _engine.draw(_floats(moved(points)), indices.tobytes(), normal_bytes, view, look)
    return _writable(frame, (200, 320)), _writable(colors, (256, 3))


def to_rgb(frame: ArrayLike, palette: ArrayLike) -> NDArray[np.uint8]:
    """Looks up a frame's colours.

    Args:
        frame: (height, width) integers, 0 to 255.
        palette: (256, 3) integers, 0 to 255: red, green, blue.

    Returns:
        uint8 of shape (height, width, 3). Of a frame of `render` the pixels are 5:6: a viewer of square
        pixels shows it 320 × 240 if you stretch it by 1.2 in height.

    Raises:
        ValueError: for a wrong shape or type, or a number out of range.
    """
    return _bytes("palette", palette, (256, 3))[_bytes("frame", frame, ("height", "width"))]


def save_png(path: str | os.PathLike[str], frame: ArrayLike, palette: ArrayLike) -> None:
    """Writes a frame as an indexed PNG.

    A frame of 320 × 200 says in the file that its pixels are 5:6, any other that they are square.

    Args:
        path: the file, which is replaced if it exists.
        frame: (height, width) integers, 0 to 255; sides of 1 to 16,384 pixels.
        palette: (256, 3) integers, 0 to 255: red, green, blue.

    Raises:
        ValueError: for a wrong shape or type, or a number out of range.
        OSError: if the file cannot be written; FileNotFoundError, NotADirectoryError, IsADirectoryError or
            PermissionError if that is why. What was there before is still there.
    """
    pixels = _bytes("frame", frame, ("height", "width"))
    if pixels.size == 0:
        raise ValueError("frame: no pixels")
    _engine.save(os.fspath(path), pixels.tobytes(), pixels.shape[1], _bytes("palette", palette, (256, 3)).tobytes())


def _array(name: str, value: ArrayLike, kinds: str, what: str, shape: tuple[int | str, ...]) -> NDArray[Any]:
    """Converts a value to an array, if its type and shape are right. A name in `shape` stands for any length."""
    try:
        array = np.asarray(value)
    except (TypeError, ValueError, OverflowError):
        raise ValueError(f"{name}: no array of {what}") from None
    # To numpy an empty list is a list of floats.
    if array.dtype.kind not in kinds and array.size != 0:
        raise ValueError(f"{name}: {array.dtype} values, but {what} are needed")
    is_right = array.ndim == len(shape) and all(isinstance(a, str) or a == b for a, b in zip(shape, array.shape))
    if not is_right:
        needed = f"({', '.join(map(str, shape))}{',' if len(shape) == 1 else ''})" if shape else "a single number"
        raise ValueError(f"{name}: an array of shape {array.shape}, but {needed} is needed")
    return array


def _numbers(name: str, value: ArrayLike, shape: tuple[int | str, ...]) -> NDArray[np.float64]:
    with np.errstate(over="ignore"):
        return _array(name, value, "fiu", "numbers", shape).astype(np.float64)


def _bytes(name: str, value: ArrayLike, shape: tuple[int | str, ...]) -> NDArray[np.uint8]:
    array = _array(name, value, "iu", "integers", shape)
    if array.size != 0 and not (array.min() >= 0 and array.max() <= 255):
        raise ValueError(f"{name}: values must be 0 to 255")
    return array.astype(np.uint8)


def _finite(what: str, rows: NDArray[np.float64]) -> None:
    wrong = np.flatnonzero(~np.isfinite(rows).all(axis=1))
    if wrong.size != 0:
        raise ValueError(f"{what} {wrong[0]} is not finite")


def _indices(faces: ArrayLike, vertices: int) -> NDArray[np.uint32]:
    array = _array("faces", faces, "iu", "integers", ("m", 3))
    if len(array) == 0:
        raise ValueError("faces: there are none")
    wrong = np.argwhere((array < 0) | (array >= vertices))
    if wrong.size != 0:
        face, corner = wrong[0]
        raise ValueError(f"face {face} names vertex {array[face, corner]}, but there are {vertices}")
    return array.astype(np.uint32)


def _floats(array: NDArray[np.float64]) -> bytes:
    with np.errstate(over="ignore"):
        return array.astype(np.float32).tobytes()


def _text(name: str, value: object) -> str:
    if not isinstance(value, str):
        raise ValueError(f"{name}: a name is needed")
    # Without half a character, which has no bytes.
    return value.encode(errors="replace").decode()


def _writable(data: bytes, shape: tuple[int, ...]) -> NDArray[np.uint8]:
    return np.frombuffer(data, np.uint8).reshape(shape).copy()
