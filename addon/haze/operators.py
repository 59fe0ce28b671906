# SPDX-License-Identifier: GPL-3.0-or-later
"""Add > Glimmer > Haze, which is also a button in the world's properties."""

from typing import Any

import bpy

from . import nodes
from .properties import FARTHEST
from .visual_range import density

VISUAL_RANGE = 500.0


class GLIMMER_OT_add_haze(bpy.types.Operator):
    """Fill the world with haze that one sees some distance through. Lamps and whatever shines must stand inside: the
    sky and suns are endlessly far away"""

    bl_idname = "glimmer.add_haze"
    bl_label = "Haze"
    bl_options = {"REGISTER", "UNDO"}

    visual_range: bpy.props.FloatProperty(  # type: ignore[valid-type]
        name="Visual Range",
        description="How far away a dark object can still be told from the haze",
        default=VISUAL_RANGE,
        min=0.01,
        max=FARTHEST,
        soft_min=1.0,
        soft_max=10000.0,
        unit="LENGTH",
    )
    color: bpy.props.FloatVectorProperty(  # type: ignore[valid-type]
        name="Color",
        description="How much of each colour the haze scatters; it absorbs the rest",
        subtype="COLOR",
        size=3,
        default=(0.85, 0.88, 0.92),
        min=0.0,
        max=1.0,
    )
    anisotropy: bpy.props.FloatProperty(  # type: ignore[valid-type]
        name="Anisotropy",
        description="0: light is scattered to all sides; towards 1: it mostly goes on, with glows around what shines",
        default=0.3,
        min=-0.99,
        max=0.99,
    )

    def execute(self, context: Any) -> set[str]:
        world = context.scene.world
        if world is None:
            world = context.scene.world = bpy.data.worlds.new("World")
        if world.library is not None:
            self.report({"ERROR"}, f"World {world.name} is linked from another file: make it local first")
            return {"CANCELLED"}
        nodes.add(world, density(self.visual_range), tuple(self.color), self.anisotropy)
        return {"FINISHED"}


def register() -> None:
    bpy.utils.register_class(GLIMMER_OT_add_haze)


def unregister() -> None:
    bpy.utils.unregister_class(GLIMMER_OT_add_haze)
