# SPDX-License-Identifier: GPL-3.0-or-later
"""What is rendered of the light, and how it comes to the picture."""

import bpy

from ..cluster.settings import cluster_of
from ..scene.problems import GlimmerError
from .panel import GlimmerPanel, draw_wrapped, limit_row


class GLIMMER_PT_light_paths(GlimmerPanel, bpy.types.Panel):
    bl_label = "Light Paths"
    bl_context = "render"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout, settings = self.layout, context.scene.glimmer
        layout.use_property_split = True
        layout.use_property_decorate = False
        limit_row(layout, settings, "use_max_depth", "max_bounces")
        limit_row(layout, settings, "use_max_scatter", "volume_bounces")
        if settings.use_max_depth or settings.use_max_scatter:
            draw_wrapped(layout, context, "Limits make the picture darker than it should be", "INFO")


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
        cycles, render = getattr(context.scene, "cycles", None), context.scene.render
        if cycles is not None:
            layout.prop(cycles, "film_exposure")
        layout.prop(render, "film_transparent", text="Transparent")
        if cycles is not None and render.film_transparent:
            limit_row(layout, cycles, "film_transparent_glass", "film_transparent_roughness")
        if render.use_multiview:
            layout.prop(render, "use_multiview", text="Stereoscopy: not rendered")


class GLIMMER_PT_performance(GlimmerPanel, bpy.types.Panel):
    bl_label = "Performance"
    bl_context = "render"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout, render = self.layout, context.scene.render
        layout.use_property_split = True
        layout.use_property_decorate = False
        layout.prop(render, "threads_mode", text="Threads")
        field = layout.column()
        field.enabled = render.threads_mode == "FIXED"
        field.prop(render, "threads", text="Count")
        layout.prop(context.scene.glimmer, "tile_size")


class GLIMMER_PT_cluster(GlimmerPanel, bpy.types.Panel):
    bl_label = "Render on Cluster"
    bl_parent_id = "GLIMMER_PT_performance"
    bl_context = "render"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header(self, context: bpy.types.Context) -> None:
        self.layout.prop(context.scene.glimmer, "use_cluster", text="")

    def draw(self, context: bpy.types.Context) -> None:
        layout, settings = self.layout, context.scene.glimmer
        layout.use_property_split = True
        layout.use_property_decorate = False
        layout.active = settings.use_cluster
        layout.prop(settings, "cluster_task_samples")
        try:
            cluster = cluster_of(context.scene)
        except GlimmerError as error:
            draw_wrapped(layout, context, str(error), "ERROR")
            return
        if cluster is not None:
            where = cluster.scheduler or "Two workers on this machine: the preferences name no scheduler"
            draw_wrapped(layout, context, where, "NETWORK_DRIVE")


_CLASSES = (GLIMMER_PT_light_paths, GLIMMER_PT_film, GLIMMER_PT_performance, GLIMMER_PT_cluster)

register, unregister = bpy.utils.register_classes_factory(_CLASSES)
