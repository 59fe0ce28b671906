# SPDX-License-Identifier: GPL-3.0-or-later
"""Kinds of things that people's files hold, each as a scene of its own, by Cycles and by Glimmer: kinds_script.py FILE.

Materials shine or are lit by an even sky, so that there is next to no noise. Writes for each case how far the means of
blocks are apart, as a part of the picture's brightest, and what was told.
"""

import json
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).parent))

import bmesh
import inside
from exact_cycles import set_up_cycles
from shading_cases import make

BLOCK = 10  # pixels
SAMPLES = 64
Build = Callable[[], dict[str, Any] | None]
"""Builds a scene, and returns the settings of Cycles' that are its own."""
CASES: dict[str, Build] = {}


def case(build: Build) -> Build:
    CASES[build.__name__] = build
    return build


# ---- Materials ---------------------------------------------------------------------------------------------------


def material(kind: str = "ShaderNodeEmission", color: tuple[float, float, float] = (0.8, 0.3, 0.1)) -> Any:
    return inside.material(kind, Color=(*color, 1.0))


def shown(build: Callable[[Any], Any]) -> Any:
    """A material that shines with what `build` puts in its tree."""
    result = material()
    tree = result.node_tree
    tree.links.new(build(tree), tree.nodes["Emission"].inputs["Color"])
    return result


def surface(result: Any, output: Any) -> Any:
    result.node_tree.links.new(output, result.node_tree.nodes["Material Output"].inputs["Surface"])
    return result


@case
def without_nodes() -> None:
    plain = bpy.data.materials.new("Plain")
    if hasattr(plain, "use_nodes"):
        plain.use_nodes = False
    plain.diffuse_color, plain.metallic, plain.roughness = (0.8, 0.6, 0.1, 1.0), 1.0, 0.2
    inside.ball("Ball", plain)


@case
def without_an_output() -> None:
    lost = material("ShaderNodeBsdfDiffuse")
    lost.node_tree.nodes.remove(lost.node_tree.nodes["Material Output"])
    inside.ball("Ball", lost)


@case
def without_a_shader() -> None:
    lost = material("ShaderNodeBsdfDiffuse")
    lost.node_tree.links.clear()
    inside.ball("Ball", lost)


@case
def value_as_shader() -> None:
    inside.ball("Ball", surface(material(), make(material().node_tree, "ShaderNodeRGB")))
    own = material()
    inside.ball("Checker", surface(own, make(own.node_tree, "ShaderNodeTexChecker")), (2.0, 0.0, 1.0))


@case
def background_as_shader() -> None:
    inside.ball("Ball", inside.material("ShaderNodeBackground", Color=(0.2, 0.8, 0.3, 1.0), Strength=1.5))


def group(build: Callable[[Any, Any], Any]) -> Any:
    """Of a colour input and a number, and a colour output."""
    tree = bpy.data.node_groups.new("Group", "ShaderNodeTree")
    if hasattr(tree, "interface"):
        tree.interface.new_socket("Color", in_out="INPUT", socket_type="NodeSocketColor")
        tree.interface.new_socket("Amount", in_out="INPUT", socket_type="NodeSocketFloat")
        tree.interface.new_socket("Result", in_out="OUTPUT", socket_type="NodeSocketColor")
    else:
        tree.inputs.new("NodeSocketColor", "Color")
        tree.inputs.new("NodeSocketFloat", "Amount")
        tree.outputs.new("NodeSocketColor", "Result")
    given, result = tree.nodes.new("NodeGroupInput"), tree.nodes.new("NodeGroupOutput")
    tree.links.new(build(tree, given), result.inputs[0])
    return tree


def used(tree: Any, inner: Any, color: tuple[float, float, float] = (0.9, 0.4, 0.1), amount: float = 0.4) -> Any:
    node = tree.nodes.new("ShaderNodeGroup")
    node.node_tree = inner
    node.inputs[0].default_value, node.inputs[1].default_value = (*color, 1.0), amount
    return node


