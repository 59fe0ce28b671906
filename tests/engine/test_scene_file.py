# SPDX-License-Identifier: GPL-3.0-or-later
"""The scene file: every key is read, and every mistake gets one line that says where it is and what is allowed."""

import json
import os
import struct
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from tests.engine import scenes
from tests.engine.scenes import QUAD, Scene, changed, every_key, removed, run_glimmer, write_scene

pytestmark = pytest.mark.usefixtures("glimmer_command")


def message_of(folder: Path, content: Scene | str) -> str:
    """The one line that a bad scene gets, without the file's name."""
    path = write_scene(folder, content)
    done = run_glimmer(path, "-o", folder / "out.exr", "--spp", 1)
    assert done.returncode == 1, f"exit status {done.returncode}: {done.stderr}"
    assert done.stderr.startswith(f"{path}: ") and done.stderr.endswith("\n")
    assert done.stderr.count("\n") == 1, f"not one line: {done.stderr!r}"
    assert not list(folder.glob("out*")), "a failed run left a picture"
    return done.stderr[len(f"{path}: ") : -1]


def expect_good(folder: Path, content: Scene) -> None:
    path = write_scene(folder, content)
    done = run_glimmer(path, "-o", folder / "out.exr", "--spp", 1, "--quiet")
    assert done.returncode == 0, done.stderr


def test_every_key_is_read(tmp_path: Path) -> None:
    expect_good(tmp_path, every_key(tmp_path))


def test_example_of_the_format(tmp_path: Path) -> None:
    """The file that SCENE_FORMAT.md shows."""
    text = (Path(__file__).parents[2] / "engine" / "cli" / "SCENE_FORMAT.md").read_text()
    example = text.split("```json\n")[1].split("```")[0]
    np.save(tmp_path / "plates.npy", np.tile(np.eye(3, 4, dtype=np.float32), (2, 1, 1)))
    np.save(tmp_path / "many.npy", np.array([[3.0, 20.0, 3.0]]))
    scenes.write_ply(tmp_path / "hex.ply", QUAD["vertices"], [[0, 1, 2, 3]])
    expect_good(tmp_path, json.loads(example))


@dataclass(frozen=True)
class Bad:
    """One value of the scene with every key, replaced or removed, and the message it must get."""

    path: tuple[str | int, ...]
    value: Any
    message: str


REMOVED = object()

