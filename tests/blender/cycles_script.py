# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders small scenes by Cycles and Glimmer in turn, in one process: cycles_script.py FOLDER.

Writes pictures.npz: NAME.CYCLES and NAME.GLIMMER, each (seeds, height, width, 3); hair.npz: the same of strands,
without NAME; and edges.npz, of an edge: WIDTH.ENGINE by filter width, each (rows, width, 3).
"""

import itertools
import math
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import bpy
import numpy as np
from mathutils import Vector

sys.path.insert(0, str(Path(__file__).parent))

import inside
from exact_cycles import set_up_cycles

OUT = Path(inside.words()[0])
SEEDS, SAMPLES = 4, 32
EDGE_SEEDS = 24
WIDTH, HEIGHT = 36, 24

inside.enable()
if not hasattr(bpy.types.Scene, "cycles"):
    bpy.ops.preferences.addon_enable(module="cycles")

OCHRE = (0.9, 0.6, 0.3, 1.0)


def floor() -> None:
    inside.plane(material=inside.material("ShaderNodeBsdfDiffuse", Color=(0.7, 0.6, 0.5, 1.0)))


def under_lamps(material: Any, segments: int = 16, is_smooth: bool = False) -> None:
    """A faceted ball: Cycles bends shadows on smooth ones."""
    inside.empty_scene((0.2, 0.2, 0.25))
    floor()
    inside.lamp("AREA", (-3.0, -2.0, 4.0), energy=200.0, shape="RECTANGLE", size=2.0, size_y=1.0)
    ball = inside.ball("Ball", material, segments=segments)
    ball.data.polygons.foreach_set("use_smooth", [is_smooth] * len(ball.data.polygons))


def coarse_metal(roughness: float) -> None:
    """Smooth normals would send what is seen at its outlines into its faces: both engines bend them."""
    material = inside.material("ShaderNodeBsdfGlossy", "GGX", Color=OCHRE, Roughness=roughness)
    under_lamps(material, segments=8, is_smooth=True)


def under_lamp(kind: str, **settings: Any) -> Any:
    inside.empty_scene()
    floor()
    return inside.lamp(kind, (1.0, 1.0, 3.0), **settings)


def area_ellipse() -> None:
    under_lamp("AREA", energy=100.0, shape="ELLIPSE", size=2.0, size_y=0.5).scale = (2.0, 1.0, 1.0)


def world() -> None:
    inside.empty_scene((0.3, 0.4, 0.5))
    floor()


def world_image(rotation: tuple[float, float, float] = (0.3, 0.2, 1.0)) -> None:
    scene = inside.empty_scene()
    scene.camera.rotation_euler = (1.5, 0.0, 0.4)
    image = bpy.data.images.new("Sky", 32, 16, float_buffer=True)
    pixels = np.zeros((16, 32, 4), np.float32)
    pixels[..., 0] = np.linspace(0.0, 1.0, 32)
    pixels[..., 1] = np.linspace(0.0, 1.0, 16)[:, None]
    pixels[8:12, 20:24, 2] = 3.0
    pixels[..., 3] = 1.0
    image.pixels.foreach_set(pixels.ravel())
    tree = scene.world.node_tree
    names = ("ShaderNodeTexCoord", "ShaderNodeMapping", "ShaderNodeTexEnvironment")
    coordinates, mapping, texture = (tree.nodes.new(name) for name in names)
    texture.image = image
    mapping.inputs["Rotation"].default_value = rotation
    tree.links.new(coordinates.outputs["Generated"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs["Vector"], texture.inputs["Vector"])
    tree.links.new(texture.outputs["Color"], tree.nodes["Background"].inputs["Color"])
    floor()


def emissive_mesh() -> None:
    inside.empty_scene()
    floor()
    inside.ball("Lamp", inside.material("ShaderNodeEmission", Color=OCHRE, Strength=5.0), (0.0, 0.0, 2.0), 16)


def camera() -> None:
    """Everything that a camera can do at once: shift, a lens that is not in focus, the height fitted."""
    world_image((0.0, 0.0, 0.0))
    inside.ball("Lamp", inside.material("ShaderNodeEmission", Color=OCHRE, Strength=2.0), (0.5, 1.0, 4.0), 16)
    item = bpy.context.scene.camera
    item.scale = (2.0, 2.0, 2.0)
    data = item.data
    data.lens, data.sensor_fit, data.sensor_height = 20.0, "VERTICAL", 20.0
    data.shift_x, data.shift_y = 0.15, -0.2
    data.dof.use_dof, data.dof.focus_distance, data.dof.aperture_fstop = True, 4.0, 0.05


def orthographic() -> None:
    """With the same, seen from within its own depth, and mirrored."""
    camera()
    item = bpy.context.scene.camera
    item.rotation_euler, item.scale = (1.2, 0.0, 0.4), (-1.0, 1.0, 1.0)
    data = item.data
    data.type, data.ortho_scale = "ORTHO", 7.0
    data.dof.aperture_fstop = 2.0


def fisheye() -> None:
    """With a lens, and the filter's ends beyond the circle."""
    camera()
    data = bpy.context.scene.camera.data
    data.type, data.shift_x, data.shift_y = "PANO", 0.0, 0.0
    settings = data if hasattr(data, "panorama_type") else data.cycles
    settings.panorama_type, settings.fisheye_fov = "FISHEYE_EQUIDISTANT", 2.5