@case
def blackbodies() -> None:
    for number, kelvin in enumerate((900.0, 1800.0, 3000.0, 4500.0, 7000.0, 13000.0)):
        shader = shown(lambda tree, kelvin=kelvin: make(tree, "ShaderNodeBlackbody", inputs={0: kelvin}))  # type: ignore[misc]
        inside.plane("Plate", 0.4, shader).location.x = 0.9 * number - 2.25


@case
def groups_within_groups() -> None:
    inner = group(lambda tree, given: make(tree, "ShaderNodeGamma", inputs={0: given.outputs[0], 1: given.outputs[1]}))

    def outer(tree: Any, given: Any) -> Any:
        node = used(tree, inner, amount=2.2)
        tree.links.new(given.outputs[0], node.inputs[0])
        return node.outputs[0]

    inside.ball("Ball", shown(lambda tree: used(tree, group(outer)).outputs[0]))


@case
def muted_nodes() -> None:
    def free(tree: Any) -> Any:
        node = used(tree, group(lambda inner, given: given.outputs[0]))
        node.mute = True
        return node.outputs[0]

    def linked(tree: Any) -> Any:
        color = make(tree, "ShaderNodeRGB")
        color.default_value = (0.2, 0.7, 0.4, 1.0)
        result = make(tree, "ShaderNodeInvert", inputs={1: color})
        result.node.mute = True
        return result

    inside.ball("Free", shown(free), (-1.2, 0.0, 1.0))
    inside.ball("Linked", shown(linked), (1.2, 0.0, 1.0))


@case
def slots() -> None:
    item = inside.ball("Ball", material(), segments=16)
    item.data.materials.append(None)
    item.data.materials.append(material(color=(0.1, 0.2, 0.9)))
    item.data.polygons.foreach_set("material_index", [i % 5 for i in range(len(item.data.polygons))])
    own = inside.ball("Own", material(), (2.2, 0.0, 1.0))
    own.material_slots[0].link = "OBJECT"
    own.material_slots[0].material = material(color=(0.1, 0.9, 0.2))


@case
def nothing_but_the_default() -> None:
    inside.ball("Ball")


@case
def sheen_of_a_dark_hue() -> None:
    inside.ball(
        "Ball", inside.material("ShaderNodeBsdfPrincipled", Base_Color=(0.3, 0.05, 0.3, 1.0), Sheen=1.0, Specular=0.0)
    )


@case
def glass_without_shadows() -> None:
    shader = material("ShaderNodeBsdfGlass", (1.0, 1.0, 1.0))
    tree = shader.node_tree
    glass = tree.nodes["Glass BSDF"]
    glass.inputs["Roughness"].default_value = 0.0
    mixed = tree.nodes.new("ShaderNodeMixShader")
    tree.links.new(make(tree, "ShaderNodeLightPath", "Is Shadow Ray"), mixed.inputs[0])
    tree.links.new(glass.outputs[0], mixed.inputs[1])
    tree.links.new(make(tree, "ShaderNodeBsdfTransparent"), mixed.inputs[2])
    inside.plane(material=material("ShaderNodeBsdfDiffuse"))
    pane = inside.plane("Pane", 1.0, surface(shader, mixed.outputs[0]))
    pane.location = (0.0, 0.0, 1.0)
    inside.lamp("SUN", (0.0, 0.0, 5.0), energy=2.0, angle=0.0)


def glass(ior: float = 1.45, roughness: float = 0.0) -> Any:
    return inside.material("ShaderNodeBsdfGlass", "GGX", IOR=ior, Roughness=roughness)


def sheet(height: float, shader: Any) -> Any:
    result = inside.plane("Sheet", 20.0, shader)
    result.location = (0.0, 0.0, height)
    return result


@case
def sheets_of_glass() -> None:
    """Two, the lower one of which is rough, over a floor that shines: each is met from air."""
    inside.plane(material=material())
    sheet(0.5, glass(1.45, 0.2))
    sheet(1.0, glass(1.6))


@case
def principled_sheet() -> None:
    shader = inside.material("ShaderNodeBsdfPrincipled", Base_Color=(0.8, 0.9, 0.7, 1.0), Roughness=0.0, IOR=1.33)
    inputs = shader.node_tree.nodes["Principled BSDF"].inputs
    (inputs.get("Transmission Weight") or inputs["Transmission"]).default_value = 1.0
    inside.plane(material=material())
    sheet(0.5, shader)


