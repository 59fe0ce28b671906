# SPDX-License-Identifier: GPL-3.0-or-later
"""What nodes ask about the surface, the object and the ray; Fresnel, Layer Weight, Bump, Normal Map."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ...scene.program import Op
from ..affine import inverse
from .values import Number, Triple, Value, math, number, op, product, triple, value_of, vector_math

if TYPE_CHECKING:
    from ..nodes import Nodes
    from ..sockets import Source

# Names of attributes that Blender has no name for.
ACTIVE_UV = "uv"
ACTIVE_COLOR = "color"
GENERATED = "generated"
TANGENT_PREFIX = "tangent:"
ISLAND = "island"  # another number for each part of a mesh that hangs together
POINTINESS = "pointiness"
STRAND_PREFIX = "strand:"  # of hair, by the outputs of a Curves Info node
STRAND_TANGENT = STRAND_PREFIX + "Tangent"
# Of instances: properties of objects and instancers, and values of particles, by name.
OBJECT_PREFIX, INSTANCER_PREFIX, PARTICLE_PREFIX = "object:", "instancer:", "particle:"
INSTANCER_GENERATED, INSTANCER_UV = "instancer_generated", "instancer_uv"
# Of instances: from the object's coordinates to generated ones, by which points within it go.
VOLUME_SCALE, VOLUME_OFFSET = "volume_scale", "volume_offset"
VOLUME_DENSITY = "volume_density"  # of instances of volume objects: a factor of their density

OF_A_SHAPE, OF_A_PLACE = ("UV", "Parametric"), ("Camera", "Window", "Reflection")

TO_WORLD = ("vector", "object", "world")  # modes of an operation

# From here on the strength of a normal map scales what it holds; before, it blends normals.
STRENGTH_IN_TANGENTS = (4, 0)


def named(name: str) -> str:
    return f"attribute:{name}"


def tangents(uv_map: str) -> str:
    return TANGENT_PREFIX + uv_map


def geometry(nodes: Nodes, what: str) -> Op:
    if what == "normal" and nodes.bumped_normal is not None:
        return nodes.bumped_normal
    return op("geometry", nodes.shift_width, modes=(what, nodes.shift))


def attribute(nodes: Nodes, name: str) -> Op:
    grid = nodes.grids.get(name.removeprefix(named("")))
    if grid is not None:
        return grid.lookup(geometry(nodes, "object_position"))
    return op("attribute", nodes.shift_width, modes=(nodes.shift,), resource=name)


def fact(what: str) -> Op:
    return op("geometry_number", modes=(what,))


def place(nodes: Nodes, kind: str) -> Triple:
    """Texture coordinates where nothing is linked to a texture's vector."""
    if nodes.is_sky:
        return geometry(nodes, "position")
    return generated(nodes) if kind != "uv" else attribute(nodes, ACTIVE_UV)


def generated(nodes: Nodes) -> Triple:
    if nodes.lamp:
        return geometry(nodes, "object_position")
    if not nodes.in_volume:
        return attribute(nodes, GENERATED)
    place = geometry(nodes, "object_position")
    return vector_math("multiply_add", place, attribute(nodes, VOLUME_SCALE), attribute(nodes, VOLUME_OFFSET))


def _is_unknown_of_lamp(nodes: Nodes, source: Source) -> bool:
    """A lamp has neither coordinates of its own nor, where it is a sun or in Blender 3, a place in the picture."""
    kind = source.output.identifier
    has_place = nodes.lamp != "SUN" and nodes.version >= (4, 0)
    if not nodes.lamp or not (kind in OF_A_SHAPE or (kind in OF_A_PLACE and not has_place)):
        return False
    nodes.notice(source.node, f"{source.output.name} of a lamp is not known; it is 0")
    return True


