# SPDX-License-Identifier: GPL-3.0-or-later
"""Vector Math, Mapping, Vector Rotate, Vector Transform, Normal."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .values import Value, op, triple, vector_math

if TYPE_CHECKING:
    from ..nodes import Nodes
    from ..sockets import Source

ZERO = (0.0, 0.0, 0.0)


def vector_math_node(nodes: Nodes, source: Source) -> Value:
    node = source.node
    operation = node.operation
    vectors = [socket for socket in node.inputs if socket.type == "VECTOR"]
    a, b, c = (triple(nodes.socket_value(source, vectors[i])) if i < len(vectors) else ZERO for i in range(3))
    scale = nodes.number_named(source, "Scale", 1.0)
    if operation == "DOT_PRODUCT":
        return op("dot", a, b)
    if operation == "DISTANCE":
        return op("distance", a, b)
    if operation == "LENGTH":
        return op("distance", a, ZERO)
    return vector_math(operation.lower(), a, b, c, scale)


def mapping(nodes: Nodes, source: Source) -> Value:
    kind = source.node.vector_type.lower()
    vector, rotation = (nodes.triple_named(source, name, ZERO) for name in ("Vector", "Rotation"))
    scale = nodes.triple_named(source, "Scale", (1.0, 1.0, 1.0))
    place = ZERO if kind in ("vector", "normal") else nodes.triple_named(source, "Location", ZERO)
    if kind == "point" and place == ZERO and rotation == ZERO and scale == (1.0, 1.0, 1.0):
        return vector
    return op("mapping", vector, place, rotation, scale, modes=(kind,))


def vector_rotate(nodes: Nodes, source: Source) -> Value:
    node = source.node
    kind = {"EULER_XYZ": "euler"}.get(node.rotation_type, node.rotation_type.lower())
    vector, center, axis, rotation = (
        nodes.triple_named(source, name, ZERO) for name in ("Vector", "Center", "Axis", "Rotation")
    )
    angle = nodes.number_named(source, "Angle", 0.0)
    modes = (kind, "inverse" if node.invert else "forward")
    return op("vector_rotate", vector, center, axis, angle, rotation, modes=modes)


def vector_transform(nodes: Nodes, source: Source) -> Value:
    node = source.node
    vector = node.inputs.find("Vector")  # the first input until 5.2
    if node.convert_from == node.convert_to and nodes.version >= (4, 0):
        return nodes.input(source, vector)  # where an older Blender makes normals as long as 1
    modes = (node.vector_type.lower(), node.convert_from.lower(), node.convert_to.lower())
    return op("vector_transform", triple(nodes.input(source, vector)), modes=modes)


def normal_node(nodes: Nodes, source: Source) -> Value:
    """A direction that is set by hand, and how far a vector points along it."""
    direction = tuple(float(v) for v in source.node.outputs[0].default_value)
    own = (direction[0], direction[1], direction[2])
    if source.output.type != "VALUE":
        return own
    size = sum(v * v for v in own) ** 0.5 or 1.0
    unit = (own[0] / size, own[1] / size, own[2] / size)
    return op("dot", unit, vector_math("normalize", triple(nodes.input(source, 0))))
