# SPDX-License-Identifier: GPL-3.0-or-later
"""A material's displacement as the bump that it makes of the shading normal."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ..scene.program import Op
from .nodes import Nodes
from .sockets import Input, Source
from .translate.surface import attribute, geometry, tangents
from .translate.values import Number, Triple, math, number, op, product, triple, vector_math

if TYPE_CHECKING:
    import bpy

FILTER_WIDTH = (0.1, (4, 3))  # of a pixel, and the version that has it; before, a whole one


def bump_of_displacement(nodes: Nodes, material: bpy.types.Material) -> Op | None:
    """The normal that the surface has in place of the mesh's; None where nothing displaces it."""
    item = nodes.surface_of_output("Displacement")
    source = None if item is None else nodes.source(item)
    if item is None or source is None or source.node is None:
        return None
    method = getattr(material, "displacement_method", None) or getattr(material.cycles, "displacement_method", "BUMP")
    if method != "BUMP":
        nodes.notice(source.node, "true displacement is not supported; the surface is bumped and keeps its outline")
    if nodes.constants_only:
        nodes.notice(source.node, "displacement is left out; the surface is smooth")
        return None
    step = FILTER_WIDTH[0] if nodes.version >= FILTER_WIDTH[1] else 1.0
    heights = []
    for shift in ("center", "dx", "dy"):
        with nodes.shifted(shift, step):
            heights.append(_height(nodes, source, item))
    return op("bump", 1.0, 1.0, *heights, geometry(nodes, "normal"), step)


def _height(nodes: Nodes, source: Source, item: Input) -> Number:
    """How far the surface is moved along its normal, in the world."""
    kind, normal = source.node.bl_idname, geometry(nodes, "normal")
    if kind == "ShaderNodeDisplacement":
        height, midlevel, scale = (number(nodes.input(source, i)) for i in range(3))
        moved = product(math("subtract", height, midlevel), scale)
        socket = source.node.inputs["Normal"]
        own = nodes.is_free(source, socket)
        if own and source.node.space == "WORLD":
            return moved
        along: Triple = normal if own else triple(nodes.socket_value(source, socket))
        if source.node.space == "OBJECT":
            along = op("vector_transform", along, modes=("normal", "world", "object"))
            along = op("vector_transform", along, modes=("vector", "object", "world"))
        return product(moved, op("dot", along, normal))
    if kind == "ShaderNodeVectorDisplacement":
        vector, midlevel = triple(nodes.input(source, 0)), number(nodes.input(source, 1))
        offset = op("combine", midlevel, midlevel, midlevel)
        moved_by: Triple = vector_math("scale", vector_math("subtract", vector, offset), scale=_third(nodes, source))
        if source.node.space == "TANGENT":
            moved_by = _of_tangents(nodes, moved_by)
        if source.node.space != "WORLD":
            moved_by = op("vector_transform", moved_by, modes=("vector", "object", "world"))
        return op("dot", moved_by, normal)
    return op("dot", triple(nodes.value(item)), normal)


def _third(nodes: Nodes, source: Source) -> Number:
    return number(nodes.input(source, 2))


def _of_tangents(nodes: Nodes, vector: Triple) -> Triple:
    """(along the tangent, along the normal, along the bitangent) in the object's space."""
    parts: list[Any] = [op("separate", vector, modes=(axis,)) for axis in "xyz"]
    normal, tangent = geometry(nodes, "object_normal"), attribute(nodes, tangents(""))
    sign = op("attribute_alpha", nodes.shift_width, modes=(nodes.shift,), resource=tangents(""))
    bitangent = vector_math("scale", vector_math("cross_product", normal, tangent), scale=sign)
    axes = zip((tangent, normal, bitangent), parts, strict=True)
    along = [vector_math("scale", axis, scale=part) for axis, part in axes]
    return vector_math("add", vector_math("add", along[0], along[1]), along[2])
