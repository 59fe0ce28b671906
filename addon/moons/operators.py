# SPDX-License-Identifier: GPL-3.0-or-later
"""Add > Glimmer > Moon, and Five Moons; surfaces and orbits of moons."""

from typing import Any

import bpy

from . import orbit
from .camera import eye_of, is_seen, upright
from .framing import frame, look_pitch, stand
from .ground import field_points, floor_below
from .kepler import through
from .moon import FIVE_MOONS, Moon, create, emission_node, set_surface


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


class GLIMMER_OT_set_moon_surface(bpy.types.Operator):
    """Give the moon another surface"""

    bl_idname = "glimmer.set_moon_surface"
    bl_label = "Surface"
    bl_options = {"REGISTER", "UNDO"}

    kind: bpy.props.EnumProperty(  # type: ignore[valid-type]
        name="Surface",
        description="What the moon looks like",
        items=(
            ("EVEN", "Even", "An even light, which Glimmer traces as a true sphere"),
            ("GLOWING", "Glowing", "A light with craters and dark seas"),
            ("LIT", "Lit", "Craters and seas that other lights fall on: it has phases"),
            ("BLACK", "Black", "It swallows all light but for a faint rim"),
        ),
    )

    @classmethod
    def poll(cls, context: Any) -> bool:
        return emission_node(context.object) is not None and context.object.active_material.library is None

    def execute(self, context: Any) -> set[str]:
        set_surface(context.object, self.kind)
        return {"FINISHED"}


class GLIMMER_OT_put_on_orbit(bpy.types.Operator):
    """Let the object run around the 3D cursor, on a circle through its place and its highest point. Drivers that need
    no scripts hold it there, in playback and in every render"""

    bl_idname = "glimmer.put_on_orbit"
    bl_label = "Put on an Orbit"
    bl_options = {"REGISTER", "UNDO"}

    period: bpy.props.FloatProperty(  # type: ignore[valid-type]
        name="Period", description="Frames for once around", default=250.0, min=1e-3, soft_max=10000.0
    )

    @classmethod
    def poll(cls, context: Any) -> bool:
        obj = context.object
        return obj is not None and obj.library is None and not obj.glimmer_orbit.enabled

    def execute(self, context: Any) -> set[str]:
        obj, scene = context.object, context.scene
        path = through(tuple(obj.location), scene.frame_current, self.period, tuple(scene.cursor.location))
        orbit.put_on_orbit(obj, path)
        return {"FINISHED"}


class GLIMMER_OT_take_off_orbit(bpy.types.Operator):
    """Take the object off its orbit; it stays where it is"""

    bl_idname = "glimmer.take_off_orbit"
    bl_label = "Take off the Orbit"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: Any) -> bool:
        return context.object is not None and context.object.glimmer_orbit.enabled

    def execute(self, context: Any) -> set[str]:
        orbit.take_off_orbit(context.object)
        return {"FINISHED"}


def _select(context: Any, objects: list[Any]) -> None:
    for other in context.selected_objects:
        other.select_set(False)
    for obj in objects:
        obj.select_set(True)
    context.view_layer.objects.active = objects[0]


_CLASSES = (
    GLIMMER_OT_add_moon,
    GLIMMER_OT_add_five_moons,
    GLIMMER_OT_set_moon_surface,
    GLIMMER_OT_put_on_orbit,
    GLIMMER_OT_take_off_orbit,
)

register, unregister = bpy.utils.register_classes_factory(_CLASSES)
