# SPDX-License-Identifier: GPL-3.0-or-later
"""Add > Glimmer: all that the add-on adds."""

from typing import Any

import bpy

OPERATORS = (
    ("glimmer.add_glimmer_world", "WORLD_DATA"),
    ("glimmer.add_world", "WORLD"),
    ("glimmer.add_hexagon_field", "MOD_ARRAY"),
    ("glimmer.add_moon", "SPHERE"),
    ("glimmer.add_five_moons", "LIGHT_POINT"),
    ("glimmer.add_haze", "MOD_FLUID"),
)


class GLIMMER_MT_add(bpy.types.Menu):
    bl_label = "Glimmer"

    def draw(self, context: bpy.types.Context) -> None:
        for name, icon in OPERATORS:
            if name == "glimmer.add_glimmer_world":
                self.layout.operator_menu_enum(name, "preset", icon=icon)
            else:
                self.layout.operator(name, icon=icon)


def draw_in_add_menu(menu: Any, context: bpy.types.Context) -> None:
    menu.layout.separator()
    menu.layout.menu(GLIMMER_MT_add.__name__, icon="LIGHT_SUN")


def register() -> None:
    bpy.utils.register_class(GLIMMER_MT_add)
    bpy.types.VIEW3D_MT_add.append(draw_in_add_menu)


def unregister() -> None:
    bpy.types.VIEW3D_MT_add.remove(draw_in_add_menu)
    bpy.utils.unregister_class(GLIMMER_MT_add)
