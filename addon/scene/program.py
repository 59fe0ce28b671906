# SPDX-License-Identifier: GPL-3.0-or-later
"""Shader programs: a graph of operations, and the straight-line code that the engine evaluates at a shading point.

Operations, their modes and inputs are those of the engine's table (engine/src/shading/ops.h).
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, fields, is_dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

Rgb = tuple[float, float, float]

# The engine's bounds.
MOST_INSTRUCTIONS = 4096
MOST_REGISTERS = 256
MOST_OUTPUTS = 64

# Operations whose output is one number; that of all others is a vector or colour.
NUMBERS = frozenset(
    [
        "math",
        "dot",
        "distance",
        "separate",
        "luminance",
        "average",
        "map_range",
        "clamp",
        "mix_number",
        "ramp_alpha",
        "curve",
        "noise",
        "musgrave",
        "voronoi",
        "voronoi_w",
        "white_noise",
        "wave",
        "checker",
        "gradient",
        "gabor",
        "image_alpha",
        "geometry_number",
        "attribute_alpha",
        "fresnel",
        "layer_weight",
        "wireframe",
    ]
)

# The kinds of each operation's inputs, as the engine's table has them: n a number, v a vector or colour.
INPUTS = {
    "math": "nnn",
    "vector_math": "vvvn",
    "dot": "vv",
    "distance": "vv",
    "combine": "nnn",
    "separate": "v",
    "luminance": "v",
    "average": "v",
    "splat": "n",
    "map_range": "nnnnnn",
    "vector_map_range": "vvvvvv",
    "clamp": "nnn",
    "mix_number": "nnn",
    "mix_vector": "vvv",
    "mapping": "vvvv",
    "vector_rotate": "vvvnv",
    "vector_transform": "v",
    "blend": "nvv",
    "convert": "v",
    "hue_saturation": "nnnnv",
    "bright_contrast": "vnn",
    "gamma": "vn",
    "invert": "nv",
    "ramp": "n",
    "ramp_alpha": "n",
    "curves": "nv",
    "curve": "nn",
    "noise": "vnnnnnnn",
    "noise_color": "vnnnnnnn",
    "musgrave": "vnnnnnn",
    "voronoi": "vnnnnnnnn",
    "voronoi_color": "vnnnnnnnn",
    "voronoi_w": "vnnnnnnnn",
    "white_noise": "vn",
    "white_noise_color": "vn",
    "wave": "vnnnnn",
    "checker": "v",
    "gradient": "v",
    "magic": "vnn",
    "brick": "vnnnnnvv",
    "gabor": "vnnnv",
    "grid": "vv",
    "image": "vn",
    "image_alpha": "vn",
    "geometry": "n",
    "geometry_number": "",
    "attribute": "n",
    "attribute_alpha": "n",
    "fresnel": "nv",
    "layer_weight": "nv",
    "bump": "nnnnnvn",
    "normal_map": "nv",
    "tangent": "v",
    "wireframe": "n",
}
# What operations look at beside their inputs.
RESOURCES = {
    "ramp": "table",
    "ramp_alpha": "table",
    "curves": "table",
    "curve": "table",
    "grid": "texture",
    "image": "texture",
    "image_alpha": "texture",
    "attribute": "attribute",
    "attribute_alpha": "attribute",
    "normal_map": "attribute",
}


class TooLargeError(Exception):
    """A program that the engine's bounds do not hold."""


@dataclass(frozen=True, eq=False)
class Table:
    """Colours over an interval."""

    rows: NDArray[np.float32]  # (n, 4)
    low: float = 0.0
    high: float = 1.0


@dataclass(frozen=True, eq=False)
class Texture:
    """An image as the engine keeps it: bottom row first, colours multiplied by their alpha."""

    name: str
    pixels: NDArray[Any]  # (height, width, channels) uint8 or float32
    srgb: bool = False  # colours are encoded as sRGB

    @cached_property
    def digest(self) -> bytes:
        """Equal for textures of equal content."""
        state = hashlib.blake2b(digest_size=16)
        state.update(f"{self.pixels.dtype}{self.pixels.shape}{self.srgb}".encode())
        state.update(np.ascontiguousarray(self.pixels).reshape(-1).view(np.uint8).data)
        return state.digest()


@dataclass(frozen=True, eq=False)
class Op:
    """One operation of a graph. Inputs are other operations or constants."""

    name: str
    inputs: tuple[Op | float | Rgb, ...] = ()
    modes: tuple[str, ...] = ()
    resource: Table | Texture | str | None = None  # str: the name of a mesh's attribute

    @property
    def is_number(self) -> bool:
        return self.name in NUMBERS


