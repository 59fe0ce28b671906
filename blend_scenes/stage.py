# SPDX-License-Identifier: GPL-3.0-or-later
"""What the scene builders share: an empty file with the add-on at work, a camera, haze, materials, and saving."""

import importlib.util
import math
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import bpy

_ADDON = Path(__file__).resolve().parent.parent / "addon"

Color = tuple[float, float, float]


def addon() -> ModuleType:
    """The add-on as the package `glimmer`: an installed and enabled one, or else the one of this checkout."""
    if "glimmer" not in sys.modules:
        spec = importlib.util.spec_from_file_location("glimmer", _ADDON / "__init__.py")
        if spec is None or spec.loader is None:
            raise ImportError(f"no add-on at {_ADDON}")
        module = importlib.util.module_from_spec(spec)
        sys.modules["glimmer"] = module
        spec.loader.exec_module(module)
        module.register()
    return sys.modules["glimmer"]


def tools(name: str) -> ModuleType:
    """A module of the add-on, as "hexfield.field"."""
    addon()
    return importlib.import_module(f"glimmer.{name}")


def clear() -> Any:
    """Leaves one empty scene, with Glimmer as its engine."""
    addon()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine = "GLIMMER"
    scene.render.film_transparent = False
    scene.view_settings.view_transform = "Filmic"
    scene.view_settings.look = "None"
    return scene


def picture(scene: Any, width: int, height: int, samples: int, exposure: float = 0.0) -> None:
    scene.render.resolution_x, scene.render.resolution_y = width, height
    scene.render.resolution_percentage = 100
    scene.view_settings.exposure = exposure
    scene.glimmer.samples = samples
    # The same light in Cycles: as many bounces as matter, nothing cut off.
    cycles = scene.cycles
    cycles.samples = samples
    cycles.max_bounces = cycles.glossy_bounces = cycles.diffuse_bounces = cycles.transmission_bounces = 32
    cycles.volume_bounces = 32
    cycles.sample_clamp_indirect = 0.0
    cycles.blur_glossy = 0.0
    cycles.light_sampling_threshold = 0.0
    cycles.use_adaptive_sampling = False  # its stopping rule loses light
    cycles.use_denoising = False  # Debian's Blender has no denoiser, and would not render


def camera(scene: Any, origin: Color, target: Color, fov_x: float) -> Any:
    """fov_x: the full horizontal angle in degrees."""
    data = bpy.data.cameras.new("Camera")
    data.sensor_fit = "HORIZONTAL"
    data.angle = math.radians(fov_x)
    data.clip_start, data.clip_end = 0.01, 10000.0
    obj = bpy.data.objects.new("Camera", data)
    obj.location = origin
    x, y, z = (b - a for a, b in zip(origin, target, strict=True))
    obj.rotation_euler = (math.atan2(math.hypot(x, y), -z), 0.0, math.atan2(-x, y))
    scene.collection.objects.link(obj)
    scene.camera = obj
    return obj


def haze(
    scene: Any, sigma_s: Color, sigma_a: Color = (0.0, 0.0, 0.0), g: float = 0.0, sky: Color = (0.0, 0.0, 0.0)
) -> None:
    """A world of homogeneous haze with coefficients per length; no haze when both are 0."""
    world = bpy.data.worlds.new("World")
    scene.world = world
    if bpy.app.version < (5, 0):
        world.use_nodes = True
    nodes, links = world.node_tree.nodes, world.node_tree.links
    nodes.clear()
    output = nodes.new("ShaderNodeOutputWorld")
    background = nodes.new("ShaderNodeBackground")
    background.inputs["Color"].default_value = (*sky, 1.0)
    links.new(background.outputs[0], output.inputs["Surface"])
    parts = []
    if max(sigma_s) > 0:
        scatter = nodes.new("ShaderNodeVolumeScatter")
        scatter.inputs["Density"].default_value = max(sigma_s)
        scatter.inputs["Color"].default_value = (*(s / max(sigma_s) for s in sigma_s), 1.0)
        scatter.inputs["Anisotropy"].default_value = g
        parts.append(scatter)
    if max(sigma_a) > 0:
        # Absorption takes (1 - color) times density.
        absorption = nodes.new("ShaderNodeVolumeAbsorption")
        absorption.inputs["Density"].default_value = max(sigma_a)
        absorption.inputs["Color"].default_value = (*(1 - s / max(sigma_a) for s in sigma_a), 1.0)
        parts.append(absorption)
    if len(parts) == 2:
        add = nodes.new("ShaderNodeAddShader")
        for index, part in enumerate(parts):
            links.new(part.outputs[0], add.inputs[index])
        parts = [add]
    if parts:
        links.new(parts[0].outputs[0], output.inputs["Volume"])
    for index, node in enumerate(nodes):
        node.location = 220 * (len(nodes) - index), 0