def through_an_aperture(build: Callable[[], None]) -> None:
    """A bright ball far out of focus before the black world: its picture has the shape of the aperture."""
    build()
    for item in list(bpy.context.scene.collection.objects):
        if item.type == "MESH":
            bpy.data.objects.remove(item)
    item = bpy.context.scene.camera
    bpy.context.view_layer.update()
    is_panorama = item.data.type == "PANO"  # which turns its aperture about the axis of view
    ahead = item.matrix_world.normalized() @ Vector((12.0, -8.0, -12.0) if is_panorama else (0.3, -0.2, -20.0))
    inside.ball("Far", inside.material("ShaderNodeEmission", Color=OCHRE, Strength=300.0), tuple(ahead), 16)
    data = item.data
    data.shift_x = data.shift_y = 0.0
    data.dof.aperture_blades, data.dof.aperture_rotation, data.dof.aperture_ratio = 3, 0.4, 0.8
    radius = {"PERSP": 1.0, "ORTHO": 0.6, "PANO": 2.5}[data.type]  # of a picture of the ball that shows its shape
    data.dof.aperture_fstop = 0.5 * (1.0 if data.type == "ORTHO" else 1e-3 * data.lens) / radius


def instances() -> None:
    """A collection in a collection, turned and scaled, with a lamp in it."""
    inside.empty_scene((0.1, 0.1, 0.1))
    floor()
    ball = inside.ball("Ball", inside.material("ShaderNodeBsdfDiffuse", Color=OCHRE), segments=16)
    ball.scale = (0.5, 0.5, 0.8)
    light = inside.lamp("AREA", (0.0, -1.0, 2.5), energy=40.0, shape="RECTANGLE", size=1.0, size_y=0.5)
    root = bpy.context.scene.collection
    inner, outer = bpy.data.collections.new("Inner"), bpy.data.collections.new("Outer")
    for item in (ball, light):
        root.objects.unlink(item)
        inner.objects.link(item)
    for collection, place, x, turn in ((inner, outer, 0.0, 0.5), (inner, outer, 1.5, 1.0), (outer, root, -1.0, 0.3)):
        empty = bpy.data.objects.new("Empty", None)
        empty.instance_type, empty.instance_collection = "COLLECTION", collection
        empty.location, empty.rotation_euler, empty.scale = (x, 0.0, 0.0), (0.0, 0.0, turn), (0.9, 0.9, 0.9)
        place.objects.link(empty)


def lit_floor() -> Any:
    scene = inside.empty_scene((0.1, 0.1, 0.1))
    floor()
    inside.lamp("AREA", (0.0, -1.0, 4.0), energy=100.0, shape="RECTANGLE", size=1.0, size_y=0.5)
    return scene


def faceted_ball(name: str, radius: float, location: tuple[float, float, float]) -> Any:
    ball = inside.ball(name, inside.material("ShaderNodeBsdfDiffuse", Color=OCHRE), location, segments=16)
    ball.data.polygons.foreach_set("use_smooth", [False] * len(ball.data.polygons))
    ball.scale = (radius,) * 3
    return ball


