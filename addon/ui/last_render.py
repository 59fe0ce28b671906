# SPDX-License-Identifier: GPL-3.0-or-later

import bpy

from .. import reports
from .panel import GlimmerPanel, draw_wrapped


class GLIMMER_PT_report(GlimmerPanel, bpy.types.Panel):
    bl_label = "Last Render"
    bl_context = "render"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        report = reports.last()
        if not report:
            self.layout.label(text="Nothing rendered yet")
            return
        for line in reports.summary(report):
            draw_wrapped(self.layout, context, line, "DOT")
        for line in report["warnings"]:
            draw_wrapped(self.layout, context, line, "ERROR")
        for line in report["export"]["notices"]:
            draw_wrapped(self.layout, context, line, "INFO")


class GLIMMER_PT_report_details(GlimmerPanel, bpy.types.Panel):
    bl_label = "Saved Work"
    bl_parent_id = "GLIMMER_PT_report"
    bl_context = "render"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and bool(reports.skipped(reports.last()))

    def draw(self, context: bpy.types.Context) -> None:
        draw_wrapped(self.layout, context, "Faster, since this scene needs none of it:", "CHECKMARK")
        for line in reports.skipped(reports.last()):
            draw_wrapped(self.layout, context, line, "BLANK1")


_CLASSES = (GLIMMER_PT_report, GLIMMER_PT_report_details)

register, unregister = bpy.utils.register_classes_factory(_CLASSES)
