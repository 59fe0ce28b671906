# SPDX-License-Identifier: GPL-3.0-or-later
"""Misuse of the C API: every call comes back with a result code and one line, and nothing crashes."""

import ctypes
import math
import re
import subprocess
import threading
from collections.abc import Callable, Iterator
from ctypes import byref, c_char_p, c_double, c_float, c_int, c_size_t, c_uint32, c_void_p
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from addon.native import structs
from addon.native.structs import Result
from tests.engine.library import Render, Scene, call, engine, functions, last_error, library_path
from tests.engine.worlds import everything

OK, ARGUMENT, STATE = Result.OK, Result.INVALID_ARGUMENT, Result.INVALID_STATE
VERTICES = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float64)
TRIANGLES = np.array([[0, 1, 2]], np.uint32)
IDENTITY = (c_double * 16)(*np.eye(4).ravel())
NAN, INFINITY = math.nan, math.inf


def refused(result: int, code: Result, *words: str) -> str:
    """That a call gave back `code` and a message of one line that has the words in it."""
    message = last_error()
    assert result == code, f"{Result(result).name}: {message}"
    assert message and "\n" not in message and len(message) < 300, message
    for word in words:
        assert word in message, f"'{word}' is not in: {message}"
    return message


@pytest.fixture
def scene() -> Iterator[c_void_p]:
    handle = c_void_p()
    call("glimmer_scene_create", byref(handle))
    yield handle
    functions().glimmer_scene_destroy(handle)


@cache
def committed() -> Scene:
    return Scene(everything(16, 8))


def mesh_desc(**changes: Any) -> structs.MeshDesc:
    desc = engine().init(structs.MeshDesc)
    desc.format, desc.vertex_count, desc.vertices = 1, 3, VERTICES.ctypes.data
    desc.triangle_count, desc.triangles = 1, TRIANGLES.ctypes.data
    return changed(desc, changes)


def changed(desc: Any, changes: dict[str, Any]) -> Any:
    for key, value in changes.items():
        current = getattr(desc, key)
        setattr(desc, key, type(current)(*value) if isinstance(current, ctypes.Array) else value)
    return desc


def new_mesh() -> c_void_p:
    handle = c_void_p()
    call("glimmer_mesh_create", byref(mesh_desc()), byref(handle))
    return handle


def add_material(scene: c_void_p, **changes: Any) -> tuple[int, int]:
    """Result and number."""
    desc = changed(engine().init(structs.MaterialDesc), changes)
    number = c_uint32(12345)
    return functions().glimmer_scene_add_material(scene, byref(desc), byref(number)), number.value


# ---- What the library shows of itself -------------------------------------------------------------------------------


def test_exports_are_its_own_alone() -> None:
    """Inside Blender any other symbol could be taken for the host's, or the host's for ours."""
    out = subprocess.run(
        ["nm", "-D", "--defined-only", library_path()], capture_output=True, text=True, check=True
    ).stdout
    names = [line.split()[-1].split("@")[0] for line in out.splitlines()]
    assert names and all(name.startswith("glimmer_") for name in names), names


def test_every_function_of_the_header_is_exported(repository: Path) -> None:
    header = (repository / "engine" / "include" / "glimmer.h").read_text()
    declared = set(re.findall(r"^GLIMMER_API .*?\b(glimmer_\w+)\(", header, re.MULTILINE | re.DOTALL))
    out = subprocess.run(
        ["nm", "-D", "--defined-only", library_path()], capture_output=True, text=True, check=True
    ).stdout
    assert declared == {line.split()[-1].split("@")[0] for line in out.splitlines()}
    assert len(declared) > 40


def test_needs_nothing_but_the_c_and_cpp_runtimes() -> None:
    out = subprocess.run(["readelf", "-d", library_path()], capture_output=True, text=True, check=True).stdout
    needed = set(re.findall(r"NEEDED.*\[(.+?)\]", out))
    allowed = {"libc.so.6", "libm.so.6", "libstdc++.so.6", "libgcc_s.so.1", "ld-linux-x86-64.so.2"}
    assert needed and needed <= allowed, needed - allowed