@case
def sheet_from_behind() -> None:
    inside.plane(material=material())
    sheet(0.5, glass()).data.flip_normals()


@case
def light_under_water() -> None:
    """And the surface through a ball of glass."""
    inside.ball("Lamp", material(), (0.0, 1.0, 0.5), 16).scale = (0.5, 0.5, 0.5)
    ball = inside.ball("Ball", glass(1.5), (0.0, -1.0, 1.5), 16)
    ball.data.polygons.foreach_set("use_smooth", [False] * len(ball.data.polygons))
    sheet(1.5, glass(1.33))


@case
def camera_under_water() -> None:
    inside.ball("Lamp", material(), (0.0, 1.0, 6.0), 16)
    sheet(5.5, glass(1.33))
    bpy.context.scene.camera.rotation_euler = (1.7, 0.0, 0.0)


@case
def bowl_of_glass() -> None:
    """Without a thickness, which is no body to be in; before a ball that is one."""
    bowl = inside.ball("Bowl", glass(), segments=16)
    mesh = bmesh.new()
    mesh.from_mesh(bowl.data)
    bmesh.ops.delete(mesh, geom=[v for v in mesh.verts if v.co.z > 0.5], context="VERTS")
    mesh.to_mesh(bowl.data)
    mesh.free()
    bowl.data.polygons.foreach_set("use_smooth", [False] * len(bowl.data.polygons))
    inside.plane(material=material())
    ball = inside.ball("Ball", glass(), (0.0, 1.5, 0.6), 16)
    ball.data.polygons.foreach_set("use_smooth", [False] * len(ball.data.polygons))
    ball.scale = (0.5, 0.5, 0.5)


@case
def glass_around_a_light() -> None:
    ball = inside.ball("Ball", glass(), segments=16)
    ball.data.polygons.foreach_set("use_smooth", [False] * len(ball.data.polygons))
    inside.ball("Lamp", material(), segments=16).scale = (0.6, 0.6, 0.6)


@case
def zones() -> None:
    """0.1 and three times 0.2; and a closure that squares."""
    if bpy.app.version < (5, 0):
        return

    def repeated(tree: Any) -> Any:
        begin, end = tree.nodes.new("GeometryNodeRepeatInput"), tree.nodes.new("GeometryNodeRepeatOutput")
        begin.pair_with_output(end)
        end.repeat_items.new("FLOAT", "Sum")
        begin.inputs["Iterations"].default_value, begin.inputs["Sum"].default_value = 3, 0.1
        tree.links.new(make(tree, "ShaderNodeMath", inputs={0: begin.outputs["Sum"], 1: 0.2}), end.inputs["Sum"])
        return end.outputs["Sum"]

    def squared(tree: Any) -> Any:
        begin, end = tree.nodes.new("NodeClosureInput"), tree.nodes.new("NodeClosureOutput")
        begin.pair_with_output(end)
        call = tree.nodes.new("NodeEvaluateClosure")
        for node in (end, call):
            node.input_items.new("FLOAT", "X")
            node.output_items.new("FLOAT", "Square")
        x = begin.outputs["X"]
        tree.links.new(make(tree, "ShaderNodeMath", inputs={0: x, 1: x}, operation="MULTIPLY"), end.inputs["Square"])
        tree.links.new(end.outputs["Closure"], call.inputs["Closure"])
        call.inputs["X"].default_value = 0.7
        return call.outputs["Square"]

    inside.ball("Repeat", shown(repeated), (-1.2, 0.0, 1.0))
    inside.ball("Closure", shown(squared), (1.2, 0.0, 1.0))


# ---- Attributes --------------------------------------------------------------------------------------------------


def card(name: str, shader: Any, x: float, y: float = 0.0) -> Any:
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata([(-0.5, -0.5, 0.0), (0.5, -0.5, 0.0), (0.5, 0.5, 0.0), (-0.5, 0.5, 0.0)], [], [(0, 1, 2, 3)])
    layer = mesh.uv_layers.new(name="UVMap")
    for loop, uv in enumerate(((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0))):
        layer.data[loop].uv = uv
    return inside.add_mesh(name, mesh, shader, (x, y, 0.3))


