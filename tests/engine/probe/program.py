# SPDX-License-Identifier: GPL-3.0-or-later
"""Shader programs at places of an object that stands in the world as it is."""

import ctypes
from collections.abc import Sequence
from ctypes import POINTER, byref, c_void_p
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from addon.native import structs
from addon.native.ops import OpRow, op_rows
from addon.native.programs import fill_program
from addon.scene.program import Op, Program, Texture, compile_program
from tests.engine.probe.call import Array, call, f32, library


@cache
def rows() -> dict[str, OpRow]:
    info = library().probe_op_info
    info.restype = POINTER(structs.OpInfo)
    return op_rows(info)


def description(program: Program) -> tuple[Any, list[Any]]:
    """Of a program without textures, and what must live as long."""
    desc = structs.ProgramDesc(struct_size=ctypes.sizeof(structs.ProgramDesc), name=b"test")
    return desc, fill_program(desc, program, [], rows())


def refusal(desc: Any) -> str:
    """What the check says of a description; "" when it is taken."""
    handle = call("probe_program_create", byref(desc), None, returns=c_void_p)
    if handle:
        call("probe_program_destroy", c_void_p(handle))
        return ""
    message = call("probe_program_message", returns=ctypes.c_char_p)
    return str(message.decode())


def _create_texture(texture: Texture) -> int:
    pixels = np.ascontiguousarray(texture.pixels)
    height, width, channels = pixels.shape
    is_float = int(pixels.dtype != np.uint8)
    handle = call(
        "probe_texture_create", width, height, channels, int(texture.srgb), is_float, pixels, returns=c_void_p
    )
    return int(handle)


def evaluate(
    roots: Sequence[Op],
    positions: ArrayLike,
    normals: ArrayLike = (0.0, 0.0, 1.0),
    incoming: ArrayLike = (0.0, 0.0, 1.0),
    attribute: ArrayLike = (0.0, 0.0, 0.0),
) -> Array:
    """(n, roots, 3). Every attribute of the program is the one array, a row a place."""
    places = f32(positions)
    n = len(places)
    program = compile_program(roots)
    desc, keep = description(program)
    textures = [_create_texture(item) for item in program.textures]
    handles = (c_void_p * max(len(textures), 1))(*textures)
    desc.texture_count, desc.textures = len(textures), ctypes.addressof(handles)
    handle = call("probe_program_create", byref(desc), byref(handles), returns=c_void_p)
    assert handle, call("probe_program_message", returns=ctypes.c_char_p)
    out = np.zeros((n, len(roots), 3), np.float32)
    arrays = [f32(array, n, 3) for array in (normals, incoming, attribute)]
    call("probe_program_evaluate", c_void_p(handle), places, *arrays, np.uint64(n), out)
    call("probe_program_destroy", c_void_p(handle))
    for item in textures:
        call("probe_texture_destroy", c_void_p(item))
    del keep
    return out
