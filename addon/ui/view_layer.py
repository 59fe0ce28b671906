# SPDX-License-Identifier: GPL-3.0-or-later

import bpy

from ..film.passes import OPTIONAL
from .panel import GlimmerPanel


class GLIMMER_PT_passes(GlimmerPanel, bpy.types.Panel):
    bl_label = "Passes"
    bl_context = "view_layer"

    def draw(self, context: bpy.types.Context) -> None:
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        column = self.layout.column(heading="Include")
        for item in OPTIONAL:
            owner = context.view_layer if item.builtin else context.view_layer.glimmer
            column.prop(owner, item.switch, text=item.blender_name)


def register() -> None:
    bpy.utils.register_class(GLIMMER_PT_passes)


def unregister() -> None:
    bpy.utils.unregister_class(GLIMMER_PT_passes)
