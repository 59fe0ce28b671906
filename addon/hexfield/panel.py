# SPDX-License-Identifier: GPL-3.0-or-later
"""The live parameters in the data properties of a field, a panel a section of the table."""

from typing import Any

import bpy

from . import properties
from .layout import check
from .parameters import SECTIONS, controls

_HIDDEN_UNLESS_EXTENT = {"rings": "RINGS", "radius": "RADIUS"}


def draw_parameters(layout: Any, group: Any, section: str) -> None:
    """The parameters of one section; `group` holds them, a field's properties or the operator."""
    column = layout.column()
    for name, control in controls():
        if control.section == section and _HIDDEN_UNLESS_EXTENT.get(name, group.extent) == group.extent:
            column.prop(group, name, slider=0 < control.maximum <= 1)


class _FieldPanel:
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "data"

    @classmethod
    def poll(cls, context: Any) -> bool:
        return context.object is not None and context.object.type == "MESH" and context.object.glimmer_field.enabled


class GLIMMER_PT_hexagon_field(_FieldPanel, bpy.types.Panel):
    bl_label = "Hexagon Field"

    def draw(self, context: Any) -> None:
        layout = self.layout
        layout.use_property_split = True
        obj = context.object
        try:
            check(properties.read(obj.glimmer_field))
        except ValueError as error:
            layout.label(text=str(error), icon="ERROR")
        if obj.data.is_editmode:
            layout.label(text="Leave edit mode to change the field", icon="INFO")
        if obj.animation_data is not None and not context.scene.render.use_lock_interface:
            layout.label(text="Animated: lock the interface while rendering", icon="INFO")
            layout.prop(context.scene.render, "use_lock_interface")
        layout.label(text=f"{len(obj.data.vertices)} plates")
        layout.prop(obj.glimmer_field, "plate_material")
        layout.prop(obj.glimmer_field, "bevel_material")


def _section_panel(section: str) -> type:
    def draw(self: Any, context: Any) -> None:
        self.layout.use_property_split = True
        draw_parameters(self.layout, context.object.glimmer_field, section)

    name = f"GLIMMER_PT_hexagon_field_{section.lower()}"
    members = {"bl_label": section, "bl_parent_id": "GLIMMER_PT_hexagon_field", "draw": draw}
    return type(name, (_FieldPanel, bpy.types.Panel), members)


_CLASSES = (GLIMMER_PT_hexagon_field, *(_section_panel(section) for section in SECTIONS))


def register() -> None:
    for cls in _CLASSES:
        bpy.utils.register_class(cls)


def unregister() -> None:
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
