# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks of hexagon fields and moons inside a Blender: run by test_hexfield.py, one process a host.

    blender -b --python hexfield_checks.py -- OUT.json     or     python hexfield_checks.py OUT.json

Every function of CHECKS starts from an empty file. OUT.json holds "" or a traceback for each. Only what adds things
is registered, so that nothing here depends on the engine's library.
"""

import json
import math
import sys
import tempfile
import time
import traceback
from collections.abc import Callable
from pathlib import Path
from typing import Any

import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).parent))

from addon_parts import load
from moon_checks import (
    a_new_file_shows_field_and_moons,
    a_world_is_added_in_one_step,
    five_moons_are_in_the_picture,
    the_menu_adds_all_there_is,
)
from world_checks import (
    cameras_find_their_views,
    moons_have_surfaces,
    orbits_are_keplers_everywhere,
    worlds_come_whole,
)

FieldParameters = load("hexfield.parameters").FieldParameters
layout_of = load("hexfield.layout").lay_out
field = load("hexfield.field")
export_instances = load("hexfield.export").export_instances
node_group = load("hexfield.node_group")


def new_field(**changes: Any) -> Any:
    parameters = FieldParameters(**{"rings": 4, "mutation_turn": 0.3, "mutation_size": 0.2, **changes})
    return field.create("Field", parameters, collection=bpy.context.scene.collection)


def evaluated(obj: Any) -> tuple[Any, Any]:
    depsgraph = bpy.context.evaluated_depsgraph_get()
    depsgraph.update()
    return obj.evaluated_get(depsgraph), depsgraph


def loop_instances(obj: Any, depsgraph: Any) -> dict[str, Any]:
    found: dict[str, list[Any]] = {}
    for instance in depsgraph.object_instances:
        if instance.is_instance and instance.parent.original == obj:
            found.setdefault(instance.object.original.name, []).append(np.array(instance.matrix_world))
    return {name: np.array(matrices) for name, matrices in found.items()}


def assert_export_is_the_loop(obj: Any) -> int:
    """Returns the number of plates. float32 matrices of Blender: 1e-6 of the largest number in them."""
    source, depsgraph = evaluated(obj)
    exported = {prototype.original.name: matrices for prototype, matrices, _ in export_instances(source, depsgraph)}
    looped = loop_instances(obj, depsgraph)
    assert set(exported) == set(looped), (sorted(exported), sorted(looped))
    for name, matrices in looped.items():
        assert exported[name].dtype == np.float64
        assert exported[name].shape == matrices.shape
        assert np.abs(exported[name] - matrices).max() <= 1e-6 * np.abs(matrices).max()
    return sum(map(len, looped.values()))


def plates_of(obj: Any) -> Any:
    return node_group.plates(node_group.find_modifier(obj))


def points_of(obj: Any) -> Any:
    values = np.empty(3 * len(obj.data.vertices), np.float32)
    obj.data.vertices.foreach_get("co", values)
    return values.reshape(-1, 3)


def assert_points(obj: Any, **changes: Any) -> None:
    parameters = FieldParameters(**{"rings": 4, "mutation_turn": 0.3, "mutation_size": 0.2, **changes})
    np.testing.assert_allclose(points_of(obj), layout_of(parameters).positions, rtol=1e-6, atol=1e-5)


def ours() -> tuple[int, int, int]:
    """How many collections of prototypes, objects and meshes the file has."""
    return (
        len([c for c in bpy.data.collections if "glimmer_plates" in c]),
        len(bpy.data.objects),
        len(bpy.data.meshes),
    )


# ---- Checks


def export_matches_the_loop() -> None:
    obj = new_field(rings=81, hill_follow=0.7, mutation_tilt=0.4)
    obj.location, obj.rotation_euler, obj.scale = (30, -20, 5), (0.1, 0.2, 0.3), (1.5, 0.7, 1.2)
    assert assert_export_is_the_loop(obj) == 19927
    for count in (1, 3, 20):
        obj.glimmer_field.prototypes = count
        assert assert_export_is_the_loop(obj) == 19927


def export_is_quick() -> None:
    source, depsgraph = evaluated(new_field(rings=81))
    seconds = []
    for _ in range(5):
        start = time.process_time()
        export_instances(source, depsgraph)
        seconds.append(time.process_time() - start)
    assert min(seconds) < 0.1, seconds


def export_declines_what_it_cannot_know() -> None:
    obj = new_field()
    obj.modifiers.new("More", "NODES")
    assert export_instances(*evaluated(obj)) is None
    obj.modifiers.remove(obj.modifiers["More"])
    assert export_instances(*evaluated(obj)) is not None
    obj.modifiers[0].show_viewport = False
    assert export_instances(*evaluated(obj)) is None
    cube = bpy.data.objects.new("Plain", bpy.data.meshes.new("Plain"))
    bpy.context.scene.collection.objects.link(cube)
    assert export_instances(*evaluated(cube)) is None
    empty = bpy.data.objects.new("Empty", None)
    bpy.context.scene.collection.objects.link(empty)
    assert export_instances(*evaluated(empty)) is None


def empty_field() -> None:
    obj = new_field(rings=2, clearing=50.0)
    assert len(obj.data.vertices) == 0
    assert export_instances(*evaluated(obj)) == []
    obj.glimmer_field.clearing = 0.0
    assert assert_export_is_the_loop(obj) == 19


def shapes(obj: Any) -> list[Any]:
    """What a field's prototypes look like."""
    meshes = [prototype.data for prototype in field.prototypes(plates_of(obj))]
    return [([tuple(v.co) for v in mesh.vertices], [p.use_smooth for p in mesh.polygons]) for mesh in meshes]


