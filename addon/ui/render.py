# SPDX-License-Identifier: GPL-3.0-or-later

import bpy

from .. import reports
from ..native.library import load
from ..scene.problems import GlimmerError
from .panel import GlimmerPanel, draw_wrapped


def _limit(layout: bpy.types.UILayout, settings: bpy.types.PropertyGroup, switch: str, value: str) -> None:
    row = layout.row(align=True, heading=settings.bl_rna.properties[switch].name)
    row.prop(settings, switch, text="")
    field = row.row(align=True)
    field.active = getattr(settings, switch)
    field.prop(settings, value, text="")


class GLIMMER_PT_sampling(GlimmerPanel, bpy.types.Panel):
    bl_label = "Sampling"
    bl_context = "render"
    bl_order = -1  # above Blender's own, which were registered before

    def draw(self, context: bpy.types.Context) -> None:
        layout, settings = self.layout, context.scene.glimmer
        layout.use_property_split = True
        layout.use_property_decorate = False
        try:
            load()
        except GlimmerError as error:
            draw_wrapped(layout, context, str(error), "ERROR")
        layout.prop(settings, "integrator")
        _limit(layout, settings, "use_samples", "samples")
        _limit(layout, settings, "use_seconds", "seconds")
        _limit(layout, settings, "use_target_error", "target_error")
        layout.prop(settings, "use_adaptive")
        layout.prop(settings, "viewport_samples")
        row = layout.row(align=True)
        row.prop(settings, "seed")
        row.prop(settings, "use_seed_per_frame", text="", icon="TIME")


class GLIMMER_PT_depth(GlimmerPanel, bpy.types.Panel):
    bl_label = "Depth Limits"
    bl_context = "render"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout, settings = self.layout, context.scene.glimmer
        layout.use_property_split = True
        layout.use_property_decorate = False
        _limit(layout, settings, "use_max_depth", "max_depth")
        _limit(layout, settings, "use_max_scatter", "max_scatter")
        if settings.use_max_depth or settings.use_max_scatter:
            layout.label(text="Limits make the picture darker than it should be", icon="INFO")


class GLIMMER_PT_film(GlimmerPanel, bpy.types.Panel):
    bl_label = "Film"
    bl_context = "render"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout, settings = self.layout, context.scene.glimmer
        layout.use_property_split = True
        layout.use_property_decorate = False
        layout.prop(settings, "filter")
        if settings.filter != "BOX":
            layout.prop(settings, "filter_width")
        if hasattr(context.scene, "cycles"):
            layout.prop(context.scene.cycles, "film_exposure")


class GLIMMER_PT_performance(GlimmerPanel, bpy.types.Panel):
    bl_label = "Performance"
    bl_context = "render"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout, render = self.layout, context.scene.render
        layout.use_property_split = True
        layout.use_property_decorate = False
        layout.prop(render, "threads_mode")
        field = layout.column()
        field.enabled = render.threads_mode == "FIXED"
        field.prop(render, "threads")
        layout.prop(context.scene.glimmer, "tile_size")


class GLIMMER_PT_report(GlimmerPanel, bpy.types.Panel):
    bl_label = "Last Render"
    bl_context = "render"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        report = reports.last()
        column = self.layout.column(align=True)
        if not report:
            column.label(text="Nothing rendered yet")
            return
        for line in reports.summary(report):
            column.label(text=line)
        for line in [*report["export"]["notices"], *report["warnings"]]:
            column.label(text=line, icon="INFO")


_CLASSES = (GLIMMER_PT_sampling, GLIMMER_PT_depth, GLIMMER_PT_film, GLIMMER_PT_performance, GLIMMER_PT_report)


def register() -> None:
    for panel in _CLASSES:
        bpy.utils.register_class(panel)


def unregister() -> None:
    for panel in reversed(_CLASSES):
        bpy.utils.unregister_class(panel)