def hidden_instancers() -> None:
    """Vertices, faces and particles that show others and are hidden themselves; a parent that is off by rounding."""
    lit_floor()
    for number, kind in enumerate(("VERTS", "FACES")):
        instancer = faceted_ball(kind, 0.8, (2.0 * number - 2.0, 0.0, 1.0))
        shown = faceted_ball("Shown", 0.15, (0.0, 0.0, 0.0))
        shown.parent, instancer.instance_type, instancer.show_instancer_for_render = instancer, kind, False
    emitter = inside.plane("Emitter", 0.7, inside.material("ShaderNodeBsdfDiffuse", Color=OCHRE))
    emitter.location = (2.0, 0.0, 0.8)
    emitter.modifiers.new("Particles", "PARTICLE_SYSTEM")
    settings = emitter.particle_systems[0].settings
    settings.type, settings.count, settings.render_type, settings.particle_size = "HAIR", 20, "OBJECT", 0.5
    settings.instance_object, emitter.show_instancer_for_render = faceted_ball("Particle", 0.3, (5.0, 9.0, 0.0)), False
    rounded = faceted_ball("Rounded", 0.5, (0.0, 2.0, 0.5))
    rounded.parent = bpy.data.objects.new("Parent", None)
    bpy.context.scene.collection.objects.link(rounded.parent)
    inverse = rounded.matrix_parent_inverse.copy()
    inverse[3][3] = 0.99999994
    rounded.matrix_parent_inverse = inverse


def curves_and_texts() -> None:
    """What Blender shows by a mesh that is none of its own: curves that share their data and differ in modifiers and
    material, a metaball, and a shining text in an instanced collection."""
    scene = lit_floor()
    data = bpy.data.curves.new("Curve", "CURVE")
    spline = data.splines.new("POLY")
    spline.points.add(1)
    spline.points[0].co, spline.points[1].co = (0.0, 0.0, 0.0, 1.0), (0.0, 1.0, 0.5, 1.0)
    data.dimensions, data.bevel_depth, data.bevel_resolution = "3D", 0.2, 0
    data.materials.append(inside.material("ShaderNodeBsdfDiffuse", Color=OCHRE))
    for number in range(2):
        item = bpy.data.objects.new("Curve", data)
        item.location = (2.5 * number - 2.5, 0.0, 0.3)
        scene.collection.objects.link(item)
        array = item.modifiers.new("Array", "ARRAY")
        array.count, array.use_relative_offset, array.use_constant_offset = 1 + 2 * number, False, True
        array.constant_offset_displace = (0.4, 0.0, 0.4)
        if number:
            item.material_slots[0].link = "OBJECT"
            item.material_slots[0].material = inside.material("ShaderNodeBsdfDiffuse", Color=(0.1, 0.2, 0.9, 1.0))
    meta = bpy.data.metaballs.new("Meta")
    meta.elements.new().co = (0.0, 2.0, 1.0)
    scene.collection.objects.link(bpy.data.objects.new("Meta", meta))
    text = bpy.data.curves.new("Text", "FONT")
    text.body, text.extrude = "il", 0.1
    text.materials.append(inside.material("ShaderNodeEmission", Strength=2.0))
    inner = bpy.data.collections.new("Texts")
    inner.objects.link(bpy.data.objects.new("Text", text))
    empty = bpy.data.objects.new("Empty", None)
    empty.instance_type, empty.instance_collection = "COLLECTION", inner
    empty.location, empty.rotation_euler, empty.scale = (1.5, -0.5, 0.3), (1.2, 0.0, 0.0), (2.0, 2.0, 2.0)
    scene.collection.objects.link(empty)


def points() -> None:
    """A point cloud, from Geometry Nodes of an object that is hidden itself."""
    lit_floor()
    item = faceted_ball("Cloud", 1.0, (0.0, 0.0, 1.2))
    tree = bpy.data.node_groups.new("Points", "GeometryNodeTree")
    for direction in ("INPUT", "OUTPUT"):
        if hasattr(tree, "interface"):
            tree.interface.new_socket("Geometry", in_out=direction, socket_type="NodeSocketGeometry")
        else:
            getattr(tree, f"{direction.lower()}s").new("NodeSocketGeometry", "Geometry")
    kinds = ("NodeGroupInput", "GeometryNodeMeshToPoints", "GeometryNodeSetMaterial", "NodeGroupOutput")
    nodes = [tree.nodes.new(kind) for kind in kinds]
    for before, after in itertools.pairwise(nodes):
        tree.links.new(before.outputs[0], after.inputs[0])
    nodes[1].inputs["Radius"].default_value = 0.15
    nodes[2].inputs["Material"].default_value = item.active_material
    item.modifiers.new("Points", "NODES").node_group = tree
    item.show_instancer_for_render = False


