# SPDX-License-Identifier: GPL-3.0-or-later
"""A hexagon field as Blender's data.

The object's mesh holds a point for every plate; a node modifier puts a prototype on each. The prototypes are in a
collection that is in no scene; fields with the same plates share one, and a field that changes its plates changes a
collection that is its alone, or takes another. Everything remembers the parameters it was made from, so that only
what changed is made anew.
"""

from typing import Any

import bpy
import numpy as np
from numpy.typing import NDArray

from . import node_group, properties, slots
from .layout import FieldLayout, check, lay_out
from .naming import natural_key
from .parameters import FieldParameters, Part
from .plate import make_plate

_LAYOUT_KEY, _PLATES_KEY = "glimmer_layout", "glimmer_plates"


def create(
    name: str,
    parameters: FieldParameters,
    plate_material: Any = None,
    bevel_material: Any = None,
    collection: Any = None,
) -> Any:
    """A new field object, linked to `collection` if there is one. `parameters` impossible together raise ValueError and
    leave nothing behind."""
    check(parameters)
    obj = bpy.data.objects.new(name, bpy.data.meshes.new(name))
    if collection is not None:
        collection.objects.link(obj)
    group = obj.glimmer_field
    properties.write(group, parameters)
    group.plate_material, group.bevel_material = plate_material, bevel_material
    group.enabled = True
    return obj


def rebuild(obj: Any, parameters: FieldParameters) -> None:
    """Brings a field's data up to date with `parameters`, as far as they changed. Raises ValueError for parameters
    that are impossible together, and leaves the data as it was.
    """
    if obj.type != "MESH" or obj.library is not None or obj.data.library is not None or obj.data.is_editmode:
        return
    _rebuild_points(obj, parameters)
    slots.follow_pointers(obj)
    _rebuild_plates(obj, parameters)


def prototypes(collection: Any) -> list[Any]:
    """The prototypes in the order of the node Collection Info, which sorts by name as people count."""
    return sorted(collection.objects, key=lambda obj: natural_key(obj.name))


def sweep() -> None:
    """Removes prototypes that no field uses any more."""
    for collection in [c for c in bpy.data.collections if _PLATES_KEY in c and c.users == 0 and c.library is None]:
        leftover = list(collection.objects)
        bpy.data.collections.remove(collection)
        for obj in leftover:
            if obj.users == 0:
                _remove_prototype(obj)


def _rebuild_points(obj: Any, parameters: FieldParameters) -> None:
    key = parameters.key(Part.LAYOUT)
    if obj.data.get(_LAYOUT_KEY) == key:
        return
    layout = lay_out(parameters)
    if obj.data.users > 1:  # a linked duplicate, whose parameters are its own
        obj.data = bpy.data.meshes.new(obj.data.name)
    _fill_points(obj.data, layout)
    obj.data[_LAYOUT_KEY] = key
    obj.update_tag()


def _fill_points(mesh: Any, layout: FieldLayout) -> None:
    mesh.clear_geometry()
    mesh.vertices.add(len(layout))
    mesh.vertices.foreach_set("co", layout.positions.astype(np.float32).ravel())
    for name, values in ((node_group.ROTATION, layout.rotations), (node_group.SCALE, layout.scales)):
        _set_attribute(mesh, name, "FLOAT_VECTOR", "vector", values.astype(np.float32))
    _set_attribute(mesh, node_group.PROTOTYPE, "INT", "value", layout.prototypes)
    mesh.update()


def _set_attribute(mesh: Any, name: str, kind: str, member: str, values: NDArray[Any]) -> None:
    attribute = mesh.attributes.get(name) or mesh.attributes.new(name, kind, "POINT")
    attribute.data.foreach_set(member, np.ascontiguousarray(values).ravel())


def _rebuild_plates(obj: Any, parameters: FieldParameters) -> None:
    modifier = node_group.find_modifier(obj)
    if modifier is None:
        modifier = obj.modifiers.new(node_group.NAME, "NODES")
        modifier.node_group = node_group.ensure()
    current = node_group.plates(modifier)
    key = parameters.key(Part.PLATES)
    materials = [obj.glimmer_field.plate_material, obj.glimmer_field.bevel_material]
    if current is not None and _is_made_of(current, key, materials):
        return
    wanted = next((c for c in bpy.data.collections if c.library is None and _is_made_of(c, key, materials)), None)
    if wanted is None:
        # The only user of a collection that nobody shares is this field's modifier.
        own = current is not None and _PLATES_KEY in current and current.users == 1 and current.library is None
        wanted = current if own else bpy.data.collections.new("Hexagon Plates")
        _fill_plates(wanted, parameters, materials)
        wanted[_PLATES_KEY] = key
    if wanted != current:
        node_group.set_plates(modifier, wanted)
        sweep()
    obj.update_tag()


def _is_made_of(collection: Any, key: str, materials: list[Any]) -> bool:
    members = collection.objects
    return collection.get(_PLATES_KEY) == key and len(members) > 0 and list(members[0].data.materials) == materials


def _fill_plates(collection: Any, parameters: FieldParameters, materials: list[Any]) -> None:
    existing = prototypes(collection)
    for obj in existing[parameters.prototypes :]:
        _remove_prototype(obj)
    for index in range(parameters.prototypes):
        if index < len(existing):
            obj = existing[index]
        else:
            name = f"{collection.name} {index:03d}"
            obj = bpy.data.objects.new(name, bpy.data.meshes.new(name))
            collection.objects.link(obj)
        _fill_plate(obj.data, parameters, index, materials)


def _fill_plate(mesh: Any, parameters: FieldParameters, index: int, materials: list[Any]) -> None:
    plate = make_plate(parameters, index)
    faces = np.split(plate.face_vertices, plate.face_starts[1:])
    mesh.clear_geometry()
    mesh.from_pydata(plate.vertices.tolist(), [], [face.tolist() for face in faces])
    mesh.materials.clear()  # and with them the faces' slots
    for material in materials:
        mesh.materials.append(material)
    mesh.polygons.foreach_set("material_index", plate.slots)
    mesh.polygons.foreach_set("use_smooth", plate.smooth)
    mesh.update()


def _remove_prototype(obj: Any) -> None:
    mesh = obj.data
    bpy.data.objects.remove(obj)
    if mesh is not None and mesh.users == 0:
        bpy.data.meshes.remove(mesh)