def texture_coordinate(nodes: Nodes, source: Source) -> Value:
    kind = source.output.identifier
    if _is_unknown_of_lamp(nodes, source):
        return (0.0, 0.0, 0.0)
    if nodes.is_sky and kind in ("Generated", "Object"):
        if kind == "Object" and source.node.object is not None:
            return _in_space_of(nodes, source.node.object)
        return geometry(nodes, "position")
    if source.node.from_instancer and kind in ("Generated", "UV"):
        return attribute(nodes, INSTANCER_GENERATED if kind == "Generated" else INSTANCER_UV)
    if kind == "Generated":
        return value_of(generated(nodes))
    if kind == "UV":
        return (0.0, 0.0, 0.0) if nodes.is_sky else attribute(nodes, ACTIVE_UV)
    if kind == "Object":
        other = source.node.object
        if other is None:
            return geometry(nodes, "object_position")
        return _in_space_of(nodes, other)
    names = {"Normal": "object_normal", "Camera": "camera", "Window": "window", "Reflection": "reflection"}
    return geometry(nodes, names[kind])


def _in_space_of(nodes: Nodes, item: Any) -> Value:
    """The point that is shaded in another object's own space."""
    point = geometry(nodes, "position")
    rows = inverse(nodes.images.place_of(item))
    parts = [op("dot", (row[0], row[1], row[2]), point) for row in rows[:3].tolist()]
    return vector_math("add", op("combine", *parts), tuple(rows[:3, 3].tolist()))


def uv_map(nodes: Nodes, source: Source) -> Value:
    if source.node.from_instancer:
        return attribute(nodes, INSTANCER_UV)
    name = source.node.uv_map
    return attribute(nodes, named(name) if name else ACTIVE_UV)


def attribute_node(nodes: Nodes, source: Source) -> Value:
    node = source.node
    kind = getattr(node, "attribute_type", "GEOMETRY")
    if kind == "VIEW_LAYER":
        return _constant_output(source, nodes.layer_property(node.attribute_name))
    prefixes = {"OBJECT": OBJECT_PREFIX, "INSTANCER": INSTANCER_PREFIX}
    name = prefixes[kind] + node.attribute_name if kind in prefixes else named(node.attribute_name)
    return _attribute_output(nodes, source, name)


def _constant_output(source: Source, value: tuple[float, float, float, float]) -> Value:
    kind = source.output.identifier
    if kind == "Alpha":
        return (value[3],)
    return (sum(value[:3]) / 3.0,) if kind == "Fac" else value[:3]


def particle_info(nodes: Nodes, source: Source) -> Value:
    value = attribute(nodes, PARTICLE_PREFIX + source.output.identifier)
    return value if source.output.type == "VECTOR" else op("separate", value, modes=("x",))


def volume_info(nodes: Nodes, source: Source) -> Value:
    """Of a volume object's grids; 0 where there is none of the name."""
    name = source.output.identifier.lower()
    if name not in nodes.grids:
        return (0.0,) if source.output.type == "VALUE" else (0.0, 0.0, 0.0)
    value = attribute(nodes, named(name))
    return op("average", value) if source.output.type == "VALUE" else value


def color_attribute(nodes: Nodes, source: Source) -> Value:
    name = source.node.layer_name
    return _attribute_output(nodes, source, named(name) if name else ACTIVE_COLOR)


def _attribute_output(nodes: Nodes, source: Source, name: str) -> Value:
    identifier = source.output.identifier
    if identifier == "Alpha" and name.removeprefix(named("")) in nodes.grids:
        return (1.0,)
    if identifier == "Alpha":
        return op("attribute_alpha", nodes.shift_width, modes=(nodes.shift,), resource=name)
    value = attribute(nodes, name)
    return op("average", value) if identifier == "Fac" else value


def geometry_node(nodes: Nodes, source: Source) -> Value:
    kind = source.output.identifier
    if _is_unknown_of_lamp(nodes, source):
        return (0.0, 0.0, 0.0)
    names = {"Position": "position", "Normal": "normal", "True Normal": "true_normal", "Incoming": "incoming"}
    if kind in names:
        return geometry(nodes, names[kind])
    if kind == "Parametric":
        return geometry(nodes, "parametric")
    if kind == "Backfacing":
        return fact("backfacing")
    if kind == "Random Per Island":
        return op("separate", attribute(nodes, ISLAND), modes=("x",))
    if kind == "Pointiness":
        return op("separate", attribute(nodes, POINTINESS), modes=("x",))
    if kind == "Tangent":
        return (0.0, 0.0, 0.0) if nodes.lamp else op("tangent", _around_z(attribute(nodes, GENERATED)))
    return nodes.not_translated(source, f"{source.output.name}")


