# SPDX-License-Identifier: GPL-3.0-or-later
"""What looks like misuse and is none; what is copied; how a message looks."""

import ctypes
import threading
from ctypes import byref, c_char_p, c_uint32, c_void_p

import numpy as np

from addon.native import structs
from tests.engine.api.misuse import ARGUMENT, NAN, OK, VERTICES, add_material, material_desc, mesh_desc, refused
from tests.engine.library import call, engine, functions, last_error


def test_null_is_allowed_in_every_destroy_and_init() -> None:
    library = functions()
    for kind in ("mesh", "image", "scene", "render"):
        getattr(library, f"glimmer_{kind}_destroy")(None)
    for name in structs.INITIALISERS:
        getattr(library, name)(None)
    assert not library.glimmer_scene_warnings(None)


def test_an_older_caller_is_understood(scene: c_void_p) -> None:
    """A description that ends early keeps the defaults of the rest."""
    desc = engine().init(structs.CameraDesc)
    desc.struct_size = structs.CameraDesc.shift.offset
    desc.lens_radius = -1  # beyond what this caller knows
    assert functions().glimmer_scene_set_camera(scene, byref(desc)) == OK


def test_a_message_is_one_line_whatever_the_name(scene: c_void_p) -> None:
    for name in (b"two\nlines", b"back\rto the start", b"\x1b[31mred", b"bell\x07", b"delete\x7f"):
        message = refused(add_material(scene, "lambert", {"albedo": 2.0}, name=name)[0], ARGUMENT, "albedo")
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
    desc = material_desc()
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
    assert library.glimmer_warning_name(library.glimmer_scene_warning_code(scene, 0)) == b"no_light"
    assert library.glimmer_warning_name(library.glimmer_scene_warning_code(scene, 1)) is None
    desc = engine().init(structs.RenderDesc)
    desc.samples = 3
    for integrator in (b"path", b"baseline"):
        desc.integrator = integrator
        render = c_void_p()
        call("glimmer_render_create", scene, byref(desc), byref(render))
        call("glimmer_render_start", render)
        call("glimmer_render_wait", render, -1.0)
        pixels = np.full((8, 8, 3), NAN, np.float32)
        call("glimmer_render_read", render, 0, 0, 0, 8, 8, pixels.ctypes.data, pixels.size)
        assert (pixels == 0).all()
        library.glimmer_render_destroy(render)
