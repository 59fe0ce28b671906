# SPDX-License-Identifier: GPL-3.0-or-later
"""A moon as Blender's data: a unit sphere that all moons share, scaled to its radius, with an emission material of
its own.

Nothing is kept twice: the radius is the object's scale, colour and radiance are the sockets of its Emission node.
"""

import dataclasses
from typing import Any

import bpy
import numpy as np

from . import surface

_MESH_MARK = "glimmer_unit_sphere"
_MATERIAL_MARK = "glimmer_moon"
_RINGS, _SEGMENTS = 32, 64


@dataclasses.dataclass(frozen=True)
class Moon:
    """Radiance is color times strength, in W/(m^2 sr); lengths in scene units."""

    name: str
    color: tuple[float, float, float]
    strength: float
    radius: float
    location: tuple[float, float, float] = (0.0, 0.0, 0.0)
    surface: str = "EVEN"  # or one of surface.KINDS


# The last is all but black: an opaque disc of faint violet light.
FIVE_MOONS = (
    Moon("Red Moon", (1.0, 0.07, 0.03), 30.0, 4.0, (-26.0, 52.0, 20.0)),
    Moon("Green Moon", (0.1, 1.0, 0.2), 20.0, 2.5, (14.0, 40.0, 12.0)),
    Moon("White Moon", (1.0, 0.93, 0.82), 24.0, 3.0, (2.0, 70.0, 30.0)),
    Moon("Blue Moon", (0.08, 0.25, 1.0), 30.0, 3.5, (34.0, 60.0, 22.0)),
    Moon("Black Moon", (0.45, 0.15, 1.0), 0.05, 5.0, (-8.0, 44.0, 11.0)),
)


def create(moon: Moon, collection: Any) -> Any:
    obj = bpy.data.objects.new(moon.name, unit_sphere())
    obj.location = moon.location
    obj.scale = (moon.radius,) * 3
    # The material hangs on the object: the mesh is shared.
    obj.material_slots[0].link = "OBJECT"
    obj.material_slots[0].material = light_material(moon.name, moon.color, moon.strength, moon.surface)
    if hasattr(obj, "glimmer"):
        obj.glimmer.is_sphere = moon.surface == "EVEN"  # an analytic sphere has no coordinates for textures
    collection.objects.link(obj)
    return obj


def unit_sphere() -> Any:
    """The file's smooth sphere of radius 1 with one empty material slot, made when there is none."""
    for mesh in bpy.data.meshes:
        if mesh.library is None and _MESH_MARK in mesh:
            return mesh
    mesh = bpy.data.meshes.new("Glimmer Sphere")
    mesh[_MESH_MARK] = True
    vertices, faces = _sphere(_RINGS, _SEGMENTS)
    mesh.from_pydata(vertices, [], faces)
    mesh.polygons.foreach_set("use_smooth", np.ones(len(faces), dtype=bool))
    mesh.materials.append(None)
    mesh.update()
    return mesh


def light_material(name: str, color: tuple[float, float, float], strength: float, kind: str = "EVEN") -> Any:
    """kind: an even light, or a surface of surface.KINDS."""
    material = bpy.data.materials.new(name)
    material[_MATERIAL_MARK] = True
    if bpy.app.version < (5, 0):  # from then on always
        material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    emission = tree.nodes.new("ShaderNodeEmission") if kind == "EVEN" else surface.add(tree, kind)
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    output.location = 250, 0
    emission.inputs["Color"].default_value = (*color, 1.0)
    if "Strength" in emission.inputs:
        emission.inputs["Strength"].default_value = strength
    tree.links.new(emission.outputs[0], output.inputs["Surface"])
    material.diffuse_color = (*color, 1.0)
    return material


def emission_node(obj: Any) -> Any:
    """The node that holds the sliders of a moon, its Emission or its surface; None if the object is no moon."""
    material = obj.active_material if obj is not None and obj.type == "MESH" else None
    if material is None or material.node_tree is None or _MATERIAL_MARK not in material:
        return None
    nodes = material.node_tree.nodes
    return next((node for node in nodes if node.type == "EMISSION" or surface.is_surface(node)), None)


def set_surface(obj: Any, kind: str) -> None:
    """Gives a moon another surface; what both kinds have keeps its value."""
    node, material = emission_node(obj), obj.active_material
    old = {socket.name: socket.default_value for socket in node.inputs if hasattr(socket, "default_value")}
    color = tuple(old["Color"])[:3]
    tree = material.node_tree
    target = next(link.to_socket for link in tree.links if link.from_node == node)
    new = tree.nodes.new("ShaderNodeEmission") if kind == "EVEN" else surface.add(tree, kind)
    new.location = node.location
    for socket in new.inputs:
        if socket.name in old and socket.name != "Color" and hasattr(socket, "default_value"):
            socket.default_value = old[socket.name]
    new.inputs["Color"].default_value = (*color, 1.0)
    tree.nodes.remove(node)
    tree.links.new(new.outputs[0], target)
    if hasattr(obj, "glimmer"):
        obj.glimmer.is_sphere = kind == "EVEN"


def _sphere(rings: int, segments: int) -> tuple[list[tuple[float, float, float]], list[list[int]]]:
    """Vertices and outward faces: south pole, rings - 1 circles of `segments`, north pole."""
    latitude = np.pi * (np.arange(1, rings) / rings - 0.5)
    longitude = 2 * np.pi * np.arange(segments) / segments
    x = np.cos(latitude)[:, np.newaxis] * np.cos(longitude)
    y = np.cos(latitude)[:, np.newaxis] * np.sin(longitude)
    z = np.broadcast_to(np.sin(latitude)[:, np.newaxis], x.shape)
    circles = np.column_stack([x.ravel(), y.ravel(), z.ravel()])
    vertices = [(0.0, 0.0, -1.0), *map(tuple, circles.tolist()), (0.0, 0.0, 1.0)]
    north = len(vertices) - 1
    faces = []
    for s in range(segments):
        t = (s + 1) % segments
        faces.append([0, 1 + t, 1 + s])
        for ring in range(rings - 2):
            low, high = 1 + ring * segments, 1 + (ring + 1) * segments
            faces.append([low + s, low + t, high + t, high + s])
        faces.append([north - segments + s, north - segments + t, north])
    return vertices, faces
