# SPDX-License-Identifier: GPL-3.0-or-later

import bpy

from ..callbacks import of_group_and
from ..film.passes import OPTIONAL


def _update_passes(group: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    """The compositor's sockets follow the switches."""
    context.view_layer.update_render_passes()


_on_change = of_group_and(_update_passes)


class GlimmerViewLayerSettings(bpy.types.PropertyGroup):
    """The switches of the passes that Blender has none for, made from the table of passes."""

    __annotations__ = {
        item.switch: bpy.props.BoolProperty(
            name=item.short_name, description=item.help, default=False, update=_on_change
        )
        for item in OPTIONAL
        if item.is_ours
    }
