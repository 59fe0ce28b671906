# SPDX-License-Identifier: GPL-3.0-or-later
"""Add > Glimmer > Glimmer World: field, moons, haze and camera of a preset, in one step."""

from math import pi, radians
from typing import Any

import bpy
import numpy as np

from ..haze import nodes
from ..haze.visual_range import density
from ..hexfield import field
from ..hexfield.materials import default_materials
from ..hexfield.parameters import FieldParameters
from ..moons import orbit
from ..moons.camera import upright
from ..moons.kepler import through
from ..moons.moon import Moon, create
from .presets import PRESETS, Preset, PresetMoon

_SECTOR = radians(150.0)  # of the field, about the look


class GLIMMER_OT_add_glimmer_world(bpy.types.Operator):
    """Add a whole world: plates to the horizon of a planet, moons on orbits, haze, and a camera that sees them"""

    bl_idname = "glimmer.add_glimmer_world"
    bl_label = "Glimmer World"
    bl_options = {"REGISTER", "UNDO"}

    preset: bpy.props.EnumProperty(  # type: ignore[valid-type]
        name="Preset",
        description="What the world is like",
        items=[(key, preset.label, preset.help) for key, preset in PRESETS.items()],
    )
    seed: bpy.props.IntProperty(  # type: ignore[valid-type]
        name="Seed", description="Another number, other hills", min=0, soft_max=1000
    )
    plate_radius: bpy.props.FloatProperty(  # type: ignore[valid-type]
        name="Plate Radius",
        description="Half the size of a plate, more of them for smaller ones",
        default=1.0,
        min=0.25,
        max=10.0,
        unit="LENGTH",
    )
    is_moving: bpy.props.BoolProperty(  # type: ignore[valid-type]
        name="Orbits", description="Moons run on orbits; else they stand still", default=True
    )

    @classmethod
    def poll(cls, context: Any) -> bool:
        return context.mode == "OBJECT"

    def execute(self, context: Any) -> set[str]:
        scene, preset = context.scene, PRESETS[self.preset]
        if scene.world is not None and scene.world.library is not None:
            self.report({"ERROR"}, f"World {scene.world.name} is linked from another file: make it local first")
            return {"CANCELLED"}
        collection = bpy.data.collections.new(preset.label)
        scene.collection.children.link(collection)
        land = field.create(
            "Hexagon Field",
            _parameters(preset, self.seed, self.plate_radius),
            *default_materials(),
            collection=collection,
        )
        eye = (0.0, 0.0, ground_height(land) + preset.eye_height)
        for moon in preset.moons:
            _add_moon(moon, preset, eye, self.is_moving, collection)
        _set_haze(scene, preset)
        _set_camera(scene, preset, eye, collection)
        scene.frame_set(preset.frame)
        for other in context.selected_objects:
            other.select_set(False)
        land.select_set(True)
        context.view_layer.objects.active = land
        return {"FINISHED"}


def _parameters(preset: Preset, seed: int, plate_radius: float) -> FieldParameters:
    land = dict(preset.land)
    return FieldParameters(
        **{
            "extent": "RADIUS",
            "radius": preset.reach(),
            "sector": _SECTOR,
            "planet_radius": preset.planet_radius,
            "hill_height": preset.hill_height,
            "thickness": 1.6 * plate_radius,
            "bevel_width": 0.14 * plate_radius,
            "bevel_segments": 4,
            "plate_radius": plate_radius,
            **land,
            "seed": land.get("seed", 0) + seed,
        }
    )


def ground_height(land: Any, near: float = 8.0) -> float:
    """Of the highest plate near the origin of a field, in its own space; 0 where there is none."""
    points = np.empty(3 * len(land.data.vertices), np.float32)
    land.data.vertices.foreach_get("co", points)
    x, y, z = points.reshape(-1, 3).T
    return float(z[np.hypot(x, y) < near].max(initial=0.0))


def _add_moon(moon: PresetMoon, preset: Preset, eye: tuple[float, ...], is_moving: bool, collection: Any) -> None:
    place = moon.place((eye[0], eye[1], eye[2]))
    obj = create(Moon(moon.name, moon.color, moon.strength, moon.radius(), place, moon.surface), collection)
    if is_moving:
        path = through(place, preset.frame, moon.period, (eye[0], eye[1], eye[2]), moon.eccentricity, moon.is_eastward)
        orbit.put_on_orbit(obj, path)


def _set_haze(scene: Any, preset: Preset) -> None:
    if scene.world is None:
        scene.world = bpy.data.worlds.new("World")
    world = scene.world
    nodes.add(world, density(preset.visual_range), preset.haze_color, preset.anisotropy)
    background = next((node for node in world.node_tree.nodes if node.type == "BACKGROUND"), None)
    if background is not None:  # an even sky of before would outshine all moons
        background.inputs["Color"].default_value = (0.0, 0.0, 0.0, 1.0)


def _set_camera(scene: Any, preset: Preset, eye: tuple[float, ...], collection: Any) -> None:
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.data.sensor_fit, camera.data.angle = "HORIZONTAL", radians(58.0)
    camera.data.clip_start, camera.data.clip_end = 0.1, 1e5
    camera.matrix_world = upright((eye[0], eye[1], eye[2]), 0.0, preset.pitch * pi / 180.0)
    collection.objects.link(camera)
    scene.camera = camera
    scene.view_settings.exposure = preset.exposure


def register() -> None:
    bpy.utils.register_class(GLIMMER_OT_add_glimmer_world)


def unregister() -> None:
    bpy.utils.unregister_class(GLIMMER_OT_add_glimmer_world)
