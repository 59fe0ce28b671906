# SPDX-License-Identifier: GPL-3.0-or-later
"""Textures, attributes, shader programs and what they are bound to, as the C API refuses them."""

import ctypes
from ctypes import byref, c_uint32, c_void_p
from typing import Any

import numpy as np
import pytest

from addon.native import structs
from addon.native.programs import fill_program
from addon.scene.program import Op, Texture, compile_program
from tests.engine.api.misuse import (
    ARGUMENT,
    OK,
    add_material,
    changed,
    mesh_desc,
    refused,
)
from tests.engine.library import engine, functions

PIXELS = np.zeros((4, 4, 3), np.float32)
COLOR = Op("splat", (0.5,))
NUMBER = Op("math", (0.5, 0.5, 0.0), ("add", "free"))


def create_texture(**changes: Any) -> int:
    desc = engine().init(structs.TextureDesc)
    desc.width = desc.height = 4
    desc.format, desc.pixels = 1, PIXELS.ctypes.data
    handle = c_void_p()
    result = functions().glimmer_texture_create(byref(changed(desc, changes)), byref(handle))
    functions().glimmer_texture_destroy(handle)
    return int(result)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"width": 0}, "width is 0; allowed: 1 to 65536"),
        ({"height": 65537}, "height is 65537"),
        ({"channels": 5}, "channels is 5; allowed: 1 to 4"),
        ({"format": 2}, "format is 2; allowed: uint8 (0), float32 (1)"),
        ({"pixels": None}, "pixels is null"),
        ({"struct_size": 3}, "struct_size is 3"),
    ],
)
def test_a_bad_texture_is_refused(changes: dict[str, Any], words: str) -> None:
    assert create_texture() == OK
    refused(create_texture(**changes), ARGUMENT, "texture", words)


def test_a_texel_that_is_no_number_is_refused() -> None:
    pixels = PIXELS.copy()
    pixels[2, 1, 0] = np.nan
    refused(create_texture(pixels=pixels.ctypes.data), ARGUMENT, "x 1, y 2 is not finite")


def create_mesh(count: int = 1, **changes: Any) -> int:
    values = np.zeros((3, 2), np.float32)
    attribute = structs.Attribute(b"uv", structs.AttributeDomain.CORNER, 2, values.ctypes.data)
    array = (structs.Attribute * 2)(changed(attribute, changes), attribute)
    desc = mesh_desc(attribute_count=count, attributes=ctypes.addressof(array))
    handle = c_void_p()
    result = functions().glimmer_mesh_create(byref(desc), byref(handle))
    functions().glimmer_mesh_destroy(handle)
    return int(result)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"name": None}, "has no name"),
        ({"domain": 3}, "domain is 3; allowed: 0 to 2"),
        ({"components": 0}, "components is 0; allowed: 1 to 4"),
        ({"components": 5}, "components is 5"),
        ({"values": None}, "values are null"),
        ({"count": 2}, "uv is given twice"),
        ({"count": 257}, "attributes are 257; allowed: up to 256"),
    ],
)
def test_a_bad_attribute_is_refused(changes: dict[str, Any], words: str) -> None:
    assert create_mesh() == OK
    refused(create_mesh(**changes), ARGUMENT, "mesh", words)


def add_program(scene: c_void_p, *roots: Op, **changes: Any) -> tuple[int, int]:
    """Result and number. Textures of the program are left out."""
    desc = engine().init(structs.ProgramDesc)
    keep = fill_program(desc, compile_program(roots), [], engine().op_rows)
    number = c_uint32(12345)
    result = functions().glimmer_scene_add_program(scene, byref(changed(desc, changes)), byref(number))
    del keep
    return int(result), number.value


def test_a_program_without_its_textures_is_refused(scene: c_void_p) -> None:
    texture = Texture("four", PIXELS)
    image = Op("image", ((0.0, 0.0, 0.0), 0.0), ("flat", "linear", "repeat", "as_is"), texture)
    result, number = add_program(scene, image)
    refused(result, ARGUMENT, "texture 0 of 0")
    assert number == 12345
    handles = (c_void_p * 1)(None)
    result, _ = add_program(scene, image, texture_count=1, textures=ctypes.addressof(handles))
    refused(result, ARGUMENT, "texture is null")
    result, _ = add_program(scene, image, texture_count=300, textures=ctypes.addressof(handles))
    refused(result, ARGUMENT, "textures are 300; allowed: up to 256")


