"""Tests of the installed package: python -m unittest discover python/tests

MODE13H is the path of the program, with which frames are compared.
"""

import os
import subprocess
import tempfile
import threading
import typing
import unittest
import warnings
from pathlib import Path

import numpy as np

import mode13h

CUBE = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
# Counter-clockwise seen from outside; vertex i is at x = i & 4, y = i & 2, z = i & 1.
CUBE_FACES = np.array(
    [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1]]
    + [[2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]
)


def torus(around: int = 24, tube: int = 12):
    """Vertices, normals and faces, within a box around the origin whose longest side is 1.5."""
    a, b = np.meshgrid(np.arange(around), np.arange(tube), indexing="ij")
    u, v = 2 * np.pi * a / around, 2 * np.pi * b / tube
    normals = np.stack([np.cos(v) * np.cos(u), np.cos(v) * np.sin(u), np.sin(v)], -1).reshape(-1, 3)
    centres = np.stack([np.cos(u), np.sin(u), 0 * u], -1).reshape(-1, 3)
    at = lambda i, j: (i % around) * tube + j % tube
    quads = [(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)) for i in range(around) for j in range(tube)]
    faces = np.array([face for p, q, r, s in quads for face in ((p, q, r), (p, r, s))])
    # Rounded as in the text of a model file.
    vertices = np.round(0.5 * centres + 0.25 * normals, 8) + 0.0
    return vertices, np.round(normals, 8) + 0.0, faces