def surface(name: str, kind: str, **inputs: Any) -> Any:
    """A material of one shader node, as "ShaderNodeBsdfGlossy", with these inputs; colours as three numbers."""
    material = bpy.data.materials.new(name)
    if bpy.app.version < (5, 0):  # from then on always
        material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    shader, output = tree.nodes.new(kind), tree.nodes.new("ShaderNodeOutputMaterial")
    output.location = 250, 0
    for key, value in inputs.items():
        shader.inputs[key.replace("_", " ")].default_value = (*value, 1.0) if isinstance(value, tuple) else value
    tree.links.new(shader.outputs[0], output.inputs["Surface"])
    return material


def sphere(scene: Any, name: str, location: Color, radius: float, material: Any) -> Any:
    """A sphere that Glimmer traces as one."""
    obj = bpy.data.objects.new(name, tools("moons.moon").unit_sphere())
    obj.location, obj.scale = location, (radius,) * 3
    obj.material_slots[0].link = "OBJECT"
    obj.material_slots[0].material = material
    obj.glimmer.is_sphere = True
    scene.collection.objects.link(obj)
    return obj


def moon(scene: Any, name: str, color: Color, strength: float, radius: float, location: Color) -> Any:
    module = tools("moons.moon")
    return module.create(module.Moon(name, color, strength, radius, location), scene.collection)


def field(scene: Any, plate: Any, bevel: Any, **parameters: Any) -> Any:
    """A hexagon field around the origin."""
    values = tools("hexfield.parameters").FieldParameters(**parameters)
    return tools("hexfield.field").create("Hexagon Field", values, plate, bevel, scene.collection)


def world(preset: str, samples: int, plate_radius: float = 1.3) -> tuple[Any, Any]:
    """The scene and the field of an empty file with a world of Glimmer's: plates only where the camera sees them, which
    keeps the file small.
    """
    scene = clear()
    bpy.ops.glimmer.add_glimmer_world(preset=preset, plate_radius=plate_radius)
    picture(scene, 960, 540, samples, scene.view_settings.exposure)
    land = bpy.context.object
    land.glimmer_field.sector = math.radians(66.0)
    return scene, land


def look_through_camera() -> None:
    """The file opens with its picture, but in solid shading: Blender opens none in rendered shading."""
    for window in bpy.context.window_manager.windows:
        for space in (area.spaces.active for area in window.screen.areas if area.type == "VIEW_3D"):
            space.region_3d.view_perspective = "CAMERA"
            space.overlay.show_floor = space.overlay.show_axis_x = space.overlay.show_axis_y = False


def save(script: str) -> Path:
    """Writes the .blend beside its script, or into the folder after `--` on the command line."""
    look_through_camera()
    arguments = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else []
    folder = Path(arguments[0]).resolve() if arguments else Path(script).resolve().parent
    path = folder / (Path(script).stem + ".blend")
    bpy.context.preferences.filepaths.save_version = 0
    bpy.ops.wm.save_as_mainfile(filepath=str(path), compress=True, check_existing=False, relative_remap=False)
    return path
