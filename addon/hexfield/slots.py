# SPDX-License-Identifier: GPL-3.0-or-later
"""The materials of a field's plates and bevels as its object's two slots, so that Blender's own tools edit them.

Nothing of the object's mesh wears them: the prototypes do. The slots belong to the object, since linked duplicates
share a mesh.
"""

from typing import Any

COUNT = 2


def is_writable(obj: Any) -> bool:
    return obj.type == "MESH" and obj.library is None and obj.data.library is None and not obj.data.is_editmode


def follow_pointers(obj: Any) -> None:
    """Gives the slots the materials of the field's properties."""
    group, mesh = obj.glimmer_field, obj.data
    while len(mesh.materials) < COUNT:
        mesh.materials.append(None)
    for slot, material in zip(obj.material_slots, (group.plate_material, group.bevel_material), strict=False):
        if slot.link != "OBJECT":
            slot.link = "OBJECT"
        if slot.material != material:
            slot.material = material


def lead_pointers(obj: Any) -> None:
    """Gives the field's properties, and so the plates, what somebody has put into the slots."""
    group = obj.glimmer_field
    if len(obj.material_slots) < COUNT:  # one was removed, or the file is older than they are
        follow_pointers(obj)
        return
    for name, slot in zip(("plate_material", "bevel_material"), obj.material_slots, strict=False):
        if getattr(group, name) != slot.material:
            setattr(group, name, slot.material)