@case
def kinds_of_attributes() -> None:
    kinds = ("FLOAT", "EDGE"), ("INT8", "POINT"), ("INT", "FACE"), ("FLOAT_VECTOR", "CORNER"), ("FLOAT2", "POINT")
    for number, (kind, domain) in enumerate(kinds):
        shader = shown(lambda tree: make(tree, "ShaderNodeAttribute", attribute_name="цвет"))
        item = card(kind, shader, 1.1 * number - 2.2)
        data = item.data.attributes.new("цвет", kind, domain).data
        for index, value in enumerate(data):
            if hasattr(value, "vector"):
                value.vector = (0.3 * index, 0.5, 0.2)[: len(value.vector)]
            else:
                value.value = 0.3 * index + 0.2 if kind == "FLOAT" else index + 1


@case
def pointiness() -> None:
    mesh = bpy.data.meshes.new("Block")
    shape = bmesh.new()
    bmesh.ops.create_cube(shape, size=1.6)
    bmesh.ops.bevel(shape, geom=shape.edges[:], offset=0.3, segments=2, affect="EDGES")
    shape.to_mesh(mesh)
    shape.free()
    inside.add_mesh("Block", mesh, shown(lambda tree: make(tree, "ShaderNodeNewGeometry", "Pointiness")))


@case
def vertex_group() -> None:
    """Cycles 3.4 does not know it as an attribute."""
    item = inside.ball("Ball", shown(lambda tree: make(tree, "ShaderNodeAttribute", attribute_name="Group")))
    group = item.vertex_groups.new(name="Group")
    for index in range(0, len(item.data.vertices), 2):
        group.add([index], index / len(item.data.vertices), "REPLACE")


def hair(output: str) -> None:
    item = inside.ball("Ball", shown(lambda tree: make(tree, "ShaderNodeHairInfo", output)))
    item.modifiers.new("Hair", "PARTICLE_SYSTEM")
    settings = item.particle_systems[0].settings
    settings.type, settings.count, settings.hair_length = "HAIR", 60, 1.0
    settings.root_radius, settings.tip_radius, settings.radius_scale = 1.0, 1.0, 0.02


for _output in ("Intercept", "Random", "Length", "Is Strand"):
    CASES[f"hair_{_output.lower().replace(' ', '_')}"] = lambda output=_output: hair(output)  # type: ignore[misc]


# ---- Images ------------------------------------------------------------------------------------------------------


def stored(name: str, file_format: str, is_float: bool = False) -> Any:
    """A saved image, read back."""
    image = bpy.data.images.new(name, 16, 16, alpha=True, float_buffer=is_float)
    x, y = np.meshgrid(np.linspace(0.1, 0.9, 16), np.linspace(0.1, 0.9, 16))
    image.pixels.foreach_set(
        np.stack([0.6 + 0.2 * x, 0.6 + 0.2 * y, np.full_like(x, 0.5), np.ones_like(x)], axis=2)
        .astype(np.float32)
        .ravel()
    )
    path = Path(inside.words()[0]).with_name(f"{name}.{file_format[:3].lower()}")
    image.filepath_raw, image.file_format = str(path), file_format
    image.save()
    bpy.data.images.remove(image)
    return bpy.data.images.load(str(path), check_existing=False)


