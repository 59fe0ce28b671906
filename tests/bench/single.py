# SPDX-License-Identifier: GPL-3.0-or-later
"""Takes the objects and faces that lie on others out of a scene, inside Blender: they shade each other in Cycles."""

from typing import Any

import bmesh
import bpy

DIGITS = 5  # to which places are held against each other


def make_single(scene: Any) -> None:
    seen: set[Any] = set()
    graph = bpy.context.evaluated_depsgraph_get()
    for item in [item for item in scene.objects if item.type == "MESH" and not item.hide_render]:
        mesh = bpy.data.meshes.new_from_object(
            item.evaluated_get(graph), preserve_all_data_layers=True, depsgraph=graph
        )
        vertices = tuple(vertex.co.to_tuple(DIGITS) for vertex in mesh.vertices)
        place = tuple(round(value, DIGITS) for row in item.matrix_world for value in row)
        if (vertices, place) in seen:
            item.hide_render = True
        elif _without_doubled_faces(mesh):
            item.modifiers.clear()
            item.data = mesh
        seen.add((vertices, place))


def _without_doubled_faces(mesh: Any) -> bool:
    """Whether there were some."""
    edited, seen, doubled = bmesh.new(), set(), []
    edited.from_mesh(mesh)
    for face in edited.faces:
        corners = frozenset(vertex.co.to_tuple(DIGITS) for vertex in face.verts)
        if corners in seen:
            doubled.append(face)
        seen.add(corners)
    bmesh.ops.delete(edited, geom=doubled, context="FACES_ONLY")
    edited.to_mesh(mesh)
    edited.free()
    return bool(doubled)