@dataclass(frozen=True)
class Instruction:
    op: str
    modes: tuple[str, ...]
    inputs: tuple[int, ...]  # registers; below 0: -1 - the constant's number
    out: int  # register
    resource: int = 0


@dataclass(frozen=True, eq=False)
class Program:
    instructions: tuple[Instruction, ...]
    constants: NDArray[np.float32]  # (n, 3), of a number the first
    tables: tuple[Table, ...]
    textures: tuple[Texture, ...]
    attributes: tuple[str, ...]
    outputs: tuple[int, ...]  # registers


@dataclass(frozen=True)
class Output:
    """Stands for a value of a material that its program gives."""

    index: int
    is_number: bool


def compile_program(roots: Sequence[Op]) -> Program:
    """A program with one output for each root. Raises TooLargeError."""
    order = in_order(roots)
    if len(order) > MOST_INSTRUCTIONS:
        raise TooLargeError(f"it takes {len(order)} operations; allowed: {MOST_INSTRUCTIONS}")
    if len(roots) > MOST_OUTPUTS:
        raise TooLargeError(f"it has {len(roots)} values; allowed: {MOST_OUTPUTS}")
    return _Compiler(order, roots).program()


def in_order(roots: Iterable[Op]) -> list[Op]:
    """Every operation once, after its inputs."""
    order: list[Op] = []
    done: set[int] = set()
    stack: list[tuple[Op, bool]] = [(root, False) for root in reversed(list(roots))]
    while stack:
        op, ready = stack.pop()
        if id(op) in done:
            continue
        if ready:
            done.add(id(op))
            order.append(op)
        else:
            stack.append((op, True))
            stack += [(item, False) for item in reversed(op.inputs) if isinstance(item, Op) and id(item) not in done]
    return order


class _Compiler:
    """Gives registers to operations that are in order; one is free again after its last use."""

    def __init__(self, order: list[Op], roots: Sequence[Op]) -> None:
        self._order = order
        self._roots = roots
        self._constants: dict[Rgb, int] = {}
        self._resources: dict[type, list[Any]] = {Table: [], Texture: [], str: []}
        self._register: dict[int, int] = {}
        self._free = list(range(MOST_REGISTERS - 1, -1, -1))

    def program(self) -> Program:
        last = {id(item): k for k, op in enumerate(self._order) for item in op.inputs if isinstance(item, Op)}
        kept = {id(root) for root in self._roots}
        instructions = []
        for k, op in enumerate(self._order):
            inputs = tuple(self._input(item) for item in op.inputs)
            for item in dict.fromkeys(id(item) for item in op.inputs if isinstance(item, Op)):  # the same every time
                if last[item] == k and item not in kept:
                    self._free.append(self._register[item])
            if not self._free:
                raise TooLargeError(f"it needs more than {MOST_REGISTERS} values at one time")
            out = self._register[id(op)] = self._free.pop()
            instructions.append(Instruction(op.name, op.modes, inputs, out, self._resource(op.resource)))
        constants = np.array(list(self._constants), np.float32).reshape(-1, 3)
        return Program(
            tuple(instructions),
            constants,
            tuple(self._resources[Table]),
            tuple(self._resources[Texture]),
            tuple(self._resources[str]),
            tuple(self._register[id(root)] for root in self._roots),
        )

    def _input(self, item: Op | float | Rgb) -> int:
        if isinstance(item, Op):
            return self._register[id(item)]
        value = (item[0], item[1], item[2]) if isinstance(item, tuple) else (item, 0.0, 0.0)
        return -1 - self._constants.setdefault(value, len(self._constants))

    def _resource(self, resource: Any) -> int:
        if resource is None:
            return 0
        known = self._resources[type(resource)]
        for number, item in enumerate(known):
            if item is resource or (isinstance(item, str) and item == resource):
                return number
        known.append(resource)
        return len(known) - 1


def programmed(material: Any) -> tuple[Any, Program | None]:
    """A material (any tree of frozen dataclasses and tuples) with outputs of a program in the place of operations, and
    that program."""
    roots: list[Op] = []

    def outputs(value: Any) -> Any:
        if isinstance(value, Op):
            if not any(value is root for root in roots):
                roots.append(value)
            return Output(next(i for i, root in enumerate(roots) if root is value), value.is_number)
        if is_dataclass(value) and not isinstance(value, type):
            changed = {item.name: outputs(getattr(value, item.name)) for item in fields(value) if item.init}
            return replace(value, **changed)
        if isinstance(value, tuple):
            return tuple(outputs(item) for item in value)
        return value

    result = outputs(material)
    return result, compile_program(roots) if roots else None
