# SPDX-License-Identifier: GPL-3.0-or-later
"""The node groups that put plates on the points of a field: one for all fields of a file, and one for all of whose
plates the viewport shows a share.
"""

from typing import Any

import bpy

NAME = "Glimmer Hexagon Field"
_MARK = "glimmer_hexagon_field"
_WHOLE, _THINNED = 1, 2  # what the mark holds

ROTATION, SCALE, PROTOTYPE = "glimmer_rotation", "glimmer_scale", "glimmer_prototype"
# What shaders ask for with the node Attribute, of the type Instancer. Instances take over their points' attributes.
COLOR, ROUGHNESS, RANDOM, RING, PATINA = (
    f"glimmer_{name}" for name in ("color", "roughness", "random", "ring", "patina")
)


def ensure(is_thinned: bool = False) -> Any:
    """The file's own group, made when it has none. is_thinned: it has an input for the viewport's share of plates."""
    version = _THINNED if is_thinned else _WHOLE
    for group in bpy.data.node_groups:
        if group.library is None and group.get(_MARK) == version:
            return group
    group = bpy.data.node_groups.new(f"{NAME} Preview" if is_thinned else NAME, "GeometryNodeTree")
    group[_MARK] = version
    _build(group, is_thinned)
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
    """The collection of prototypes that a modifier of these groups is given, or None."""
    return _value(modifier, "Plates")


def set_plates(modifier: Any, collection: Any) -> None:
    _set_value(modifier, "Plates", collection)


def viewport_share(modifier: Any) -> float:
    """Plates whose random number is not less than this are not in the viewport."""
    return float(_value(modifier, _SHARE)) if modifier.node_group[_MARK] == _THINNED else 1.0


def set_viewport_share(modifier: Any, share: float) -> None:
    if share == viewport_share(modifier):
        return
    is_thinned = share < 1.0
    if is_thinned != (modifier.node_group[_MARK] == _THINNED):
        collection = plates(modifier)
        modifier.node_group = ensure(is_thinned)
        set_plates(modifier, collection)
    if is_thinned:
        _set_value(modifier, _SHARE, share)


_SHARE = "Viewport Share"


def _value(modifier: Any, name: str) -> Any:
    identifier = _socket(modifier.node_group, name)
    if hasattr(modifier, "properties"):  # 5.2
        return getattr(modifier.properties.inputs, identifier).value
    return modifier.get(identifier)


def _set_value(modifier: Any, name: str, value: Any) -> None:
    identifier = _socket(modifier.node_group, name)
    if hasattr(modifier, "properties"):  # 5.2
        getattr(modifier.properties.inputs, identifier).value = value
    else:
        modifier[identifier] = value


def _socket(group: Any, name: str) -> str:
    """The name under which a modifier of this group holds its inputs: an ID property before 5.2."""
    sockets = group.interface.items_tree if hasattr(group, "interface") else group.inputs
    return str(next(socket.identifier for socket in sockets if socket.name == name))


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


def _build(group: Any, is_thinned: bool) -> None:
    _add_sockets(group, ("NodeSocketCollection", "Plates"), *([("NodeSocketFloat", _SHARE)] if is_thinned else []))
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
    if is_thinned:
        less, final = _node(group, "FunctionNodeCompare", 150, 150), _node(group, "GeometryNodeIsViewport", 150, 300)
        less.data_type, less.operation = "FLOAT", "LESS_THAN"
        own, share = (socket for socket in less.inputs if socket.enabled and socket.name in "AB")
        link(_attribute(group, RANDOM, "FLOAT", 150), own)
        link(group_input.outputs[_SHARE], share)
        # In the viewport what is less, in a render all.
        either = _node(group, "FunctionNodeBooleanMath", 300, 200)
        either.operation = "IMPLY"
        link(final.outputs[0], either.inputs[0])
        link(less.outputs[0], either.inputs[1])
        link(either.outputs[0], scatter.inputs["Selection"])


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