BAD = [
    # top level
    Bad(("glimmer",), REMOVED, 'the key "glimmer" is missing'),
    Bad(("glimmer",), 2, "glimmer: 2 is not 1, the only value that is allowed here"),
    Bad(("film",), REMOVED, 'the key "film" is missing'),
    Bad(
        ("camera",),
        {"to_world": [[2, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]], "fov_x": 60},
        "camera: to_world must be rigid",
    ),
    Bad(("camera",), REMOVED, 'the key "camera" is missing'),
    Bad(("extra",), 1, 'unknown key "extra"; allowed here are glimmer, film, camera, materials,'),
    Bad(("objects",), {}, "objects: an object is not a list [...]"),
    Bad(("meshes",), [], "meshes: a list of 0 is not an object {...}"),
    Bad(("objects", 0), 5, "objects[0]: 5 is not an object {...}"),
    # film
    Bad(("film", "width"), 0, "film.width: 0 is not an integer from 1 to 65536"),
    Bad(("film", "width"), 65537, "film.width: 65537 is not an integer from 1 to 65536"),
    Bad(("film", "width"), 480.5, "film.width: 480.5 is not an integer from 1 to 65536"),
    Bad(("film", "width"), 1e300, "film.width: 1e+300 is not an integer from 1 to 65536"),
    Bad(("film", "width"), 2**64 - 1, "film.width: 18446744073709551615 is not an integer from 1 to 65536"),
    Bad(("film", "width"), "480", 'film.width: "480" is not an integer from 1 to 65536'),
    Bad(("film", "height"), REMOVED, 'film: the key "height" is missing'),
    Bad(("film", "widht"), 4, 'film: unknown key "widht"; allowed here are width, height, filter, crop'),
    Bad(("film", "filter"), "gauss", 'film.filter: "gauss" is not a filter; filters are "box", "blackman_harris"'),
    Bad(("film", "filter", "type"), 3, "film.filter.type: 3 is not a text in double quotes"),
    Bad(("film", "filter", "width"), 0, "film.filter.width: 0 is not a number above 0"),
    Bad(("film", "filter"), {"type": "box", "width": 2}, "film.filter.width: a box is exactly one pixel"),
    Bad(("film", "filter"), {"width": 2}, 'film.filter: the key "type" is missing'),
    Bad(
        ("film", "crop"),
        [4, 1, 4, 11],
        "film.crop: [4,1,4,11] is not a rectangle [x0, y0, x1, y1) of the 16 x 12 picture",
    ),
    Bad(("film", "crop"), [0, 0, 17, 12], "film.crop: [0,0,17,12] is not a rectangle"),
    Bad(("film", "crop"), [0, 0, 8], "film.crop: a list of 3 is not a list of 4"),
    Bad(("film", "crop", 1), -1, "film.crop[1]: -1 is not an integer from 0 to 65536"),
    # camera
    Bad(("camera", "fov_x"), 180, "camera.fov_x: 180 is not a number above 0 and below 180"),
    Bad(("camera", "fov_x"), "wide", 'camera.fov_x: "wide" is not a number above 0 and below 180'),
    Bad(("camera", "origin"), [0, 1], "camera.origin: a list of 2 is not a list of 3"),
    Bad(("camera", "origin"), [0, 1, True], "camera.origin[2]: true is not a number"),
    Bad(("camera", "target"), [0, -8, 2], "camera.target: the target is where the origin is"),
    Bad(("camera", "up"), [0, 0, 0], "camera.up: [0, 0, 0] is not a direction"),
    Bad(("camera", "up"), [0, 8, -2], "camera: up is parallel to the direction of view"),
    Bad(("camera", "to_world"), scenes.IDENTITY, "camera: needs either origin and target (and up), or to_world"),
    Bad(("camera", "focus_distance"), REMOVED, "camera: a lens_radius above 0 needs a focus_distance"),
    Bad(("camera", "lens_radius"), -1, "camera.lens_radius: -1 is not a number of 0 or more"),
    Bad(("camera", "clip"), [2, 1], "camera.clip: [2,1] is not [start, end] with start < end"),
    Bad(("camera", "shift"), 1, "camera.shift: 1 is not a list of 2"),
    # materials
    Bad(
        ("materials", "wax", "type"),
        "lambertt",
        'materials.wax.type: "lambertt" is not a material type; material types are "lambert",',
    ),
    Bad(("materials", "wax", "albedo"), 1.5, "materials.wax.albedo: 1.5 is not a number from 0 to 1"),
    Bad(("materials", "wax", "albedo"), [0, 0, 2], "materials.wax.albedo[2]: 2 is not a number from 0 to 1"),
    Bad(("materials", "wax", "albedo"), [0, 0], "materials.wax.albedo: a list of 2 is not a number or a list of 3"),
    Bad(
        ("materials", "wax", "alpha"),
        0.1,
        'materials.wax: unknown key "alpha"; allowed here are type, albedo, emission',
    ),
    Bad(("materials", "wax", "emission"), -0.1, "materials.wax.emission: -0.1 is not a number of 0 or more"),
    Bad(("materials", "wax", "emission"), 1e39, "materials.wax.emission: 1e+39 is too large; up to 3.4e38 is allowed"),
    Bad(("materials", "glass", "emission"), 1, 'materials.glass: unknown key "emission"'),
    Bad(("materials", "glass", "ior"), 0, "materials.glass.ior: 0 is not a number above 0"),
    Bad(("materials", "glass", "ior"), 1e-60, "materials.glass.ior: 1e-60 as a 32-bit float is not a number above 0"),
    Bad(
        ("materials", "glass", "fresnel"),
        "Schlick",
        'materials.glass.fresnel: "Schlick" is not a Fresnel function; Fresnel functions are "exact", "schlick"',
    ),
    Bad(("materials", "metal", "f0"), 0.5, "materials.metal: needs either eta and k, or f0"),
    Bad(("materials", "metal", "f90"), 0.5, "materials.metal: f90 goes with f0, not with eta and k"),
    Bad(("materials", "gold", "f90"), 1.5, "materials.gold.f90: 1.5 is not a number from 0 to 1"),
    Bad(("materials", "metal", "k"), REMOVED, 'materials.metal: the key "k" is missing'),
    Bad(("materials", "metal", "eta"), 0, "materials.metal.eta: 0 is not a number above 0"),
    Bad(
        ("materials", "metal", "masking"),
        "ggx",
        'materials.metal.masking: "ggx" is not a masking function; masking functions are "smith",',
    ),
    Bad(("materials", "gold", "alpha"), 2, "materials.gold.alpha: 2 is not a number from 0 to 1"),
    Bad(("materials", "plate", "weight"), [0.5] * 3, "materials.plate.weight: a list of 3 is not a number from 0 to 1"),
    Bad(
        ("materials", "plate", "b"),
        "metall",
        'materials.plate.b: "metall" is not a material; materials are "plate", "metal",',
    ),
    Bad(("materials", "plate", "b"), "moon", "materials.plate.b: neither part of a mix may be light, glass or null"),
    Bad(
        ("materials", "plate", "a"),
        {"type": "glass", "ior": 1},
        "materials.plate.a: neither part of a mix may be light, glass or null",
    ),
    Bad(("materials", "plate", "b"), "plate", 'materials.plate.b: a mix is a part of itself: "plate" -> "plate"'),
    Bad(
        ("materials", "metal"),
        {"type": "mix", "weight": 1, "a": "wax", "b": "plate"},
        'materials.metal.b: a mix is a part of itself: "plate" -> "metal" -> "plate"',
    ),
    Bad(("materials", "plate", "a", "albedo"), -1, "materials.plate.a.albedo: -1 is not a number from 0 to 1"),
    Bad(("materials", "two\nlines"), {"type": 1}, 'materials."two\\x0alines".type: 1 is not a text in double quotes'),
    Bad(("materials", "old", "f0"), REMOVED, 'materials.old: the key "f0" is missing'),
    # meshes
    Bad(("meshes", "quad", "file"), "hex.ply", "meshes.quad: needs either file, or vertices and triangles"),
    Bad(("meshes", "quad"), {"slots": [0]}, "meshes.quad: needs either file, or vertices and triangles"),
    Bad(("meshes", "quad", "triangles"), REMOVED, 'meshes.quad: the key "triangles" is missing'),
    Bad(("meshes", "quad", "triangles", 1, 2), 4, "meshes.quad.triangles[1][2]: 4 is not an integer from 0 to 3"),
    Bad(("meshes", "quad", "triangles", 1, 2), 1.0, "meshes.quad.triangles[1][2]: 1 is not an integer from 0 to 3"),
    Bad(("meshes", "quad", "triangles", 0), [0, 1], "meshes.quad.triangles[0]: a list of 2 is not a list of 3"),
    Bad(("meshes", "quad", "triangles"), [], "meshes.quad: has no triangles; 1 or more are allowed"),
    Bad(
        ("meshes", "quad", "vertices"), [], "meshes.quad.normals: has 4 rows; one for each of the 0 vertices is allowed"
    ),
    Bad(("meshes", "quad", "vertices", 3, 1), None, "meshes.quad.vertices[3][1]: null is not a number"),
    Bad(
        ("meshes", "quad", "normals"),
        [[0, 0, 1]],
        "meshes.quad.normals: has 1 rows; one for each of the 4 vertices is allowed",
    ),
    Bad(("meshes", "quad", "uvs"), "plates.npy", 'meshes.quad.uvs: "plates.npy": shape (5, 3, 4) is not (n, 2)'),
    Bad(("meshes", "hex", "slots"), [0], "meshes.hex.slots: has 1 rows; one for each of the 2 triangles is allowed"),
    Bad(("meshes", "hex", "slots"), [0, 65536], "meshes.hex.slots[1]: 65536 is not an integer from 0 to 65535"),
    Bad(
        ("meshes", "hex", "file"),
        "plates.npy",
        'meshes.hex.file: "plates.npy" is not a mesh file; .ply and .obj are allowed',
    ),
    Bad(("meshes", "hex", "file"), "gone.ply", 'meshes.hex.file: "gone.ply": no such file'),
    Bad(
        ("meshes", "hex", "file"),
        "/etc/passwd",
        'meshes.hex.file: "/etc/passwd" is an absolute path; files stand in the scene\'s folder',
    ),
    Bad(("meshes", "hex", "file"), "a/../hex.ply", 'meshes.hex.file: "a/../hex.ply" has ".." in it'),
    Bad(("meshes", "hex", "file"), "", 'meshes.hex.file: "" is not a file name'),
    Bad(("meshes", "hex", "file"), ".", 'meshes.hex.file: ".": is a folder; a file is allowed'),
    Bad(("meshes", "hex", "file"), "hex.ply\0", 'meshes.hex.file: "hex.ply\\x00" is not a file name'),
    # objects
    Bad(
        ("objects", 1, "mesh"),
        "hexx",
        'objects[1].mesh: "hexx" is not a mesh; meshes are "hex", "tetra", "quad", "files"',
    ),
    Bad(("objects", 0, "material"), "plat", 'objects[0].material: "plat" is not a material; materials are "plate",'),
    Bad(("objects", 0, "material"), REMOVED, "objects[0]: needs either material or materials"),
    Bad(("objects", 0, "materials"), ["plate"], "objects[0]: needs either material or materials"),
    Bad(("objects", 1, "materials"), ["plate"], 'objects[1]: the mesh "hex" uses slot 1, but there is 1 material'),
    Bad(("objects", 1, "materials", 1), "x", 'objects[1].materials[1]: "x" is not a material'),
    Bad(("objects", 0, "to_world"), [[1, 0, 0, 0]] * 3, "objects[0].to_world: a list of 3 is not a 4x4 matrix"),
    Bad(("objects", 0, "to_world", 3), [0, 0, 0, 2], "objects[0].to_world: the last row is 0 0 0 2, not 0 0 0 1"),
    Bad(("objects", 0, "to_world", 1), [0, 1, 0], "objects[0].to_world[1]: a list of 3 is not a list of 4"),
    Bad(("objects", 0, "index"), -1, "objects[0].index: -1 is not an integer from 0 to 4294967295"),
    Bad(("objects", 0, "indices"), "indices.npy", "objects[0].indices: indices are for objects with instances"),
    Bad(("objects", 1, "indices"), [1], "objects[1].indices: has 1 rows; one for each of the 5 instances is allowed"),
    Bad(
        ("objects", 1, "instances"),
        "many.npy",
        'objects[1].instances: "many.npy": shape (7, 3) is not (n, 3, 4) or (n, 4, 4)',
    ),
    Bad(("objects", 1, "instances"), [[1]], "objects[1].instances: a list of 1 is not a text in double quotes"),
    Bad(("objects", 1, "instances"), "hex.ply", 'objects[1].instances: "hex.ply": is not a .npy file'),
    # spheres
    Bad(("spheres", 0, "radius"), 0, "spheres[0].radius: 0 is not a number above 0"),
    Bad(("spheres", 0, "radius"), -4, "spheres[0].radius: -4 is not a number above 0"),
    Bad(("spheres", 0, "center"), REMOVED, "spheres[0]: needs either center or centers"),
    Bad(("spheres", 0, "radius"), REMOVED, "spheres[0]: needs either radius or radii"),
    Bad(("spheres", 0, "material"), REMOVED, 'spheres[0]: the key "material" is missing'),
    Bad(
        ("spheres", 2, "radii"), "indices.npy", 'spheres[2].radii: "indices.npy": dtype "<u4" is not float32 or float64'
    ),
    Bad(("spheres", 3, "radii"), [0.1], "spheres[3].radii: has 1 rows; one for each of the 2 centers is allowed"),
    Bad(("spheres", 3, "radii", 1), -0.1, "spheres[3].radii: element [1] is not a number above 0"),
    # lights
    Bad(
        ("lights", 0, "type"),
        "lamp",
        'lights[0].type: "lamp" is not a light type; light types are "point", "spot", "sun", "area"',
    ),
    Bad(
        ("lights", 0, "angle"), 3, 'lights[0]: unknown key "angle"; allowed here are type, position, intensity, radius'
    ),
    Bad(("lights", 0, "intensity"), -1, "lights[0].intensity: -1 is not a number of 0 or more"),
    Bad(("lights", 1, "direction"), [0, 0, 0], "lights[1].direction: [0, 0, 0] is not a direction"),
    Bad(("lights", 1, "angle"), 181, "lights[1].angle: 181 is not a number above 0 and to 180"),
    Bad(("lights", 1, "blend"), 2, "lights[1].blend: 2 is not a number from 0 to 1"),
    Bad(("lights", 2, "irradiance"), REMOVED, 'lights[2]: the key "irradiance" is missing'),
    Bad(("lights", 3, "size"), [1, 0], "lights[3].size[1]: 0 is not a number above 0"),
    Bad(("lights", 3, "shape"), "disc", 'lights[3].shape: "disc" is not a shape; shapes are "rectangle", "ellipse"'),
    # environment, medium, render
    Bad(("environment", "radiance"), 1, "environment: needs either radiance or image"),
    Bad(("environment",), {"radiance": 1, "strength": 2}, "environment.strength: is for an image"),
    Bad(("environment", "image"), "hex.ply", 'environment.image: "hex.ply": is not an image that can be read'),
    Bad(("medium", "sigma_s"), -1, "medium.sigma_s: -1 is not a number of 0 or more"),
    Bad(("medium", "g"), 1, "medium.g: 1 is not a number above -1 and below 1"),
    Bad(("medium", "density"), 1, 'medium: unknown key "density"; allowed here are sigma_a, sigma_s, g'),
    Bad(("render", "max_depth"), -1, "render.max_depth: -1 is not an integer from 0 to 9223372036854775807"),
    Bad(("render", "max_depth"), "all", 'render.max_depth: "all" is not null or an integer of 0 or more'),
    Bad(("render", "max_scatter"), 1.5, "render.max_scatter: 1.5 is not an integer from 0"),
]