def test_tables_end() -> None:
    library = functions()
    for name in ("glimmer_pass_info", "glimmer_integrator_info"):
        assert getattr(library, name)(0)
        for index in (12, 1000, 0xFFFFFFFF):
            assert not getattr(library, name)(index)


# ---- Handles --------------------------------------------------------------------------------------------------------

RENDER_CALLS: dict[str, Callable[[], tuple[Any, ...]]] = {
    "start": tuple,
    "pause": tuple,
    "resume": tuple,
    "cancel": tuple,
    "wait": lambda: (0.0,),
    "poll": lambda: (byref(engine().init(structs.ProgressDesc)),),
    "next_tile": lambda: (byref(structs.TileDesc()), byref(c_int())),
    "read": lambda: (0, 0, 0, 1, 1, (c_float * 3)(), 3),
    "report": lambda: (byref(c_char_p()),),
    "save": lambda: (byref(c_void_p()), byref(c_size_t())),
    "load": lambda: (b"12345678", 8),
}


def render_call(name: str, handle: Any) -> int:
    result: int = getattr(functions(), f"glimmer_render_{name}")(handle, *RENDER_CALLS[name]())
    return result


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
        "add_material": lambda s: library.glimmer_scene_add_material(
            s, byref(init(structs.MaterialDesc)), byref(c_uint32())
        ),
        "add_object": lambda s: library.glimmer_scene_add_object(s, byref(init(structs.ObjectDesc))),
        "add_spheres": lambda s: library.glimmer_scene_add_spheres(s, byref(init(structs.SpheresDesc))),
        "add_light": lambda s: library.glimmer_scene_add_light(s, byref(init(structs.LightDesc))),
        "set_environment": lambda s: library.glimmer_scene_set_environment(s, color, None, IDENTITY),
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


def test_null_is_allowed_in_every_destroy_and_init() -> None:
    library = functions()
    for kind in ("mesh", "image", "scene", "render"):
        getattr(library, f"glimmer_{kind}_destroy")(None)
    for name in structs.INITIALISERS:
        getattr(library, name)(None)
    assert not library.glimmer_scene_warnings(None)


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
    refused(
        library.glimmer_scene_add_material(scene, byref(engine().init(structs.MaterialDesc)), None), ARGUMENT, "null"
    )
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


