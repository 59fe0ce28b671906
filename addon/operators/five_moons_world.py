# SPDX-License-Identifier: GPL-3.0-or-later
"""Add > Glimmer > World of Five Moons: a picture to begin with, in one step."""

import math
from typing import Any

import bpy


class GLIMMER_OT_add_world(bpy.types.Operator):
    """Add a hexagon field under five moons in haze, and turn the camera to them"""

    bl_idname = "glimmer.add_world"
    bl_label = "World of Five Moons"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: Any) -> bool:
        return context.mode == "OBJECT"

    def execute(self, context: Any) -> set[str]:
        scene = context.scene
        if scene.camera is None:
            camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
            camera.location, camera.rotation_euler = (0.0, -20.0, 5.0), (0.45 * math.pi, 0.0, 0.0)
            context.collection.objects.link(camera)
            scene.camera = camera
        bpy.ops.glimmer.add_hexagon_field(rings=40)
        bpy.ops.glimmer.add_five_moons()
        bpy.ops.glimmer.add_haze()
        return {"FINISHED"}


def register() -> None:
    bpy.utils.register_class(GLIMMER_OT_add_world)


def unregister() -> None:
    bpy.utils.unregister_class(GLIMMER_OT_add_world)
