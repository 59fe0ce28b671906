# SPDX-License-Identifier: GPL-3.0-or-later
"""Math, Map Range, Clamp, Mix of numbers; Combine and Separate."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from .values import Value, number, op, triple

if TYPE_CHECKING:
    from ..nodes import Nodes
    from ..sockets import Source

# Blender's names where they are not the engine's in capitals.
MATH_NAMES = {"FRACT": "fraction"}


def math_node(nodes: Nodes, source: Source) -> Value:
    node = source.node
    operation = MATH_NAMES.get(node.operation, node.operation.lower())
    a, b, c = (number(nodes.input(source, i)) for i in range(3))
    return op("math", a, b, c, modes=(operation, "clamped" if node.use_clamp else "free"))


def map_range(nodes: Nodes, source: Source) -> Value:
    node = source.node
    kind = node.interpolation_type.lower()
    by_identifier = {socket.identifier: socket for socket in node.inputs}
    clamp = "clamped" if node.clamp and kind in ("linear", "stepped") else "free"
    if getattr(node, "data_type", "FLOAT") == "FLOAT_VECTOR":
        names = ("Vector", "From_Min_FLOAT3", "From_Max_FLOAT3", "To_Min_FLOAT3", "To_Max_FLOAT3", "Steps_FLOAT3")
        vectors = [triple(nodes.socket_value(source, by_identifier[name])) for name in names]
        return op("vector_map_range", *vectors, modes=(kind, clamp))
    names = ("Value", "From Min", "From Max", "To Min", "To Max", "Steps")
    numbers = [number(nodes.socket_value(source, by_identifier[name])) for name in names]
    return op("map_range", *numbers, modes=(kind, clamp))


def clamp(nodes: Nodes, source: Source) -> Value:
    value, low, high = (number(nodes.input(source, i)) for i in range(3))
    return op("clamp", value, low, high, modes=(source.node.clamp_type.lower(),))


def mix_inputs(nodes: Nodes, source: Source, suffix: str, uniform: bool = True) -> list[Value]:
    """Factor, A and B of a Mix node of one kind of data."""
    by_identifier: dict[str, Any] = {socket.identifier: socket for socket in source.node.inputs}
    wanted = ("Factor_Float" if uniform else "Factor_Vector", f"A_{suffix}", f"B_{suffix}")
    return [nodes.socket_value(source, by_identifier[name]) for name in wanted]


def combine(nodes: Nodes, source: Source) -> Value:
    parts = [number(nodes.input(source, i)) for i in range(3)]
    mode = getattr(source.node, "mode", "HSV" if source.node.bl_idname == "ShaderNodeCombineHSV" else "RGB")
    result = op("combine", *parts)
    return result if mode == "RGB" else op("convert", result, modes=(f"{mode.lower()}_to_rgb",))


def separate(nodes: Nodes, source: Source) -> Value:
    value = triple(nodes.input(source, 0))
    mode = getattr(source.node, "mode", "HSV" if source.node.bl_idname == "ShaderNodeSeparateHSV" else "RGB")
    if mode != "RGB":
        value = op("convert", value, modes=(f"rgb_to_{mode.lower()}",))
    index = [socket.identifier for socket in source.node.outputs].index(source.output.identifier)
    if isinstance(value, tuple):
        return (value[index],)
    return op("separate", value, modes=("xyz"[index],))
