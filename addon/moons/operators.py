# SPDX-License-Identifier: GPL-3.0-or-later
"""Add > Glimmer > Moon, and Five Moons."""

from typing import Any

import bpy

from .camera import eye_of, is_seen, upright
from .framing import frame, look_pitch, stand
from .ground import field_points, floor_below
from .moon import FIVE_MOONS, Moon, create


class GLIMMER_OT_add_moon(bpy.types.Operator):
    """Add an opaque sphere that shines evenly in all directions"""

    bl_idname = "glimmer.add_moon"
    bl_label = "Moon"
    bl_options = {"REGISTER", "UNDO"}

    radius: bpy.props.FloatProperty(  # type: ignore[valid-type]
        name="Radius", default=1.0, min=1e-4, soft_max=100, unit="LENGTH"
    )
    color: bpy.props.FloatVectorProperty(  # type: ignore[valid-type]
        name="Color", subtype="COLOR", size=3, default=(1.0, 0.93, 0.82), min=0.0, max=1.0
    )
    radiance: bpy.props.FloatProperty(  # type: ignore[valid-type]
        name="Strength",
        description="Radiance of the moon times its colour, in W/(m² sr)",
        default=20.0,
        min=0.0,
        soft_max=1000.0,
    )

    @classmethod
    def poll(cls, context: Any) -> bool:
        return context.mode == "OBJECT"

    def execute(self, context: Any) -> set[str]:
        moon = Moon("Moon", tuple(self.color), self.radiance, self.radius, tuple(context.scene.cursor.location))
        _select(context, [create(moon, context.collection)])
        return {"FINISHED"}


class GLIMMER_OT_add_five_moons(bpy.types.Operator):
    """Add the red, the green, the white, the blue and the black moon above the horizon that the camera looks to"""

    bl_idname = "glimmer.add_five_moons"
    bl_label = "Five Moons"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: Any) -> bool:
        return context.mode == "OBJECT"

    aim_camera: bpy.props.BoolProperty(  # type: ignore[valid-type]
        name="Place Camera",
        description=(
            "Where the scene's camera does not see all of the moons, turn it to them, upright, and take it down to "
            "look over the hexagon field, or over what is under it, so that the picture holds both"
        ),
        default=True,
    )

    def execute(self, context: Any) -> set[str]:
        scene, camera = context.scene, context.scene.camera
        if camera is None or camera.type != "CAMERA" or camera.data.type != "PERSP":
            _select(context, [create(moon, context.collection) for moon in FIVE_MOONS])
            return {"FINISHED"}
        # Before anything is created: what stands where is known after an evaluation alone.
        context.view_layer.update()
        eye = eye_of(scene, camera)
        moons = frame(FIVE_MOONS, eye)
        if self.aim_camera and not all(is_seen(scene, camera, moon.location) for moon in moons):
            if camera.constraints or (camera.animation_data is not None and camera.animation_data.action is not None):
                self.report({"WARNING"}, f"{camera.name} is animated or constrained and was not turned to the moons")
            else:
                eye = stand(eye, field_points(context.view_layer), floor_below(context, eye.location))
                moons = frame(FIVE_MOONS, eye)
                camera.matrix_world = upright(eye.location, eye.heading, look_pitch(eye))
        _select(context, [create(moon, context.collection) for moon in moons])
        return {"FINISHED"}


def _select(context: Any, objects: list[Any]) -> None:
    for other in context.selected_objects:
        other.select_set(False)
    for obj in objects:
        obj.select_set(True)
    context.view_layer.objects.active = objects[0]


_CLASSES = (GLIMMER_OT_add_moon, GLIMMER_OT_add_five_moons)

register, unregister = bpy.utils.register_classes_factory(_CLASSES)