def hair() -> None:
    """Strands of a hidden emitter, with children, in an instanced collection, of the emitter's second material."""
    scene = lit_floor()
    emitter = inside.plane("Emitter", 1.0, inside.material("ShaderNodeBsdfDiffuse", Color=OCHRE))
    emitter.data.materials.append(inside.material("ShaderNodeEmission", Color=OCHRE, Strength=0.5))
    emitter.modifiers.new("Hair", "PARTICLE_SYSTEM")
    settings = emitter.particle_systems[0].settings
    settings.type, settings.count, settings.hair_length, settings.material = "HAIR", 40, 1.5, 2
    settings.root_radius, settings.tip_radius, settings.shape, settings.child_type = 8.0, 2.0, 0.3, "SIMPLE"
    settings.rendered_child_count = 3
    emitter.show_instancer_for_render = False
    inner = bpy.data.collections.new("Hair")
    scene.collection.objects.unlink(emitter)
    inner.objects.link(emitter)
    for x in (-1.2, 1.2):
        empty = bpy.data.objects.new("Empty", None)
        empty.instance_type, empty.instance_collection = "COLLECTION", inner
        empty.location, empty.rotation_euler, empty.scale = (x, 0.0, 0.0), (0.0, 0.3, x), (0.8, 0.8, 0.8)
        scene.collection.objects.link(empty)


def mixed() -> None:
    under_lamps(inside.material("ShaderNodeBsdfDiffuse", Color=OCHRE))
    tree = bpy.data.objects["Ball"].active_material.node_tree
    glossy, mix = tree.nodes.new("ShaderNodeBsdfGlossy"), tree.nodes.new("ShaderNodeMixShader")
    glossy.distribution = "GGX"
    glossy.inputs["Color"].default_value = OCHRE
    glossy.inputs["Roughness"].default_value = 0.5
    mix.inputs[0].default_value = 0.3
    tree.links.new(tree.nodes["Diffuse BSDF"].outputs[0], mix.inputs[1])
    tree.links.new(glossy.outputs[0], mix.inputs[2])
    tree.links.new(mix.outputs[0], tree.nodes["Material Output"].inputs["Surface"])


def mixed_with(kind: str, factor: float, other: str, **inputs: Any) -> None:
    """A ball: (1 - factor) of a node of this kind with these inputs, factor of another one."""
    under_lamps(inside.material(kind, **inputs))
    tree = bpy.data.objects["Ball"].active_material.node_tree
    first, second, mix = tree.nodes[0], tree.nodes.new(other), tree.nodes.new("ShaderNodeMixShader")
    if "Color" in second.inputs:
        second.inputs["Color"].default_value = OCHRE
    mix.inputs[0].default_value = factor
    tree.links.new(first.outputs[0], mix.inputs[1])
    tree.links.new(second.outputs[0], mix.inputs[2])
    tree.links.new(mix.outputs[0], tree.nodes["Material Output"].inputs["Surface"])


def screen(kind: str, **inputs: Any) -> None:
    """Between a lamp and a floor, in the camera's view: what the material lets through."""
    inside.empty_scene((0.1, 0.1, 0.1))
    floor()
    inside.lamp("AREA", (0.0, 0.0, 4.0), energy=200.0, shape="RECTANGLE", size=1.0, size_y=1.0)
    inside.lamp("POINT", (1.0, 0.5, 3.0), energy=100.0, shadow_soft_size=0.0)
    pane = inside.plane("Pane", 2.0, inside.material(kind, **inputs))
    pane.location, pane.rotation_euler = (0.0, 0.0, 1.5), (0.3, 0.1, 0.0)


def glossy_at_grazing() -> None:
    """Under an even sky, where a reflectance that grows with the angle would show most."""
    scene = inside.empty_scene((0.5, 0.5, 0.5))
    inside.plane(material=inside.material("ShaderNodeBsdfGlossy", "GGX", Color=OCHRE, Roughness=0.4))
    scene.camera.location, scene.camera.rotation_euler = (0.0, -6.0, 1.0), (1.3, 0.0, 0.0)


