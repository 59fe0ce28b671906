# SPDX-License-Identifier: GPL-3.0-or-later
"""The node group that puts plates on the points of a field: one for all fields of a file."""

from typing import Any

import bpy

NAME = "Glimmer Hexagon Field"
_MARK = "glimmer_hexagon_field"
_VERSION = 1

ROTATION, SCALE, PROTOTYPE = "glimmer_rotation", "glimmer_scale", "glimmer_prototype"


def ensure() -> Any:
    """The file's own group, made when it has none."""
    for group in bpy.data.node_groups:
        if group.library is None and group.get(_MARK) == _VERSION:
            return group
    group = bpy.data.node_groups.new(NAME, "GeometryNodeTree")
    group[_MARK] = _VERSION
    _build(group)
    return group


def realizing() -> Any:
    """A new group that turns instances into faces."""
    group = bpy.data.node_groups.new("Glimmer Real Plates", "GeometryNodeTree")
    _add_sockets(group)
    group_input, group_output = _node(group, "NodeGroupInput", 0, 0), _node(group, "NodeGroupOutput", 400, 0)
    realize = _node(group, "GeometryNodeRealizeInstances", 200, 0)
    group.links.new(group_input.outputs["Geometry"], realize.inputs["Geometry"])
    group.links.new(realize.outputs["Geometry"], group_output.inputs["Geometry"])
    return group


def find_modifier(obj: Any) -> Any:
    """The modifier of an object that uses such a group, or None."""
    for modifier in obj.modifiers:
        if modifier.type == "NODES" and modifier.node_group is not None and _MARK in modifier.node_group:
            return modifier
    return None


def plates(modifier: Any) -> Any:
    """The collection of prototypes that a modifier of this group is given, or None."""
    identifier = _plates_socket(modifier.node_group)
    if hasattr(modifier, "properties"):  # 5.2
        return getattr(modifier.properties.inputs, identifier).value
    return modifier.get(identifier)


def set_plates(modifier: Any, collection: Any) -> None:
    identifier = _plates_socket(modifier.node_group)
    if hasattr(modifier, "properties"):  # 5.2
        getattr(modifier.properties.inputs, identifier).value = collection
    else:
        modifier[identifier] = collection


def _plates_socket(group: Any) -> str:
    """The name under which a modifier of this group holds its inputs: an ID property before 5.2."""
    sockets = group.interface.items_tree if hasattr(group, "interface") else group.inputs
    return str(next(socket.identifier for socket in sockets if socket.name == "Plates"))


def _add_sockets(group: Any, *inputs: tuple[str, str]) -> None:
    """Geometry in and out, and more inputs (kind, name)."""
    for kind, name in (("NodeSocketGeometry", "Geometry"), *inputs):
        if hasattr(group, "interface"):  # 4.0
            group.interface.new_socket(name, in_out="INPUT", socket_type=kind)
        else:
            group.inputs.new(kind, name)
    if hasattr(group, "interface"):
        group.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    else:
        group.outputs.new("NodeSocketGeometry", "Geometry")


def _build(group: Any) -> None:
    _add_sockets(group, ("NodeSocketCollection", "Plates"))
    group_input = _node(group, "NodeGroupInput", 0, 0)
    group_output = _node(group, "NodeGroupOutput", 600, 0)
    plates = _node(group, "GeometryNodeCollectionInfo", 150, -150)
    plates.inputs["Separate Children"].default_value = True
    plates.inputs["Reset Children"].default_value = True
    scatter = _node(group, "GeometryNodeInstanceOnPoints", 400, 0)
    scatter.inputs["Pick Instance"].default_value = True
    link = group.links.new
    link(group_input.outputs["Geometry"], scatter.inputs["Points"])
    link(group_input.outputs["Plates"], plates.inputs["Collection"])
    link(_output(plates, "Instances", "Geometry"), scatter.inputs["Instance"])
    link(_attribute(group, PROTOTYPE, "INT", -350), scatter.inputs["Instance Index"])
    link(_attribute(group, ROTATION, "FLOAT_VECTOR", -500), scatter.inputs["Rotation"])
    link(_attribute(group, SCALE, "FLOAT_VECTOR", -650), scatter.inputs["Scale"])
    link(scatter.outputs["Instances"], group_output.inputs["Geometry"])


def _attribute(group: Any, name: str, data_type: str, y: float) -> Any:
    """The output that gives the point attribute `name`. Before 4.0 a node has one for every type, and shows the right
    one.
    """
    node = _node(group, "GeometryNodeInputNamedAttribute", 150, y)
    node.data_type = data_type
    node.inputs["Name"].default_value = name
    return next(output for output in node.outputs if output.enabled and output.name == "Attribute")


def _node(group: Any, kind: str, x: float, y: float) -> Any:
    node = group.nodes.new(kind)
    node.location = x, y
    return node


def _output(node: Any, *names: str) -> Any:
    return next(output for output in node.outputs if output.name in names)
