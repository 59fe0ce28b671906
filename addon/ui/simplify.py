# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's own settings. Its panel of them would stand above all others."""

import bpy

from .panel import GlimmerPanel


class _SimplifyPanel(GlimmerPanel):
    bl_context = "render"
    bl_options = {"DEFAULT_CLOSED"}
    names: tuple[tuple[str, str], ...] = ()

    def draw(self, context: bpy.types.Context) -> None:
        layout, render = self.layout, context.scene.render  # type: ignore[attr-defined]
        layout.use_property_split = True
        layout.active = render.use_simplify
        for name, text in self.names:
            if name in render.bl_rna.properties:
                layout.prop(render, name, text=text)


class GLIMMER_PT_simplify(_SimplifyPanel, bpy.types.Panel):
    bl_label = "Simplify"

    def draw_header(self, context: bpy.types.Context) -> None:
        self.layout.prop(context.scene.render, "use_simplify", text="")


class GLIMMER_PT_simplify_viewport(_SimplifyPanel, bpy.types.Panel):
    bl_label = "Viewport"
    bl_parent_id = "GLIMMER_PT_simplify"
    names = (("simplify_subdivision", "Subdivision"), ("simplify_child_particles", "Child Particles"))


class GLIMMER_PT_simplify_render(_SimplifyPanel, bpy.types.Panel):
    bl_label = "Render"
    bl_parent_id = "GLIMMER_PT_simplify"
    names = (("simplify_subdivision_render", "Subdivision"), ("simplify_child_particles_render", "Child Particles"))


_CLASSES = (GLIMMER_PT_simplify, GLIMMER_PT_simplify_viewport, GLIMMER_PT_simplify_render)

register, unregister = bpy.utils.register_classes_factory(_CLASSES)