def strand_info(nodes: Nodes, source: Source) -> Value:
    """Of hair; 0 on all other surfaces."""
    kind = source.output.identifier
    if kind != "Tangent Normal":
        return op("separate", attribute(nodes, STRAND_PREFIX + kind), modes=("x",))
    along = vector_math("normalize", op("vector_transform", attribute(nodes, STRAND_TANGENT), modes=TO_WORLD))
    incoming = geometry(nodes, "incoming")
    across = vector_math("subtract", incoming, vector_math("scale", along, scale=op("dot", along, incoming)))
    return vector_math("scale", vector_math("normalize", across), scale=_is_strand(nodes))


def _is_strand(nodes: Nodes) -> Number:
    return op("separate", attribute(nodes, STRAND_PREFIX + "Is Strand"), modes=("x",))


def _around_z(generated: Triple, axis: str = "Z") -> Triple:
    """The direction around an axis through the middle of the generated coordinates."""
    d = vector_math("subtract", generated, (0.5, 0.5, 0.5))
    x, y, z = (op("separate", d, modes=(name,)) for name in "xyz")
    minus = {name: op("math", part, -1.0, 0.0, modes=("multiply", "free")) for name, part in (("y", y), ("z", z))}
    if axis == "X":
        return op("combine", 0.0, minus["z"], y)
    return op("combine", minus["z"], 0.0, x) if axis == "Y" else op("combine", minus["y"], x, 0.0)


def tangent_input(nodes: Nodes, source: Source) -> Triple:
    """A node's Tangent, or around the object's z axis."""
    socket = source.node.inputs.get("Tangent")
    if socket is None or nodes.is_free(source, socket):
        return op("tangent", _around_z(attribute(nodes, GENERATED)))
    return triple(nodes.socket_value(source, socket))


def tangent_node(nodes: Nodes, source: Source) -> Value:
    node = source.node
    if node.direction_type == "RADIAL":
        return op("tangent", _around_z(attribute(nodes, GENERATED), node.axis))
    return op("tangent", attribute(nodes, tangents(node.uv_map)))


def object_info(nodes: Nodes, source: Source) -> Value:
    names = {"Location": "object_location", "Color": "object_color"}
    kind = source.output.identifier
    if kind in names:
        return geometry(nodes, names[kind])
    if kind == "Material Index":
        return (float(nodes.material_index),)
    numbers = {"Alpha": "object_alpha", "Object Index": "object_index", "Random": "object_random"}
    return fact(numbers[kind])


def camera_data(nodes: Nodes, source: Source) -> Value:
    kind = source.output.identifier
    if kind == "View Vector":
        return vector_math("normalize", geometry(nodes, "camera"))
    return fact("view_z" if kind == "View Z Depth" else "view_distance")


# What is exact wherever it is asked for; a light that is sampled, or a light vertex, does not know the rest.
EXACT_IN_LIGHT_PATH = ("Is Camera Ray", "Is Shadow Ray")
LIGHT_PATH = {
    "Is Camera Ray": "camera_ray",
    "Is Shadow Ray": "shadow_ray",
    "Is Diffuse Ray": "diffuse_ray",
    "Is Glossy Ray": "glossy_ray",
    "Is Singular Ray": "singular_ray",
    "Is Reflection Ray": "reflection_ray",
    "Is Transmission Ray": "transmission_ray",
    "Ray Length": "ray_length",
    "Ray Depth": "ray_depth",
    "Is Volume Scatter Ray": "volume_scatter_ray",
}
# Counted by nobody: those of the camera's own rays.
NO_DEPTH = ("Diffuse Depth", "Glossy Depth", "Transparent Depth", "Transmission Depth", "Portal Depth")


