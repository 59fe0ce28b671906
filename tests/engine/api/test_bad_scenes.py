# SPDX-License-Identifier: GPL-3.0-or-later
"""Bad values in the description of a scene: each is named in one line, and nothing is added."""

import ctypes
from ctypes import addressof, byref, c_double, c_float, c_uint32, c_void_p
from typing import Any

import numpy as np
import pytest

from addon.native import structs
from tests.engine.api.misuse import (
    ARGUMENT,
    GREY,
    IDENTITY,
    INFINITY,
    NAN,
    OK,
    add_material,
    changed,
    material_desc,
    mesh_desc,
    new_mesh,
    parameters,
    refused,
)
from tests.engine.library import engine, functions


@pytest.mark.parametrize(
    ("changes", "word"),
    [
        ({"format": 2}, "format"),
        ({"vertex_count": 2}, "vert"),
        ({"vertices": None}, "vertices"),
        ({"triangle_count": 0}, "triangle"),
        ({"triangles": None}, "triangle"),
        ({"triangles": np.array([[0, 1, 3]], np.uint32)}, "3"),
        ({"triangles": np.array([[0, 1, 0xFFFFFFFF]], np.uint32)}, "triangle"),
        ({"vertices": np.array([[0, 0, NAN], [1, 0, 0], [0, 1, 0]])}, "vert"),
        ({"vertices": np.array([[0, 0, INFINITY], [1, 0, 0], [0, 1, 0]])}, "vert"),
        ({"normals": np.array([[0, 0, NAN], [1, 0, 0], [0, 1, 0]])}, "normal"),
        ({"uvs": np.array([[0, NAN], [1, 0], [0, 1]])}, "uv"),
        ({"vertex_count": 1 << 60}, "vert"),
    ],
)
def test_bad_mesh(changes: dict[str, Any], word: str) -> None:
    kept = {key: value.ctypes.data if isinstance(value, np.ndarray) else value for key, value in changes.items()}
    out = c_void_p()
    refused(functions().glimmer_mesh_create(byref(mesh_desc(**kept)), byref(out)), ARGUMENT, word)
    assert not out


@pytest.mark.parametrize(
    ("width", "height", "channels", "value"),
    [(0, 1, 3, 1), (1, 0, 3, 1), (1, 1, 2, 1), (1, 1, 5, 1), (1, 1, 3, -1), (1, 1, 3, NAN), (1, 1, 3, INFINITY)],
)
def test_bad_image(width: int, height: int, channels: int, value: float) -> None:
    out = c_void_p()
    pixels = (c_float * 8)(*[value] * 8)
    refused(functions().glimmer_image_create(width, height, channels, pixels, byref(out)), ARGUMENT, "image")
    assert not out


METAL = {"alpha": 0.1, "eta": (2.0, 2.0, 2.0), "k": (3.0, 3.0, 3.0)}
GOLD = {"alpha": 0.1, "f0": (0.9, 0.7, 0.4)}


