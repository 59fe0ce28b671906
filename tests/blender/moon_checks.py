# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks of where moons and the camera go, run by hexfield_checks.py."""

import math
import types
from typing import Any

import bpy
import numpy as np
from addon_parts import load
from bpy_extras.object_utils import world_to_camera_view
from mathutils import Vector


def five_moons_are_in_the_picture() -> None:
    """In the camera of a new file, in a portrait one, in one that looks straight down, and in one that sees them."""
    camera_module = load("moons.camera")
    scene = bpy.context.scene
    camera = scene.camera or bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    if scene.camera is None:
        scene.collection.objects.link(camera)
        scene.camera = camera
    default = (7.3589, -6.9258, 4.9583), (1.1093, 0.0, 0.8149)
    size = scene.render.resolution_x, scene.render.resolution_y
    for (place, turn), lens, portrait in (
        (default, 50.0, False),
        (default, 85.0, True),
        (((3.0, 2.0, 9.0), (0.0, 0.0, 1.0)), 50.0, False),
    ):
        camera.location, camera.rotation_euler, camera.data.lens = place, turn, lens
        scene.render.resolution_x, scene.render.resolution_y = size[::-1] if portrait else size
        bpy.context.view_layer.update()
        heading = camera_module.eye_of(scene, camera).heading
        assert bpy.ops.glimmer.add_five_moons() == {"FINISHED"}
        bpy.context.view_layer.update()
        for moon in bpy.context.selected_objects:
            assert camera_module.is_seen(scene, camera, tuple(moon.location)), (moon.name, lens)
            assert moon.location.z - moon.scale.z > camera.location.z - 1.0, "it stands under the horizon"
        assert max(abs(a - b) for a, b in zip(camera.location[:2], place[:2], strict=True)) < 1e-5
        assert camera.location.z <= place[2]
        assert abs(camera_module.eye_of(scene, camera).heading - heading) < 1e-5
    turned = camera.matrix_world.copy()
    assert bpy.ops.glimmer.add_five_moons() == {"FINISHED"}  # it sees them already
    bpy.context.view_layer.update()
    assert camera.matrix_world == turned
    camera.rotation_euler = (1.1093, 0.0, 0.8149)
    bpy.context.view_layer.update()
    before = camera.matrix_world.copy()
    assert bpy.ops.glimmer.add_five_moons(aim_camera=False) == {"FINISHED"}
    bpy.context.view_layer.update()
    assert camera.matrix_world == before
    scene.render.resolution_x, scene.render.resolution_y = size
    bpy.ops.object.select_all(action="DESELECT")


def a_new_file_shows_field_and_moons() -> None:
    """By the README's first steps, in either order; and small, raised or hilly fields too."""
    add_field, add_moons = bpy.ops.glimmer.add_hexagon_field, bpy.ops.glimmer.add_five_moons
    for steps in ((add_field, add_moons), (add_moons, add_field)):
        bpy.ops.wm.read_factory_settings()
        for step in steps:
            assert step() == {"FINISHED"}
        _assert_field_and_moons_are_seen()
    small = {"plate_radius": 0.2, "gap": 0.01, "thickness": 0.1, "bevel_width": 0.01, "hill_height": 0.1}
    for height, options in ((0.0, {"rings": 60, **small}), (40.0, {}), (0.0, {"hill_height": 8.0, "rings": 60})):
        bpy.ops.wm.read_factory_settings()
        bpy.context.scene.cursor.location.z = height
        assert add_field(**options) == {"FINISHED"}
        assert add_moons() == {"FINISHED"}
        _assert_field_and_moons_are_seen()
    bpy.ops.wm.read_factory_settings()
    before = bpy.context.scene.camera.matrix_world.copy()
    bpy.ops.ed.undo_push(message="Start")  # the background has no undo stack of its own accord
    assert add_moons() == {"FINISHED"}
    bpy.ops.ed.undo_push(message="Moons")
    bpy.context.view_layer.update()
    assert bpy.context.scene.camera.matrix_world != before
    bpy.ops.ed.undo()
    assert bpy.context.scene.camera.matrix_world == before and "Red Moon" not in bpy.data.objects
    bpy.ops.wm.read_factory_settings()
    floor = bpy.ops.mesh.primitive_plane_add(size=100, location=(0, 0, 1))
    assert floor == {"FINISHED"} and add_moons() == {"FINISHED"}
    assert math.isclose(bpy.context.scene.camera.location.z, 3.5, abs_tol=1e-5)  # over what is there


def _assert_field_and_moons_are_seen() -> None:
    """All of every moon, and plates from edge to edge in the lowest quarter of the picture."""
    scene = bpy.context.scene
    bpy.context.view_layer.update()
    camera, is_seen = scene.camera, load("moons.camera").is_seen
    moons = [o for o in scene.objects if load("moons.moon").emission_node(o)]
    assert len(moons) == 5
    for moon in moons:
        for axis in (0, 1):
            side = camera.matrix_world.col[axis].to_3d() * moon.scale.x
            for point in (moon.location + side, moon.location - side):
                assert is_seen(scene, camera, tuple(point)), moon.name
    obj = next(o for o in scene.objects if o.glimmer_field.enabled)
    points = np.array([obj.matrix_world @ vertex.co for vertex in obj.data.vertices])
    seen = [world_to_camera_view(scene, camera, Vector(point)) for point in points]
    near = np.array([p.x for p in seen if p.z > 0.0 and 0.0 < p.x < 1.0 and 0.0 < p.y < 0.25])
    assert set((near * 8).astype(int)) == set(range(8)), (camera.location, len(near))
    around = np.hypot(*(points - camera.location)[:, :2].T) < 3.0
    assert (points[around, 2] < camera.location.z).all(), "the camera stands in the hill"


class _Layout:
    """Notes which operators and menus a menu draws."""

    def __init__(self) -> None:
        self.drawn: list[str] = []

    def operator(self, name: str, **_: Any) -> None:
        self.drawn.append(name)

    menu = operator

    def operator_menu_enum(self, name: str, _property: str, **_: Any) -> None:
        self.drawn.append(name)

    def separator(self) -> None:
        pass


def the_menu_adds_all_there_is() -> None:
    layout = _Layout()
    for function in bpy.types.VIEW3D_MT_add.draw._draw_funcs:
        if function.__module__.split(".")[-1] == "add_menu":
            function(types.SimpleNamespace(layout=layout), bpy.context)
    assert layout.drawn == ["GLIMMER_MT_add"]
    bpy.types.GLIMMER_MT_add.draw(types.SimpleNamespace(layout=layout), bpy.context)
    added = {f"glimmer.{name}" for name in dir(bpy.ops.glimmer) if name.startswith("add_")}
    assert set(layout.drawn[1:]) == added, (layout.drawn, added)


def a_world_is_added_in_one_step() -> None:
    bpy.ops.wm.read_factory_settings()
    assert bpy.ops.glimmer.add_world() == {"FINISHED"}
    _assert_field_and_moons_are_seen()
    assert load("haze.nodes").node_of(bpy.context.scene.world) is not None
    bpy.ops.wm.read_factory_settings(use_empty=True)
    assert bpy.ops.glimmer.add_world() == {"FINISHED"}  # and without a camera or a world
    _assert_field_and_moons_are_seen()
