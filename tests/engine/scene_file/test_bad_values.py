# SPDX-License-Identifier: GPL-3.0-or-later
"""Every mistake in a value gets one line that says where it is and what is allowed."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from tests.engine import scenes
from tests.engine.scene_file.outcome import message_of
from tests.engine.scenes import changed, every_key, removed

pytestmark = pytest.mark.usefixtures("glimmer_command")


@dataclass(frozen=True)
class Bad:
    """One value of the scene with every key, replaced or removed, and the message it must get."""

    path: tuple[str | int, ...]
    value: Any
    message: str


def program(step: dict[str, Any]) -> dict[str, Any]:
    """A table of one program of one step."""
    return {"p": {"steps": [step], "outputs": ["r0"]}}


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
    Bad(("extra",), 1, 'unknown key "extra"; allowed here are glimmer, film, camera, textures, programs, materials,'),
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
    Bad(
        ("camera", "to_world"),
        scenes.IDENTITY,
        "camera: needs either origin and target (and up), or to_world, or motion",
    ),
    Bad(("camera", "focus_distance"), REMOVED, "camera: a lens_radius above 0 needs a focus_distance"),
    Bad(("camera", "lens_radius"), -1, "camera.lens_radius: -1 is not a number of 0 or more"),
    Bad(("camera", "aperture", "blades"), -1, "camera.aperture.blades"),
    Bad(("camera", "aperture", "ratio"), 0, "camera.aperture.ratio"),
    Bad(("camera", "clip"), [2, 1], "camera.clip: [2,1] is not [start, end] with start < end"),
    Bad(("camera", "shift"), 1, "camera.shift: 1 is not a list of 2"),
    Bad(
        ("objects", 0, "motion"),
        [scenes.IDENTITY],
        "objects[0]: needs either to_world or motion, which takes its place",
    ),
    Bad(
        ("camera", "motion"), [scenes.IDENTITY] * 2, "camera: needs either origin and target (and up), or to_world, or"
    ),
    Bad(("objects", 3, "motion"), [scenes.IDENTITY], "objects[3].motion: has fewer than 2 matrices"),
    Bad(("objects", 3, "motion"), [scenes.IDENTITY, 5], "objects[3].motion[1]: 5 is not a"),
    Bad(("camera", "type"), "round", 'camera.type: "round" is not a camera type; camera types are "perspective",'),
    Bad(("camera", "type"), "orthographic", 'camera: unknown key "fov_x"; allowed here are type,'),
    Bad(("camera", "width"), 3, 'camera: unknown key "width"; allowed here are type,'),
    Bad(("camera",), {"type": "orthographic", "to_world": scenes.IDENTITY}, 'camera: the key "width" is missing'),
    Bad(
        ("camera",),
        {"type": "orthographic", "to_world": scenes.IDENTITY, "width": 0},
        "camera.width: 0 is not a number above 0",
    ),
    Bad(
        ("camera",),
        {"type": "mirror_ball", "to_world": scenes.IDENTITY, "shift": [0, 0]},
        'camera: unknown key "shift"; allowed here are type,',
    ),
    Bad(
        ("camera",),
        {"type": "fisheye_polynomial", "to_world": scenes.IDENTITY},
        'camera: the key "polynomial" is missing',
    ),
    Bad(
        ("camera",),
        {"type": "equirectangular", "to_world": scenes.IDENTITY, "latitude": [0, 91]},
        "camera: latitude",
    ),
    # programs
    Bad(("programs",), {"p": 1}, "programs.p: 1 is not an object {...}"),
    Bad(("programs",), program({"op": "wood"}), 'programs.p.steps[0].op: "wood" is not an operation; operations are'),
    Bad(("programs",), program({"op": "math", "out": "r0"}), 'programs.p.steps[0]: the key "in" is missing'),
    Bad(
        ("programs",),
        program({"op": "splat", "in": ["r1"], "out": "r0"}),
        'programs.p: program "p": instruction 0 (splat): input 0 is register 1, which nothing has written',
    ),
    Bad(
        ("programs",),
        program({"op": "splat", "in": [1], "out": "r256"}),
        'programs.p.steps[0].out: "r256" is not a register, "r0" to "r255"',
    ),
    Bad(
        ("programs",),
        program({"op": "splat", "modes": ["x"], "in": [1], "out": "r0"}),
        'programs.p.steps[0].modes: has more words than the 0 that "splat" takes',
    ),
    Bad(
        ("programs",),
        program({"op": "ramp", "in": [1], "out": "r0", "texture": "t"}),
        "programs.p.steps[0].texture: is nothing that this operation takes",
    ),
    Bad(
        ("materials", "wax", "albedo"),
        {"program": "p"},
        'materials.wax.albedo.program: "p" is not a program; programs are none',
    ),
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
        'materials.wax: unknown key "alpha"; allowed here are type, albedo, roughness, facets, emission, normal,'
        " bumped_normal, bumped_normal_cubic, aovs",
    ),
    Bad(("materials", "wax", "emission"), -0.1, "materials.wax.emission: -0.1 is not a number of 0 or more"),
    Bad(("materials", "wax", "emission"), 1e39, "materials.wax.emission: 1e+39 is too large; up to 3.4e38 is allowed"),
    Bad(("materials", "gone", "emission"), 1, 'materials.gone: unknown key "emission"'),
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
    Bad(
        ("materials", "plate", "a"),
        {"type": "glass", "ior": 1, "alpha": 2},
        "materials.plate.a.alpha: 2 is not a number from 0 to 1",
    ),
    Bad(
        ("materials", "plate", "a"),
        {"type": "glass", "ior": 1, "lobes": "reflection"},
        'materials.plate.a.lobes: "reflection" is not a choice of lobes; ',
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
    Bad(("objects", 0, "interior"), 1, "objects[0].interior: 1 is not an object {...}"),
    Bad(("objects", 0, "interior"), {"sigma_s": -1}, "objects[0].interior.sigma_s: -1 is not a number of 0 or more"),
    Bad(("objects", 0, "interior"), {"g": -1}, "objects[0].interior.g: -1 is not a number above -1 and below 1"),
    Bad(
        ("objects", 0, "interior"),
        {"density": 1},
        'objects[0].interior: unknown key "density"; allowed here are sigma_a, sigma_s, g, emission',
    ),
    # spheres
    Bad(("spheres", 0, "interior"), {"emission": [1]}, "spheres[0].interior.emission: "),
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
    Bad(("lights", 0, "visible"), "camera", 'lights[0].visible: "camera" is not a list'),
    Bad(
        ("lights", 0, "visible"),
        ["light"],
        'lights[0].visible[0]: "light" is not a kind of rays; kinds of rays are "camera", "diffuse", "glossy", '
        '"transmission", "volume", "shadow"',
    ),
    Bad(("lights", 0, "profile"), {"to_world": 1}, 'lights[0].profile: the key "factor" is missing'),
    Bad(
        ("lights", 0, "profile"),
        {"factor": {"program": "none"}, "to_world": scenes.IDENTITY},
        'lights[0].profile.factor.program: "none" is not a program',
    ),
    Bad(("film", "pixel_aspect"), 0, "film.pixel_aspect: 0 is not a number above 0"),
    Bad(("film", "pixel_aspect"), 2000, "film: pixel_aspect is 2000; allowed: 0.001 to 1000"),
    Bad(("lights", 0, "shadows"), 0, "lights[0].shadows: 0 is not true or false"),
    Bad(("lights", 0, "max_bounces"), -1, "lights[0].max_bounces: -1 is not an integer from 0 to 4294967295"),
    Bad(("lights", 0, "shape"), "ellipse", 'lights[0].shape: "ellipse" is not a shape; shapes are "sphere", "disk"'),
    Bad(("lights", 3, "spread"), 0, "lights[3].spread: 0 is not a number above 0 and to 180"),
    Bad(("objects", 0, "visible"), [1], "objects[0].visible[0]: "),
    Bad(("objects", 0, "holdout"), "yes", 'objects[0].holdout: "yes" is not true or false'),
    Bad(("film", "exposure"), -1, "film.exposure: -1 is not a number of 0 or more"),
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
