# SPDX-License-Identifier: GPL-3.0-or-later
"""How long a view and a picture are rendered."""

import bpy
from bl_ui.utils import PresetPanel

from ..film import denoise
from ..native.library import load
from ..scene.problems import GlimmerError
from .panel import GlimmerPanel, draw_wrapped, limit_row


class _SamplingPanel(GlimmerPanel):
    bl_context = "render"


def _settings_layout(panel: bpy.types.Panel) -> bpy.types.UILayout:
    panel.layout.use_property_split = True
    panel.layout.use_property_decorate = False
    return panel.layout


class GLIMMER_PT_sampling_presets(PresetPanel, bpy.types.Panel):
    """Some of ours, and the artist's own."""

    bl_label = "Sampling Presets"
    preset_subdir = "glimmer/sampling"
    preset_operator = "script.execute_preset"
    preset_add_operator = "render.glimmer_sampling_preset_add"
    COMPAT_ENGINES = GlimmerPanel.COMPAT_ENGINES

    def draw(self, context: bpy.types.Context) -> None:
        column = self.layout.column(align=True)
        column.emboss = "PULLDOWN_MENU"
        column.operator_context = "EXEC_DEFAULT"
        column.operator_enum("render.glimmer_sampling_preset", "kind")
        if bpy.utils.preset_paths(self.preset_subdir):
            PresetPanel.draw(self, context)
            return
        # Blender's panel of presets would say that it misses a folder, which comes with the first of them.
        manager = context.window_manager
        row = self.layout.row()
        row.prop(manager, "preset_name", text="")
        row.operator(self.preset_add_operator, text="", icon="ADD").name = manager.preset_name


class GLIMMER_PT_sampling(_SamplingPanel, bpy.types.Panel):
    bl_label = "Sampling"

    def draw_header_preset(self, context: bpy.types.Context) -> None:
        GLIMMER_PT_sampling_presets.draw_panel_header(self.layout)

    def draw(self, context: bpy.types.Context) -> None:
        layout = _settings_layout(self)
        try:
            load()
        except GlimmerError as error:
            draw_wrapped(layout, context, str(error), "ERROR")


class GLIMMER_PT_sampling_viewport(_SamplingPanel, bpy.types.Panel):
    bl_label = "Viewport"
    bl_parent_id = "GLIMMER_PT_sampling"

    def draw(self, context: bpy.types.Context) -> None:
        layout = _settings_layout(self)
        settings = context.scene.glimmer
        layout.prop(settings, "viewport_samples", text="Samples")
        is_there = denoise.path() is not None
        column = layout.column()
        column.enabled = is_there
        column.prop(settings, "use_viewport_denoising")
        if not is_there:
            draw_wrapped(layout, context, denoise.ABSENT_IN_VIEWS, "INFO")
        elif settings.use_viewport_denoising:
            column.prop(settings, "viewport_denoising_start")


class GLIMMER_PT_sampling_render(_SamplingPanel, bpy.types.Panel):
    bl_label = "Render"
    bl_parent_id = "GLIMMER_PT_sampling"

    def draw(self, context: bpy.types.Context) -> None:
        layout = _settings_layout(self)
        settings = context.scene.glimmer
        limit_row(layout, settings, "use_target_error", "noise_limit")
        limit_row(layout, settings, "use_samples", "samples")
        limit_row(layout, settings, "use_seconds", "seconds")
        if not (settings.use_target_error or settings.use_samples or settings.use_seconds):
            draw_wrapped(layout, context, "Without a limit, a render ends after 64 samples", "INFO")
        layout.prop(settings, "use_adaptive", text="Adaptive")
        layout.prop(settings, "use_denoising")
        if settings.use_denoising and denoise.find() is None:
            draw_wrapped(layout, context, denoise.ABSENT, "ERROR")


class GLIMMER_PT_sampling_advanced(_SamplingPanel, bpy.types.Panel):
    bl_label = "Advanced"
    bl_parent_id = "GLIMMER_PT_sampling"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout = _settings_layout(self)
        settings = context.scene.glimmer
        row = layout.row(align=True)
        row.prop(settings, "seed")
        row.prop(settings, "use_seed_per_frame", text="", icon="TIME")
        # The others are yardsticks for who develops the engine; who has one must find the way back.
        if context.preferences.view.show_developer_ui or settings.integrator not in ("", "path"):
            layout.prop(settings, "integrator")


_CLASSES = (
    GLIMMER_PT_sampling_presets,
    GLIMMER_PT_sampling,
    GLIMMER_PT_sampling_viewport,
    GLIMMER_PT_sampling_render,
    GLIMMER_PT_sampling_advanced,
)

register, unregister = bpy.utils.register_classes_factory(_CLASSES)
