# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks of orbits, surfaces of moons and whole worlds, run by hexfield_checks.py."""

import math
import tempfile
from pathlib import Path
from typing import Any

import bpy
import numpy as np
from addon_parts import load


def orbits_are_keplers_everywhere() -> None:
    """In playback, in what an engine sees of an animation, between frames and after reopening: within float32."""
    orbit, moon, kepler = load("moons.orbit"), load("moons.moon"), load("moons.kepler")
    scene = bpy.context.scene
    path = kepler.Orbit((1.0, 2.0, 3.0), 20.0, 0.7, 30.0, 0.5, 0.3, 1.1, 0.7)
    obj = moon.create(moon.Moon("Moon", (1.0, 1.0, 1.0), 5.0, 1.0), scene.collection)
    orbit.put_on_orbit(obj, path)
    read = orbit.read(obj)
    drivers = obj.animation_data.drivers
    assert len(drivers) == 7
    assert all(driver.driver.is_valid and driver.driver.is_simple_expression for driver in drivers)

    def check(frame: float, place: Any) -> None:
        assert np.abs(np.array(place) - read.place(frame)).max() < 2e-4, (frame, place, read.place(frame))

    for frame in (1, 7, 16, 29, 45):
        scene.frame_set(frame)
        check(frame, obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).matrix_world.translation)
    scene.frame_set(8, subframe=0.5)
    check(8.5, obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).matrix_world.translation)
    seen: dict[int, tuple[float, ...]] = {}

    class Watcher(bpy.types.RenderEngine):
        bl_idname, bl_label = "GLIMMER_WATCHER", "Watcher"

        def update(self, _data: Any, depsgraph: Any) -> None:
            for source in depsgraph.objects:
                if source.name == "Moon":
                    seen[depsgraph.scene.frame_current] = tuple(source.matrix_world.translation)

        def render(self, _depsgraph: Any) -> None:
            self.end_result(self.begin_result(0, 0, 8, 8))

    scene.camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    scene.collection.objects.link(scene.camera)
    scene.render.resolution_x = scene.render.resolution_y = 8
    scene.frame_start, scene.frame_end = 3, 6
    bpy.utils.register_class(Watcher)
    try:
        scene.render.engine = Watcher.bl_idname
        with tempfile.TemporaryDirectory() as folder:
            scene.render.filepath = str(Path(folder) / "frame")
            bpy.ops.render.render(animation=True)
    finally:
        scene.render.engine = "CYCLES"
        bpy.utils.unregister_class(Watcher)
    assert set(seen) == {3, 4, 5, 6}
    for frame, place in seen.items():
        check(frame, place)
    with tempfile.TemporaryDirectory() as folder:
        file = str(Path(folder) / "orbit.blend")
        bpy.ops.wm.save_as_mainfile(filepath=file)
        bpy.ops.wm.open_mainfile(filepath=file, use_scripts=False)
    bpy.context.scene.frame_set(22)
    obj = bpy.data.objects["Moon"]
    check(22, obj.matrix_world.translation)
    obj.glimmer_orbit.period = 60.0
    bpy.context.view_layer.update()
    read = orbit.read(obj)
    check(22, obj.matrix_world.translation)
    place = tuple(obj.location)
    orbit.take_off_orbit(obj)
    bpy.context.scene.frame_set(5)
    assert tuple(obj.location) == place and not obj.glimmer_orbit.enabled and not len(obj.animation_data.drivers)


def moons_have_surfaces() -> None:
    """Each kind keeps a moon's colour and place among moons; the sliders of what differs are the new node's inputs."""
    moon = load("moons.moon")
    assert bpy.ops.glimmer.add_moon(radius=2.0, color=(1.0, 0.5, 0.25), radiance=7.0) == {"FINISHED"}
    obj = bpy.context.object
    for kind, inputs in (
        ("GLOWING", {"Color", "Strength", "Craters", "Crater Scale"}),
        ("LIT", {"Color", "Craters", "Crater Scale"}),
        ("BLACK", {"Color", "Strength", "Rim"}),
        ("EVEN", {"Color", "Strength"}),
    ):
        assert bpy.ops.glimmer.set_moon_surface(kind=kind) == {"FINISHED"}
        node = moon.emission_node(obj)
        assert {socket.name for socket in node.inputs if socket.enabled and socket.name != "Weight"} == inputs
        assert np.allclose(node.inputs["Color"].default_value, (1.0, 0.5, 0.25, 1.0))
        output = obj.active_material.node_tree.get_output_node("CYCLES")
        assert output.inputs["Surface"].links[0].from_node == node
    assert len([group for group in bpy.data.node_groups if "glimmer_moon_surface" in group]) == 3
    bpy.context.scene.frame_set(10)
    before = tuple(obj.location)
    bpy.context.scene.cursor.location = (5.0, 6.0, -7.0)
    assert bpy.ops.glimmer.put_on_orbit(period=40.0) == {"FINISHED"}
    bpy.context.view_layer.update()
    assert np.abs(np.array(obj.matrix_world.translation) - before).max() < 1e-4
    assert not bpy.ops.glimmer.put_on_orbit.poll()
    assert bpy.ops.glimmer.take_off_orbit() == {"FINISHED"}


