# SPDX-License-Identifier: GPL-3.0-or-later
"""What the scripts that run inside Blender share: the add-on, and small scenes."""

import math
import os
import sys
from pathlib import Path
from typing import Any

import bmesh
import bpy
import numpy as np

sys.path.insert(0, os.environ["GLIMMER_TEST_ADDONS"])

WIDTH, HEIGHT = 60, 40


def words() -> list[str]:
    """The script's own arguments."""
    return sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else sys.argv[1:]


def enable() -> Any:
    import glimmer

    glimmer.register()
    return glimmer


def empty_scene(world: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Any:
    """A camera that looks down on the origin, and nothing else."""
    for item in list(bpy.data.objects):
        bpy.data.objects.remove(item)
    scene = bpy.context.scene
    scene.render.engine = "GLIMMER"
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = WIDTH, HEIGHT, 100
    scene.render.use_border = False
    scene.frame_set(1)
    scene.glimmer.samples = 8
    scene.world = bpy.data.worlds.new("World")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (*world, 1.0)
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.location, camera.rotation_euler = (0.0, -6.0, 5.0), (math.radians(52.0), 0.0, 0.1)
    camera.data.clip_end = 1000.0
    scene.collection.objects.link(camera)
    scene.camera = camera
    return scene


def add_mesh(name: str, mesh: Any, material: Any = None, location: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Any:
    if material is not None:
        mesh.materials.append(material)
    item = bpy.data.objects.new(name, mesh)
    item.location = location
    bpy.context.scene.collection.objects.link(item)
    return item


def plane(name: str = "Floor", size: float = 20.0, material: Any = None) -> Any:
    mesh = bpy.data.meshes.new(name)
    corners = [(-size, -size, 0.0), (size, -size, 0.0), (size, size, 0.0), (-size, size, 0.0)]
    mesh.from_pydata(corners, [], [(0, 1, 2, 3)])
    return add_mesh(name, mesh, material)


def ball(
    name: str, material: Any = None, location: tuple[float, float, float] = (0.0, 0.0, 1.0), segments: int = 64
) -> Any:
    mesh = bpy.data.meshes.new(name)
    shape = bmesh.new()
    bmesh.ops.create_uvsphere(shape, u_segments=segments, v_segments=segments // 2, radius=1.0)
    shape.to_mesh(mesh)
    shape.free()
    mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
    return add_mesh(name, mesh, material, location)


def material(kind: str, distribution: str | None = None, **inputs: Any) -> Any:
    """A material of one shader node; inputs by name, with _ for blanks, and only those that this Blender has."""
    result = bpy.data.materials.new(kind)
    result.use_nodes = True
    tree = result.node_tree
    tree.nodes.clear()
    shader, output = tree.nodes.new(kind), tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(shader.outputs[0], output.inputs["Surface"])
    if distribution is not None:
        shader.distribution = distribution
    for name, value in inputs.items():
        socket = shader.inputs.get(name.replace("_", " "))
        if socket is not None:
            socket.default_value = value
    return result


def lamp(kind: str, location: tuple[float, float, float], **settings: Any) -> Any:
    """Settings that this Blender lacks are left out."""
    data = bpy.data.lights.new(kind, kind)
    for name, value in settings.items():
        if hasattr(data, name):
            setattr(data, name, value)
    item = bpy.data.objects.new(kind, data)
    item.location, item.rotation_euler = location, (0.2, 0.3, 0.0)
    bpy.context.scene.collection.objects.link(item)
    return item


def endless_scene(width: int, height: int) -> None:
    """A lit ball on a floor, with more samples than anybody waits for."""
    scene = empty_scene((0.3, 0.3, 0.3))
    ball("Ball")
    plane()
    lamp("POINT", (2.0, -2.0, 3.0), energy=500.0)
    scene.render.resolution_x, scene.render.resolution_y = width, height
    scene.glimmer.samples = 1_000_000


def use_format(name: str) -> None:
    settings = bpy.context.scene.render.image_settings
    if hasattr(settings, "media_type"):  # 5.0
        settings.media_type = "MULTI_LAYER_IMAGE" if name == "OPEN_EXR_MULTILAYER" else "IMAGE"
    settings.file_format = name
    if name.startswith("OPEN_EXR"):
        settings.color_depth = "32"


def render(path: Path, **options: Any) -> None:
    bpy.context.scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=not options.get("animation", False), **options)


def picture(path: Path, engine: str, seed: int) -> Any:
    """(height, width, 3) of float32, bottom row first: what an engine renders of the scene, by way of that file."""
    scene = bpy.context.scene
    scene.render.engine = engine
    scene.cycles.seed = scene.glimmer.seed = seed
    render(path)
    return pixels(path)


def pixels(path: Path) -> Any:
    """(height, width, 3) of float32, bottom row first: what a file shows."""
    image = bpy.data.images.load(str(path), check_existing=False)
    width, height = image.size
    values = np.empty(width * height * image.channels, np.float32)
    image.pixels.foreach_get(values)
    bpy.data.images.remove(image)
    return values.reshape(height, width, -1)[..., :3]