def bind(scene: c_void_p, material: int, key: bytes | None, program: int, output: int = 0) -> int:
    return int(functions().glimmer_scene_bind(scene, material, key, program, output))


def test_what_cannot_be_bound_is_refused(scene: c_void_p) -> None:
    kinds: dict[str, dict[str, Any]] = {
        "lambert": {"albedo": 0.5},
        "glass": {"ior": 1.5},
        "conductor": {"alpha": 0.5, "f0": 0.5},
        "mirror": {"reflectance": 0.5},
        "null": {},
    }
    lambert, glass, conductor, mirror, null = (add_material(scene, kind, given)[1] for kind, given in kinds.items())
    result, program = add_program(scene, COLOR, NUMBER)
    assert result == OK
    assert bind(scene, lambert, b"albedo", program) == OK
    refused(bind(scene, lambert, b"albedo", program), ARGUMENT, "albedo is bound twice")
    refused(bind(scene, lambert, b"emission", program + 1), ARGUMENT, f"program {program + 1} was not added")
    refused(bind(scene, lambert, b"emission", program, 2), ARGUMENT, "output 2 of 2")
    refused(bind(scene, lambert, b"emission", program, 1), ARGUMENT, "emission is a colour or vector")
    refused(
        bind(scene, lambert, b"alpha", program, 1),
        ARGUMENT,
        '"alpha" cannot vary',
        "albedo, roughness, emission, normal",
    )
    refused(bind(scene, lambert, None, program), ARGUMENT, '"" cannot vary')
    refused(bind(scene, conductor, b"alpha", program, 0), ARGUMENT, "alpha is a number")
    assert bind(scene, conductor, b"alpha", program, 1) == OK
    assert bind(scene, mirror, b"normal", program, 0) == OK
    refused(bind(scene, null, b"color", program), ARGUMENT, "cannot vary; allowed: nothing")
    refused(bind(scene, glass, b"color", program), ARGUMENT, "cannot vary")
    refused(bind(scene, 99, b"color", program), ARGUMENT, "material 99 was not added")


def test_a_sky_is_a_colour_of_a_program(scene: c_void_p) -> None:
    _, program = add_program(scene, COLOR, NUMBER)
    sky = functions().glimmer_scene_bind_environment
    assert sky(scene, program, 0) == OK
    refused(sky(scene, program, 1), ARGUMENT, "environment", "or a number; allowed: a colour")
    refused(sky(scene, program, 2), ARGUMENT, "environment")
    refused(sky(scene, program + 1, 0), ARGUMENT, "was not added")


def test_a_lamp_is_multiplied_by_a_colour_of_a_program(scene: c_void_p) -> None:
    _, program = add_program(scene, COLOR, NUMBER)
    lamp = engine().init(structs.LightDesc)
    lamp.name = b"lamp"
    assert functions().glimmer_scene_add_light(scene, byref(lamp)) == OK

    def bind(light: int = 0, program: int = program, output: int = 0, size: float = 1.0) -> int:
        to_world = np.diag([size, 1.0, 1.0, 1.0])
        return int(
            functions().glimmer_scene_bind_light(
                scene, light, program, output, to_world.ctypes.data_as(ctypes.POINTER(ctypes.c_double))
            )
        )

    assert bind() == OK and bind(size=-2.0) == OK
    refused(bind(light=1), ARGUMENT, "light 1 was not added")
    refused(bind(program=program + 1), ARGUMENT, 'light "lamp"', "was not added")
    refused(bind(output=1), ARGUMENT, 'light "lamp"', "or a number; allowed: a colour")
    refused(bind(size=0.0), ARGUMENT, 'light "lamp": to_world has no inverse')
    refused(bind(size=float("nan")), ARGUMENT, 'light "lamp": to_world')
    refused(functions().glimmer_scene_bind_light(scene, 0, program, 0, None), ARGUMENT, "to_world is null")
