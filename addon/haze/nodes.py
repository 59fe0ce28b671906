# SPDX-License-Identifier: GPL-3.0-or-later
"""The node of a world that is its haze: one Principled Volume, or a Volume Scatter, whose density is no link."""

from typing import Any

import bpy

KINDS = ("ShaderNodeVolumePrincipled", "ShaderNodeVolumeScatter")


def node_of(world: Any) -> Any:
    """None where the world has no such haze."""
    if world is None or not world.use_nodes or world.node_tree is None:
        return None
    output = world.node_tree.get_output_node("CYCLES")
    links = output.inputs["Volume"].links if output is not None else ()
    node = links[0].from_node if links else None
    if node is None or node.bl_idname not in KINDS or node.inputs["Density"].is_linked:
        return None
    return node


def add(world: Any, density: float, color: tuple[float, float, float], anisotropy: float) -> Any:
    """Gives a world this haze in place of its volume, if it has any. color: how much of each colour is scattered and
    not absorbed."""
    if bpy.app.version < (5, 0):  # from then on always
        world.use_nodes = True
    tree = world.node_tree
    output = tree.get_output_node("CYCLES")
    if output is None:
        output = tree.nodes.new("ShaderNodeOutputWorld")
    node = tree.nodes.new(KINDS[0])
    node.location = output.location.x - 300, output.location.y - 200
    node.inputs["Color"].default_value = (*color, 1.0)
    node.inputs["Density"].default_value = density
    node.inputs["Anisotropy"].default_value = anisotropy
    tree.links.new(node.outputs[0], output.inputs["Volume"])
    return node