def fog(kind: str, **inputs: Any) -> None:
    inside.empty_scene()
    floor()
    inside.ball("Lamp", inside.material("ShaderNodeEmission", Strength=5.0), (0.0, 0.0, 2.0), 16)
    tree = bpy.context.scene.world.node_tree
    volume = tree.nodes.new(kind)
    for name, value in inputs.items():
        volume.inputs[name].default_value = value
    tree.links.new(volume.outputs[0], tree.nodes["World Output"].inputs["Volume"])


def between(kind: str = "POINT", visible: str = "", **settings: Any) -> Any:
    """A faceted ball over a floor under a lamp, hidden from the rays of one property."""
    scene = inside.empty_scene((0.1, 0.1, 0.12))
    floor()
    light = inside.lamp(kind, (0.5, -1.0, 4.0), **{"energy": 300.0, "shadow_soft_size": 0.0, **settings})
    ball = inside.ball("Ball", inside.material("ShaderNodeBsdfDiffuse", Color=OCHRE), segments=16)
    ball.data.polygons.foreach_set("use_smooth", [False] * len(ball.data.polygons))
    if visible:
        setattr(ball, visible, False)
    return scene, light, ball


def seen_in(kind: str, visible: str, **inputs: Any) -> None:
    """A ball that the floor's lobe does not see, or not through another one of the material."""
    between(visible=visible)
    if kind == "ShaderNodeBsdfGlossy":
        bpy.data.objects["Floor"].data.materials[0] = inside.material(kind, "GGX", **inputs)
    else:
        glass = inside.ball("Glass", inside.material(kind, **inputs), (0.0, -2.2, 2.4), 16)
        glass.data.polygons.foreach_set("use_smooth", [False] * len(glass.data.polygons))


def lamp_seen_by(*hidden: str, **settings: Any) -> None:
    """A wide lamp over a floor that is diffuse and glossy, hidden from the rays of these properties."""
    _, light, _ = between("AREA", shape="DISK", size=3.0, **settings)
    light.visible_camera = True
    for name in hidden:
        setattr(light, name, False)
    glossy = inside.material("ShaderNodeBsdfGlossy", "GGX", Color=OCHRE, Roughness=0.4)
    bpy.data.objects["Ball"].data.materials[0] = glossy


def without_shadow(**settings: Any) -> None:
    _, light, _ = between(**settings)
    if hasattr(light.data.cycles, "cast_shadow"):
        light.data.cycles.cast_shadow = False
    else:
        light.data.use_shadow = False


def lamp_of_one_bounce() -> None:
    _, light, _ = between("AREA", shape="SQUARE", size=2.0)
    light.data.cycles.max_bounces = 0


def portal() -> None:
    _, light, _ = between("AREA", shape="SQUARE", size=2.0)
    light.data.cycles.is_portal = True


def holdout() -> None:
    between()[2].is_holdout = True


def indirect_only() -> None:
    _, _, ball = between()
    scene = bpy.context.scene
    collection = bpy.data.collections.new("Unseen")
    scene.collection.children.link(collection)
    scene.collection.objects.unlink(ball)
    collection.objects.link(ball)
    bpy.context.view_layer.layer_collection.children["Unseen"].indirect_only = True


def world_not_seen() -> None:
    scene = inside.empty_scene((0.5, 0.6, 0.9))
    scene.world.cycles_visibility.camera = False
    inside.plane(size=2.0, material=inside.material("ShaderNodeBsdfDiffuse", Color=OCHRE))
    ball = inside.ball("Ball", inside.material("ShaderNodeBsdfGlossy", "GGX", Roughness=0.3), segments=16)
    ball.data.polygons.foreach_set("use_smooth", [False] * len(ball.data.polygons))


def by_a_wall(**settings: Any) -> None:
    """A lamp that is wide and close."""
    under_lamp("POINT", energy=300.0, shadow_soft_size=0.5, **settings)
    wall = inside.plane("Wall", 2.0, inside.material("ShaderNodeBsdfDiffuse", Color=OCHRE))
    wall.location, wall.rotation_euler = (0.0, 2.0, 2.0), (1.5, 0.0, 0.0)


