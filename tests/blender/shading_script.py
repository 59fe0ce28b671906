# SPDX-License-Identifier: GPL-3.0-or-later
"""Every node and each of its options as emission, by Cycles and by Glimmer: shading_script.py FILE FAMILY.

Emission shows a node's value without noise. Each case is a patch of its own in one picture, tilted, so that all three
coordinates vary; both engines render the same scene. Writes for each case how far the two are apart.
"""

import json
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).parent))

import inside
import shading_cases

PATCH = 32  # pixels along a side
SIZE = 4.0  # of a patch in the world
HEIGHT = 60.0  # of the camera
SLOPE = (0.37, 0.21, 0.13)  # z = 0.37 x + 0.21 y + 0.13
# Values are brought into this window, since negative light is none.
GAIN, LIFT = 0.01, 1.0


def emission(name: str, build: Callable[[Any], Any]) -> Any:
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    output, shader = tree.nodes.new("ShaderNodeOutputMaterial"), tree.nodes.new("ShaderNodeEmission")
    window = tree.nodes.new("ShaderNodeVectorMath")
    window.operation = "MULTIPLY_ADD"
    window.inputs[1].default_value, window.inputs[2].default_value = (GAIN,) * 3, (LIFT,) * 3
    tree.links.new(build(tree), window.inputs[0])
    tree.links.new(window.outputs[0], shader.inputs["Color"])
    tree.links.new(shader.outputs[0], output.inputs["Surface"])
    return material


def patch(name: str, material: Any, x: float, y: float) -> Any:
    half = SIZE / 2.0
    corners = [(a * half, b * half) for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata([(a, b, SLOPE[0] * a + SLOPE[1] * b + SLOPE[2]) for a, b in corners], [], [(0, 1, 2, 3)])
    layer = mesh.uv_layers.new(name="UVMap")
    for loop, uv in enumerate(((0.0, 0.0), (1.0, 0.1), (1.1, 0.9), (0.1, 0.8))):
        layer.data[loop].uv = uv
    return inside.add_mesh(name, mesh, material, (x, y, 0.0))


def build_scene(cases: list[tuple[str, Callable[[Any], Any]]]) -> tuple[Any, int]:
    """The scene, and how many patches stand in a row."""
    scene = inside.empty_scene()
    columns = int(np.ceil(np.sqrt(len(cases))))
    for number, (name, build) in enumerate(cases):
        x, y = number % columns, number // columns
        item = patch(name, emission(name, build), (x + 0.5) * SIZE, (y + 0.5) * SIZE)
        item.color, item.pass_index = (0.2, 0.4, 0.6, 0.8), number
    camera = scene.camera
    camera.location, camera.rotation_euler = (columns * SIZE / 2.0, columns * SIZE / 2.0, HEIGHT), (0.0, 0.0, 0.0)
    camera.data.sensor_fit = "HORIZONTAL"
    # Parallel rays: at the end of slanted ones Cycles' positions are off by more than fine textures forgive.
    camera.data.type, camera.data.ortho_scale = "ORTHO", columns * SIZE
    camera.data.clip_end = 2.0 * HEIGHT
    scene.render.resolution_x = scene.render.resolution_y = columns * PATCH
    scene.view_settings.view_transform = "Standard" if "Standard" in _views(scene) else "Raw"
    inside.use_format("OPEN_EXR")
    return scene, columns


def _views(scene: Any) -> list[str]:
    return [item.identifier for item in scene.view_settings.bl_rna.properties["view_transform"].enum_items] or ["Raw"]


def picture(path: Path, engine: str) -> Any:
    """(height, width, 3), bottom row first."""
    scene = bpy.context.scene
    scene.render.engine = engine
    inside.render(path)
    image = bpy.data.images.load(str(path))
    image.colorspace_settings.name = "Non-Color"
    width, height = image.size
    pixels = np.empty(width * height * image.channels, np.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    return pixels.reshape(height, width, -1)[..., :3]


@dataclass(frozen=True)
class Difference:
    off: float  # the part of pixels that are apart
    mean: float  # over the range
    range: float


def compare(mine: Any, theirs: Any) -> Difference:
    """Pixels are apart where they differ by more than 1e-4 of the range and three hundredths of what their
    neighbours differ by: no renderer samples a pixel's very middle."""
    span = max(float(theirs.max() - theirs.min()), 0.1 * GAIN)
    height, width = theirs.shape[:2]
    around = np.stack([theirs[y : height - 2 + y, x : width - 2 + x] for y in range(3) for x in range(3)])
    bound = 1e-4 * span + 0.03 * (around.max(axis=0) - around.min(axis=0))
    apart = np.abs(mine - theirs)[1:-1, 1:-1]
    return Difference(float((~(apart <= bound)).any(axis=2).mean()), float(apart.mean() / span), span)


def main() -> None:
    out, family = (Path(inside.words()[0]), inside.words()[1])
    inside.enable()
    cases = shading_cases.FAMILIES[family]()
    scene, columns = build_scene(cases)
    cycles = scene.cycles
    cycles.samples, cycles.use_adaptive_sampling, cycles.use_denoising = 1, False, False
    cycles.pixel_filter_type, cycles.filter_width, cycles.max_bounces = "GAUSSIAN", 0.01, 0
    theirs = picture(out.with_name("cycles.exr"), "CYCLES")
    cycles.max_bounces = 12  # its own: one that is lower is told
    scene.glimmer.samples, scene.glimmer.filter, scene.glimmer.filter_width = 1, "BLACKMAN_HARRIS", 0.01
    mine = picture(out.with_name("glimmer.exr"), "GLIMMER")
    from glimmer import reports

    report = reports.last()
    facts = {}
    for number, (name, _) in enumerate(cases):
        x, y = number % columns * PATCH, number // columns * PATCH
        window = (slice(y, y + PATCH), slice(x, x + PATCH))
        found = compare(mine[window], theirs[window])
        facts[name] = {"off": found.off, "mean": found.mean, "range": found.range}
    out.write_text(json.dumps({"cases": facts, "report": report}))


if __name__ == "__main__":
    main()
