# SPDX-License-Identifier: GPL-3.0-or-later
"""Add > Light > Glimmer Moon and Glimmer Five Moons."""

from typing import Any

import bpy

from .camera import eye_of, is_seen, upright
from .framing import frame
from .moon import FIVE_MOONS, Moon, create


class GLIMMER_OT_add_moon(bpy.types.Operator):
    """Add an opaque sphere that shines evenly in all directions"""

    bl_idname = "glimmer.add_moon"
    bl_label = "Glimmer Moon"
    bl_options = {"REGISTER", "UNDO"}

    radius: bpy.props.FloatProperty(  # type: ignore[valid-type]
        name="Radius", default=1.0, min=1e-4, soft_max=100, unit="LENGTH"
    )
    color: bpy.props.FloatVectorProperty(  # type: ignore[valid-type]
        name="Color", subtype="COLOR", size=3, default=(1.0, 0.93, 0.82), min=0.0, max=1.0
    )
    radiance: bpy.props.FloatProperty(  # type: ignore[valid-type]
        name="Radiance", description="Of white, in W/(m² sr)", default=20.0, min=0.0, soft_max=1000.0
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
    bl_label = "Glimmer Five Moons"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: Any) -> bool:
        return context.mode == "OBJECT"

    aim_camera: bpy.props.BoolProperty(  # type: ignore[valid-type]
        name="Turn Camera",
        description="Turn the scene's camera upright and up to the moons where it does not see all of them",
        default=True,
    )

    def execute(self, context: Any) -> set[str]:
        camera = context.scene.camera
        if camera is None or camera.type != "CAMERA" or camera.data.type != "PERSP":
            _select(context, [create(moon, context.collection) for moon in FIVE_MOONS])
            return {"FINISHED"}
        # Before anything is created: that waits for the next evaluation.
        moons, pitch = frame(FIVE_MOONS, eye_of(context.scene, camera))
        unseen = [moon.name for moon in moons if not is_seen(context.scene, camera, moon.location)]
        _select(context, [create(moon, context.collection) for moon in moons])
        if unseen and self.aim_camera:
            if camera.constraints or (camera.animation_data is not None and camera.animation_data.action is not None):
                self.report({"WARNING"}, f"{camera.name} is animated or constrained and was not turned to the moons")
            else:
                heading = eye_of(context.scene, camera).heading
                camera.matrix_world = upright(tuple(camera.matrix_world.translation), heading, pitch)
        return {"FINISHED"}


def _select(context: Any, objects: list[Any]) -> None:
    for other in context.selected_objects:
        other.select_set(False)
    for obj in objects:
        obj.select_set(True)
    context.view_layer.objects.active = objects[0]


_CLASSES = (GLIMMER_OT_add_moon, GLIMMER_OT_add_five_moons)


def _draw_menu(self: Any, _context: Any) -> None:
    self.layout.separator()
    self.layout.operator(GLIMMER_OT_add_moon.bl_idname, icon="SPHERE")
    self.layout.operator(GLIMMER_OT_add_five_moons.bl_idname, icon="SPHERE")


def register() -> None:
    for cls in _CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.VIEW3D_MT_light_add.append(_draw_menu)


def unregister() -> None:
    bpy.types.VIEW3D_MT_light_add.remove(_draw_menu)
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
