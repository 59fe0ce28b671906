# SPDX-License-Identifier: GPL-3.0-or-later
"""The shaders of worlds and lamps, which shine and do nothing else, as one value."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...scene.description import BLACK
from ...scene.program import Op, Program, TooLargeError, compile_program
from ..sockets import Input
from .values import Triple, added, clamped, lerp, scaled

if TYPE_CHECKING:
    from ..nodes import Nodes


def emitted(nodes: Nodes, item: Input) -> Triple:
    """What the shaders of a world or a lamp shine with."""
    source = nodes.source(item)
    if source is None or source.node is None:
        return BLACK
    node = source.node
    if node.bl_idname in ("ShaderNodeBackground", "ShaderNodeEmission"):
        strength = nodes.varying_number(node, source.groups, "Strength")
        return scaled(nodes.varying_color(node, source.groups, "Color"), strength)
    if node.bl_idname == "ShaderNodeMixShader":
        factor = clamped(nodes.varying_number(node, source.groups, node.inputs[0].name))
        first, second = (emitted(nodes, Input(node.inputs[i], source.groups)) for i in (1, 2))
        return lerp(first, second, factor)
    if node.bl_idname == "ShaderNodeAddShader":
        first, second = (emitted(nodes, Input(node.inputs[i], source.groups)) for i in (0, 1))
        return added(first, second)
    nodes.notice(node, f"is not supported in a {'world' if nodes.is_sky else 'lamp'}; it is black")
    return BLACK


def program_of(nodes: Nodes, value: Op, otherwise: str) -> Program | None:
    """None where it would be too large, which is told, with what happens then."""
    try:
        return compile_program([value])
    except TooLargeError as error:
        nodes.notices.add(nodes.where, f"its nodes cannot be rendered, since {error}; {otherwise}")
        return None
