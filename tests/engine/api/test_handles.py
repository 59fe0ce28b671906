# SPDX-License-Identifier: GPL-3.0-or-later
"""Handles and descriptions that are null, foreign, committed or of another size: a result code and one line."""

import ctypes
from collections.abc import Callable
from ctypes import byref, c_double, c_float, c_int, c_size_t, c_uint32, c_void_p
from typing import Any

import pytest

from addon.native import structs
from tests.engine.api.misuse import (
    ARGUMENT,
    IDENTITY,
    OK,
    RENDER_CALLS,
    STATE,
    add_material,
    committed,
    material_desc,
    mesh_desc,
    new_mesh,
    refused,
    render_call,
)
from tests.engine.library import Render, engine, functions


@pytest.mark.parametrize("name", RENDER_CALLS)
def test_null_render(name: str) -> None:
    refused(render_call(name, None), ARGUMENT, "render", "null")


@pytest.mark.parametrize("name", RENDER_CALLS)
def test_foreign_render(name: str, scene: c_void_p) -> None:
    """A scene's handle, and a mesh's."""
    mesh = new_mesh()
    for handle in (scene, mesh):
        refused(render_call(name, handle), ARGUMENT, "render")
    functions().glimmer_mesh_destroy(mesh)


def scene_calls() -> dict[str, Callable[[Any], int]]:
    library, init = functions(), engine().init
    three, color = (c_double * 3)(0, 0, 0), (c_float * 3)(1, 1, 1)
    return {
        "add_material": lambda s: library.glimmer_scene_add_material(s, byref(material_desc()), byref(c_uint32())),
        "add_object": lambda s: library.glimmer_scene_add_object(s, byref(init(structs.ObjectDesc))),
        "add_spheres": lambda s: library.glimmer_scene_add_spheres(s, byref(init(structs.SpheresDesc))),
        "add_light": lambda s: library.glimmer_scene_add_light(s, byref(init(structs.LightDesc))),
        "set_environment": lambda s: library.glimmer_scene_set_environment(s, color, None, IDENTITY),
        "set_environment_visible": lambda s: library.glimmer_scene_set_environment_visible(s, 63),
        "set_medium": lambda s: library.glimmer_scene_set_medium(s, three, three, 0),
        "set_camera": lambda s: library.glimmer_scene_set_camera(s, byref(init(structs.CameraDesc))),
        "set_film": lambda s: library.glimmer_scene_set_film(s, byref(init(structs.FilmDesc))),
        "commit": lambda s: library.glimmer_scene_commit(s, 1),
    }


SCENE_CALLS = (
    "add_material",
    "add_object",
    "add_spheres",
    "add_light",
    "set_environment",
    "set_environment_visible",
    "set_medium",
    "set_camera",
    "set_film",
    "commit",
)


@pytest.mark.parametrize("name", SCENE_CALLS)
def test_null_and_foreign_scene(name: str) -> None:
    refused(scene_calls()[name](None), ARGUMENT, "scene", "null")
    mesh = new_mesh()
    refused(scene_calls()[name](mesh), ARGUMENT, "scene")
    functions().glimmer_mesh_destroy(mesh)


@pytest.mark.parametrize("name", SCENE_CALLS)
def test_a_committed_scene_never_changes(name: str) -> None:
    refused(scene_calls()[name](committed().handle), STATE, "commit")


def test_foreign_handles_in_destroy(scene: c_void_p) -> None:
    """Nothing happens to them."""
    library = functions()
    for kind in ("mesh", "image", "render"):
        getattr(library, f"glimmer_{kind}_destroy")(scene)
    assert add_material(scene)[0] == OK


