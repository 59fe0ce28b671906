# SPDX-License-Identifier: GPL-3.0-or-later
"""Add > Glimmer > Hexagon Field, and what makes its plates a mesh of their own."""

from typing import Any

import bpy

from . import field, node_group, properties
from .layout import check
from .materials import default_materials
from .panel import draw_parameters
from .parameters import SECTIONS


class GLIMMER_OT_add_hexagon_field(bpy.types.Operator):
    """Add hills of bevelled hexagonal plates, as instances; its parameters stay live in the object's data properties"""

    bl_idname = "glimmer.add_hexagon_field"
    bl_label = "Hexagon Field"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: Any) -> bool:
        return context.mode == "OBJECT"

    def draw(self, _context: Any) -> None:
        self.layout.use_property_split = True
        for section in SECTIONS:
            self.layout.label(text=section)
            draw_parameters(self.layout, self, section)

    def execute(self, context: Any) -> set[str]:
        parameters = properties.read(self)
        try:
            check(parameters)
        except ValueError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        materials = default_materials()
        obj = field.create("Hexagon Field", parameters, *materials, collection=context.collection)
        obj.location = context.scene.cursor.location
        for other in context.selected_objects:
            other.select_set(False)
        obj.select_set(True)
        context.view_layer.objects.active = obj
        return {"FINISHED"}


GLIMMER_OT_add_hexagon_field.__annotations__ = properties.field_annotations()


class GLIMMER_OT_make_plates_real(bpy.types.Operator):
    """Turn the field into one mesh of all its plates, to be edited or sculpted. Convert and Apply do not do that: they
    leave no faces"""

    bl_idname = "glimmer.make_plates_real"
    bl_label = "Make Plates Real"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: Any) -> bool:
        obj = context.object
        return context.mode == "OBJECT" and obj is not None and obj.type == "MESH" and obj.glimmer_field.enabled

    def execute(self, context: Any) -> set[str]:
        obj = context.object
        if obj.library is not None or obj.override_library is not None:
            self.report({"ERROR"}, f"{obj.name} is linked from another file: make it local first")
            return {"CANCELLED"}
        mesh = real_mesh(context, obj)
        obj.glimmer_field.enabled = False
        modifier = node_group.find_modifier(obj)
        if modifier is not None:
            node_group.set_plates(modifier, None)  # whose users are not counted down by removing it (5.3)
            obj.modifiers.remove(modifier)
        obj.data = mesh
        for slot in obj.material_slots:
            slot.link = "DATA"
        field.sweep()
        return {"FINISHED"}


def real_mesh(context: Any, obj: Any) -> Any:
    """A new mesh of all that a field shows, with its materials."""
    group = node_group.realizing()
    modifier = obj.modifiers.new(group.name, "NODES")
    modifier.node_group = group
    try:
        depsgraph = context.evaluated_depsgraph_get()
        return bpy.data.meshes.new_from_object(obj.evaluated_get(depsgraph), depsgraph=depsgraph)
    finally:
        obj.modifiers.remove(modifier)
        bpy.data.node_groups.remove(group)


_CLASSES = (GLIMMER_OT_add_hexagon_field, GLIMMER_OT_make_plates_real)

register, unregister = bpy.utils.register_classes_factory(_CLASSES)