@pytest.mark.parametrize("bad", BAD, ids=lambda bad: ".".join(map(str, bad.path)) + "=" + repr(bad.value)[:20])
def test_bad_value(bad: Bad, tmp_path: Path) -> None:
    good = every_key(tmp_path)
    content = removed(good, bad.path) if bad.value is REMOVED else changed(good, bad.path, bad.value)
    assert message_of(tmp_path, content).startswith(bad.message)


HERE = "is not allowed here; allowed is"
KEY = "a key in double quotes"
VALUE = "a number, a text in double quotes, true, false, null, [...] or {...}"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", f"line 1, column 1: syntax error: the end of the file {HERE} {VALUE}"),
        ("{\n  ] ", f"line 2, column 3: syntax error: ']' {HERE} {KEY}"),
        ('{"glimmer": 1, "glimmer": 1}', 'key "glimmer" stands twice'),
        ('{"materials": {"a": {"type": "null", "type": "null"}}}', 'materials.a: key "type" stands twice'),
        ('{"objects": [{}, {"a": 1, "a": 2}]}', 'objects[1]: key "a" stands twice'),
        ("[]", "a list of 0 is not a scene, which is an object {...}"),
        ('{"glimmer": NaN}', f'glimmer: line 1, column 13: syntax error: "N" {HERE} {VALUE}'),
        ('{"glimmer": Infinity}', f'glimmer: line 1, column 13: syntax error: "I" {HERE} {VALUE}'),
        ('{"glimmer": 1e999}', "the number before character 17 is too large"),
        ('{"a": ' + "[" * 100 + "]" * 100 + "}", "a" + "[0]" * 63 + ": nested too deeply; 64 levels are allowed"),
        ('{"a": "\xff"}', None),
        ('{"glimmer": 1} x', f'line 1, column 16: syntax error: "x" {HERE} nothing more, after the closing brace'),
        (
            '{"film": {"width": 4 "height": 2}}',
            f"film.width: line 1, column 29: syntax error: a text {HERE} a comma",
        ),
        ('{"film": {"width": 4,,}}', f"film.width: line 1, column 22: syntax error: ',' {HERE} {KEY}"),
        ('{"film": {"width" 4}}', f"film.width: line 1, column 19: syntax error: a number {HERE} a colon"),
        ('{"film": {"width": 4, }}', f"film.width: line 1, column 23: syntax error: '}}' {HERE} {KEY}"),
        ('{"up": [0, 1 2]}', f"up[2]: line 1, column 14: syntax error: a number {HERE} a comma or a closing bracket"),
        ('{"glimmer": 1, // c\n}', f'glimmer: line 1, column 16: syntax error: "/" {HERE} {KEY}'),
        ("{'glimmer': 1}", f'line 1, column 2: syntax error: "\'" {HERE} {KEY}'),
        ('{"a": 1.}', "a: line 1, column 9: syntax error: invalid number; expected digit after '.'"),
        ('{"a": {"b": "\\q"}}', "a.b: line 1, column 15: syntax error: forbidden character after a backslash; allowed"),
        ('{"film": {"width": 4', f"film.width: line 1, column 21: syntax error: the end of the file {HERE} a comma or"),
    ],
    ids=[
        "empty",
        "bracket",
        "twice",
        "twice-deep",
        "twice-list",
        "list",
        "nan",
        "inf",
        "huge",
        "deep",
        "latin1",
        "tail",
        "no-comma",
        "two-commas",
        "no-colon",
        "last-comma",
        "list-no-comma",
        "comment",
        "single-quotes",
        "number",
        "escape",
        "cut-off",
    ],
)
def test_bad_json(text: str, message: str | None, tmp_path: Path) -> None:
    if message is None:  # bytes that are not UTF-8
        path = tmp_path / "scene.json"
        path.write_bytes(text.encode("latin-1"))
        done = run_glimmer(path, "-o", tmp_path / "out.exr")
        assert done.returncode == 1 and "ill-formed UTF-8" in done.stderr and done.stderr.count("\n") == 1
    else:
        assert message_of(tmp_path, text).startswith(message)