def light_path(nodes: Nodes, source: Source) -> Value:
    kind = source.output.identifier
    if kind in NO_DEPTH:
        nodes.notice(source.node, f"{kind} is not counted; it is 0, as for the camera's own rays")
        return (0.0,)
    known = LIGHT_PATH.get(kind)
    if known is None:
        return nodes.not_translated(source, source.output.name)
    if kind not in EXACT_IN_LIGHT_PATH and not nodes.lamp:
        nodes.notice(source.node, f"{kind}: light that is sampled is asked for as by a diffuse ray, of depth 1")
    return fact(known)


def light_falloff(nodes: Nodes, source: Source) -> Value:
    """Light falls with the square of the distance by itself."""
    strength, smooth = (number(nodes.input(source, i)) for i in range(2))
    kind = source.output.identifier
    if kind == "Quadratic" and (smooth == 0.0 or nodes.lamp == "SUN"):  # which is infinitely far away
        return value_of(strength)
    if not nodes.lamp:  # a surface that is sampled as a light does not know the distance
        return nodes.not_translated(source, source.output.name)
    distance: Number = fact("ray_length")
    squared = product(distance, distance)
    if smooth != 0.0 and nodes.lamp != "SUN":
        strength = product(strength, math("divide", squared, math("add", squared, smooth)))
    factors: dict[str, Number] = {"Quadratic": 1.0, "Linear": distance, "Constant": squared}
    return value_of(product(strength, factors[kind]))


def wireframe(nodes: Nodes, source: Source) -> Value:
    kind = "pixels" if source.node.use_pixel_size else "world"
    return op("wireframe", number(nodes.input(source, 0)), modes=(kind,))


def normal_input(nodes: Nodes, source: Source) -> Triple:
    """A node's Normal, or the surface's."""
    socket = source.node.inputs.get("Normal")
    if socket is None or nodes.is_free(source, socket):
        return geometry(nodes, "normal")
    return triple(nodes.socket_value(source, socket))


def fresnel(nodes: Nodes, source: Source) -> Value:
    return op("fresnel", number(nodes.input(source, 0)), normal_input(nodes, source))


def layer_weight(nodes: Nodes, source: Source) -> Value:
    kind = "fresnel" if source.output.identifier == "Fresnel" else "facing"
    return op("layer_weight", number(nodes.input(source, 0)), normal_input(nodes, source), modes=(kind,))


def bump(nodes: Nodes, source: Source) -> Value:
    """Its height is asked for at the place and at two places beside it."""
    node = source.node
    if nodes.shift != "center":
        # Within the height of another bump: of the place itself, as in Cycles.
        return normal_input(nodes, source)
    inputs = node.inputs
    strength, distance = (number(nodes.socket_value(source, inputs[name])) for name in ("Strength", "Distance"))
    width = inputs.get("Filter Width")
    step = 1.0 if width is None else number(nodes.socket_value(source, width))
    if nodes.is_free(source, inputs["Height"]):
        return normal_input(nodes, source)
    heights = []
    for shift in ("center", "dx", "dy"):
        with nodes.shifted(shift, step):
            heights.append(number(nodes.socket_value(source, inputs["Height"])))
    if node.invert:
        distance = op("math", distance, -1.0, 0.0, modes=("multiply", "free"))
    return op("bump", strength, distance, *heights, normal_input(nodes, source), step)


def normal_map(nodes: Nodes, source: Source) -> Value:
    node = source.node
    strength, color = number(nodes.input(source, 0)), triple(nodes.input(source, 1))
    modes, attribute_name = (node.space.lower(),), tangents(node.uv_map)
    if nodes.version >= STRENGTH_IN_TANGENTS:
        return op("normal_map", strength, color, modes=modes, resource=attribute_name)
    # Along a line between both normals.
    own = geometry(nodes, "normal")
    bent = op("normal_map", 1.0, color, modes=modes, resource=attribute_name)
    part = op("clamp", strength, 0.0, 1e6, modes=("minmax",))
    return vector_math(
        "normalize", vector_math("add", own, vector_math("scale", vector_math("subtract", bent, own), scale=part))
    )