class Frames(unittest.TestCase):
    def test_a_cube_seen_straight_on_fills_nine_tenths_of_the_height(self):
        frame, palette = mode13h.render(CUBE, CUBE_FACES, direction=(0, 0, 1), light=(0, 0, 1), shading="flat")
        self.assertEqual((frame.shape, frame.dtype), ((200, 320), np.uint8))
        self.assertEqual((palette.shape, palette.dtype), ((256, 3), np.uint8))
        # The picture's 4:3 are 320 × 200, so a square of 180 rows has 216 columns. Edges lie between pixels' centres, half
        # a pixel from each.
        expected = np.zeros((200, 320), bool)
        expected[10:190, 52:268] = True
        np.testing.assert_array_equal(frame != 0, expected)
        self.assertEqual(np.unique(frame).tolist(), [0, 255])
        frame[0, 0] = palette[0, 0] = 1

    def test_the_program_writes_the_same_files(self):
        vertices, normals, faces = torus()
        # Besides the default, where the argument is left out.
        shadings = [None, *typing.get_args(mode13h.Shading)]
        with tempfile.TemporaryDirectory() as folder:
            folder = Path(folder)
            lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in vertices.tolist()]
            lines += [f"vn {x!r} {y!r} {z!r}" for x, y, z in normals.tolist()]
            lines += ["f " + " ".join(f"{i + 1}//{i + 1}" for i in face) for face in faces.tolist()]
            (folder / "torus.obj").write_text("\n".join(lines) + "\n")
            (folder / "torus.toml").write_text(
                'objects = [{ model = "torus.obj" }]\n'
                "lights = [{ sun = [0.4, 0.6, 1] }]\n"
                "camera = { eye = [0, 0, 2], target = [0, 0, 0.125], field-of-view = 50 }\n"
            )
            for palette in ("grey", "copper", "materials-4x64", "cube"):
                for shading in shadings:
                    look = {} if shading is None else {"shading": shading}
                    frame, colors = mode13h.render(
                        vertices, faces, normals=normals, eye=(0, 0, 2), target=(0, 0, 0.125), field_of_view=50,
                        palette=palette, **look,
                    )
                    mode13h.save_png(folder / "ours.png", frame, colors)
                    name = {None: [], "gouraud": []}.get(shading, ["--shading", shading])
                    words = [*name, "--palette", palette, "-o", "theirs.png", "--force", "-q"]
                    subprocess.run([os.environ["MODE13H"], "render", "torus.toml", *words], cwd=folder, check=True)
                    self.assertGreater(len(np.unique(frame)), 4, (palette, shading))
                    ours, theirs = (folder / "ours.png").read_bytes(), (folder / "theirs.png").read_bytes()
                    self.assertEqual(ours, theirs, (palette, shading))

    def test_a_budget_of_error_makes_another_frame(self):
        vertices, normals, faces = torus(12, 8)
        fine, coarse = (mode13h.render(vertices, faces, normals=normals, max_error=e)[0] for e in (0.5, 100))
        self.assertGreater(np.count_nonzero(fine != coarse), 100)

    def test_size_and_place_of_a_model_change_nothing(self):
        vertices, _, faces = torus()
        # Ten fraction bits, so that the sums are exact.
        vertices = np.round(vertices * 1024) / 1024
        frame = mode13h.render(vertices, faces)[0]
        for scale in (2.0**-1000, 2.0**-40, 2.0**40, 2.0**1000):
            np.testing.assert_array_equal(mode13h.render(vertices * scale, faces)[0], frame)
        far = np.array([2.0**30, -(2.0**35), 5e6])
        np.testing.assert_array_equal(mode13h.render(vertices + far, faces)[0], frame)
        seen = mode13h.render(vertices, faces, eye=(1, 2, 3))[0]
        np.testing.assert_array_equal(mode13h.render(vertices + far, faces, eye=far + (1, 2, 3))[0], seen)

    def test_vertices_of_no_face_change_nothing(self):
        expected = mode13h.render(CUBE, CUBE_FACES, normals=CUBE)
        for far in (2, 1e5, 1e30):
            with_more = np.vstack([[far, 0, 0], CUBE[:4], [0, -far, far], CUBE[4:]])
            numbers = np.array([1, 2, 3, 4, 6, 7, 8, 9])[CUBE_FACES]
            drawn = mode13h.render(with_more, numbers, normals=with_more)
            self.assertTrue(all(np.array_equal(a, b) for a, b in zip(expected, drawn)), far)

    def test_only_the_direction_to_a_target_matters(self):
        expected, _ = mode13h.render(CUBE, CUBE_FACES, eye=(0.5, 0.25, 4), target=(0.5, 0.25, 0))
        for z in (1, -100, -1e3, -1e6, -1e20, -1e300):
            drawn, _ = mode13h.render(CUBE, CUBE_FACES, eye=(0.5, 0.25, 4), target=(0.5, 0.25, z))
            self.assertTrue(np.array_equal(expected, drawn), z)

    def test_an_eye_in_the_middle_sees_what_is_in_front(self):
        # Two walls, the one behind turned away from the light, and one behind the eye.
        corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
        walls = np.vstack([np.column_stack([corners, np.full(4, z)]) for z in (-0.9, -0.9001, 0.9001)])
        faces = [[a + 4 * wall, b + 4 * wall, c + 4 * wall] for wall in range(3) for a, b, c in ((0, 1, 2), (0, 2, 3))]
        normals = np.repeat([[0, 0, 1], [0, 0, -1], [0, 0, -1]], 4, axis=0)
        for off in (0, 1e-9, 1e-6, 1e-3):
            seen = {"eye": (off, 0, 0), "target": (off, 0, -1e3), "field_of_view": 60}
            frame, _ = mode13h.render(walls, faces, normals=normals, **seen)
            self.assertGreater(frame[50:150, 100:220].min(), 50, off)

    def test_normals_have_any_length(self):
        expected, _ = mode13h.render(CUBE, CUBE_FACES, normals=CUBE)
        for length in (1e-300, 1e-46, 2.0, 1e39, 1e300):
            drawn, _ = mode13h.render(CUBE, CUBE_FACES, normals=CUBE * length)
            self.assertLess(np.abs(drawn.astype(int) - expected).max(), 2, length)

    def test_up_turns_the_model_and_the_default_direction_with_it(self):
        y = mode13h.render(CUBE * (1, 2, 3), CUBE_FACES, shading="flat")[0]
        # (x, y, z) with y up is (x, −z, y) with z up.
        turned = (CUBE * (1, 2, 3))[:, [0, 2, 1]] * (1, -1, 1)
        z = mode13h.render(turned, CUBE_FACES, up=(0, 0, 1), shading="flat")[0]
        # The turn rounds, so a pixel on an edge may go either way; fewer than a hundredth of the edges' pixels do.
        self.assertLess((y != z).sum(), 10)
        for up in ((0, 0, 1), (0, 0, -2), (1e-9, 0, 1)):
            self.assertGreater(np.count_nonzero(mode13h.render(CUBE, CUBE_FACES, direction=(0, 0, 5), up=up)[0]), 1000)

    def test_a_palette_of_ones_own(self):
        grey = np.repeat(np.arange(256), 3).reshape(256, 3)
        frame, palette = mode13h.render(CUBE, CUBE_FACES)
        own, colors = mode13h.render(CUBE, CUBE_FACES, palette=grey)
        np.testing.assert_array_equal(own, frame)
        np.testing.assert_array_equal(colors, palette)
        rgb = mode13h.to_rgb(frame, palette)
        self.assertEqual((rgb.shape, rgb.dtype), ((200, 320, 3), np.uint8))
        self.assertEqual(rgb[100, 160].tolist(), palette[frame[100, 160]].tolist())

    def test_other_forms_of_the_same_arrays(self):
        frame = mode13h.render(CUBE, CUBE_FACES)[0]
        for vertices in (CUBE.tolist(), CUBE.astype(np.int8), CUBE.astype(">f4"), np.asfortranarray(CUBE)):
            for faces in (CUBE_FACES.tolist(), CUBE_FACES.astype(np.uint64), CUBE_FACES.astype(">i2")[:, ::1]):
                np.testing.assert_array_equal(mode13h.render(vertices, faces)[0], frame)

    def test_threads_draw_at_the_same_time(self):
        vertices, _, faces = torus(96, 48)
        frame, frames = mode13h.render(vertices, faces)[0], []
        draw = lambda: frames.append(mode13h.render(vertices, faces)[0])
        threads = [threading.Thread(target=draw) for _ in range(8)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(len(frames), 8)
        for other in frames:
            np.testing.assert_array_equal(other, frame)


class Errors(unittest.TestCase):
    def refused(self, words: str, *arguments, call=mode13h.render, **named):
        with self.assertRaises(ValueError) as caught:
            call(*arguments, **named)
        self.assertEqual(str(caught.exception), words)

    def test_each_has_its_words(self):
        nan = CUBE.copy()
        nan[5, 2] = np.nan
        self.refused("vertex 5 is not finite", nan, CUBE_FACES)
        self.refused("vertex 0 is not finite", CUBE * np.inf, CUBE_FACES)
        self.refused("vertices: an array of shape (8, 2), but (n, 3) is needed", CUBE[:, :2], CUBE_FACES)
        self.refused("vertices: no array of numbers", [[0, 1, 2], [3]], CUBE_FACES)
        self.refused("vertices: complex128 values, but numbers are needed", CUBE * 1j, CUBE_FACES)
        self.refused("vertices: <U1 values, but numbers are needed", [["a", "b", "c"]], CUBE_FACES)
        self.refused("vertices: object values, but numbers are needed", None, CUBE_FACES)
        self.refused("faces: an array of shape (12, 2), but (m, 3) is needed", CUBE, CUBE_FACES[:, :2])
        self.refused("faces: an array of shape (0,), but (m, 3) is needed", CUBE, [])
        self.refused("faces: there are none", CUBE, np.zeros((0, 3), int))
        self.refused("faces: float64 values, but integers are needed", CUBE, CUBE_FACES * 1.0)
        self.refused("face 1 names vertex 8, but there are 8", CUBE, [[0, 1, 2], [3, 8, 4], [9, 9, 9]])
        self.refused("face 0 names vertex -1, but there are 8", CUBE, [[0, -1, 2]])
        self.refused(f"face 0 names vertex {2**64 - 1}, but there are 8", CUBE, np.array([[2**64 - 1] * 3], np.uint64))
        self.refused("face 0 names vertex 0, but there are 0", np.zeros((0, 3)), [[0, 0, 0]])
        self.refused("normals: an array of shape (7, 3), but (8, 3) is needed", CUBE, CUBE_FACES, normals=CUBE[1:])
        self.refused("the normal of vertex 5 is not finite", CUBE, CUBE_FACES, normals=nan)
        self.refused("the normal of vertex 0 is zero", CUBE, CUBE_FACES, normals=CUBE * 0)
        more = np.vstack([[[9, 9, 9]], CUBE])
        normals = more.copy()
        normals[[0, 3]] = 0
        self.refused("the normal of vertex 3 is zero", more, CUBE_FACES + 1, normals=normals)
        self.refused("direction must not be zero", CUBE, CUBE_FACES, direction=(0, 0, 0))
        self.refused("direction: an array of shape (2,), but (3,) is needed", CUBE, CUBE_FACES, direction=(0, 0))
        self.refused("up must be finite", CUBE, CUBE_FACES, up=(0, np.nan, 0))
        self.refused("light must not be zero", CUBE, CUBE_FACES, light=(0, 0, 0))
        self.refused("the vector from target to eye must not be zero", CUBE, CUBE_FACES, eye=(0, 0, 0))
        self.refused("the vector from target to eye must be finite", CUBE, CUBE_FACES, eye=(0, np.inf, 0))
        self.refused("give either an eye or a direction", CUBE, CUBE_FACES, eye=(0, 0, 9), direction=(0, 0, 1))
        self.refused("a target needs an eye", CUBE, CUBE_FACES, target=(0, 0, 0))
        for angle in (0, 180, -1, np.nan, np.inf):
            words = "field_of_view must be above 0 and below 180 degrees"
            self.refused(words, CUBE, CUBE_FACES, field_of_view=angle)
            self.refused(words, CUBE, CUBE_FACES, field_of_view=angle, eye=(0, 0, 9))
        self.refused("field_of_view: an array of shape (1,), but a single number is needed", CUBE, CUBE_FACES, field_of_view=[9])
        names = ", ".join(typing.get_args(mode13h.Shading)[1:])
        self.refused(f'shading "none": unknown shading; there are {names}', CUBE, CUBE_FACES, shading="none")
        self.refused(f'shading "none": unknown shading; there are {names}', CUBE, CUBE_FACES, shading="none", max_error=4)
        self.refused("shading: a name is needed", CUBE, CUBE_FACES, shading=1)
        names = ", ".join(typing.get_args(mode13h.Palette))
        self.refused(f'palette "none": unknown palette; there are {names}', CUBE, CUBE_FACES, palette="none")
        self.refused('palette "?": unknown palette; there are ' + names, CUBE, CUBE_FACES, palette="\ud800")
        self.refused("palette: values must be 0 to 255", CUBE, CUBE_FACES, palette=np.full((256, 3), 256))
        self.refused("palette: an array of shape (255, 3), but (256, 3) is needed", CUBE, CUBE_FACES, palette=np.zeros((255, 3), int))
        self.refused("palette: float64 values, but integers are needed", CUBE, CUBE_FACES, palette=np.zeros((256, 3)))
        for shades in (0, -1, np.nan, np.inf):
            with self.assertRaisesRegex(ValueError, "^settings: .*"):
                mode13h.render(CUBE, CUBE_FACES, max_error=shades)

    def test_of_the_other_functions(self):
        frame, palette = mode13h.render(CUBE, CUBE_FACES)
        self.refused("frame: an array of shape (200,), but (height, width) is needed", frame[:, 0], palette, call=mode13h.to_rgb)
        self.refused("frame: values must be 0 to 255", frame.astype(int) - 1, palette, call=mode13h.to_rgb)
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "a.png")
            path.write_text("kept")
            self.refused("frame: no pixels", path, frame[:, :0], palette, call=mode13h.save_png)
            with self.assertRaisesRegex(ValueError, "20000"):
                mode13h.save_png(path, np.zeros((1, 20000), int), palette)
            self.assertEqual(path.read_text(), "kept")
            with self.assertRaisesRegex(FileNotFoundError, "^[^\n]*missing[^\n]*$"):
                mode13h.save_png(Path(folder, "missing", "a.png"), frame, palette)
            with self.assertRaisesRegex(NotADirectoryError, "^[^\n]*not a directory$"):
                mode13h.save_png(path / "b.png", frame, palette)
            with self.assertRaisesRegex(IsADirectoryError, "^[^\n]*is a directory$"):
                mode13h.save_png(folder, frame, palette)
            mode13h.save_png(str(path), frame, palette)
            self.assertEqual(path.read_bytes()[:8], b"\x89PNG\r\n\x1a\n")
            self.assertEqual(os.listdir(folder), ["a.png"])

    def test_no_input_does_more_than_raise_a_valueerror(self):
        random = np.random.default_rng(13)
        numbers = [0.0, -0.0, 1.0, -1.0, 0.5, 5e-324, 1e-45, 1e-38, 3.4e38, 1e39, -1.7e308, 1.7e308, np.nan, np.inf, -np.inf]
        # Most rounds with numbers that are drawn.
        lists = [numbers[:5], numbers[:12], numbers]
        drawn, refused = 0, 0
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            for _ in range(3000):
                some = lists[random.choice(3, p=(0.3, 0.5, 0.2))]
                vertex_count, face_count = random.integers(1, 7), random.integers(1, 9)
                pick = lambda *shape: random.choice(some, shape)
                named = {
                    "normals": lambda: pick(vertex_count, 3),
                    "direction": lambda: pick(3),
                    "up": lambda: pick(3),
                    "eye": lambda: pick(3),
                    "target": lambda: pick(3),
                    "light": lambda: pick(3),
                    "field_of_view": lambda: random.choice([*some, 1e-9, 40, 179.999]),
                    "max_error": lambda: random.choice([*some, 4]),
                    "palette": lambda: random.integers(0, 256, (256, 3)),
                    "shading": lambda: random.choice(typing.get_args(mode13h.Shading)).item(),
                }
                chosen = {name: make() for name, make in named.items() if random.random() < 0.1}
                faces = random.integers(0, vertex_count + (random.random() < 0.1), (face_count, 3))
                try:
                    frame, palette = mode13h.render(pick(vertex_count, 3), faces, **chosen)
                    self.assertEqual((frame.shape, palette.shape), ((200, 320), (256, 3)))
                    drawn += 1
                except ValueError as error:
                    self.assertNotIn("\n", str(error))
                    refused += 1
        self.assertGreater(min(drawn, refused), 500, (drawn, refused))


if __name__ == "__main__":
    unittest.main()