@pytest.mark.parametrize(
    ("name", "message"),
    [("gone.json", "no such file"), (".", "is a folder; a file is allowed"), ("pipe", "is not a regular file")],
)
def test_bad_scene_path(name: str, message: str, tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    path = tmp_path / name
    done = run_glimmer(path, "-o", tmp_path / "out.exr", timeout=20)
    assert done.returncode == 1
    assert done.stderr == f"{path}: {message}\n"


def test_links(tmp_path: Path) -> None:
    """A link inside the folder is a file like any other; one that leads out is refused."""
    inside = tmp_path / "inside"
    inside.mkdir()
    content = every_key(inside)
    (inside / "hex.ply").rename(tmp_path / "hex.ply")
    (inside / "hex.ply").symlink_to(tmp_path / "hex.ply")
    assert message_of(inside, content).startswith('meshes.hex.file: "hex.ply" is a link out of the scene\'s folder')
    (inside / "hex.ply").unlink()
    scenes.write_ply(inside / "real.ply", QUAD["vertices"], [[0, 1, 2, 3]])
    (inside / "hex.ply").symlink_to("real.ply")
    expect_good(inside, content)


def test_folder_link_out(tmp_path: Path) -> None:
    inside = tmp_path / "inside"
    inside.mkdir()
    (inside / "sub").symlink_to(tmp_path)
    content = every_key(inside)
    (inside / "hex.ply").rename(tmp_path / "hex.ply")
    content = changed(content, ("meshes", "hex", "file"), "sub/hex.ply")
    assert "is a link out of the scene's folder" in message_of(inside, content)


# ---- .npy ----------------------------------------------------------------------------------------------------------


def npy_bytes(header: str, data: bytes, version: int = 1) -> bytes:
    text = header.encode() + b"\n"
    length = struct.pack("<H" if version == 1 else "<I", len(text))
    return b"\x93NUMPY" + bytes([version, 0]) + length + text + data


GOOD_HEADER = "{'descr': '<f8', 'fortran_order': False, 'shape': (1, 3, 4), }"
IDENTITY_BYTES = np.eye(3, 4).tobytes()


def instance_scene(folder: Path, data: bytes) -> Scene:
    (folder / "i.npy").write_bytes(data)
    return scenes.scene(
        materials={"grey": {"type": "lambert", "albedo": 0.5}},
        meshes={"quad": QUAD},
        objects=[{"mesh": "quad", "material": "grey", "instances": "i.npy"}],
    )


@pytest.mark.parametrize("version", [1, 2, 3])
def test_npy_versions(version: int, tmp_path: Path) -> None:
    expect_good(tmp_path, instance_scene(tmp_path, npy_bytes(GOOD_HEADER, IDENTITY_BYTES, version)))


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"", "is not a .npy file"),
        (b"\x93NUMPY\x01", "the .npy header is cut off"),
        (npy_bytes(GOOD_HEADER, b"")[:40], "the .npy header is cut off"),
        (npy_bytes(GOOD_HEADER, IDENTITY_BYTES, 9), ".npy format version 9 is not known"),
        (npy_bytes(GOOD_HEADER, IDENTITY_BYTES[:-1]), "is cut off: shape (1, 3, 4) takes 96 bytes, but 95 are there"),
        (npy_bytes(GOOD_HEADER, IDENTITY_BYTES + b"x"), "has 1 bytes more than shape (1, 3, 4) takes"),
        (
            npy_bytes(GOOD_HEADER.replace("(1,", "(99999999999,"), IDENTITY_BYTES),
            "is cut off: shape (99999999999, 3, 4) takes",
        ),
        (
            npy_bytes(GOOD_HEADER.replace("(1,", "(9999999999999999999,"), b""),
            "the shape (9999999999999999999, 3, 4) is larger",
        ),
        (npy_bytes(GOOD_HEADER.replace("(1,", "(99999999999999999999,"), b""), "the .npy header is damaged"),
        (npy_bytes(GOOD_HEADER.replace("(1,", "(-1,"), b""), "the .npy header is damaged"),
        (npy_bytes(GOOD_HEADER.replace("<f8", "<c8"), IDENTITY_BYTES), 'dtype "<c8" is not allowed'),
        (npy_bytes(GOOD_HEADER.replace("<f8", "|O"), IDENTITY_BYTES), 'dtype "|O" is not allowed'),
        (
            npy_bytes(GOOD_HEADER.replace("'<f8'", "[('x', '<f8')]"), IDENTITY_BYTES),
            "a structured dtype is not allowed",
        ),
        (npy_bytes(GOOD_HEADER.replace("<f8", "<i8"), IDENTITY_BYTES), 'dtype "<i8" is not float32 or float64'),
        (npy_bytes(GOOD_HEADER.replace("'shape'", "'shapes'"), IDENTITY_BYTES), "the .npy header is damaged"),
        (npy_bytes("{}", IDENTITY_BYTES), "the .npy header is damaged"),
        (
            npy_bytes(GOOD_HEADER, np.where(np.eye(3, 4) == 1, np.nan, 0).tobytes()),
            "element [0][0][0] is nan; finite numbers are allowed",
        ),
        (
            npy_bytes(GOOD_HEADER, np.array([0] * 11 + [np.inf]).tobytes()),
            "element [0][2][3] is inf; finite numbers are allowed",
        ),
        (
            npy_bytes(GOOD_HEADER.replace("(1, 3, 4)", "(12,)"), IDENTITY_BYTES),
            "shape (12,) is not (n, 3, 4) or (n, 4, 4)",
        ),
        (
            npy_bytes(GOOD_HEADER.replace("(1, 3, 4)", "()"), IDENTITY_BYTES[:8]),
            "shape () is not (n, 3, 4) or (n, 4, 4)",
        ),
    ],
)
def test_bad_npy(data: bytes, message: str, tmp_path: Path) -> None:
    assert message_of(tmp_path, instance_scene(tmp_path, data)).startswith('objects[0].instances: "i.npy": ' + message)