def test_null_descriptions_and_outputs(scene: c_void_p) -> None:
    library = functions()
    handle = c_void_p()
    refused(library.glimmer_mesh_create(None, byref(handle)), ARGUMENT, "mesh")
    refused(library.glimmer_mesh_create(byref(mesh_desc()), None), ARGUMENT)
    refused(library.glimmer_scene_create(None), ARGUMENT)
    refused(library.glimmer_image_create(1, 1, 3, None, byref(handle)), ARGUMENT, "image")
    refused(library.glimmer_image_create(1, 1, 3, (c_float * 3)(), None), ARGUMENT)
    for name in ("add_object", "add_spheres", "add_light", "set_camera", "set_film"):
        refused(getattr(library, f"glimmer_scene_{name}")(scene, None), ARGUMENT, "null")
    refused(library.glimmer_scene_add_material(scene, None, byref(c_uint32())), ARGUMENT, "null")
    refused(library.glimmer_scene_add_material(scene, byref(material_desc()), None), ARGUMENT, "the output is null")
    refused(library.glimmer_scene_set_environment(scene, None, None, None), ARGUMENT, "null")
    refused(library.glimmer_scene_set_medium(scene, None, (c_double * 3)(), 0), ARGUMENT, "null")
    refused(library.glimmer_scene_set_medium(scene, (c_double * 3)(), None, 0), ARGUMENT, "null")
    refused(library.glimmer_render_create(committed().handle, None, byref(handle)), ARGUMENT, "null")
    desc = engine().init(structs.RenderDesc)
    refused(library.glimmer_render_create(committed().handle, byref(desc), None), ARGUMENT, "null")
    with Render(committed(), samples=1) as render:
        for name, arguments in (
            ("poll", (None,)),
            ("next_tile", (None, byref(c_int()))),
            ("next_tile", (byref(structs.TileDesc()), None)),
            ("read", (0, 0, 0, 1, 1, None, 3)),
            ("report", (None,)),
            ("save", (None, byref(c_size_t()))),
            ("save", (byref(c_void_p()), None)),
            ("load", (None, 8)),
        ):
            refused(getattr(library, f"glimmer_render_{name}")(render.handle, *arguments), ARGUMENT, "null")
    assert not handle


def add_filled_sphere(scene: c_void_p, interior: Any) -> int:
    """interior: a reference to the medium within it."""
    add_material(scene)
    centers, radii = (c_double * 3)(), (c_double * 1)(1)
    spheres = engine().init(structs.SpheresDesc)
    spheres.name, spheres.count, spheres.radius_count = b"filled", 1, 1
    spheres.centers, spheres.radii = ctypes.addressof(centers), ctypes.addressof(radii)
    spheres.interior = ctypes.cast(interior, c_void_p)
    result: int = functions().glimmer_scene_add_spheres(scene, byref(spheres))
    return result


@pytest.mark.parametrize("struct", structs.INITIALISERS.values())
def test_struct_size(struct: type[ctypes.Structure], scene: c_void_p) -> None:
    """0 (never initialised) and more than the library knows."""
    library = functions()
    out = c_void_p()
    takers: dict[str, Callable[[Any], int]] = {
        "MeshDesc": lambda p: library.glimmer_mesh_create(p, byref(out)),
        "TextureDesc": lambda p: library.glimmer_texture_create(p, byref(out)),
        "ProgramDesc": lambda p: library.glimmer_scene_add_program(scene, p, byref(c_uint32())),
        "MaterialDesc": lambda p: library.glimmer_scene_add_material(scene, p, byref(c_uint32())),
        "MediumDesc": lambda p: add_filled_sphere(scene, p),
        "ObjectDesc": lambda p: library.glimmer_scene_add_object(scene, p),
        "SpheresDesc": lambda p: library.glimmer_scene_add_spheres(scene, p),
        "LightDesc": lambda p: library.glimmer_scene_add_light(scene, p),
        "CameraDesc": lambda p: library.glimmer_scene_set_camera(scene, p),
        "FilmDesc": lambda p: library.glimmer_scene_set_film(scene, p),
        "RenderDesc": lambda p: library.glimmer_render_create(committed().handle, p, byref(out)),
        "PlotDesc": lambda p: library.glimmer_plot_error_curve(None, 0, p, None, 0),
    }
    if struct is structs.ProgressDesc:
        with Render(committed(), samples=1) as render:
            for size in (0, 100000, ctypes.sizeof(struct) - 4):
                progress = engine().init(structs.ProgressDesc)
                progress.struct_size = size
                refused(library.glimmer_render_poll(render.handle, byref(progress)), ARGUMENT, "progress")
        return
    for size in (0, 100000, ctypes.sizeof(struct) + 8, ctypes.sizeof(struct) - 4, 9):  # the last two cut a field in two
        desc: Any = engine().init(struct)
        desc.struct_size = size
        refused(takers[struct.__name__](byref(desc)), ARGUMENT, "struct_size")
    assert not out