@pytest.mark.parametrize(
    ("kind", "values", "words"),
    [
        ("wax", GREY, ('type "wax" is not known; allowed: lambert, mirror, ',)),
        ("", GREY, ("type",)),
        (None, GREY, ("type is null",)),
        ("lambert", {"albedo": (0.5, 1.5, 0.5)}, ("albedo is 1.5; allowed: 0 to 1",)),
        ("lambert", {"albedo": (0.5, -0.1, 0.5)}, ("albedo",)),
        ("lambert", {"albedo": (0.5, NAN, 0.5)}, ("albedo",)),
        ("lambert", {}, ('the key "albedo" is missing',)),
        ("lambert", {**GREY, "alpha": 0.5}, ('lambert has no parameter "alpha"; allowed: albedo, ',)),
        ("mirror", {"reflectance": (2.0, 0.0, 0.0)}, ("reflectance",)),
        ("conductor", {**METAL, "alpha": 1.5}, ("alpha",)),
        ("conductor", {**METAL, "alpha": NAN}, ("alpha",)),
        ("conductor", {**METAL, "eta": (0.0, 1.0, 1.0)}, ("eta is 0; allowed: finite numbers above 0",)),
        ("conductor", {**METAL, "k": (1.0, -1.0, 1.0)}, ("k",)),
        ("conductor", {**GOLD, "f0": (0.0, 0.0, 1.1)}, ("f0",)),
        ("conductor", {**GOLD, "f90": (0.0, -0.1, 1.0)}, ("f90",)),
        ("conductor", {**GOLD, "masking": "ggx"}, ('masking is "ggx"; allowed: smith, smith_separable, ',)),
        ("conductor", {**GOLD, "masking": ""}, ("masking",)),
        ("conductor", {**GOLD, "masking": 1}, ("masking is null",)),
        ("conductor", {"alpha": 0.1}, ("needs either eta and k, or f0",)),
        ("conductor", {**METAL, **GOLD}, ("needs either eta and k, or f0",)),
        ("conductor", {**METAL, "f90": 0.5}, ("f90 goes with f0, not with eta and k",)),
        ("conductor", {"alpha": 0.1, "eta": 2.0}, ('the key "k" is missing',)),
        ("glass", {"ior": 0.0}, ("ior",)),
        ("glass", {"ior": -1.5}, ("ior",)),
        ("glass", {"ior": NAN}, ("ior",)),
        ("light", {"radiance": 1.0, "emission": 1.0}, ("emission",)),
        ("null", {"emission": 1.0}, ('null has no parameter "emission"; allowed: none',)),
        ("lambert", {**GREY, "emission": (-1.0, 0.0, 0.0)}, ("emission",)),
        ("lambert", {**GREY, "emission": (INFINITY, 0.0, 0.0)}, ("emission",)),
        ("light", {"radiance": (-1.0, 0.0, 0.0)}, ("radiance",)),
        ("light", {"radiance": (INFINITY, 0.0, 0.0)}, ("radiance",)),
        ("report_metal", {**GREY, "f0": 0.5, "alpha": -1.0}, ("alpha",)),
        ("mix", {"weight": 0.5, "a": 0, "b": 99}, ("b: material 99 was not added before",)),
        ("mix", {"weight": 1.5, "a": 0, "b": 1}, ("weight",)),
        ("glass", {"ior": 1.5, "alpha": 2.0}, ("alpha",)),
        ("glass", {"ior": 1.5, "lobes": "reflection"}, ("lobes", "allowed: both, refraction")),
        ("transparent", {"transmittance": 1.5}, ("transmittance",)),
        ("mix", {"weight": 0.5, "a": 0}, ('the key "b" is missing',)),
    ],
)
def test_bad_material(scene: c_void_p, kind: str | None, values: dict[str, Any], words: tuple[str, ...]) -> None:
    """Named in the message, and not added: the next good one takes its number."""
    for good in (("lambert", GREY), ("mirror", {"reflectance": 0.9}), ("glass", {"ior": 1.5})):
        assert add_material(scene, *good)[0] == OK
    result, number = add_material(scene, kind, values, name=b"culprit")
    refused(result, ARGUMENT, *words, "culprit")
    assert number == 12345, "an output of a call that failed was written"
    assert add_material(scene) == (OK, 3)


def test_bad_arrays_of_parameters(scene: c_void_p) -> None:
    refused(add_material(scene, "lambert", GREY, parameters=None)[0], ARGUMENT, "null parameters")
    refused(add_material(scene, "lambert", GREY, parameter_count=65)[0], ARGUMENT, "65 parameters; allowed: up to 64")
    twice = parameters({"albedo": 0.5, "emission": 0.5})
    twice[1].key = b"albedo"
    desc = material_desc()
    desc.parameter_count, desc.parameters = 2, twice
    add = functions().glimmer_scene_add_material
    refused(add(scene, byref(desc), byref(c_uint32())), ARGUMENT, "albedo is given twice")
    twice[1].key = None
    refused(add(scene, byref(desc), byref(c_uint32())), ARGUMENT, "the key of a parameter is null")


@pytest.mark.parametrize(
    ("changes", "word"),
    [
        ({"mesh": None}, "mesh"),
        ({"material_count": 0}, "material"),
        ({"materials": None}, "material"),
        ({"materials": (c_uint32 * 1)(7)}, "7"),
        ({"to_world": [NAN] * 16}, "to_world"),
        ({"to_world": [0] * 16}, "to_world"),
        ({"instances": np.full((1, 3, 4), NAN), "instance_count": 1, "instance_format": 1}, "instance"),
        ({"instances": np.zeros((1, 3, 4)), "instance_count": 1, "instance_format": 5}, "instance_format"),
    ],
)
def test_bad_object(scene: c_void_p, changes: dict[str, Any], word: str) -> None:
    mesh = new_mesh()
    assert add_material(scene)[0] == OK
    numbers = (c_uint32 * 1)(0)
    desc = engine().init(structs.ObjectDesc)
    desc.name, desc.mesh, desc.material_count, desc.materials = b"culprit", mesh, 1, ctypes.addressof(numbers)
    for key, value in changes.items():
        pointer = value.ctypes.data if isinstance(value, np.ndarray) else value
        if key == "materials" and value is not None:
            pointer = ctypes.addressof(value)
        changed(desc, {key: pointer})
    refused(functions().glimmer_scene_add_object(scene, byref(desc)), ARGUMENT, word)
    functions().glimmer_mesh_destroy(mesh)