def attributes_of(obj: Any) -> Any:
    """What shaders know of the plates."""
    read = load("hexfield.export").read_attribute
    names = (node_group.COLOR, node_group.ROUGHNESS, node_group.PATINA)
    return np.concatenate([read(obj.data, name) for name in names], axis=1)


def every_parameter_is_live() -> None:
    """Changing a property changes what the field shows: points, plates, their look or none of these, as the table
    says. Each is tried where it does something.
    """
    parameters = load("hexfield.parameters")
    needed: dict[str, dict[str, Any]] = {
        "radius": {"extent": "RADIUS"},
        "sector_direction": {"sector": 1.0},
        "sunken_depth": {"sunken": 0.5},
        "crack_width": {"cracked": 0.5},
        "terrace_flatness": {"terrace_height": 0.5},
        "crater_radius": {"crater_density": 1.0},
        "crater_depth": {"crater_density": 1.0},
        **{f"path_{name}": {"path_width": 3.0} for name in ("depth", "bend", "length")},
        **{f"second_{name}": {"second_weight": 0.5} for name in ("color", "roughness")},
        **{f"third_{name}": {"third_weight": 0.5} for name in ("color", "roughness")},
        **{f"patina_{name}": {"patina": 0.5} for name in ("color", "roughness", "height", "slope", "noise", "length")},
    }
    without_a_mark = {"image_size", "image_height", "simplify_pixels"}  # they need an image, or a camera
    for name, control in parameters.controls():
        if name in without_a_mark:
            continue
        own = needed.get(name, {})
        if control.needs is not None:
            own = {control.needs[0]: control.needs[1], **own}
        obj = new_field(**({"mutation_shape": 0.1, "mutation_bevel": 0.1} | own))
        group = obj.glimmer_field
        before = [matrices.copy() for _, matrices, _ in export_instances(*evaluated(obj))]
        plates, look = shapes(obj), attributes_of(obj)
        value = getattr(group, name)
        if control.choices:
            setattr(group, name, control.choices[1][0])
        elif isinstance(value, bool):
            setattr(group, name, not value)
        elif isinstance(value, int):
            setattr(group, name, value + 1)
        elif not isinstance(value, float):
            setattr(group, name, [0.5 * part for part in value])
        else:
            setattr(group, name, 0.6 * value + (0.11 if name != "planet_radius" else 100.0))
        after = [matrices for _, matrices, _ in export_instances(*evaluated(obj))]
        new_plates = shapes(obj)
        same_layout = len(before) == len(after) and all(map(np.array_equal, before, after))
        same_plates = plates == new_plates
        # A clearing of 0.1 takes the plate in the middle. Plates that are simplified stand where they stood.
        moves = bool(control.part & (parameters.Part.LAYOUT | parameters.Part.DISPLAY))
        assert same_layout != moves or name == "simplify", name
        assert same_plates != bool(control.part & parameters.Part.PLATES), name
        if not control.part & parameters.Part.LAYOUT:
            assert np.array_equal(look, attributes_of(obj)) != bool(control.part & parameters.Part.LOOK), name


