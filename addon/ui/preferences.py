# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""What the add-on's entry in Blender's preferences shows: which engine is at work, or why none is."""

import bpy

from ..native import machine
from ..native.library import load
from ..scene.problems import GlimmerError
from .panel import draw_wrapped

ADDON = __package__.rpartition(".")[0]


class GlimmerPreferences(bpy.types.AddonPreferences):
    bl_idname = ADDON

    scheduler: bpy.props.StringProperty(
        name="Scheduler",
        description="Address of the cluster's Dask scheduler, as tcp://10.0.0.1:8786. Without one, Render on Cluster"
        " starts two workers on this machine",
    )
    farm_command: bpy.props.StringProperty(
        name="Command",
        description="The command build/bin/glimmer of a checkout on this machine, built as on the workers. It hands"
        " frames to the cluster. Without one, the checkout's that this add-on is of, or the one on the path",
        subtype="FILE_PATH",
    )

    def draw(self, context: bpy.types.Context) -> None:
        try:
            engine = load()
        except GlimmerError as error:
            draw_wrapped(self.layout, context, str(error), "ERROR")
            return
        draw_wrapped(self.layout, context, f"Glimmer {engine.version()}: {engine.build_info()}", "CHECKMARK")
        glibc = ".".join(map(str, machine.GLIBC))
        draw_wrapped(self.layout, context, f"For Linux with glibc {glibc} or later, on x86-64 with AVX2", "BLANK1")
        column = self.layout.column(heading="Render on Cluster")
        column.use_property_split = True
        column.prop(self, "scheduler")
        column.prop(self, "farm_command")


class GlimmerNotice(bpy.types.AddonPreferences):
    """In their place, of a package that does nothing."""

    bl_idname = ADDON
    text = ""

    def draw(self, context: bpy.types.Context) -> None:
        draw_wrapped(self.layout, context, self.text, "ERROR")


def register_notice(text: str) -> None:
    GlimmerNotice.text = text
    bpy.utils.register_class(GlimmerNotice)


def register() -> None:
    bpy.utils.register_class(GlimmerPreferences)


def unregister() -> None:
    for cls in (GlimmerPreferences, GlimmerNotice):
        if cls.is_registered:
            bpy.utils.unregister_class(cls)
