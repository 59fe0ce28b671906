# SPDX-License-Identifier: GPL-3.0-or-later
"""The panels of a field: its live parameters, a panel a section of the table."""

from collections.abc import Callable
from typing import Any

import bpy

from . import properties
from .layout import check
from .parameters import SECTIONS, controls

_OPEN = ("Extent", "Plates", "Hills", "Mutation")  # the other sections' panels are closed at first


def draw_parameters(layout: Any, group: Any, section: str) -> None:
    """The parameters of one section; `group` holds them, a field's properties or the operator."""
    column = layout.column()
    for name, control in controls():
        if control.section == section and (
            control.needs is None or getattr(group, control.needs[0]) == control.needs[1]
        ):
            column.prop(group, name, slider=0 < control.maximum <= 1)


def _is_field(context: Any) -> bool:
    return context.object is not None and context.object.type == "MESH" and context.object.glimmer_field.enabled


def _draw_field(self: Any, context: Any) -> None:
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
    row = layout.row()
    row.label(text=f"Field of {len(obj.data.vertices)} plates")
    row.operator_menu_enum("glimmer.hexagon_field_preset", "kind", text="Presets")
    row.operator("glimmer.make_plates_real")
    layout.use_property_split = False
    column = layout.column()
    for name, label in (("plate_material", "Plates"), ("bevel_material", "Bevels")):
        split = column.split(factor=0.25)
        split.label(text=label)
        split.template_ID(obj.glimmer_field, name, new="material.new")


def _draw_section(section: str) -> Callable[[Any, Any], None]:
    def draw(self: Any, context: Any) -> None:
        self.layout.use_property_split = True
        group = context.object.glimmer_field
        if section == "Ground":
            self.layout.prop(group, "ground")
            self.layout.prop(group, "height_image")
        draw_parameters(self.layout, group, section)

    return draw


# The same panels stand in the data properties and in the sidebar of the viewport.
_PLACES: dict[str, dict[str, Any]] = {
    "GLIMMER_PT_hexagon_field": {
        "bl_space_type": "PROPERTIES",
        "bl_region_type": "WINDOW",
        "bl_context": "data",
        "bl_options": {"HIDE_HEADER"},  # what has no header stands above all of Blender's panels
    },
    "GLIMMER_PT_hexagon_field_sidebar": {"bl_space_type": "VIEW_3D", "bl_region_type": "UI", "bl_category": "Glimmer"},
}


def _panels(name: str, place: dict[str, Any]) -> list[type]:
    """The panel of a place and its children, one a section."""
    common = {**place, "poll": classmethod(lambda _cls, context: _is_field(context))}
    parent = type(name, (bpy.types.Panel,), {**common, "bl_label": "Hexagon Field", "draw": _draw_field})
    common.pop("bl_options", None)
    children = [
        type(
            f"{name}_{section.lower()}",
            (bpy.types.Panel,),
            {
                **common,
                "bl_label": section,
                "bl_parent_id": name,
                "bl_options": set() if section in _OPEN else {"DEFAULT_CLOSED"},
                "draw": _draw_section(section),
            },
        )
        for section in SECTIONS
    ]
    return [parent, *children]


_CLASSES = tuple(panel for name, place in _PLACES.items() for panel in _panels(name, place))

register, unregister = bpy.utils.register_classes_factory(_CLASSES)