def attributes_are_of_the_plates() -> None:
    """What is handed out with the matrices belongs to them: a plate's colour is its own metal's, wherever it comes."""
    obj = new_field(rings=6, cracked=0.3, second_weight=1.0, roughness_spread=0.0, second_color=(0.1, 0.2, 0.3))
    layout = layout_of(FieldParameters(rings=6, cracked=0.3, mutation_turn=0.3, mutation_size=0.2))
    by_place = {tuple(p): r for p, r in zip(layout.positions.round(3).tolist(), layout.randoms.tolist(), strict=True)}
    seen = 0
    for _, matrices, attribute in export_instances(*evaluated(obj)):
        random, color = attribute(node_group.RANDOM), attribute(node_group.COLOR)
        assert attribute("nothing") is None
        assert random.shape == color.shape == (len(matrices), 4)
        assert set(color[:, 0].astype(np.float64).round(3).tolist()) <= {0.56, 0.1}
        for place, number in zip(matrices[:, :3, 3].round(3).tolist(), random[:, 0].tolist(), strict=True):
            near = min(by_place, key=lambda other: sum((a - b) ** 2 for a, b in zip(place, other, strict=True)))
            assert math.isclose(by_place[near], number, rel_tol=1e-6)
            seen += 1
    assert seen == 127


def the_viewport_shows_a_share() -> None:
    obj = new_field(rings=20)
    group = obj.glimmer_field
    assert assert_export_is_the_loop(obj) == 1261
    group.viewport_share = 0.25
    count = assert_export_is_the_loop(obj)
    assert abs(count - 315) < 5 * math.sqrt(1261 * 0.25 * 0.75), count
    seen: list[int] = []

    class Counter(bpy.types.RenderEngine):
        bl_idname, bl_label = "GLIMMER_COUNTER", "Counter"

        def update(self, _data: Any, depsgraph: Any) -> None:
            source = obj.evaluated_get(depsgraph)
            seen.append(sum(len(matrices) for _, matrices, _ in export_instances(source, depsgraph)))
            seen.append(sum(instance.is_instance for instance in depsgraph.object_instances))

        def render(self, _depsgraph: Any) -> None:
            self.end_result(self.begin_result(0, 0, 8, 8))

    scene = bpy.context.scene
    scene.camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    scene.collection.objects.link(scene.camera)
    scene.render.resolution_x = scene.render.resolution_y = 8
    bpy.utils.register_class(Counter)
    try:
        scene.render.engine = Counter.bl_idname
        bpy.ops.render.render()
    finally:
        scene.render.engine = "CYCLES"
        bpy.utils.unregister_class(Counter)
    assert seen == [1261, 1261], seen
    group.viewport_share = 1.0
    assert assert_export_is_the_loop(obj) == 1261
    assert plates_of(obj) is not None


def far_plates_are_simple() -> None:
    """Those and only those that the camera sees small, and again when it moves."""
    scene = bpy.context.scene
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    scene.collection.objects.link(camera)
    scene.camera = camera
    scene.render.resolution_x, scene.render.resolution_percentage = 500, 100
    camera.data.sensor_fit, camera.data.angle = "HORIZONTAL", math.radians(90.0)
    camera.location = (0.0, -30.0, 2.0)
    bpy.context.view_layer.update()
    obj = new_field(rings=20, simplify=True, simplify_pixels=20.0, prototypes=4, bevel_segments=4)
    prototypes = field.prototypes(plates_of(obj))
    assert [len(p.data.polygons) > 40 for p in prototypes] == [True] * 4 + [False] * 4
    for place in ((0.0, -30.0, 2.0), (10.0, 20.0, 5.0)):
        camera.location = place
        bpy.context.view_layer.update()
        found = {}
        for prototype, matrices, _ in export_instances(*evaluated(obj)):
            pixels = 2.0 * 250.0 / np.linalg.norm(matrices[:, :3, 3] - place, axis=1)
            is_simple = prototype.original in prototypes[4:]
            assert (pixels < 20.001).all() if is_simple else (pixels > 19.999).all()
            found[is_simple] = True
        assert set(found) == {True, False}
    obj.glimmer_field.simplify = False
    assert len(field.prototypes(plates_of(obj))) == 4
    assert assert_export_is_the_loop(obj) == 1261


