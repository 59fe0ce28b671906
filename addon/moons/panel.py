# SPDX-License-Identifier: GPL-3.0-or-later
"""Radius, surface and orbit of a moon in its data properties and in the sidebar."""

from typing import Any

import bpy

from .moon import emission_node


class _MoonPanel:
    bl_label = "Moon"

    @classmethod
    def poll(cls, context: Any) -> bool:
        return emission_node(context.object) is not None

    def draw(self, context: Any) -> None:
        layout = self.layout  # type: ignore[attr-defined]
        layout.label(text="Moon", icon="SPHERE")
        layout.use_property_split = True
        node = emission_node(context.object)
        layout.prop(context.object.glimmer_moon, "radius")
        for socket in node.inputs:
            if socket.enabled and hasattr(socket, "default_value") and socket.name != "Weight":
                layout.prop(socket, "default_value", text=socket.name)
        layout.operator_menu_enum("glimmer.set_moon_surface", "kind")
        orbit = context.object.glimmer_orbit
        if not orbit.enabled:
            layout.operator("glimmer.put_on_orbit", icon="DRIVER")
            return
        layout.label(text="Orbit", icon="DRIVER")
        for name in ("center", "semi_axis", "eccentricity", "period", "phase", "inclination", "node", "periapsis"):
            layout.prop(orbit, name)
        layout.operator("glimmer.take_off_orbit", icon="X")


class GLIMMER_PT_moon(_MoonPanel, bpy.types.Panel):
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "data"
    bl_options = {"HIDE_HEADER"}  # what has no header stands above all of Blender's panels


class GLIMMER_PT_moon_sidebar(_MoonPanel, bpy.types.Panel):
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Glimmer"


_CLASSES = (GLIMMER_PT_moon, GLIMMER_PT_moon_sidebar)

register, unregister = bpy.utils.register_classes_factory(_CLASSES)
