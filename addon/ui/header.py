# SPDX-License-Identifier: GPL-3.0-or-later
"""In the header of a 3D view."""

from typing import Any

import bpy

from .compatible import ENGINE


def _draw_pause(self: Any, context: bpy.types.Context) -> None:
    if context.engine == ENGINE and context.space_data.shading.type == "RENDERED":
        settings = context.scene.glimmer
        self.layout.prop(settings, "preview_pause", icon="PLAY" if settings.preview_pause else "PAUSE", text="")


def register() -> None:
    bpy.types.VIEW3D_HT_header.append(_draw_pause)


def unregister() -> None:
    bpy.types.VIEW3D_HT_header.remove(_draw_pause)
