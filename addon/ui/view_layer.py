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


def register() -> None:
    bpy.utils.register_class(GLIMMER_PT_passes)


def unregister() -> None:
    bpy.utils.unregister_class(GLIMMER_PT_passes)
