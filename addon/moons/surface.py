# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials of moons with craters, seas and a rim, as node groups whose inputs are a moon's sliders.

GLOWING shines by itself, LIT by what falls on it, and so shows phases; BLACK swallows all light but for a faint rim.
"""

from typing import Any

import bpy

_MARK = "glimmer_moon_surface"
KINDS = ("GLOWING", "LIT", "BLACK")
_LABELS = {kind: f"Glimmer {kind.title()} Moon" for kind in KINDS}
# (name, kind, default) of a group's inputs.
_COLOR, _STRENGTH = ("Color", "NodeSocketColor", (1.0, 0.93, 0.82, 1.0)), ("Strength", "NodeSocketFloat", 20.0)
_RELIEF = (("Craters", "NodeSocketFloat", 0.5), ("Crater Scale", "NodeSocketFloat", 4.0))
_INPUTS = {
    "GLOWING": (_COLOR, _STRENGTH, *_RELIEF),
    "LIT": (_COLOR, *_RELIEF),
    "BLACK": (_COLOR, _STRENGTH, ("Rim", "NodeSocketFloat", 4.0)),
}


def is_surface(node: Any) -> bool:
    """Whether a node is one of these groups."""
    return node.type == "GROUP" and node.node_tree is not None and _MARK in node.node_tree


def add(tree: Any, kind: str) -> Any:
    """A node of the kind in a material's tree, from the file's own group or a new one."""
    node = tree.nodes.new("ShaderNodeGroup")
    node.node_tree = _group(kind)
    node.label = _LABELS[kind]
    for name, _, default in _INPUTS[kind]:
        node.inputs[name].default_value = default
    return node


def _group(kind: str) -> Any:
    for known in bpy.data.node_groups:
        if known.library is None and known.get(_MARK) == kind:
            return known
    group = bpy.data.node_groups.new(_LABELS[kind], "ShaderNodeTree")
    group[_MARK] = kind
    for name, socket, default in _INPUTS[kind]:
        if hasattr(group, "interface"):  # 4.0
            made = group.interface.new_socket(name, in_out="INPUT", socket_type=socket)
        else:
            made = group.inputs.new(socket, name)
        made.default_value = default
    if hasattr(group, "interface"):
        group.interface.new_socket("Shader", in_out="OUTPUT", socket_type="NodeSocketShader")
    else:
        group.outputs.new("NodeSocketShader", "Shader")
    given, result = _node(group, "NodeGroupInput", -900, 0), _node(group, "NodeGroupOutput", 500, 0)
    shader = {"GLOWING": _glowing, "LIT": _lit, "BLACK": _black}[kind](group, given)
    group.links.new(shader, result.inputs["Shader"])
    return group


def _glowing(group: Any, given: Any) -> Any:
    emission = _node(group, "ShaderNodeEmission", 250, 0)
    group.links.new(given.outputs["Color"], emission.inputs["Color"])
    strength = _multiply(group, given.outputs["Strength"], _relief(group, given), 50)
    group.links.new(strength, emission.inputs["Strength"])
    return emission.outputs[0]


def _lit(group: Any, given: Any) -> Any:
    diffuse = _node(group, "ShaderNodeBsdfDiffuse", 250, 0)
    scale = _node(group, "ShaderNodeVectorMath", 50, 0)
    scale.operation = "SCALE"
    group.links.new(given.outputs["Color"], scale.inputs[0])
    group.links.new(_relief(group, given), scale.inputs["Scale"])
    group.links.new(scale.outputs[0], diffuse.inputs["Color"])
    return diffuse.outputs[0]


def _black(group: Any, given: Any) -> Any:
    """Emission alone reflects nothing. The rim is where the surface is seen from the side."""
    emission, weight = _node(group, "ShaderNodeEmission", 250, 0), _node(group, "ShaderNodeLayerWeight", -500, -200)
    weight.inputs["Blend"].default_value = 0.5
    power = _node(group, "ShaderNodeMath", -250, -200)
    power.operation = "POWER"
    group.links.new(weight.outputs["Facing"], power.inputs[0])
    group.links.new(given.outputs["Rim"], power.inputs[1])
    group.links.new(given.outputs["Color"], emission.inputs["Color"])
    group.links.new(_multiply(group, given.outputs["Strength"], power.outputs[0], 50), emission.inputs["Strength"])
    return emission.outputs[0]


def _relief(group: Any, given: Any) -> Any:
    """From 1 down to 0 where the surface is dark: floors of craters of two sizes, and wide seas."""
    place = _node(group, "ShaderNodeTexCoord", -900, -300).outputs["Object"]
    shade = None
    for row, (larger, depth) in enumerate(((1.0, 0.55), (2.7, 0.35))):
        size = _multiply(group, given.outputs["Crater Scale"], larger, -700, -200 * row)
        cells = _node(group, "ShaderNodeTexVoronoi", -550, -300 - 250 * row)
        group.links.new(place, cells.inputs["Vector"])
        group.links.new(size, cells.inputs["Scale"])
        # By the distance from the middle of a crater: its floor, its bright rim, and the plain.
        part = _ramp(group, cells.outputs["Distance"], -350, -300 - 250 * row, depth, row)
        shade = part if shade is None else _multiply(group, shade, part, -50, -300)
    seas = _node(group, "ShaderNodeTexNoise", -550, -850)
    group.links.new(place, seas.inputs["Vector"])
    seas.inputs["Scale"].default_value, seas.inputs["Detail"].default_value = 1.6, 4.0
    sea = _node(group, "ShaderNodeValToRGB", -350, -850)
    for stop, (position, value) in zip(sea.color_ramp.elements, ((0.42, 0.35), (0.58, 0.9)), strict=True):
        stop.position, stop.color = position, (value, value, value, 1.0)
    group.links.new(seas.outputs[0], sea.inputs[0])
    shade = _multiply(group, shade, sea.outputs[0], -50, -500)
    # 1 - craters (1 - shade)
    missing = _node(group, "ShaderNodeMath", 100, -400)
    missing.operation, missing.inputs[0].default_value = "SUBTRACT", 1.0
    group.links.new(shade, missing.inputs[1])
    rest = _node(group, "ShaderNodeMath", 250, -300)
    rest.operation, rest.inputs[0].default_value = "SUBTRACT", 1.0
    group.links.new(_multiply(group, given.outputs["Craters"], missing.outputs[0], 180, -400), rest.inputs[1])
    return rest.outputs[0]


def _ramp(group: Any, distance: Any, x: float, y: float, depth: float, row: int) -> Any:
    ramp = _node(group, "ShaderNodeValToRGB", x, y)
    stops = ramp.color_ramp.elements
    edge = 0.3 - 0.08 * row
    wanted = ((0.0, 1.0 - depth), (0.75 * edge, 1.0 - 0.8 * depth), (edge, 1.0), (1.3 * edge, 0.88))
    while len(stops) < len(wanted):
        stops.new(0.5)
    for stop, (position, value) in zip(stops, wanted, strict=True):
        stop.position, stop.color = position, (value, value, value, 1.0)
    group.links.new(distance, ramp.inputs[0])
    return ramp.outputs[0]


def _multiply(group: Any, one: Any, other: Any, x: float, y: float = 0.0) -> Any:
    """`other`: a socket or a number."""
    node = _node(group, "ShaderNodeMath", x, y)
    node.operation = "MULTIPLY"
    group.links.new(one, node.inputs[0])
    if isinstance(other, float):
        node.inputs[1].default_value = other
    else:
        group.links.new(other, node.inputs[1])
    return node.outputs[0]


def _node(group: Any, kind: str, x: float, y: float) -> Any:
    node = group.nodes.new(kind)
    node.location = x, y
    return node
