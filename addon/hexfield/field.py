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
from .look import look_of
from .naming import natural_key
from .parameters import FieldParameters, Part
from .plate import Kind, kinds, make_plate, prototype_count
from .standing import Viewer, ground_of, viewer_of

_LAYOUT_KEY, _PLATES_KEY, _LOOK_KEY, _VIEWER_KEY = "glimmer_layout", "glimmer_plates", "glimmer_look", "glimmer_viewer"
_VARIANT = "glimmer_variant"  # the prototypes of a field before plates that are far away were simplified
_KEPT = 300_000  # the layout of a field of so many plates is kept for the next change of its colours

_last_layout: list[tuple[str, FieldLayout]] = []


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


def rebuild(obj: Any, parameters: FieldParameters, depsgraph: Any = None) -> None:
    """Brings a field's data up to date with `parameters`, as far as they changed. Raises ValueError for parameters
    that are impossible together, and leaves the data as it was. depsgraph: the context's without one.
    """
    if obj.type != "MESH" or obj.library is not None or obj.data.library is not None or obj.data.is_editmode:
        return
    _rebuild_points(obj, parameters, depsgraph)
    slots.follow_pointers(obj)
    _rebuild_plates(obj, parameters)
    simplify(obj, parameters, depsgraph)
    node_group.set_viewport_share(node_group.find_modifier(obj), parameters.viewport_share)


def simplify(obj: Any, parameters: FieldParameters, depsgraph: Any = None) -> None:
    """Gives the plates that the scene's camera sees small the plain prototypes, and all others theirs."""
    viewer = viewer_of(obj, depsgraph) if parameters.simplify else None
    key = repr((viewer, parameters.simplify_pixels)) if viewer is not None else ""
    if obj.data.get(_VIEWER_KEY, "") == key or (variants := _read_variants(obj.data)) is None:
        return
    if viewer is not None:
        variants = _simplified(obj.data, variants, parameters, viewer)
    _set_attribute(obj.data, node_group.PROTOTYPE, "INT", "value", variants)
    obj.data[_VIEWER_KEY] = key
    obj.update_tag()


def _read_variants(mesh: Any) -> NDArray[np.int32] | None:
    attribute = mesh.attributes.get(_VARIANT)
    if attribute is None:
        return None
    found = np.empty(len(attribute.data), np.int32)
    attribute.data.foreach_get("value", found)
    return found


def _simplified(
    mesh: Any, variants: NDArray[np.int32], parameters: FieldParameters, viewer: Viewer
) -> NDArray[np.int32]:
    points = np.empty(3 * len(variants), np.float32)
    mesh.vertices.foreach_get("co", points)
    pixels = viewer.pixels(points.reshape(-1, 3).astype(np.float64), 2.0 * parameters.plate_radius)
    plain = kinds(parameters).index(Kind.SIMPLE) * parameters.prototypes
    small = pixels < parameters.simplify_pixels
    return np.where(small, plain + variants % parameters.prototypes, variants).astype(np.int32)


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


def _rebuild_points(obj: Any, parameters: FieldParameters, depsgraph: Any) -> None:
    ground, ground_key = ground_of(obj, depsgraph)
    key = parameters.key(Part.LAYOUT) + ground_key
    look_key = parameters.key(Part.LOOK) + key
    if obj.data.get(_LAYOUT_KEY) == key and obj.data.get(_LOOK_KEY) == look_key:
        return
    layout = next((layout for kept_key, layout in _last_layout if kept_key == key), None) or lay_out(parameters, ground)
    _last_layout[:] = [(key, layout)] if len(layout) <= _KEPT else []
    if obj.data.users > 1:  # a linked duplicate, whose parameters are its own
        obj.data = bpy.data.meshes.new(obj.data.name)
    if obj.data.get(_LAYOUT_KEY) != key:
        _fill_points(obj.data, layout, parameters.simplify)
        obj.data[_LAYOUT_KEY] = key
        obj.data[_VIEWER_KEY] = ""
    _fill_look(obj.data, layout, parameters)
    obj.data[_LOOK_KEY] = look_key
    obj.data.update()
    obj.update_tag()


def _fill_points(mesh: Any, layout: FieldLayout, keeps_variants: bool) -> None:
    mesh.clear_geometry()
    mesh.vertices.add(len(layout))
    mesh.vertices.foreach_set("co", layout.positions.astype(np.float32).ravel())
    for name, values in ((node_group.ROTATION, layout.rotations), (node_group.SCALE, layout.scales)):
        _set_attribute(mesh, name, "FLOAT_VECTOR", "vector", values.astype(np.float32))
    _set_attribute(mesh, node_group.PROTOTYPE, "INT", "value", layout.prototypes)
    for name, numbers in ((node_group.RANDOM, layout.randoms), (node_group.RING, layout.rings)):
        _set_attribute(mesh, name, "FLOAT", "value", numbers.astype(np.float32))
    if keeps_variants:
        _set_attribute(mesh, _VARIANT, "INT", "value", layout.prototypes)
    elif _VARIANT in mesh.attributes:
        mesh.attributes.remove(mesh.attributes[_VARIANT])


def _fill_look(mesh: Any, layout: FieldLayout, parameters: FieldParameters) -> None:
    look = look_of(layout, parameters)
    colors = np.ones((len(layout), 4), np.float32)
    colors[:, :3] = look.colors
    _set_attribute(mesh, node_group.COLOR, "FLOAT_COLOR", "color", colors)
    for name, numbers in ((node_group.ROUGHNESS, look.roughnesses), (node_group.PATINA, look.patinas)):
        _set_attribute(mesh, name, "FLOAT", "value", numbers.astype(np.float32))


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
    count = prototype_count(parameters)
    for obj in existing[count:]:
        _remove_prototype(obj)
    for index in range(count):
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
    _sharpen_edges_of_flat_faces(mesh, np.repeat(~plate.smooth, plate.face_sizes))
    mesh.update()


def _sharpen_edges_of_flat_faces(mesh: Any, is_corner_of_flat: NDArray[np.bool_]) -> None:
    """They are sharp in any case, but Cycles of 4.2 to 5.1 knows only where some edge is said to be."""
    edges = np.empty(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("edge_index", edges)
    sharp = np.zeros(len(mesh.edges), np.bool_)
    sharp[edges[is_corner_of_flat]] = True
    mesh.edges.foreach_set("use_edge_sharp", sharp)


def _remove_prototype(obj: Any) -> None:
    mesh = obj.data
    bpy.data.objects.remove(obj)
    if mesh is not None and mesh.users == 0:
        bpy.data.meshes.remove(mesh)