def plates_stand_on_what_is_there() -> None:
    """On a mesh wherever it is moved, scattered over it, and on an image's pixels; without pixels it says so."""
    mesh = bpy.data.meshes.new("Slope")
    mesh.from_pydata([(-50, -50, 0), (50, -50, 0), (50, 50, 40), (-50, 50, 40)], [], [(0, 1, 2, 3)])
    slope = bpy.data.objects.new("Slope", mesh)
    bpy.context.scene.collection.objects.link(slope)
    flat = dict.fromkeys(("hill_height", "mutation_height", "mutation_tilt", "mutation_turn"), 0.0)
    obj = new_field(rings=6, hill_follow=1.0, **flat)
    obj.glimmer_field.ground = slope
    _, y, z = points_of(obj).T
    assert np.abs(z - 0.4 * (y + 50)).max() < 1e-4
    for _, matrices, _ in export_instances(*evaluated(obj)):
        normal = matrices[:, :3, 2] / np.linalg.norm(matrices[:, :3, 2], axis=1, keepdims=True)
        assert np.abs(normal - np.array([0.0, -0.4, 1.0]) / math.hypot(0.4, 1.0)).max() < 1e-5
    slope.location.z = 5.0
    bpy.context.view_layer.update()
    assert np.abs(points_of(obj)[:, 2] - 0.4 * (y + 50) - 5.0).max() < 1e-4
    slope.location = (50.0, 0.0, 0.0)  # half of the field is beside it
    bpy.context.view_layer.update()
    assert 60 <= len(obj.data.vertices) <= 70 and points_of(obj)[:, 0].min() > -1e-4
    obj.glimmer_field.pattern = "SCATTER"
    points = points_of(obj).astype(np.float64)
    assert np.abs(points[:, 2] - 0.4 * (points[:, 1] + 50)).max() < 1e-4 and points[:, 0].max() > 90.0
    assert len(points) > 1000
    obj.glimmer_field.ground = None
    obj.glimmer_field.pattern = "HEXAGONS"
    image = bpy.data.images.new("Heights", 4, 4, float_buffer=True)
    image.pixels = np.repeat(np.linspace(0.0, 1.0, 4), 4).repeat(4).astype(np.float32).ravel().tolist()
    obj.glimmer_field.image_size = 40.0
    obj.glimmer_field.height_image = image
    _, y, z = points_of(obj).T
    assert np.abs(z - 10.0 * (y + 15.0) / 30.0).max() < 1e-4, "rows of pixels rise along y"
    missing = bpy.data.images.new("Missing", 4, 4)
    missing.source, missing.filepath = "FILE", "//nowhere.png"
    obj.glimmer_field.enabled = False
    obj.glimmer_field.height_image = missing
    before = points_of(obj)
    try:
        field.rebuild(obj, load("hexfield.properties").read(obj.glimmer_field))
    except ValueError as error:
        assert "height_image is 'Missing', which has no pixels" in str(error)
    else:
        raise AssertionError("an image without pixels was taken")
    assert np.array_equal(points_of(obj), before)


def materials_reach_the_plates() -> None:
    obj = new_field()
    top, bevel = bpy.data.materials.new("Top"), bpy.data.materials.new("Bevel")
    obj.glimmer_field.plate_material = top
    obj.glimmer_field.bevel_material = bevel
    for prototype in field.prototypes(plates_of(obj)):
        assert list(prototype.data.materials) == [top, bevel]
        assert {polygon.material_index for polygon in prototype.data.polygons} == {0, 1}
        assert not prototype.data.validate()


def slots_are_the_materials() -> None:
    """Blender's own tools change the plates' materials by the object's slots, each field of a shared mesh its own."""
    top, bevel, gold = (bpy.data.materials.new(name) for name in ("Top", "Bevel", "Gold"))
    obj = field.create("Field", FieldParameters(rings=2), top, bevel, bpy.context.scene.collection)
    twin = obj.copy()
    bpy.context.scene.collection.objects.link(twin)
    assert [slot.material for slot in obj.material_slots] == [top, bevel]
    obj.material_slots[1].material = gold
    bpy.context.view_layer.update()
    assert obj.glimmer_field.bevel_material == gold
    assert all(list(p.data.materials) == [top, gold] for p in field.prototypes(plates_of(obj)))
    assert all(list(p.data.materials) == [top, bevel] for p in field.prototypes(plates_of(twin)))
    obj.glimmer_field.plate_material = gold
    assert [slot.material for slot in obj.material_slots] == [gold, gold]
    obj.data.materials.pop()
    obj.update_tag()
    bpy.context.view_layer.update()
    assert [slot.material for slot in obj.material_slots] == [gold, gold], "a slot that was removed stays away"
    assert not any(p.data.polygons for p in (obj, twin))