@pytest.mark.parametrize(
    ("centers", "radii", "material", "word"),
    [
        ([[0, 0, 0]], [0.0], 0, "radius"),
        ([[0, 0, 0]], [-1.0], 0, "radius"),
        ([[0, 0, 0]], [NAN], 0, "radius"),
        ([[0, 0, 0]], [INFINITY], 0, "radius"),
        ([[0, NAN, 0]], [1.0], 0, "center"),
        ([[0, 0, 0], [1, 1, 1], [2, 2, 2]], [1.0, 1.0], 0, "radius_count"),
        ([[0, 0, 0]], [1.0], 4, "4"),
    ],
)
def test_bad_spheres(scene: c_void_p, centers: list[list[float]], radii: list[float], material: int, word: str) -> None:
    assert add_material(scene)[0] == OK
    c, r = np.array(centers, np.float64), np.array(radii, np.float64)
    desc = engine().init(structs.SpheresDesc)
    desc.name, desc.material = b"culprit", material
    desc.count, desc.centers, desc.radius_count, desc.radii = len(c), c.ctypes.data, len(r), r.ctypes.data
    refused(functions().glimmer_scene_add_spheres(scene, byref(desc)), ARGUMENT, word, "culprit")


POINT, SPOT, SUN, AREA = range(4)


@pytest.mark.parametrize(
    ("changes", "word"),
    [
        ({"type": 4}, "type"),
        ({"type": POINT, "color": (-1, 0, 0)}, "color"),
        ({"type": POINT, "position": (0, NAN, 0)}, "position"),
        ({"type": POINT, "radius": -1}, "radius"),
        ({"type": SPOT, "direction": (0, 0, 0)}, "direction"),
        ({"type": SPOT, "angle": 181}, "angle"),
        ({"type": SPOT, "blend": 1.5}, "blend"),
        ({"type": SUN, "direction": (0, INFINITY, 0)}, "direction"),
        ({"type": SUN, "angle": -1}, "angle"),
        ({"type": AREA, "size": (0, 1)}, "size"),
        ({"type": AREA, "size": (1, NAN)}, "size"),
        ({"type": AREA, "spread": 0}, "spread"),
        ({"type": AREA, "spread": NAN}, "spread"),
        ({"type": AREA, "spread": 181}, "spread"),
        ({"type": POINT, "visible": 64}, "visible"),
        ({"type": AREA, "to_world": list(np.diag([2.0, 1, 1, 1]).ravel())}, "to_world"),
    ],
)
def test_bad_light(scene: c_void_p, changes: dict[str, Any], word: str) -> None:
    desc = changed(engine().init(structs.LightDesc), {"name": b"culprit", **changes})
    refused(functions().glimmer_scene_add_light(scene, byref(desc)), ARGUMENT, word, "culprit")


def test_bad_environment_and_medium(scene: c_void_p) -> None:
    library = functions()

    def three(*values: float) -> Any:
        return (c_double * 3)(*values)

    for color in ((-1, 0, 0), (NAN, 0, 0), (INFINITY, 0, 0)):
        refused(
            library.glimmer_scene_set_environment(scene, (c_float * 3)(*color), None, IDENTITY), ARGUMENT, "environment"
        )
    scaled = (c_double * 16)(*(2 * np.eye(4)).ravel())
    refused(library.glimmer_scene_set_environment(scene, (c_float * 3)(), None, scaled), ARGUMENT, "to_world")
    mesh = new_mesh()
    refused(library.glimmer_scene_set_environment(scene, (c_float * 3)(), mesh, IDENTITY), ARGUMENT, "image")
    library.glimmer_mesh_destroy(mesh)
    refused(library.glimmer_scene_set_environment_visible(scene, 64), ARGUMENT, "environment: visible")
    good = three(0, 0.1, 0.2)
    for bad in (three(-1, 0, 0), three(0, NAN, 0), three(0, 0, INFINITY)):
        refused(library.glimmer_scene_set_medium(scene, bad, good, 0), ARGUMENT, "sigma_a")
        refused(library.glimmer_scene_set_medium(scene, good, bad, 0), ARGUMENT, "sigma_s")
    for g in (-1.0, 1.0, NAN, 7.0):
        refused(library.glimmer_scene_set_medium(scene, good, good, g), ARGUMENT, "g")


@pytest.mark.parametrize(
    ("changes", "word"),
    [
        ({"sigma_a": (0, -1, 0)}, "sigma_a"),
        ({"sigma_s": (0, 0, NAN)}, "sigma_s"),
        ({"emission": (INFINITY, 0, 0)}, "emission"),
        ({"g": 1}, "g"),
        ({"struct_size": 3}, "struct_size"),
    ],
)
def test_bad_interior(scene: c_void_p, changes: dict[str, Any], word: str) -> None:
    medium = changed(engine().init(structs.MediumDesc), changes)
    add_material(scene)
    centers, radii = (c_double * 3)(), (c_double * 1)(1)
    spheres = engine().init(structs.SpheresDesc)
    spheres.name, spheres.count, spheres.radius_count = b"culprit", 1, 1
    spheres.centers, spheres.radii = addressof(centers), addressof(radii)
    spheres.interior = addressof(medium)
    refused(functions().glimmer_scene_add_spheres(scene, byref(spheres)), ARGUMENT, "interior", word, "culprit")