def test_npy_last_row(tmp_path: Path) -> None:
    matrices = np.tile(np.eye(4), (3, 1, 1))
    matrices[2] = matrices[2].T + np.eye(4, k=-1)
    np.save(tmp_path / "m.npy", matrices)
    message = message_of(tmp_path, instance_scene(tmp_path, (tmp_path / "m.npy").read_bytes()))
    assert message.startswith("objects[0].instances: the last row of matrix 2 is not 0 0 0 1")


def sphere_pixels(folder: Path, centers: NDArray[Any], name: str) -> NDArray[Any]:
    """What spheres at these centres look like: tells whether they were read as they stand."""
    np.save(folder / f"{name}.npy", centers)
    content = scenes.scene(
        film={"width": 32, "height": 24},
        materials={"white": {"type": "light", "radiance": 1}},
        spheres=[{"centers": f"{name}.npy", "radius": 0.5, "material": "white"}],
    )
    return scenes.render(folder, content, "--spp", 1, name=name).rgb


CENTERS = np.array([[-2, 0, 1], [1, 3, 0], [0.5, 0, -1.5], [2, -1, 2]], np.float64)


@pytest.mark.parametrize(
    ("name", "convert"),
    [
        ("float32", lambda a: a.astype(np.float32)),
        ("float16", lambda a: a.astype(np.float16)),
        ("big_endian", lambda a: a.astype(">f8")),
        ("big_endian_single", lambda a: a.astype(">f4")),
        ("fortran", np.asfortranarray),
    ],
)
def test_npy_layouts_give_the_same_picture(
    name: str, convert: Callable[[NDArray[Any]], NDArray[Any]], tmp_path: Path
) -> None:
    reference = sphere_pixels(tmp_path, CENTERS, "reference")
    assert 0 < reference.mean() < 1
    assert np.array_equal(sphere_pixels(tmp_path, convert(CENTERS), name), reference)