def edge() -> None:
    """Light of radiance 1 left of 0.3 pixels right of the middle, dark beyond; a pixel is a unit wide."""
    scene = inside.empty_scene()
    light = inside.plane("Light", 100.0, inside.material("ShaderNodeEmission", Strength=1.0))
    light.location.x = 0.3 - 100.0
    scene.camera.location, scene.camera.rotation_euler = (0.0, 0.0, 20.0), (0.0, 0.0, 0.0)
    scene.camera.data.sensor_fit, scene.camera.data.angle = "HORIZONTAL", 2.0 * math.atan(WIDTH / 40.0)


def shader(kind: str, distribution: str | None = None, **inputs: Any) -> Callable[[], None]:
    return lambda: under_lamps(inside.material(kind, distribution, **inputs))


WHITE = (1.0, 1.0, 1.0, 1.0)
EXPOSURES = {"exposure": 2.0}
GLASS, DIFFUSE = "ShaderNodeBsdfGlass", "ShaderNodeBsdfDiffuse"
SCENES: dict[str, Callable[[], Any]] = {
    "point": lambda: under_lamp("POINT", energy=500.0, shadow_soft_size=0.0),
    "sun": lambda: under_lamp("SUN", energy=2.0, angle=0.1),
    "area": lambda: under_lamp("AREA", energy=100.0, shape="RECTANGLE", size=2.0, size_y=0.5),
    "area ellipse": area_ellipse,
    "world": world,
    "world image": world_image,
    "camera": camera,
    "orthographic": orthographic,
    "fisheye": fisheye,
    "aperture": partial(through_an_aperture, camera),
    "aperture, orthographic": partial(through_an_aperture, orthographic),
    "aperture, fisheye": partial(through_an_aperture, fisheye),
    "instances": instances,
    "hidden instancers": hidden_instancers,
    "curves and texts": curves_and_texts,
    "points": points,
    "emissive mesh": emissive_mesh,
    "diffuse": shader("ShaderNodeBsdfDiffuse", Color=OCHRE),
    "glossy": shader("ShaderNodeBsdfGlossy", "GGX", Color=OCHRE, Roughness=0.5),
    "mirror": shader("ShaderNodeBsdfGlossy", "GGX", Color=OCHRE, Roughness=0.0),
    "coarse metal": lambda: coarse_metal(0.15),
    "coarse mirror": lambda: coarse_metal(0.0),
    "glass": shader("ShaderNodeBsdfGlass", None, Roughness=0.0, IOR=1.5),
    "mix": mixed,
    "absorption": lambda: fog("ShaderNodeVolumeAbsorption", Color=OCHRE, Density=0.1),
}
SCENES |= {
    "glass and diffuse": lambda: mixed_with(DIFFUSE, 0.5, GLASS, Color=OCHRE),
    "diffuse and clear": lambda: mixed_with(DIFFUSE, 0.5, "ShaderNodeBsdfTransparent", Color=OCHRE),
    "rough glass": shader(GLASS, "GGX", Color=OCHRE, Roughness=0.25, IOR=1.4),
    "refraction": shader("ShaderNodeBsdfRefraction", "GGX", Color=OCHRE, Roughness=0.25, IOR=1.4),
    "coloured glass": shader(GLASS, Color=OCHRE, Roughness=0.0, IOR=1.4),
    "rough diffuse": shader(DIFFUSE, Color=OCHRE, Roughness=1.0),
    "translucent": lambda: screen("ShaderNodeBsdfTranslucent", Color=OCHRE),
    "coloured shadow": lambda: screen("ShaderNodeBsdfTransparent", Color=OCHRE),
    "alpha": lambda: screen(
        "ShaderNodeBsdfPrincipled", Base_Color=OCHRE, Specular=0.0, Specular_IOR_Level=0.0, Alpha=0.4
    ),
    "principled glass": shader(
        "ShaderNodeBsdfPrincipled",
        Base_Color=OCHRE,
        Transmission=1.0,
        Transmission_Weight=1.0,
        Roughness=0.3,
        IOR=1.4,
    ),
}
SCENES |= {
    "not seen by the camera": lambda: between(visible="visible_camera"),
    "without shadow": lambda: between(visible="visible_shadow"),
    "without shadow, area": lambda: between("AREA", "visible_shadow", shape="SQUARE", size=2.0),
    "not seen by diffuse rays": lambda: between(visible="visible_diffuse"),
    "not seen by a mirror": lambda: seen_in("ShaderNodeBsdfGlossy", "visible_glossy", Roughness=0.0),
    "not seen through glass": lambda: seen_in(GLASS, "visible_transmission", Roughness=0.0, IOR=1.2),
    "lamp without diffuse": lambda: lamp_seen_by("visible_diffuse"),
    "lamp without glossy": lambda: lamp_seen_by("visible_glossy"),
    "lamp without shadow": without_shadow,
    "area lamp without shadow": lambda: without_shadow(kind="AREA", shape="SQUARE", size=2.0),
    "lamp of one bounce": lamp_of_one_bounce,
    "portal": portal,
    "holdout": holdout,
    "indirect only": indirect_only,
    "world not seen": world_not_seen,
    "exposure": between,
    "spread": lambda: under_lamp("AREA", energy=100.0, shape="ELLIPSE", size=2.0, size_y=1.0, spread=1.2),
    "disk": by_a_wall,
    "wide spot": lambda: under_lamp("SPOT", energy=500.0, shadow_soft_size=0.4, spot_size=1.9, spot_blend=0.3),
    "wide sun": lambda: between("SUN", energy=3.0, angle=1.6),
}
if bpy.app.version >= (4, 2):
    # Before, Cycles lost a hundredth of this light: a mean of .2669 +- .0001 in 3.4, .2693 +- .0002 in 4.2, .2695 here.
    SCENES["glossy at grazing"] = glossy_at_grazing
    SCENES["bulb"] = lambda: under_lamp("POINT", energy=500.0, shadow_soft_size=0.5, use_soft_falloff=False)
    SCENES["spot"] = lambda: under_lamp("SPOT", energy=500.0, shadow_soft_size=0.0, spot_size=1.2, spot_blend=0.5)