@pytest.mark.parametrize("key", [None, b"sigma_t", b"g", b"emission"])
def test_bad_binding_of_an_interior(scene: c_void_p, key: bytes | None) -> None:
    """Of a key that is none, or of a program that was not added."""
    binding = structs.MediumBinding(key, 7, 0)
    changes = {"binding_count": 1, "bindings": addressof(binding)}
    test_bad_interior(scene, changes, "cannot be bound" if key in (None, b"sigma_t") else "program 7")
    test_bad_interior(scene, {"binding_count": 5, "bindings": addressof(binding)}, "up to 4")
    test_bad_interior(scene, {"binding_count": 1}, "null bindings")


@pytest.mark.parametrize("scale_height", [0, -1, NAN, INFINITY])
def test_bad_falloff(scene: c_void_p, scale_height: float) -> None:
    call = functions().glimmer_scene_set_medium_falloff
    refused(call(scene, 0, scale_height), ARGUMENT, "scale_height")
    refused(call(scene, NAN, 1), ARGUMENT, "height")


@pytest.mark.parametrize(
    ("changes", "word"),
    [
        ({"fov_x": 0}, "fov_x"),
        ({"fov_x": 180}, "fov_x"),
        ({"fov_x": NAN}, "fov_x"),
        ({"to_world": [0] * 16}, "to_world"),
        ({"to_world": list(np.diag([1.0, 2, 1, 1]).ravel())}, "to_world"),
        ({"shift": (NAN, 0)}, "shift"),
        ({"lens_radius": -1}, "lens_radius"),
        ({"lens_radius": 1, "focus_distance": 0}, "focus_distance"),
        ({"aperture_blades": 1025}, "aperture_blades"),
        ({"aperture_rotation": NAN}, "aperture_rotation"),
        ({"aperture_ratio": 0}, "aperture_ratio"),
        ({"type": 6, "lens_radius": 1, "focus_distance": 1, "aperture_ratio": 0.5}, "lens_radius"),
        ({"clip_start": -1}, "clip_start"),
        ({"clip_start": 2, "clip_end": 1}, "clip_end"),
        ({"type": 9}, "type"),
        ({"type": 2, "window": (0, 0, 0, 1)}, "window"),
        ({"type": 2, "window": (0, 0, 1, NAN)}, "window"),
        ({"type": 2, "longitude": (1, 1)}, "longitude"),
        ({"type": 2, "latitude": (-91, 1)}, "latitude"),
        ({"type": 3, "fisheye_fov": 0}, "fisheye_fov"),
        ({"type": 4, "focal_length": 0}, "focal_length"),
        ({"type": 5, "polynomial": (0, NAN, 0, 0, 0)}, "polynomial"),
        ({"type": 8, "elevation": (INFINITY, 0)}, "elevation"),
        ({"type": 6, "lens_radius": 2, "focus_distance": 1}, "lens_radius"),
        ({"type": 7, "clip_start": -1}, "clip_start"),
        ({"type": 1, "width": 0}, "width"),
        ({"type": 1, "width": NAN}, "width"),
        ({"type": 1, "width": INFINITY}, "width"),
        ({"type": 1, "clip_start": -INFINITY}, "clip_start"),
        ({"type": 1, "clip_start": -1, "clip_end": -2}, "clip_end"),
    ],
)
def test_bad_camera(scene: c_void_p, changes: dict[str, Any], word: str) -> None:
    desc = changed(engine().init(structs.CameraDesc), changes)
    refused(functions().glimmer_scene_set_camera(scene, byref(desc)), ARGUMENT, word)


@pytest.mark.parametrize(
    ("changes", "word"),
    [
        ({"width": 0}, "width"),
        ({"height": 65537}, "height"),
        ({"crop": (5, 0, 5, 10)}, "crop"),
        ({"crop": (0, 0, 481, 10)}, "crop"),
        ({"filter": 2}, "filter"),
        ({"filter": 1, "filter_width": 0}, "filter_width"),
        ({"filter": 1, "filter_width": NAN}, "filter_width"),
    ],
)
def test_bad_film(scene: c_void_p, changes: dict[str, Any], word: str) -> None:
    desc = changed(engine().init(structs.FilmDesc), changes)
    refused(functions().glimmer_scene_set_film(scene, byref(desc)), ARGUMENT, word)