# ---- meshes --------------------------------------------------------------------------------------------------------

PLY_HEADER = """ply
format {format} 1.0
comment made for a test
element vertex 4
property float x
property float y
property float z
{more}element edge 1
property int vertex1
property int vertex2
element face 1
property uchar colour
property list uchar {index} vertex_indices
end_header
"""


def binary_ply(order: str, index: str = "int", code: str = "i") -> bytes:
    name = {"<": "binary_little_endian", ">": "binary_big_endian"}[order]
    header = PLY_HEADER.format(
        format=name, more="property double nx\nproperty double ny\nproperty double nz\n", index=index
    )
    rows = b"".join(struct.pack(order + "3f3d", *vertex, 0, 0, 1) for vertex in QUAD["vertices"])
    return (
        header.encode() + rows + struct.pack(order + "2i", 0, 1) + struct.pack(order + f"BB4{code}", 9, 4, 0, 1, 2, 3)
    )


def ascii_ply() -> bytes:
    header = PLY_HEADER.format(format="ascii", more="property float s\nproperty float t\n", index="int")
    rows = "".join(f"{x} {y} +{z}e0 0 1\n" for x, y, z in QUAD["vertices"])
    return (header + rows + "0 1\n9 4 0 1 2 3\n").encode()


OBJ = b"o quad\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvn 0 0 1\nvt 0 0\nusemtl x\nf -4/1/1 2/1/1 3/1/1 4/1/1\n"


def mesh_scene(folder: Path, name: str, data: bytes) -> Scene:
    (folder / name).write_bytes(data)
    to_world = [[1, 0, 0, 0.3], [0, 0, -1, 0], [0, 1, 0, 0.2], [0, 0, 0, 1]]  # upright, in view of the camera
    return scenes.scene(
        film={"width": 32, "height": 24},
        materials={"white": {"type": "light", "radiance": 1}},
        meshes={"m": {"file": name}},
        objects=[{"mesh": "m", "material": "white", "to_world": to_world}],
    )


@pytest.mark.parametrize(
    ("name", "data"),
    [
        ("little.ply", binary_ply("<")),
        ("big.ply", binary_ply(">", "ushort", "H")),
        ("text.ply", ascii_ply()),
        ("windows.ply", ascii_ply().replace(b"\n", b"\r\n")),
        ("quad.obj", OBJ),
        ("QUAD.OBJ", OBJ.replace(b"/1/1", b"")),
    ],
)
def test_mesh_files_give_the_same_picture(name: str, data: bytes, tmp_path: Path) -> None:
    content = mesh_scene(tmp_path, name, data)
    picture = scenes.render(tmp_path, content, "--spp", 1, name="file").rgb
    inline = changed(content, ("meshes", "m"), QUAD)
    reference = scenes.render(tmp_path, inline, "--spp", 1, name="inline").rgb
    assert 0 < reference.mean() < 1
    assert np.array_equal(picture, reference)