else:
    # The volumes of later versions have a mean error of their own, which depends on the sample count.
    SCENES["fog"] = lambda: fog("ShaderNodeVolumeScatter", Color=OCHRE, Density=0.05, Anisotropy=0.3)
    SCENES["principled fog"] = lambda: fog("ShaderNodeVolumePrincipled", Color=OCHRE, Density=0.05)


def picture(engine: str, seed: int) -> Any:
    return inside.picture(OUT / "picture.exr", engine, seed)


def pictures_of(build: Callable[[], Any]) -> dict[str, Any]:
    """By engine: (seeds, height, width, 3)."""
    build()
    current = bpy.context.scene
    current.render.resolution_x, current.render.resolution_y = WIDTH, HEIGHT
    current.cycles.film_exposure = EXPOSURES.get(name, 1.0)
    current.glimmer.samples, current.glimmer.filter = SAMPLES, "BOX"
    set_up_cycles(current, samples=SAMPLES)
    return {engine: np.array([picture(engine, seed) for seed in range(SEEDS)]) for engine in ("CYCLES", "GLIMMER")}


inside.use_format("OPEN_EXR")
pictures: dict[str, Any] = {}
for name, build in SCENES.items():
    pictures |= {f"{name}.{engine}": found for engine, found in pictures_of(build).items()}
np.savez(OUT / "pictures.npz", **pictures)
np.savez(OUT / "hair.npz", **pictures_of(hair))

edges: dict[str, Any] = {}
for filter_width in (1.5, 2.5):
    edge()
    current = bpy.context.scene
    current.render.resolution_x, current.render.resolution_y = WIDTH, HEIGHT
    set_up_cycles(current, samples=1024, pixel_filter_type="BLACKMAN_HARRIS", filter_width=filter_width)
    current.glimmer.samples = 1024
    current.glimmer.filter, current.glimmer.filter_width = "BLACKMAN_HARRIS", filter_width
    edges[f"{filter_width}.CYCLES"] = picture("CYCLES", 0)
    # The rows of a picture of ours share the places of their samples, so each row is of another seed.
    current.glimmer.samples = 128
    edges[f"{filter_width}.GLIMMER"] = np.array([picture("GLIMMER", seed)[0] for seed in range(EDGE_SEEDS)])
np.savez(OUT / "edges.npz", **edges)
