# SPDX-License-Identifier: GPL-3.0-or-later

import bpy

from ..film.passes import LONG_NAMES, OPTIONAL
from .panel import GlimmerPanel


class GLIMMER_PT_passes(GlimmerPanel, bpy.types.Panel):
    bl_label = "Passes"
    bl_context = "view_layer"

    def draw(self, context: bpy.types.Context) -> None:
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        column = self.layout.column(heading="Include")
        drawn = set()
        for item in OPTIONAL:
            owner = item.owner(context.view_layer)
            if owner is None or item.switch in drawn:
                continue  # Cycles is switched off, or one switch is of several passes
            drawn.add(item.switch)
            text = "Denoising Data" if item.switch == "denoising_store_passes" else item.name(LONG_NAMES)
            column.prop(owner, item.switch, text=text)


class GLIMMER_PT_view_layer_override(GlimmerPanel, bpy.types.Panel):
    bl_label = "Override"
    bl_context = "view_layer"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        self.layout.use_property_split = True
        self.layout.prop(context.view_layer, "material_override", text="Material")
        self.layout.prop(context.view_layer, "use_motion_blur", text="Motion Blur")


_CLASSES = (GLIMMER_PT_passes, GLIMMER_PT_view_layer_override)


def register() -> None:
    for panel in _CLASSES:
        bpy.utils.register_class(panel)


def unregister() -> None:
    for panel in reversed(_CLASSES):
        bpy.utils.unregister_class(panel)