def worlds_come_whole() -> None:
    """Every preset: plates to the horizon, its moons in the picture at its frame, haze, a camera over the ground."""
    presets = load("worlds.presets").PRESETS
    is_seen = load("moons.camera").is_seen
    emission_node = load("moons.moon").emission_node
    for key, preset in presets.items():
        bpy.ops.wm.read_factory_settings(use_empty=True)
        assert bpy.ops.glimmer.add_glimmer_world(preset=key, plate_radius=4.0) == {"FINISHED"}
        scene = bpy.context.scene
        bpy.context.view_layer.update()
        moons = [obj for obj in scene.objects if emission_node(obj) is not None]
        assert len(moons) == len(preset.moons) and scene.frame_current == preset.frame
        for moon in moons:
            assert is_seen(scene, scene.camera, tuple(moon.matrix_world.translation)), (key, moon.name)
        assert load("haze.nodes").node_of(scene.world) is not None
        land = next(obj for obj in scene.objects if obj.type == "MESH" and obj.glimmer_field.enabled)
        values = np.empty(3 * len(land.data.vertices), np.float32)
        land.data.vertices.foreach_get("co", values)
        points = values.reshape(-1, 3)
        eye = np.array(scene.camera.matrix_world.translation)
        assert points[np.hypot(points[:, 0], points[:, 1]) < 8.0, 2].max() < eye[2]
        # The far end of the field lies below the horizon, which no plate beyond it could rise over.
        far = points[np.hypot(points[:, 0], points[:, 1]) > 0.97 * preset.reach()]
        dip = math.sqrt(2.0 * eye[2] / preset.planet_radius)
        highest = (far[:, 2] - eye[2]) / np.hypot(far[:, 0], far[:, 1])
        assert highest.max() < -0.3 * dip, (key, highest.max(), dip)
        first = [tuple(moon.matrix_world.translation) for moon in moons]
        scene.frame_set(preset.frame + 40)
        for place, moon in zip(first, moons, strict=True):
            assert np.linalg.norm(np.array(place) - moon.matrix_world.translation) > 1.0


def cameras_find_their_views() -> None:
    assert bpy.ops.glimmer.add_glimmer_world(preset="CONVERGENCE", plate_radius=4.0) == {"FINISHED"}
    scene, camera = bpy.context.scene, bpy.context.scene.camera
    emission_node, is_seen = load("moons.moon").emission_node, load("moons.camera").is_seen
    camera.rotation_euler = (1.2, 0.0, 2.5)
    bpy.context.view_layer.update()
    assert bpy.ops.glimmer.best_view() == {"FINISHED"}
    bpy.context.view_layer.update()
    for moon in (obj for obj in scene.objects if emission_node(obj) is not None):
        assert is_seen(scene, camera, tuple(moon.matrix_world.translation)), moon.name
    scene.frame_start, scene.frame_end = 1, 31
    assert bpy.ops.glimmer.fly_over(length=60.0, height=5.0) == {"FINISHED"}
    points = load("moons.ground").field_points(bpy.context.view_layer)
    places = []
    for frame in (1, 16, 31):
        scene.frame_set(frame)
        places.append(np.array(camera.matrix_world.translation))
        near = np.hypot(*(points - places[-1])[:, :2].T) < 4.0
        assert places[-1][2] > points[near, 2].max()
    assert math.isclose(np.linalg.norm((places[2] - places[0])[:2]), 60.0, rel_tol=1e-4)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.location = (3.0, 4.0, 2.0)
    scene.collection.objects.link(camera)
    scene.camera, scene.frame_start, scene.frame_end = camera, 1, 40
    scene.frame_set(1)
    assert bpy.ops.glimmer.orbit_camera() == {"FINISHED"}
    for frame, place in ((1, (3.0, 4.0, 2.0)), (11, (-4.0, 3.0, 2.0)), (21, (-3.0, -4.0, 2.0))):
        scene.frame_set(frame)
        matrix = camera.evaluated_get(bpy.context.evaluated_depsgraph_get()).matrix_world
        assert np.abs(np.array(matrix.translation) - place).max() < 1e-4, (frame, matrix.translation)
        look = -np.array(matrix)[:3, 2]
        assert np.abs(look + np.array(place) / np.linalg.norm(place)).max() < 1e-4
