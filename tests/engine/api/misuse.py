# SPDX-License-Identifier: GPL-3.0-or-later
"""Calls of the bare C API, with descriptions that can be spoilt, and that they are refused in one line."""

import ctypes
import math
from collections.abc import Callable
from ctypes import byref, c_char_p, c_double, c_float, c_int, c_size_t, c_uint32, c_void_p
from functools import cache
from typing import Any

import numpy as np

from addon.native import structs
from addon.native.structs import Result
from tests.engine.library import Scene, call, engine, functions, last_error
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


def parameters(values: dict[str, Any]) -> Any:
    """The engine's array: a list is a colour, a text a word, an int a material."""
    out = (structs.Parameter * len(values))()
    for entry, (key, value) in zip(out, values.items(), strict=True):
        entry.key = key.encode()
        if isinstance(value, str):
            entry.word = value.encode()
        elif isinstance(value, int):
            entry.material = value
        else:
            entry.value = tuple(value) if isinstance(value, tuple) else (value,) * 3
    return out


GREY = {"albedo": 0.5}


def material_desc(kind: str | None = "lambert", values: dict[str, Any] | None = None, **changes: Any) -> Any:
    given = parameters(GREY if values is None else values)
    desc = engine().init(structs.MaterialDesc)
    desc.type = None if kind is None else kind.encode()
    desc.parameter_count, desc.parameters = len(given), given
    return changed(desc, changes)


def add_material(scene: c_void_p, *described: Any, **changes: Any) -> tuple[int, int]:
    """Result and number."""
    desc = material_desc(*described, **changes)
    number = c_uint32(12345)
    return functions().glimmer_scene_add_material(scene, byref(desc), byref(number)), number.value


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