@pytest.mark.parametrize("struct", structs.INITIALISERS.values())
def test_struct_size(struct: type[ctypes.Structure], scene: c_void_p) -> None:
    """0 (never initialised) and more than the library knows."""
    library = functions()
    out = c_void_p()
    takers: dict[str, Callable[[Any], int]] = {
        "MeshDesc": lambda p: library.glimmer_mesh_create(p, byref(out)),
        "MaterialDesc": lambda p: library.glimmer_scene_add_material(scene, p, byref(c_uint32())),
        "ObjectDesc": lambda p: library.glimmer_scene_add_object(scene, p),
        "SpheresDesc": lambda p: library.glimmer_scene_add_spheres(scene, p),
        "LightDesc": lambda p: library.glimmer_scene_add_light(scene, p),
        "CameraDesc": lambda p: library.glimmer_scene_set_camera(scene, p),
        "FilmDesc": lambda p: library.glimmer_scene_set_film(scene, p),
        "RenderDesc": lambda p: library.glimmer_render_create(committed().handle, p, byref(out)),
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


def test_an_older_caller_is_understood(scene: c_void_p) -> None:
    """A description that ends early keeps the defaults of the rest."""
    desc = engine().init(structs.CameraDesc)
    desc.struct_size = structs.CameraDesc.shift.offset
    desc.lens_radius = -1  # beyond what this caller knows
    assert functions().glimmer_scene_set_camera(scene, byref(desc)) == OK


# ---- Order ----------------------------------------------------------------------------------------------------------


def test_commit_wants_camera_and_film(scene: c_void_p) -> None:
    library = functions()
    refused(library.glimmer_scene_commit(scene, 1), STATE, "camera")
    assert library.glimmer_scene_set_camera(scene, byref(engine().init(structs.CameraDesc))) == OK
    refused(library.glimmer_scene_commit(scene, 1), STATE, "film")
    assert library.glimmer_scene_set_film(scene, byref(engine().init(structs.FilmDesc))) == OK
    assert library.glimmer_scene_commit(scene, 1) == OK
    refused(library.glimmer_scene_commit(scene, 1), STATE, "commit")


def test_render_wants_a_committed_scene(scene: c_void_p) -> None:
    out = c_void_p()
    desc = engine().init(structs.RenderDesc)
    refused(functions().glimmer_render_create(scene, byref(desc), byref(out)), STATE, "commit")
    assert not out


def test_order_of_a_render() -> None:
    with Render(committed(), samples=2) as render:
        refused(render_call("wait", render.handle), STATE, "start")
        state = render.save()  # of nothing yet
        render.run()
        refused(render_call("start", render.handle), STATE, "started")
        refused(functions().glimmer_render_load(render.handle, state, len(state)), STATE)
    with Render(committed(), samples=1 << 40) as render:
        render.start()
        refused(render_call("save", render.handle), STATE, "pause")
        refused(render_call("start", render.handle), STATE, "started")


def test_calls_that_change_nothing_in_the_wrong_state() -> None:
    """Pausing what does not run and resuming what is not paused leave everything as it is."""
    with Render(committed(), samples=1) as render:
        for name in ("pause", "resume"):
            assert render_call(name, render.handle) in (OK, STATE)
        assert render.poll().state == structs.State.READY
        render.run()
        for name in ("pause", "resume", "cancel"):
            assert render_call(name, render.handle) in (OK, STATE)
        assert render.poll().state == structs.State.FINISHED


# ---- Values ---------------------------------------------------------------------------------------------------------


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


LAMBERT, MIRROR, CONDUCTOR, GLASS, REPORT_METAL, MIX, LIGHT, NULL = range(8)


@pytest.mark.parametrize(
    ("changes", "word"),
    [
        ({"type": 8}, "type"),
        ({"type": -1}, "type"),
        ({"type": LAMBERT, "color": (0.5, 1.5, 0.5)}, "albedo"),
        ({"type": LAMBERT, "color": (0.5, -0.1, 0.5)}, "albedo"),
        ({"type": LAMBERT, "color": (0.5, NAN, 0.5)}, "albedo"),
        ({"type": MIRROR, "color": (2, 0, 0)}, "reflectance"),
        ({"type": CONDUCTOR, "alpha": 1.5}, "alpha"),
        ({"type": CONDUCTOR, "alpha": NAN}, "alpha"),
        ({"type": CONDUCTOR, "eta": (0, 1, 1)}, "eta"),
        ({"type": CONDUCTOR, "k": (1, -1, 1)}, "k"),
        ({"type": CONDUCTOR, "use_f0": 1, "f0": (0, 0, 1.1)}, "f0"),
        ({"type": CONDUCTOR, "use_f0": 1, "f90": (0, -0.1, 1)}, "f90"),
        ({"type": CONDUCTOR, "masking": 3}, "masking"),
        ({"type": GLASS, "ior": 0}, "ior"),
        ({"type": GLASS, "ior": -1.5}, "ior"),
        ({"type": GLASS, "ior": NAN}, "ior"),
        ({"type": GLASS, "emission": (1, 0, 0)}, "emission"),
        ({"type": LIGHT, "emission": (1, 0, 0)}, "emission"),
        ({"type": NULL, "emission": (1, 0, 0)}, "emission"),
        ({"type": LAMBERT, "emission": (-1, 0, 0)}, "emission"),
        ({"type": LAMBERT, "emission": (INFINITY, 0, 0)}, "emission"),
        ({"type": LIGHT, "color": (-1, 0, 0)}, "radiance"),
        ({"type": LIGHT, "color": (INFINITY, 0, 0)}, "radiance"),
        ({"type": REPORT_METAL, "alpha": -1}, "alpha"),
        ({"type": MIX, "a": 0, "b": 99}, "99"),
        ({"type": MIX, "a": 0, "b": 1, "weight": 1.5}, "weight"),
        ({"type": MIX, "a": 0, "b": 2}, "mix"),
    ],
)
def test_bad_material(scene: c_void_p, changes: dict[str, Any], word: str) -> None:
    """Named in the message, and not added: the next good one takes its number."""
    for good in (LAMBERT, MIRROR, GLASS):
        assert add_material(scene, type=good)[0] == OK
    result, number = add_material(scene, name=b"culprit", **changes)
    refused(result, ARGUMENT, word, "culprit")
    assert number == 12345, "an output of a call that failed was written"
    assert add_material(scene) == (OK, 3)


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
    good = three(0, 0.1, 0.2)
    for bad in (three(-1, 0, 0), three(0, NAN, 0), three(0, 0, INFINITY)):
        refused(library.glimmer_scene_set_medium(scene, bad, good, 0), ARGUMENT, "sigma_a")
        refused(library.glimmer_scene_set_medium(scene, good, bad, 0), ARGUMENT, "sigma_s")
    for g in (-1.0, 1.0, NAN, 7.0):
        refused(library.glimmer_scene_set_medium(scene, good, good, g), ARGUMENT, "g")


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
        ({"clip_start": -1}, "clip_start"),
        ({"clip_start": 2, "clip_end": 1}, "clip_end"),
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


@pytest.mark.parametrize(
    ("changes", "word"),
    [
        ({"integrator": b"magic"}, "magic"),
        ({"seconds": -1}, "seconds"),
        ({"seconds": NAN}, "seconds"),
        ({"target_error": -1}, "target_error"),
        ({"threads": 100000}, "threads"),
        ({"tile_size": 1 << 20}, "tile_size"),
        ({"max_depth": -2}, "max_depth"),
        ({"max_scatter": -2}, "max_scatter"),
        ({"passes": 1 << 12}, "passes"),
    ],
)
def test_bad_render(changes: dict[str, Any], word: str) -> None:
    out = c_void_p()
    desc = changed(engine().init(structs.RenderDesc), changes)
    refused(functions().glimmer_render_create(committed().handle, byref(desc), byref(out)), ARGUMENT, word)
    assert not out


@pytest.mark.parametrize(
    ("which", "rectangle", "count", "word"),
    [
        (12, (0, 0, 1, 1), 3, "pass"),
        (-1, (0, 0, 1, 1), 3, "pass"),
        (2, (0, 0, 1, 1), 3, "albedo"),
        (0, (0, 0, 17, 1), 51, "16"),
        (0, (16, 8, 1, 1), 3, "16"),
        (0, (0xFFFFFFFF, 0, 2, 1), 6, "16"),
        (0, (0, 0xFFFFFFFF, 1, 2), 6, "16"),
        (0, (0, 0, 2, 2), 11, "12"),
        (0, (0, 0, 2, 2), 13, "12"),
    ],
)
def test_bad_read(which: int, rectangle: tuple[int, int, int, int], count: int, word: str) -> None:
    """Nothing is written."""
    with Render(committed(), samples=1) as render:
        render.run()
        pixels = (c_float * 64)(*[7.0] * 64)
        refused(functions().glimmer_render_read(render.handle, which, *rectangle, pixels, count), ARGUMENT, word)
        assert all(value == 7 for value in pixels)


def test_bad_states_to_load() -> None:
    """Empty, cut off at any place, of another seed, size or integrator, or not a state at all."""
    settings: dict[str, Any] = {"samples": 2, "seed": 3, "threads": 1}
    with Render(committed(), **settings) as render:
        state = render.run().save()
    library = functions()

    def try_load(data: bytes, **other: Any) -> int:
        with Render(committed(), **{**settings, **other}) as render:
            result: int = library.glimmer_render_load(render.handle, data, len(data))
            if result != OK:  # still as good as new
                refused(result, ARGUMENT)
                assert render.run().poll().samples == 2
                assert np.isfinite(render.read()).all()
            return result

    assert try_load(state) == OK
    for length in (0, 1, 8, 47, 63, 64, len(state) // 2, len(state) - 1):
        assert try_load(state[:length]) == ARGUMENT, length
    assert try_load(b"\0" * len(state)) == ARGUMENT
    assert try_load(state, seed=4) == ARGUMENT
    assert try_load(state, integrator="report") == ARGUMENT
    assert try_load(state, passes=("albedo",)) == ARGUMENT
    damaged = bytearray(state)
    damaged[40:48] = b"\xff" * 8  # the length of its curve
    assert try_load(bytes(damaged)) == ARGUMENT


def test_a_message_is_one_line_whatever_the_name(scene: c_void_p) -> None:
    for name in (b"two\nlines", b"back\rto the start", b"\x1b[31mred", b"bell\x07", b"delete\x7f"):
        message = refused(add_material(scene, name=name, alpha=2, type=CONDUCTOR)[0], ARGUMENT, "alpha")
        assert message.isprintable(), message


def test_errors_are_kept_by_thread() -> None:
    """A failure on one thread is none of another's."""
    refused(functions().glimmer_scene_commit(None, 0), ARGUMENT, "scene")
    seen: list[str] = []
    thread = threading.Thread(target=lambda: seen.append(last_error()))
    thread.start()
    thread.join()
    assert seen == [""]
    assert "scene" in last_error()


def test_what_is_handed_in_is_copied(scene: c_void_p) -> None:
    """The caller's arrays may change before the commit."""
    library = functions()
    vertices = VERTICES.copy()
    mesh = c_void_p()
    call("glimmer_mesh_create", byref(mesh_desc(vertices=vertices.ctypes.data)), byref(mesh))
    vertices[:] = NAN
    name = ctypes.create_string_buffer(b"first name")
    desc = engine().init(structs.MaterialDesc)
    desc.name = ctypes.cast(name, c_char_p)
    assert library.glimmer_scene_add_material(scene, byref(desc), byref(c_uint32())) == OK
    name.value = b"overwrite"
    numbers = (c_uint32 * 1)(0)
    item = engine().init(structs.ObjectDesc)
    item.mesh, item.material_count, item.materials = mesh, 1, ctypes.addressof(numbers)
    assert library.glimmer_scene_add_object(scene, byref(item)) == OK
    numbers[0] = 99
    library.glimmer_mesh_destroy(mesh)  # the scene holds on to it
    film = engine().init(structs.FilmDesc)
    film.width = film.height = 8
    assert library.glimmer_scene_set_camera(scene, byref(engine().init(structs.CameraDesc))) == OK
    assert library.glimmer_scene_set_film(scene, byref(film)) == OK
    assert library.glimmer_scene_commit(scene, 1) == OK, last_error()


def test_degenerate_but_legal(scene: c_void_p) -> None:
    """No object, no light, triangles without area: a black picture and a warning, no failure."""
    library = functions()
    flat = np.zeros((3, 3))
    mesh = c_void_p()
    call("glimmer_mesh_create", byref(mesh_desc(vertices=flat.ctypes.data)), byref(mesh))
    assert add_material(scene)[0] == OK
    numbers = (c_uint32 * 1)(0)
    item = engine().init(structs.ObjectDesc)
    item.mesh, item.material_count, item.materials = mesh, 1, ctypes.addressof(numbers)
    assert library.glimmer_scene_add_object(scene, byref(item)) == OK
    item.instances, item.instance_count = VERTICES.ctypes.data, 0  # of no instance at all
    assert library.glimmer_scene_add_object(scene, byref(item)) == OK
    library.glimmer_mesh_destroy(mesh)
    film = engine().init(structs.FilmDesc)
    film.width = film.height = 8
    assert library.glimmer_scene_set_camera(scene, byref(engine().init(structs.CameraDesc))) == OK
    assert library.glimmer_scene_set_film(scene, byref(film)) == OK
    assert library.glimmer_scene_commit(scene, 1) == OK, last_error()
    assert b"black" in library.glimmer_scene_warnings(scene)
    desc = engine().init(structs.RenderDesc)
    desc.samples = 3
    for integrator in (b"path", b"report"):
        desc.integrator = integrator
        render = c_void_p()
        call("glimmer_render_create", scene, byref(desc), byref(render))
        call("glimmer_render_start", render)
        call("glimmer_render_wait", render, -1.0)
        pixels = np.full((8, 8, 3), NAN, np.float32)
        call("glimmer_render_read", render, 0, 0, 0, 8, 8, pixels.ctypes.data, pixels.size)
        assert (pixels == 0).all()
        library.glimmer_render_destroy(render)
