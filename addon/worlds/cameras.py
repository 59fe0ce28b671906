# SPDX-License-Identifier: GPL-3.0-or-later
"""Camera helpers: the best view of the moons, a flight over the field, and an orbit around the cursor."""

from dataclasses import replace
from math import asin, atan2, hypot, pi
from typing import Any

import bpy
import numpy as np

from ..moons import orbit
from ..moons.camera import eye_of, upright
from ..moons.framing import look_pitch, stand
from ..moons.ground import field_points, floor_below
from ..moons.kepler import Orbit
from ..moons.moon import emission_node
from .views import Light, best_heading, flight

_STOPS = 16


def _camera(context: Any) -> Any:
    """The scene's camera, or a new one."""
    scene = context.scene
    if scene.camera is None or scene.camera.type != "CAMERA":
        camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
        camera.location = scene.cursor.location
        camera.location.z += 4.0
        context.collection.objects.link(camera)
        scene.camera = camera
        context.view_layer.update()
    return scene.camera


class _CameraOperator:
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: Any) -> bool:
        camera = context.scene.camera
        return context.mode == "OBJECT" and (camera is None or camera.library is None)


class GLIMMER_OT_best_view(_CameraOperator, bpy.types.Operator):
    """Turn the scene's camera, where it stands, to most of the moons, low over the ground, with the horizon in the
    lower half of the picture"""

    bl_idname = "glimmer.best_view"
    bl_label = "Best View"

    def execute(self, context: Any) -> set[str]:
        camera = _camera(context)
        if camera.data.type != "PERSP":
            self.report({"ERROR"}, f"{camera.name} has no perspective")
            return {"CANCELLED"}
        if camera.constraints or (camera.animation_data is not None and camera.animation_data.action is not None):
            self.report({"ERROR"}, f"{camera.name} is animated or constrained")
            return {"CANCELLED"}
        eye = eye_of(context.scene, camera)
        moons = [_seen(obj, eye.location) for obj in context.view_layer.objects if emission_node(obj) is not None]
        heading = best_heading(moons, eye.half_width) if moons else eye.heading
        eye = replace(eye, heading=heading)
        eye = stand(eye, field_points(context.view_layer), floor_below(context, eye.location))
        pitch = look_pitch(eye)
        # The highest moon within the picture's width stays in it, if the horizon can as well.
        tops = [
            moon.elevation + 1.2 * moon.radius
            for moon in moons
            if abs((moon.azimuth - heading + pi) % (2.0 * pi) - pi) < eye.half_width
        ]
        pitch = min(max(pitch, max(tops, default=0.0) - eye.half_height), 0.9 * eye.half_height)
        camera.matrix_world = upright(eye.location, heading, pitch)
        return {"FINISHED"}


def _seen(obj: Any, eye: tuple[float, float, float]) -> Light:
    x, y, z = (a - b for a, b in zip(obj.matrix_world.translation, eye, strict=True))
    distance = max(hypot(x, y, z), 1e-6)
    radius = max(abs(value) for value in obj.matrix_world.to_scale())
    return Light(atan2(-x, y), atan2(z, hypot(x, y)), asin(min(radius / distance, 1.0)))


class GLIMMER_OT_fly_over(_CameraOperator, bpy.types.Operator):
    """Let the scene's camera fly straight ahead over the field, from the scene's first frame to its last"""

    bl_idname = "glimmer.fly_over"
    bl_label = "Fly Over"

    length: bpy.props.FloatProperty(  # type: ignore[valid-type]
        name="Length", description="How far it flies", default=100.0, min=0.01, soft_max=1000.0, unit="LENGTH"
    )
    height: bpy.props.FloatProperty(  # type: ignore[valid-type]
        name="Height", description="Above the highest plates near its way", default=4.0, min=0.0, unit="LENGTH"
    )

    def execute(self, context: Any) -> set[str]:
        camera, scene = _camera(context), context.scene
        if camera.glimmer_orbit.enabled or camera.constraints:
            self.report({"ERROR"}, f"{camera.name} is constrained or on an orbit")
            return {"CANCELLED"}
        eye = eye_of(scene, camera)
        places = flight(
            np.array(eye.location),
            eye.heading,
            self.length,
            self.height,
            field_points(context.view_layer),
            _STOPS,
            max(self.height, 0.6 * self.length / _STOPS),
        )
        frames = np.linspace(scene.frame_start, max(scene.frame_end, scene.frame_start + 1), _STOPS)
        for frame, place in zip(frames, places, strict=True):
            camera.location = place
            camera.keyframe_insert("location", frame=float(frame))
        scene.frame_set(scene.frame_current)
        return {"FINISHED"}


class GLIMMER_OT_orbit_camera(_CameraOperator, bpy.types.Operator):
    """Let the scene's camera run around the 3D cursor and look at it, once from the scene's first frame to its last"""

    bl_idname = "glimmer.orbit_camera"
    bl_label = "Orbit Cursor"

    def execute(self, context: Any) -> set[str]:
        camera, scene = _camera(context), context.scene
        cursor = scene.cursor.location
        x, y, z = camera.matrix_world.translation - cursor
        if hypot(x, y) < 1e-3:
            self.report({"ERROR"}, f"{camera.name} stands over the 3D cursor: move one of them aside")
            return {"CANCELLED"}
        if camera.animation_data is not None and camera.animation_data.action is not None:
            self.report({"ERROR"}, f"{camera.name} is animated")
            return {"CANCELLED"}
        period = float(scene.frame_end - scene.frame_start + 1)
        start = scene.frame_start / period % 1.0
        path = Orbit(
            center=(cursor.x, cursor.y, cursor.z + z),
            semi_axis=hypot(x, y),
            period=period,
            phase=atan2(y, x) - 2.0 * pi * start,
        )
        orbit.put_on_orbit(camera, path)
        if not any(constraint.type == "TRACK_TO" for constraint in camera.constraints):
            target = bpy.data.objects.new("Camera Target", None)
            target.location = cursor
            context.collection.objects.link(target)
            constraint = camera.constraints.new("TRACK_TO")
            constraint.target, constraint.track_axis, constraint.up_axis = target, "TRACK_NEGATIVE_Z", "UP_Y"
        return {"FINISHED"}


_CLASSES = (GLIMMER_OT_best_view, GLIMMER_OT_fly_over, GLIMMER_OT_orbit_camera)

register, unregister = bpy.utils.register_classes_factory(_CLASSES)