def plates_become_a_mesh() -> None:
    top, bevel = bpy.data.materials.new("Top"), bpy.data.materials.new("Bevel")
    obj = field.create("Field", FieldParameters(rings=2, bevel_segments=1), top, bevel, bpy.context.scene.collection)
    obj.location = (1.0, 2.0, 3.0)
    faces = [len(p.data.polygons) for p in field.prototypes(plates_of(obj))]
    bpy.context.view_layer.objects.active = obj
    assert bpy.ops.glimmer.make_plates_real() == {"FINISHED"}
    assert not obj.glimmer_field.enabled and not obj.modifiers
    assert min(faces) * 19 <= len(obj.data.polygons) <= max(faces) * 19
    assert [slot.material for slot in obj.material_slots] == [top, bevel]
    assert {polygon.material_index for polygon in obj.data.polygons} == {0, 1}
    assert tuple(obj.location) == (1.0, 2.0, 3.0)
    assert ours()[0] == 0, ours()  # of collections of plates
    assert not bpy.ops.glimmer.make_plates_real.poll()
    assert "Glimmer Real Plates" not in bpy.data.node_groups


def haze_takes_one_click() -> None:
    bpy.context.scene.world = None
    assert bpy.ops.glimmer.add_haze(visual_range=200.0, color=(0.5, 0.6, 0.7), anisotropy=0.4) == {"FINISHED"}
    world = bpy.context.scene.world
    assert math.isclose(world.glimmer_haze.visual_range, 200.0, rel_tol=1e-5)
    nodes = load("export.nodes").Nodes(world, "world", load("scene.problems").Notices())
    medium = load("export.volume").volume_medium(nodes, nodes.surface_of_output("Volume"))
    extinction = [a + s for a, s in zip(medium.sigma_a, medium.sigma_s, strict=True)]
    # What is left of the contrast at that distance; and the colour is how much of it is scattered.
    assert np.allclose(np.exp(-200.0 * np.array(extinction)), 0.02, rtol=1e-4)
    assert np.allclose(np.array(medium.sigma_s) / extinction, (0.5, 0.6, 0.7), rtol=1e-5)
    assert math.isclose(medium.g, 0.4, rel_tol=1e-6)
    world.glimmer_haze.visual_range = 50.0
    node = load("haze.nodes").node_of(world)
    assert math.isclose(node.inputs["Density"].default_value, math.log(50.0) / 50.0, rel_tol=1e-6)


def fields_share_plates_until_they_differ() -> None:
    one, two = new_field(), new_field(seed=0, rings=2)
    assert plates_of(one) == plates_of(two)
    assert ours()[0] == 1
    two.glimmer_field.thickness = 2.0
    assert plates_of(one) != plates_of(two)
    assert {round(min(v.co.z for v in p.data.vertices), 4) for p in plates_of(one).objects} == {-0.6}
    assert {round(min(v.co.z for v in p.data.vertices), 4) for p in plates_of(two).objects} == {-2.0}
    assert_export_is_the_loop(one)
    assert_export_is_the_loop(two)
    two.glimmer_field.thickness = one.glimmer_field.thickness
    assert plates_of(one) == plates_of(two)
    assert ours()[0] == 1, "the plates that nobody uses are still there"
    assert len([g for g in bpy.data.node_groups if node_group.NAME in g.name]) == 1


def copies_live_their_own_life() -> None:
    one = new_field()
    full, linked = one.copy(), one.copy()
    full.data = one.data.copy()
    for obj in (full, linked):
        bpy.context.scene.collection.objects.link(obj)
    before = points_of(one)
    full.glimmer_field.seed = 7
    linked.glimmer_field.seed = 8
    assert np.array_equal(points_of(one), before)
    assert_points(full, seed=7)
    assert_points(linked, seed=8)
    assert_export_is_the_loop(full)
    assert_export_is_the_loop(linked)


def deleted_fields_leave_nothing() -> None:
    start = ours()
    one, two = new_field(), new_field(thickness=1.0)
    for obj in (one, two):
        mesh = obj.data
        bpy.data.objects.remove(obj)
        bpy.data.meshes.remove(mesh)
    with tempfile.TemporaryDirectory() as folder:
        bpy.ops.wm.save_as_mainfile(filepath=str(Path(folder) / "swept.blend"), copy=True)
    assert ours() == start, ours()


