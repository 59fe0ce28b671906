# SPDX-License-Identifier: GPL-3.0-or-later

import bpy

from .panel import GlimmerPanel


class GLIMMER_PT_object(GlimmerPanel, bpy.types.Panel):
    bl_label = "Glimmer"
    bl_context = "object"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and context.object is not None and context.object.type == "MESH"

    def draw(self, context: bpy.types.Context) -> None:
        self.layout.use_property_split = True
        self.layout.prop(context.object.glimmer, "is_sphere")


def register() -> None:
    bpy.utils.register_class(GLIMMER_PT_object)


def unregister() -> None:
    bpy.utils.unregister_class(GLIMMER_PT_object)