@case
def color_spaces() -> None:
    names = [
        item.identifier
        for item in type(stored("probe", "PNG").colorspace_settings).bl_rna.properties["name"].enum_items
    ]
    wanted = ("Filmic Log", "Linear ACEScg", "ACEScg", "Display P3", "Rec.2020", "Raw")
    for number, name in enumerate(item for item in wanted if item in names):
        image = stored(f"space{number}", "PNG")
        image.colorspace_settings.name = name
        shader = shown(lambda tree, image=image: make(tree, "ShaderNodeTexImage", image=image))  # type: ignore[misc]
        card(name, shader, 1.1 * (number % 5) - 2.2, 1.1 * (number // 5))


@case
def world_without_its_image() -> None:
    image = stored("gone", "PNG")
    image.filepath = "//nowhere.hdr"
    image.reload()
    tree = bpy.context.scene.world.node_tree
    texture = make(tree, "ShaderNodeTexEnvironment", image=image)
    tree.links.new(texture, tree.nodes["Background"].inputs["Color"])
    inside.ball("Ball", material("ShaderNodeBsdfDiffuse"))


# ---- Objects -----------------------------------------------------------------------------------------------------


def normals() -> Any:
    """A material that shows the normal."""

    def build(tree: Any) -> Any:
        inputs = {0: make(tree, "ShaderNodeNewGeometry", "Normal"), 1: (0.4,) * 3, 2: (0.5,) * 3}
        return make(tree, "ShaderNodeVectorMath", inputs=inputs, operation="MULTIPLY_ADD")

    return shown(build)


@case
def scales() -> None:
    shader = normals()
    mirrored = inside.ball("Mirrored", shader, (-1.5, 0.0, 1.0), segments=12)
    mirrored.scale = (-1.0, 0.7, 1.0)
    parent = bpy.data.objects.new("Parent", None)
    bpy.context.scene.collection.objects.link(parent)
    parent.scale = (2.0, 1.0, 0.5)
    sheared = inside.ball("Sheared", shader, (0.7, 0.0, 1.5), segments=12)
    sheared.parent, sheared.rotation_euler = parent, (0.3, 0.5, 0.7)


@case
def flat_faces_beside_smooth_ones() -> None:
    for x, edges in ((-1.2, 0), (1.2, 20)):
        item = inside.ball("Ball", normals(), (x, 0.0, 1.0), segments=12)
        item.data.polygons.foreach_set("use_smooth", [i % 3 > 0 for i in range(len(item.data.polygons))])
        for edge in item.data.edges[:edges]:
            edge.use_edge_sharp = True


@case
def normals_that_face_away() -> None:
    item = inside.ball("Ball", normals(), segments=12)
    if hasattr(item.data, "use_auto_smooth"):
        item.data.use_auto_smooth = True
    item.data.normals_split_custom_set([(0.0, 0.0, 1.0)] * len(item.data.loops))


@case
def culled() -> None:
    scene = bpy.context.scene
    scene.render.use_simplify = True
    scene.cycles.use_distance_cull, scene.cycles.distance_cull_margin = True, 3.0
    inside.ball("Ball", material()).cycles.use_distance_cull = True


@case
def diced() -> dict[str, Any] | None:
    """Cycles subdivides a cube into a ball of pixels."""
    mesh = bpy.data.meshes.new("Cube")
    shape = bmesh.new()
    bmesh.ops.create_cube(shape, size=2.0)
    shape.to_mesh(mesh)
    shape.free()
    modifier = (item := inside.add_mesh("Cube", mesh, normals(), (0.0, 0.0, 1.0))).modifiers.new("Smooth", "SUBSURF")
    modifier.levels = modifier.render_levels = 1
    if hasattr(modifier, "use_adaptive_subdivision"):  # 5.0 on
        modifier.use_adaptive_subdivision = True
        return None
    item.cycles.use_adaptive_subdivision = True
    return {"feature_set": "EXPERIMENTAL"}


@case
def light_left_out() -> dict[str, Any]:
    """Light beneath a pane of glass that casts shadows."""
    inside.plane("Floor", 5.0, inside.material("ShaderNodeBsdfDiffuse", Color=(0.8, 0.8, 0.8, 1.0)))
    sheet(1.0, glass())
    return {"caustics_refractive": False, "transmission_bounces": 3}


@case
def lamps_that_are_not_normalized() -> None:
    if "normalize" not in bpy.types.PointLight.bl_rna.properties:
        return
    inside.plane(material=material("ShaderNodeBsdfDiffuse", (0.8, 0.8, 0.8)))
    inside.lamp("POINT", (-1.5, 0.0, 1.5), energy=20.0, shadow_soft_size=0.0, normalize=False)
    inside.lamp("SPOT", (1.5, 0.0, 3.0), energy=20.0, shadow_soft_size=0.0, spot_size=0.9, normalize=False)
    inside.lamp("SUN", (0.0, 0.0, 5.0), energy=3.0, angle=0.4, normalize=False)


def lamp_of_nodes(kind: str, build: Callable[[Any], Any], socket: str, **settings: Any) -> None:
    inside.plane("Floor", 5.0, inside.material("ShaderNodeBsdfDiffuse", Color=(0.8, 0.8, 0.8, 1.0)))
    data = inside.lamp(kind, (1.0, -1.0, 3.0), energy=300.0, **settings).data
    data.use_nodes = True
    data.node_tree.links.new(build(data.node_tree), data.node_tree.nodes["Emission"].inputs[socket])


@case
def lamp_of_a_pattern() -> None:
    def pattern(tree: Any) -> Any:
        normal = make(tree, "ShaderNodeTexCoord", "Normal")
        return make(tree, "ShaderNodeTexChecker", "Color", inputs={"Vector": normal, "Scale": 3.0})

    lamp_of_nodes("SPOT", pattern, "Color", spot_size=1.5, shadow_soft_size=0.02)


@case
def lamp_of_another_falloff() -> None:
    def falloff(tree: Any) -> Any:
        return make(tree, "ShaderNodeLightFalloff", "Linear", inputs={"Strength": 0.5, "Smooth": 3.0})

    lamp_of_nodes("AREA", falloff, "Strength", size=0.5)


def photometry(tree: Any) -> Any:
    """Of a quarter turn."""
    down, around = range(0, 100, 10), range(0, 91, 30)
    rows = [[1000.0 + 9.0 * a * (a < 60) - 5.0 * b for a in down] for b in around]
    numbers = [1, 1000, 1.5, len(down), len(around), 1, 2, 0, 0, 0, 0.9, 0.8, 100, *down, *around]
    numbers += [candela for row in rows for candela in row]
    text = bpy.data.texts.new("Photometry")
    text.from_string("IESNA:LM-63-2002\nTILT=NONE\n" + " ".join(map(str, numbers)))

    output = make(tree, "ShaderNodeTexIES", "Fac", inputs={"Strength": 0.02}, mode="INTERNAL")
    output.node.ies = text
    return output


@case
def point_of_photometry() -> None:
    lamp_of_nodes("POINT", photometry, "Strength", shadow_soft_size=0.02)


@case
def area_of_photometry() -> None:
    """Before Blender 4 it goes by the lamp's normal, which is one."""
    lamp_of_nodes("AREA", photometry, "Strength", size=0.2)


@case
def rays_of_mixed_closures() -> None:
    """A floor that is red to glossy rays, about a ball that is diffuse and glossy."""
    shader = inside.material("ShaderNodeBsdfDiffuse")
    tree = shader.node_tree
    glossy = make(tree, "ShaderNodeLightPath", "Is Glossy Ray")
    mixed = make(tree, "ShaderNodeMixRGB", inputs={"Fac": glossy, "Color1": (0.8,) * 4, "Color2": (0.9, 0.0, 0.0, 1.0)})
    tree.links.new(mixed, tree.nodes["Diffuse BSDF"].inputs["Color"])
    inside.plane("Floor", 6.0, shader)
    inside.ball("Ball", inside.material("ShaderNodeBsdfPrincipled", Base_Color=(0.5, 0.5, 0.5, 1.0), Roughness=0.5))


@case
def set_behind_the_scene() -> None:
    other = bpy.data.scenes.new("Set")
    item = inside.ball("Far", material(), (-1.5, 0.0, 1.0))
    bpy.context.scene.collection.objects.unlink(item)
    other.collection.objects.link(item)
    bpy.context.scene.background_set = other
    inside.ball("Near", material(color=(0.1, 0.2, 0.9)), (1.5, 0.0, 1.0))


@case
def layer_without_sky() -> None:
    bpy.context.view_layer.use_sky = False
    inside.ball("Ball", material())


@case
def layer_without_surfaces() -> None:
    bpy.context.view_layer.use_solid = False
    inside.ball("Ball", material())


def wide_pixels(**settings: Any) -> None:
    inside.ball("Ball", normals(), segments=12)
    bpy.context.scene.render.pixel_aspect_x, bpy.context.scene.render.pixel_aspect_y = 3.0, 2.0
    camera = bpy.context.scene.camera.data
    camera.shift_x, camera.shift_y = 0.1, -0.2
    for name, value in settings.items():
        setattr(camera, name, value)


@case
def wide_pixels_of_a_lens() -> None:
    wide_pixels(sensor_fit="VERTICAL", lens=30.0)
    focus = bpy.context.scene.camera.data.dof
    focus.use_dof, focus.focus_distance, focus.aperture_fstop, focus.aperture_ratio = True, 5.0, 0.05, 2.0


@case
def wide_pixels_without_perspective() -> None:
    wide_pixels(type="ORTHO", ortho_scale=4.0)


@case
def wide_pixels_of_a_fisheye() -> None:
    wide_pixels(type="PANO")
    camera = bpy.context.scene.camera.data
    settings = camera if hasattr(camera, "panorama_type") else camera.cycles
    settings.panorama_type, settings.fisheye_lens = "FISHEYE_EQUISOLID", 12.0


@case
def camera_of_a_marker() -> None:
    scene = bpy.context.scene
    other = bpy.data.objects.new("Other", bpy.data.cameras.new("Other"))
    scene.collection.objects.link(other)
    other.location, other.rotation_euler = (5.0, -5.0, 4.0), (1.0, 0.0, 0.8)
    scene.timeline_markers.new("Cut", frame=5).camera = other
    scene.frame_set(6)
    inside.ball("Ball", material())


# ---- Attributes that geometry nodes give instances ---------------------------------------------------------------


class Made:
    """Geometry nodes of an object."""

    def __init__(self, item: Any) -> None:
        self.tree = bpy.data.node_groups.new("Made", "GeometryNodeTree")
        if hasattr(self.tree, "interface"):
            self.tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
        else:
            self.tree.outputs.new("NodeSocketGeometry", "Geometry")
        item.modifiers.new("Made", "NODES").node_group = self.tree

    def node(self, kind: str, inputs: dict[str, Any] | None = None, **settings: Any) -> Any:
        """Its first output that is shown. Inputs by name: values, or sockets to link."""
        node = self.tree.nodes.new(kind)
        for name, value in settings.items():
            setattr(node, name, value)
        for name, value in (inputs or {}).items():
            socket = next(socket for socket in node.inputs if socket.name == name and socket.enabled)
            if isinstance(value, bpy.types.NodeSocket):
                self.tree.links.new(value, socket)
            else:
                socket.default_value = value
        return next(socket for socket in node.outputs if socket.enabled)

    def cubes(self, shader: Any, size: float) -> Any:
        mesh = self.node("GeometryNodeMeshCube", {"Size": (size,) * 3})
        return self.node("GeometryNodeSetMaterial", {"Geometry": mesh, "Material": shader})

    def spread(self, instance: Any, count: int, size: float, kind: str = "FLOAT_VECTOR", name: str = "tint") -> Any:
        """Instances in a square, each with a value of its own, and with ids that are not their order."""
        square = {"Size X": size, "Size Y": size, "Vertices X": count, "Vertices Y": count}
        points, index = self.node("GeometryNodeMeshGrid", square), self.node("GeometryNodeInputIndex")
        step = self.node("ShaderNodeMath", operation="MULTIPLY_ADD")
        step.node.inputs[1].default_value, step.node.inputs[2].default_value = -7.0, 300.0
        self.tree.links.new(index, step.node.inputs[0])
        points = self.node("GeometryNodeSetID", {"Geometry": points, "ID": step})
        instances = self.node("GeometryNodeInstanceOnPoints", {"Points": points, "Instance": instance})
        color = kind == "FLOAT_VECTOR"
        span = {"Min": (0.1,) * 3, "Max": (1.0,) * 3} if color else {"Min": 1, "Max": 3}
        value = self.node("FunctionNodeRandomValue", span, data_type=kind)
        settings = {"Geometry": instances, "Name": name, "Value": value}
        return self.node("GeometryNodeStoreNamedAttribute", settings, data_type=kind, domain="INSTANCE")

    def show(self, geometry: Any) -> None:
        self.tree.links.new(geometry, self.tree.nodes.new("NodeGroupOutput").inputs[0])


def of_instance() -> Any:
    """A material that shines with it."""
    return shown(lambda tree: make(tree, "ShaderNodeAttribute", attribute_name="tint", attribute_type="INSTANCER"))


def points(name: str, location: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Any:
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata([(0.0, 0.0, 0.0)], [], [])
    return inside.add_mesh(name, mesh, None, location)


def in_collection(name: str, *items: Any) -> Any:
    collection = bpy.data.collections.new(name)
    for item in items:
        bpy.context.scene.collection.objects.unlink(item)
        collection.objects.link(item)
    return collection


@case
def made_instances() -> None:
    """Instances within instances: the inner value counts, and that of an object's own property does not."""
    item = points("Points")
    item["tint"] = 0.3
    made, shader = Made(item), of_instance()
    outer = made.spread(made.spread(made.cubes(shader, 0.3), 2, 0.6, "INT"), 3, 3.0)
    plain = made.spread(made.cubes(shader, 0.8), 2, 4.5)
    made.show(made.node("GeometryNodeJoinGeometry", {"Geometry": plain}))
    made.tree.links.new(outer, made.tree.nodes["Join Geometry"].inputs[0])


@case
def made_by_a_curve() -> None:
    """It shows a mesh beside its instances."""
    curve = bpy.data.objects.new("Curve", bpy.data.curves.new("Curve", "CURVE"))
    bpy.context.scene.collection.objects.link(curve)
    made = Made(curve)
    made.show(made.node("GeometryNodeJoinGeometry", {"Geometry": made.spread(made.cubes(of_instance(), 0.7), 3, 4.0)}))
    made.tree.links.new(made.cubes(material(), 1.0), made.tree.nodes["Join Geometry"].inputs[0])


@case
def made_within_collections() -> None:
    """An empty shows an object that scatters a collection of objects that scatter; one is hidden."""
    inner = [points(name) for name in ("Hidden", "Left", "Right")]
    for number, item in enumerate(inner):
        item.hide_render, item.location.x = number == 0, 0.9 * number
        made = Made(item)
        made.show(made.spread(made.cubes(of_instance(), 0.3), 2, 0.5))
    outer = points("Outer")
    made = Made(outer)
    source = made.node("GeometryNodeCollectionInfo", {"Collection": in_collection("Inner", *inner)})
    made.show(made.spread(source, 2, 3.0, name="other"))
    empty = bpy.data.objects.new("Empty", None)
    bpy.context.scene.collection.objects.link(empty)
    empty.instance_type, empty.instance_collection = "COLLECTION", in_collection("Outer", outer)
    empty.location = (-0.5, 0.0, 0.5)


# ---- Renders -----------------------------------------------------------------------------------------------------


def blocks(picture: Any) -> Any:
    height, width = (size // BLOCK * BLOCK for size in picture.shape[:2])
    return picture[:height, :width].reshape(height // BLOCK, BLOCK, width // BLOCK, BLOCK, 3).mean(axis=(1, 3))


def compared(out: Path, build: Build) -> dict[str, Any]:
    scene = inside.empty_scene((0.3, 0.35, 0.4))
    scene.timeline_markers.clear()
    scene.background_set, scene.render.use_simplify = None, False
    layer = bpy.context.view_layer
    layer.use_sky = layer.use_solid = True
    scene.render.pixel_aspect_x = scene.render.pixel_aspect_y = 1.0
    own = build() or {}
    scene = bpy.context.scene
    set_up_cycles(scene, samples=SAMPLES, **own)
    scene.glimmer.samples, scene.glimmer.filter = SAMPLES, "BOX"
    theirs, mine = (blocks(inside.picture(out.with_name("picture.exr"), engine, 1)) for engine in ("CYCLES", "GLIMMER"))
    from glimmer import reports

    notices = reports.last()["export"]["notices"]
    return {"apart": float(np.abs(mine - theirs).max() / theirs.max()), "notices": notices}


def main() -> None:
    out = Path(inside.words()[0])
    inside.enable()
    inside.use_format("OPEN_EXR")
    out.write_text(json.dumps({name: compared(out, build) for name, build in CASES.items()}))


if __name__ == "__main__":
    main()
