# SPDX-License-Identifier: GPL-3.0-or-later
"""How noisy the picture is: in words and numbers, and as a curve that grows while it renders."""

from typing import Any

import bpy
import bpy.utils.previews
import numpy as np

from .. import reports
from ..native import error_curve
from ..native.library import load
from .panel import GlimmerPanel, draw_wrapped

SIDE = 320  # pixels of the plot
SCALE = 11.0  # of the plot in the panel, in rows
LOOK_SECONDS = 0.5

_previews: dict[str, Any] = {}
_shown = {"news": -1, "redrawn": -1}


def _colors() -> error_curve.PlotColors:
    """The panel's, and that of what is selected for the line, in Blender's theme."""
    theme = bpy.context.preferences.themes[0]
    space = theme.properties.space
    selected = theme.user_interface.wcol_regular.inner_sel
    return error_curve.PlotColors(tuple(space.back)[:3], tuple(space.text)[:3], tuple(selected)[:3])


def _icon(report: dict[str, Any]) -> int:
    """The plot as Blender's panels can show one."""
    if not _previews:
        _previews["all"] = bpy.utils.previews.new()
    previews = _previews["all"]
    preview = previews.get("curve") or previews.new("curve")
    if _shown["news"] != reports.news():
        _shown["news"] = reports.news()
        pixels = np.ones((SIDE, SIDE, 4), np.float32)
        pixels[..., :3] = error_curve.plot(load(), report, (SIDE, SIDE), _colors())[::-1] / np.float32(255.0)
        preview.image_size = (SIDE, SIDE)
        preview.image_pixels_float.foreach_set(pixels.reshape(-1))
    return int(preview.icon_id)


class GLIMMER_PT_noise(GlimmerPanel, bpy.types.Panel):
    bl_label = "Noise"
    bl_context = "render"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        report = reports.last()
        if "spp" not in report:
            self.layout.label(text="Nothing rendered yet")
            return
        first, *others = reports.noise_summary(report)
        draw_wrapped(self.layout, context, first, "RENDER_RESULT")
        for line in others:
            draw_wrapped(self.layout, context, line, "BLANK1")


class GLIMMER_PT_noise_details(GlimmerPanel, bpy.types.Panel):
    bl_label = "Details"
    bl_parent_id = "GLIMMER_PT_noise"
    bl_context = "render"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        report = reports.last()
        if "spp" in report:
            for line in reports.error_summary(report):
                draw_wrapped(self.layout, context, line, "DOT")
            if error_curve.has_points(report):
                self.layout.template_icon(icon_value=_icon(report), scale=SCALE)
        self.layout.prop(context.scene.glimmer, "use_curve_files")


_CLASSES = (GLIMMER_PT_noise, GLIMMER_PT_noise_details)


def _look() -> float:
    """Redraws the properties when a render that goes on has told something new."""
    if _shown["redrawn"] != reports.news():
        _shown["redrawn"] = reports.news()
        for window in bpy.context.window_manager.windows:
            for area in window.screen.areas:
                if area.type == "PROPERTIES":
                    area.tag_redraw()
    return LOOK_SECONDS


def register() -> None:
    for panel in _CLASSES:
        bpy.utils.register_class(panel)
    if not bpy.app.background:
        bpy.app.timers.register(_look, first_interval=LOOK_SECONDS, persistent=True)


def unregister() -> None:
    if bpy.app.timers.is_registered(_look):
        bpy.app.timers.unregister(_look)
    if _previews:
        bpy.utils.previews.remove(_previews.pop("all"))
    _shown["news"] = -1
    for panel in reversed(_CLASSES):
        bpy.utils.unregister_class(panel)