def files_keep_fields() -> None:
    obj = new_field(seed=3, hill_height=2.0)
    name, before = obj.name, points_of(obj)
    with tempfile.TemporaryDirectory() as folder:
        path = str(Path(folder) / "kept.blend")
        bpy.ops.wm.save_as_mainfile(filepath=path)
        bpy.ops.wm.read_factory_settings(use_empty=True)
        assert name not in bpy.data.objects
        bpy.ops.wm.open_mainfile(filepath=path)
    obj = bpy.data.objects[name]
    assert np.array_equal(points_of(obj), before)
    assert obj.glimmer_field.enabled
    assert obj.glimmer_field.seed == 3
    assert_export_is_the_loop(obj)
    obj.glimmer_field.seed = 4
    assert_points(obj, seed=4, hill_height=2.0)
    assert ours()[0] == 1


def undo_takes_back_a_change() -> None:
    # The background has no undo stack of its own accord.
    bpy.ops.ed.undo_push(message="Start")
    bpy.ops.glimmer.add_hexagon_field(rings=4)
    bpy.ops.ed.undo_push(message="Add")
    bpy.data.objects["Hexagon Field"].glimmer_field.seed = 5
    bpy.data.objects["Hexagon Field"].glimmer_field.thickness = 3.0
    changed = points_of(bpy.data.objects["Hexagon Field"])
    bpy.ops.ed.undo_push(message="Change")
    bpy.ops.ed.undo()
    obj = bpy.data.objects["Hexagon Field"]
    assert obj.glimmer_field.seed == 0
    assert not np.array_equal(points_of(obj), changed)
    assert {round(min(v.co.z for v in p.data.vertices), 4) for p in plates_of(obj).objects} == {-0.6}
    assert_export_is_the_loop(obj)
    bpy.ops.ed.redo()
    obj = bpy.data.objects["Hexagon Field"]
    assert np.array_equal(points_of(obj), changed)
    assert {round(min(v.co.z for v in p.data.vertices), 4) for p in plates_of(obj).objects} == {-3.0}
    assert_export_is_the_loop(obj)
    bpy.ops.ed.undo()
    bpy.ops.ed.undo()
    assert "Hexagon Field" not in bpy.data.objects


class _Probe(bpy.types.RenderEngine):
    """Notes what an engine would see of a field, frame by frame."""

    bl_idname = "GLIMMER_PROBE"
    bl_label = "Probe"
    seen: list[tuple[int, float, float]] = []

    def update(self, _data: Any, depsgraph: Any) -> None:
        for source in depsgraph.objects:
            if source.original.type == "MESH" and source.original.glimmer_field.enabled:
                exported = export_instances(source, depsgraph)
                looped = loop_instances(source.original, depsgraph)
                for prototype, matrices, _ in exported:
                    assert np.abs(looped[prototype.original.name] - matrices).max() < 1e-5
                top = max(matrices[:, 2, 3].max() for _, matrices, _ in exported)
                bottom = min(vertex.co.z for vertex in exported[0][0].data.vertices)
                self.seen.append((depsgraph.scene.frame_current, float(top), float(bottom)))

    def render(self, _depsgraph: Any) -> None:
        self.end_result(self.begin_result(0, 0, 8, 8))


def animations_are_rendered() -> None:
    """Through the handler, for the layout and for the plates, in an animation and in a single frame."""
    obj = new_field(mutation_height=0.0)
    for frame, height, thickness in ((1, 0.0, 1.0), (5, 4.0, 2.0)):
        obj.glimmer_field.hill_height, obj.glimmer_field.thickness = height, thickness
        obj.glimmer_field.keyframe_insert("hill_height", frame=frame)
        obj.glimmer_field.keyframe_insert("thickness", frame=frame)
    scene = bpy.context.scene
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    scene.collection.objects.link(camera)
    scene.camera = camera
    scene.render.resolution_x = scene.render.resolution_y = 8
    scene.frame_start, scene.frame_end = 1, 5
    scene.frame_set(1)
    bpy.utils.register_class(_Probe)
    try:
        scene.render.engine = _Probe.bl_idname
        _Probe.seen.clear()
        with tempfile.TemporaryDirectory() as folder:
            scene.render.filepath = str(Path(folder) / "frame")
            bpy.ops.render.render(animation=True)
        assert [frame for frame, _, _ in _Probe.seen] == [1, 2, 3, 4, 5]
        curves = {frame: (top, bottom) for frame, top, bottom in _Probe.seen}
        shape = layout_of(FieldParameters(rings=4, hill_height=1.0, mutation_height=0.0)).positions[:, 2].max()
        assert curves[1] == (0.0, -1.0)
        assert math.isclose(curves[5][0], 4 * shape, rel_tol=1e-5)
        assert math.isclose(curves[5][1], -2, rel_tol=1e-6)
        assert math.isclose(curves[3][0], 2 * shape, rel_tol=1e-5)
        assert math.isclose(curves[3][1], -1.5, rel_tol=1e-6)
        assert curves[1][0] < curves[2][0] < curves[3][0] < curves[4][0] < curves[5][0]
        _Probe.seen.clear()
        scene.frame_set(4)
        bpy.ops.render.render()
        assert _Probe.seen == [(4, *curves[4])]
    finally:
        scene.render.engine = "CYCLES"
        bpy.utils.unregister_class(_Probe)
    assert ours()[0] == 1


