# SPDX-License-Identifier: GPL-3.0-or-later
"""Shader programs and their textures, as the engine takes them."""

from __future__ import annotations

import ctypes
from ctypes import addressof, byref, c_char_p, c_uint16, c_uint32, c_void_p
from typing import Any

import numpy as np

from ..scene.program import Program, Texture
from . import structs
from .library import Library
from .ops import OpRow


def fill_program(desc: Any, program: Program, textures: list[c_void_p], rows: dict[str, OpRow]) -> list[Any]:
    """Returns what must live as long as the description."""
    instructions = (structs.Instruction * len(program.instructions))()
    for out, instruction in zip(instructions, program.instructions, strict=True):
        row = rows[instruction.op]
        out.op, out.out, out.resource = row.number, instruction.out, instruction.resource
        for field, word in enumerate(instruction.modes):
            out.mode[field] = row.modes[field].index(word)
        for number, operand in enumerate(instruction.inputs):
            out.inputs[number] = operand if operand >= 0 else structs.CONSTANT + (-1 - operand)
    constants = np.ascontiguousarray(program.constants, np.float32)
    keep: list[Any] = [instructions, constants]
    tables = (structs.Table * len(program.tables))()
    for out, table in zip(tables, program.tables, strict=True):
        values = np.ascontiguousarray(table.rows, np.float32)
        keep.append(values)
        out.row_count, out.rows, out.low, out.high = len(values), values.ctypes.data, table.low, table.high
    handles = (c_void_p * len(textures))(*textures)
    names = (c_char_p * len(program.attributes))(*(name.encode() for name in program.attributes))
    outputs = (c_uint16 * len(program.outputs))(*program.outputs)
    keep += [tables, handles, names, outputs]
    desc.instruction_count, desc.instructions = len(instructions), addressof(instructions)
    desc.constant_count, desc.constants = len(constants), constants.ctypes.data
    desc.table_count, desc.tables = len(tables), addressof(tables)
    desc.texture_count, desc.textures = len(handles), addressof(handles)
    desc.attribute_count, desc.attributes = len(names), addressof(names)
    desc.output_count, desc.outputs = len(outputs), addressof(outputs)
    return keep


def create_texture(library: Library, texture: Texture) -> c_void_p:
    pixels = np.ascontiguousarray(texture.pixels)
    if pixels.dtype != np.uint8:
        pixels = np.ascontiguousarray(pixels, np.float32)
    desc = library.init(structs.TextureDesc)
    desc.name = texture.name.encode()
    desc.height, desc.width, desc.channels = pixels.shape
    desc.format = int(pixels.dtype != np.uint8)
    desc.srgb = int(texture.srgb)
    desc.pixels = pixels.ctypes.data
    handle = c_void_p()
    library.call("glimmer_texture_create", byref(desc), byref(handle))
    return handle


class ProgramAdder:
    """Adds programs to a scene. Close it when the scene is committed: the scene keeps the textures that it uses."""

    def __init__(self, library: Library, scene: c_void_p) -> None:
        self._library = library
        self._scene = scene
        self._rows = library.op_rows
        self._textures: dict[bytes, c_void_p] = {}
        self._numbers: dict[Program, int] = {}

    def add(self, name: str, program: Program) -> int:
        """The engine's number of it."""
        textures = [self._texture(texture) for texture in program.textures]
        desc = self._library.init(structs.ProgramDesc)
        desc.name = name.encode()
        keep = fill_program(desc, program, textures, self._rows)
        number = c_uint32()
        self._library.call("glimmer_scene_add_program", self._scene, byref(desc), byref(number))
        del keep
        return number.value

    def add_once(self, name: str, program: Program) -> int:
        """The same of one that several things may have."""
        if program not in self._numbers:
            self._numbers[program] = self.add(name, program)
        return self._numbers[program]

    def bind(self, material: int, key: str, program: int, output: int) -> None:
        self._library.call("glimmer_scene_bind", self._scene, material, key.encode(), program, output)

    def close(self) -> None:
        for handle in self._textures.values():
            self._library.free("glimmer_texture_destroy", handle)
        self._textures = {}

    def _texture(self, texture: Texture) -> c_void_p:
        if texture.digest not in self._textures:
            self._textures[texture.digest] = create_texture(self._library, texture)
        return self._textures[texture.digest]


def attribute_structs(attributes: Any) -> tuple[Any, list[Any]]:
    """The engine's array of a mesh's attributes, and what must live as long."""
    out = (structs.Attribute * len(attributes))()
    keep: list[Any] = []
    for entry, attribute in zip(out, attributes, strict=True):
        values = np.ascontiguousarray(attribute.values, np.float32)
        name = ctypes.create_string_buffer(attribute.name.encode())
        keep += [values, name]
        entry.name = ctypes.cast(name, c_char_p)
        entry.domain = structs.AttributeDomain[attribute.domain.upper()]
        entry.components, entry.values = values.shape[1], values.ctypes.data
    return out, keep