LITTLE = binary_ply("<")


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"", "is not a .ply file"),
        (b"ply\nformat ascii 1.0\n", "the .ply header has no end_header"),
        (b"ply\nend_header\n", "the .ply header has no format line"),
        (b"ply\nformat ascii 1.0\nend_header\n", 'has no element "vertex"'),
        (b"ply\nformat binary_middle_endian 1.0\nend_header\n", 'line 2: format "binary_middle_endian" is not known'),
        (b"ply\nformat ascii 1.0\nelement vertex -4\n\n", 'line 3: "-4" is not a count of elements'),
        (
            b"ply\nformat ascii 1.0\nelement vertex 99999999999999999999\n",
            'line 3: "99999999999999999999" is not a count',
        ),
        (b"ply\nformat ascii 1.0\nproperty float x\n", 'line 3: "property float x" is not understood'),
        (LITTLE.replace(b"float x", b"half x"), 'line 5: a type of "property half x" is not known'),
        (LITTLE.replace(b"uchar int vertex", b"float int vertex"), "line 16: a type of"),
        (LITTLE.replace(b"float x", b"float q"), 'element "vertex" has only a part of x, y, z'),
        (LITTLE.replace(b"double nz", b"double z"), 'element "vertex" has two properties for the place of "z"'),
        (LITTLE.replace(b"double nz", b"double n"), 'element "vertex" has only a part of nx, ny, nz'),
        (LITTLE[:-1], "is cut off"),
        (
            LITTLE.replace(b"vertex 4", b"vertex 400000000000"),
            'is cut off: 400000000000 of element "vertex" cannot be in the',
        ),
        (LITTLE.replace(b"face 1", b"face 18446744073709551615"), 'is cut off: 18446744073709551615 of element "face"'),
        (LITTLE[:-4] + struct.pack("<i", 4), "triangle 1 uses vertex 4; there are 4"),
        (LITTLE[:-4] + struct.pack("<i", -1), "face 0 has the vertex -1; vertices count from 0"),
        (LITTLE[:-17] + b"\x02" + LITTLE[-16:], "face 0 has 2 vertices; 3 or more are allowed"),
        (LITTLE.replace(b"vertex_indices", b"vertices"), 'element "face" does not have one list vertex_indices'),
        (LITTLE.replace(b"element face", b"element tristrips"), 'element "tristrips" is not supported'),
        (
            LITTLE.replace(struct.pack("<3f", *QUAD["vertices"][2]), struct.pack("<3f", 1, np.nan, 0)),
            "vertex 2 is not finite",
        ),
        (ascii_ply().replace(b"-1 -1 +0e0", b"-1 x +0e0"), '"x" is not a number'),
        (ascii_ply().replace(b"-1 -1 +0e0", b"-1 1e999 +0e0"), "vertex 0 is not finite"),
        (ascii_ply()[:-3], "is cut off"),
    ],
)
def test_bad_ply(data: bytes, message: str, tmp_path: Path) -> None:
    assert message_of(tmp_path, mesh_scene(tmp_path, "m.ply", data)).startswith('meshes.m.file: "m.ply": ' + message)


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"", "has 0 vertices; 3 or more are allowed"),
        (b"v 0 0 0\nv 1 0 0\nv 0 1 0\n", "has 0 vertices; 3 or more are allowed"),
        (b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", ""),
        (b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3 9\n", ""),
        (b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n", ""),
        (b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1//7 2//7 3//7\n", ""),
    ],
)
def test_bad_obj(data: bytes, message: str, tmp_path: Path) -> None:
    assert message_of(tmp_path, mesh_scene(tmp_path, "m.obj", data)).startswith('meshes.m.file: "m.obj": ' + message)


# ---- images --------------------------------------------------------------------------------------------------------


def sky_scene(name: str) -> Scene:
    return scenes.scene(environment={"image": name})


def srgb_to_linear(value: float) -> float:
    """IEC 61966-2-1."""
    return value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4


def test_8_bit_images_are_srgb(tmp_path: Path) -> None:
    scenes.write_image(tmp_path / "sky.png", np.full((4, 8, 3), [188, 64, 255], np.uint8))
    picture = scenes.render(tmp_path, sky_scene("sky.png"), "--spp", 1).rgb
    expected = [srgb_to_linear(188 / 255), srgb_to_linear(64 / 255), 1]
    assert picture == pytest.approx(np.broadcast_to(expected, picture.shape), rel=1e-6)


def test_float_images_are_linear(tmp_path: Path) -> None:
    scenes.write_image(tmp_path / "sky.exr", np.full((4, 8, 3), [2.5, 0.25, 0], np.float32))
    picture = scenes.render(tmp_path, sky_scene("sky.exr"), "--spp", 1).rgb
    assert picture == pytest.approx(np.broadcast_to([2.5, 0.25, 0], picture.shape), rel=1e-6)


def test_alpha_is_ignored_and_grey_is_grey(tmp_path: Path) -> None:
    scenes.write_image(tmp_path / "alpha.png", np.full((4, 8, 4), [255, 188, 0, 40], np.uint8))
    alpha = scenes.render(tmp_path, sky_scene("alpha.png"), "--spp", 1).rgb
    assert alpha == pytest.approx(np.broadcast_to([1, srgb_to_linear(188 / 255), 0], alpha.shape), rel=1e-6)
    scenes.write_image(tmp_path / "grey.exr", np.full((4, 8, 1), 0.5, np.float32))
    grey = scenes.render(tmp_path, sky_scene("grey.exr"), "--spp", 1).rgb
    assert grey == pytest.approx(0.5, rel=1e-6)


@pytest.mark.parametrize(("value", "said"), [(np.nan, "nan"), (np.inf, "inf"), (-0.5, "-0.5")])
def test_bad_pixels(value: float, said: str, tmp_path: Path) -> None:
    pixels = np.ones((4, 8, 3), np.float32)
    pixels[2, 5, 1] = value
    scenes.write_image(tmp_path / "sky.exr", pixels)
    message = message_of(tmp_path, sky_scene("sky.exr"))
    assert message == f'environment.image: "sky.exr": pixel (5, 2) is {said}; finite numbers of 0 or more are allowed'


def test_cut_off_image(tmp_path: Path) -> None:
    scenes.write_image(tmp_path / "sky.exr", np.ones((64, 128, 3), np.float32))
    data = (tmp_path / "sky.exr").read_bytes()
    (tmp_path / "sky.exr").write_bytes(data[: len(data) // 2])
    assert message_of(tmp_path, sky_scene("sky.exr")).startswith(
        'environment.image: "sky.exr": is not an image that can be read'
    )


# ---- meaning -------------------------------------------------------------------------------------------------------


def test_materials_in_any_order(tmp_path: Path) -> None:
    """A mix may name materials that stand after it; numbering puts parts before the mix."""
    content = scenes.furnace()
    content["materials"] = {
        "outer": {"type": "mix", "weight": 0.5, "a": "inner", "b": "black"},
        "inner": {"type": "mix", "weight": 0.5, "a": "white", "b": "black"},
        "black": {"type": "lambert", "albedo": 0},
        "white": {"type": "lambert", "albedo": 1},
    }
    content["spheres"][0]["material"] = "outer"
    picture = scenes.render(tmp_path, content, "--spp", 4, "--aov", "material_index,albedo")
    middle = np.s_[2:4, 3:5]
    assert picture.layer("albedo")[middle] == pytest.approx(0.25)
    assert (picture.channels["material_index.X"][middle] == 4).all()


def test_empty_fields_are_fields(tmp_path: Path) -> None:
    content = instance_scene(tmp_path, npy_bytes(GOOD_HEADER.replace("(1,", "(0,"), b""))
    content["spheres"] = [{"centers": [], "radius": 1, "material": "grey"}]
    content["environment"] = {"radiance": 0.5}
    assert (scenes.render(tmp_path, content, "--spp", 1).rgb == 0.5).all()


def test_hash_is_of_the_content(tmp_path: Path) -> None:
    """White space and the order of keys do not count; values and the bytes of files do."""

    def hash_of(content: Scene | str) -> str:
        path = write_scene(tmp_path, content)
        done = run_glimmer(path, "-o", tmp_path / "out.exr", "--spp", 1, "--quiet")
        assert done.returncode == 0, done.stderr
        return str(scenes.read_exr(tmp_path / "out.exr").attributes["glimmer:scene"])

    content = every_key(tmp_path)
    first = hash_of(content)
    assert first.startswith("xxh64:") and len(first) == 22
    assert hash_of(json.dumps(content, sort_keys=True, indent=3)) == first
    assert hash_of(changed(content, ("lights", 0, "intensity"), 10.0)) == first
    assert hash_of(changed(content, ("lights", 0, "intensity"), 11)) != first
    np.save(tmp_path / "radii.npy", np.full(7, 0.1))
    assert hash_of(content) != first


# Each value that means something, changed: (path, other value). The picture, or a layer of it, must change with it.
MEANINGS: list[tuple[tuple[str | int, ...], Any]] = [
    (("film", "filter"), "box"),
    (("film", "filter", "width"), 3),
    (("camera", "origin", 0), 1),
    (("camera", "target", 0), 1),
    (("camera", "up"), [0.2, 0, 1]),
    (("camera", "fov_x"), 50),
    (("camera", "shift", 0), 0),
    (("camera", "shift", 1), 0),
    (("camera", "lens_radius"), 0.2),
    (("camera", "focus_distance"), 5),
    (("camera", "clip"), [7, 9]),
    (("materials", "plate", "weight"), 0.5),
    (("materials", "plate", "a", "albedo"), 0.1),
    (("materials", "plate", "b"), "gold"),
    (("materials", "plate", "emission"), 2),
    (("materials", "metal", "alpha"), 0.5),
    (("materials", "metal", "eta"), 1.5),
    (("materials", "metal", "k"), 1),
    (("materials", "metal", "masking"), "smith"),
    (("materials", "metal", "masking"), "schlick_ggx"),
    (("materials", "metal", "emission"), 2),
    (("materials", "gold", "f0"), 0.2),
    (("materials", "gold", "f90"), 0.2),
    (("materials", "gold", "alpha"), 0.5),
    (("materials", "wax", "albedo"), 0.1),
    (("materials", "wax", "emission"), 1),
    (("materials", "mirror", "reflectance"), 0.5),
    (("materials", "mirror", "emission"), 1),
    (("materials", "glass", "ior"), 1.2),
    (("materials", "glass", "fresnel"), "exact"),
    (("materials", "old", "albedo"), 0.9),
    (("materials", "old", "f0"), 0.1),
    (("materials", "old", "alpha"), 0.9),
    (("materials", "old", "emission"), 1),
    (("materials", "moon", "radiance"), 7),
    (("meshes", "quad", "normals"), [[0.3, 0, 1]] * 4),
    (("meshes", "hex", "slots"), [1, 1]),
    (("meshes", "files", "slots"), [1, 0]),
    (("objects", 0, "index"), 8),
    (("objects", 0, "material"), "wax"),
    (("objects", 0, "to_world", 2, 3), 0.3),
    (("objects", 1, "materials"), ["gold", "wax"]),
    (("objects", 1, "indices"), [4, 4, 4, 4, 4]),
    (("objects", 1, "to_world"), [[1, 0, 0, 1], *scenes.IDENTITY[1:]]),
    (("objects", 3, "material"), "wax"),
    (("spheres", 0, "center", 0), -1),
    (("spheres", 0, "radius"), 0.8),
    (("spheres", 0, "index"), 4),
    (("spheres", 1, "radius"), 0.4),
    (("spheres", 2, "radii"), [0.2] * 7),
    (("spheres", 3, "material"), "wax"),
    (("lights", 0, "position", 0), 2),
    (("lights", 0, "intensity"), 3),
    (("lights", 0, "radius"), 1),
    (("lights", 1, "intensity"), 40),
    (("lights", 1, "direction"), [0, 0.5, -2]),
    (("lights", 1, "angle"), 90),
    (("lights", 1, "blend"), 1),
    (("lights", 1, "radius"), 0.5),
    (("lights", 2, "direction"), [0, 0, -1]),
    (("lights", 2, "irradiance"), 3),
    (("lights", 2, "angle"), 20),
    (("lights", 3, "to_world", 2, 3), 2),
    (("lights", 3, "size", 1), 3),
    (("lights", 3, "shape"), "rectangle"),
    (("lights", 3, "radiance"), 5),
    (("environment", "strength"), 1),
    (("environment", "to_world"), [[0, -1, 0, 0], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]),
    (("render", "max_depth"), 1),
]

FOG_MEANINGS: list[tuple[tuple[str | int, ...], Any]] = [
    (("medium", "sigma_a"), 0.1),
    (("medium", "sigma_s"), 0.1),
    (("medium", "g"), 0.5),
    (("render", "max_scatter"), 0),
]


def all_layers(folder: Path, content: Scene) -> dict[str, NDArray[Any]]:
    options = ("--spp", 4, "--aov", "object_index,material_index,normal,depth")
    return scenes.render(folder, content, *options).channels


@pytest.mark.parametrize("fog", [False, True], ids=["clear", "fog"])
def test_every_value_means_something(fog: bool, tmp_path: Path) -> None:
    """Nothing is read and then forgotten. Without fog, through which the environment cannot be seen, and with it."""
    base = every_key(tmp_path)
    base["film"].update(width=32, height=24, crop=[0, 0, 32, 24])
    base["lights"][3]["to_world"][2][3] = 3
    if not fog:
        del base["medium"]
    reference = all_layers(tmp_path, base)
    assert all(np.array_equal(channel, reference[name]) for name, channel in all_layers(tmp_path, base).items())
    forgotten = []
    for path, value in FOG_MEANINGS if fog else MEANINGS:
        layers = all_layers(tmp_path, changed(base, path, value))
        if all(np.array_equal(layers[name], reference[name]) for name in reference):
            forgotten.append(".".join(map(str, path)))
    assert not forgotten