def cycles_renders_the_plates() -> None:
    """Seen from above, flat plates cover 3 R^2 / spacing^2 of the plane."""
    light = bpy.data.materials.new("Light")
    if bpy.app.version < (5, 0):
        light.use_nodes = True
    light.node_tree.nodes.clear()
    emission = light.node_tree.nodes.new("ShaderNodeEmission")
    output = light.node_tree.nodes.new("ShaderNodeOutputMaterial")
    light.node_tree.links.new(emission.outputs[0], output.inputs["Surface"])
    none = dict.fromkeys(("hill_height", "mutation_height", "mutation_tilt", "mutation_turn", "mutation_size"), 0.0)
    none |= {"mutation_shape": 0.0, "mutation_bevel": 0.0}
    gap = 0.4
    obj = new_field(rings=20, gap=gap, bevel_width=0.0, **none)
    obj.glimmer_field.plate_material = light
    scene = bpy.context.scene
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.data.type, camera.data.ortho_scale = "ORTHO", 30.0
    camera.location.z = 10
    scene.collection.objects.link(camera)
    scene.camera = camera
    scene.render.engine = "CYCLES"
    scene.render.resolution_x = scene.render.resolution_y = 64
    scene.render.resolution_percentage = 100
    scene.cycles.samples, scene.cycles.use_denoising = 16, False
    scene.cycles.use_adaptive_sampling = False
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    with tempfile.TemporaryDirectory() as folder:
        scene.render.filepath = str(Path(folder) / "cover.exr")
        bpy.ops.render.render(write_still=True)
        image = bpy.data.images.load(scene.render.filepath)
        pixels = np.empty(64 * 64 * 4, np.float32)
        image.pixels.foreach_get(pixels)
    covered = float(pixels.reshape(-1, 4)[:, 0].mean())
    expected = 3 / (math.sqrt(3) + gap) ** 2
    # Points of a picture are at most as spread as independent ones.
    sigma = math.sqrt(expected * (1 - expected) / (64 * 64 * 16))
    assert abs(covered - expected) < 4 * sigma, (covered, expected, sigma)


def presets_change_the_looks_alone() -> None:
    assert bpy.ops.glimmer.add_hexagon_field(rings=3, seed=9, plate_radius=2.0, hill_octaves=7) == {"FINISHED"}
    group = bpy.context.object.glimmer_field
    material, shapes = group.plate_material, set()
    for kind in load("hexfield.presets").PRESETS:
        assert bpy.ops.glimmer.hexagon_field_preset(kind=kind) == {"FINISHED"}
        assert (group.extent, group.rings, group.seed, group.plate_radius) == ("RINGS", 3, 9, 2.0)
        assert group.enabled and group.plate_material == material
        mesh = bpy.context.object.data
        assert len(mesh.vertices) == 37
        shapes.add(tuple(round(value, 5) for vertex in mesh.vertices for value in vertex.co))
    assert len(shapes) == len(load("hexfield.presets").PRESETS)
    bpy.ops.glimmer.hexagon_field_preset(kind="HILLS")
    hills = FieldParameters()
    assert math.isclose(group.hill_height, 2.0 * hills.hill_height, rel_tol=1e-6)
    assert group.hill_octaves == hills.hill_octaves


def operators_add_field_and_moons() -> None:
    moon = load("moons.moon")
    scene = bpy.context.scene
    scene.cursor.location = (1, 2, 3)
    assert bpy.ops.glimmer.add_hexagon_field(rings=2, seed=9, thickness=0.3) == {"FINISHED"}
    obj = bpy.context.object
    assert tuple(obj.location) == (1, 2, 3)
    assert obj.glimmer_field.seed == 9
    assert len(obj.data.vertices) == 19
    assert all(field.prototypes(plates_of(obj))[0].data.materials)
    assert bpy.ops.glimmer.add_moon(radius=2.5, color=(1, 0, 0.5), radiance=7) == {"FINISHED"}
    red = bpy.context.object
    assert math.isclose(red.glimmer_moon.radius, 2.5)
    red.glimmer_moon.radius = 3.0
    assert tuple(red.scale) == (3, 3, 3)
    node = moon.emission_node(red)
    assert tuple(node.inputs["Color"].default_value) == (1, 0, 0.5, 1)
    assert node.inputs["Strength"].default_value == 7
    assert moon.emission_node(obj) is None
    assert bpy.ops.glimmer.add_five_moons() == {"FINISHED"}
    five = [o for o in bpy.context.selected_objects if moon.emission_node(o)]
    assert len(five) == 5
    assert len({o.data.name for o in [*five, red]}) == 1, "moons share their mesh"
    distance = [vertex.co.length for vertex in red.data.vertices]
    assert max(distance) - min(distance) < 1e-6
    assert all(polygon.normal.dot(polygon.center) > 0 and polygon.use_smooth for polygon in red.data.polygons)
    try:
        bpy.ops.glimmer.add_hexagon_field(extent="RADIUS", radius=1e6)
    except RuntimeError as error:
        assert "radius is 1e+06; allowed with plates of this size: 0 to 1862" in str(error)
    else:
        raise AssertionError("a field of billions of plates was accepted")


def registration_goes_both_ways() -> None:
    hexfield, moons = load("hexfield"), load("moons")
    handlers = bpy.app.handlers
    before = len(handlers.frame_change_post), len(handlers.save_pre)
    moons.unregister()
    hexfield.unregister()
    assert not hasattr(bpy.types.Object, "glimmer_field")
    assert not hasattr(bpy.types.Object, "glimmer_moon")
    assert "add_moon" not in dir(bpy.ops.glimmer)
    assert (len(handlers.frame_change_post), len(handlers.save_pre)) == (before[0] - 1, before[1] - 1)
    hexfield.register()
    moons.register()
    assert (len(handlers.frame_change_post), len(handlers.save_pre)) == before
    assert assert_export_is_the_loop(new_field()) == 61


CHECKS: tuple[Callable[[], None], ...] = (
    export_matches_the_loop,
    export_is_quick,
    export_declines_what_it_cannot_know,
    empty_field,
    every_parameter_is_live,
    attributes_are_of_the_plates,
    the_viewport_shows_a_share,
    far_plates_are_simple,
    plates_stand_on_what_is_there,
    materials_reach_the_plates,
    slots_are_the_materials,
    plates_become_a_mesh,
    haze_takes_one_click,
    fields_share_plates_until_they_differ,
    copies_live_their_own_life,
    deleted_fields_leave_nothing,
    files_keep_fields,
    undo_takes_back_a_change,
    animations_are_rendered,
    cycles_renders_the_plates,
    operators_add_field_and_moons,
    presets_change_the_looks_alone,
    five_moons_are_in_the_picture,
    a_new_file_shows_field_and_moons,
    a_world_is_added_in_one_step,
    the_menu_adds_all_there_is,
    orbits_are_keplers_everywhere,
    moons_have_surfaces,
    worlds_come_whole,
    cameras_find_their_views,
    registration_goes_both_ways,
)


def main(path: str) -> None:
    parts = [
        load(name) for name in ("hexfield", "moons", "haze", "worlds", "operators.five_moons_world", "ui.add_menu")
    ]
    for part in parts:
        part.register()
    results = {}
    for check in CHECKS:
        bpy.ops.wm.read_factory_settings(use_empty=True)
        try:
            check()
            results[check.__name__] = ""
        except Exception:  # noqa: BLE001 (whatever a check raises is its result)
            results[check.__name__] = traceback.format_exc()
    Path(path).write_text(json.dumps({"version": bpy.app.version_string, "results": results}))
    for part in reversed(parts):
        part.unregister()


if __name__ == "__main__":
    main(sys.argv[-1])
