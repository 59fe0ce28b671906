# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders somebody's .blend by one engine, a few seeds of it: inside_compare.py JOB.json

JOB.json holds "file", "engine" (CYCLES or GLIMMER), "width" in pixels, "samples", "seeds" (how many), "step_rate" (or
null: the file's), "single" (whether Cycles renders no faces that lie on others) and "folder".
Leaves ENGINE.png, as the file's view transform shows the mean of the seeds, and ENGINE.npz: "linear" (seeds, height,
width, 3), "mean", their mean through that transform (height, width, 3), and "without", for each seed the mean of all
others through it (seeds, height, width, 3), bottom row first. And ENGINE.json: seconds, memory, notices.
"""

import json
import math
import resource
import sys
import time
from pathlib import Path
from typing import Any

import bpy
import numpy as np
from mathutils import Euler, Vector

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests" / "blender"), str(ROOT)]

import addon_utils  # noqa: E402 - a bpy module makes it known when it is imported
from exact_cycles import set_up_cycles, use_exr  # noqa: E402 - a neighbour by name

from tests.bench.single import make_single  # noqa: E402

BOUNCES = 64
MOST_STEPS = 65536  # that Cycles takes
VIEW = (math.radians(65.0), 0.0, math.radians(35.0))  # of the camera of files that have none
BOUNDED = ("MESH", "CURVE", "SURFACE", "META", "FONT", "CURVES", "POINTCLOUD", "VOLUME")
KINDS = ("max", "diffuse", "glossy", "transmission", "volume", "transparent_max")


def read(path: Path) -> Any:
    """(height, width, 3) as the file holds it, bottom row first."""
    image = bpy.data.images.load(str(path), check_existing=False)
    width, height = image.size
    pixels = np.empty(width * height * image.channels, np.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    return pixels.reshape(height, width, -1)[..., :3]


def through_view(scene: Any, linear: Any, path: Path) -> Any:
    """Writes linear light as the PNG that the scene's view transform makes of it, and returns that, 0 to 1."""
    height, width = linear.shape[:2]
    image = bpy.data.images.new("Mean", width, height, float_buffer=True, is_data=False)
    rgba = np.concatenate([linear, np.ones((height, width, 1))], axis=2, dtype=np.float32)
    image.pixels.foreach_set(rgba.ravel())
    settings = scene.render.image_settings
    settings.file_format, settings.color_mode, settings.color_depth = "PNG", "RGB", "8"
    image.save_render(str(path), scene=scene)
    bpy.data.images.remove(image)
    return read(path)


def camera_on_all(scene: Any) -> Any:
    """A camera that sees all that is rendered, from above and in front of it."""
    graph = bpy.context.evaluated_depsgraph_get()
    corners = [
        item.matrix_world @ Vector(corner)
        for item in graph.object_instances
        if item.object.type in BOUNDED and not item.object.hide_render
        for corner in item.object.bound_box
    ]
    if not corners:
        raise RuntimeError(f"scene '{scene.name}' has no camera and nothing to see")
    camera = bpy.data.objects.new("Compare", bpy.data.cameras.new("Compare"))
    scene.collection.objects.link(camera)
    center = sum(corners, Vector()) / len(corners)
    radius = max((corner - center).length for corner in corners)
    height, width = sorted((scene.render.resolution_x, scene.render.resolution_y))
    distance = radius / math.sin(math.atan(math.tan(0.5 * camera.data.angle) * height / width))
    turn = Euler(VIEW)
    camera.location, camera.rotation_euler = center + turn.to_matrix() @ Vector((0.0, 0.0, distance)), turn
    camera.data.clip_start, camera.data.clip_end = 1e-4 * distance, 2.0 * distance
    return camera


def prepare(scene: Any, job: dict[str, Any]) -> None:
    """What both engines share: the size, and nothing after the render."""
    render = scene.render
    render.resolution_y = max(round(render.resolution_y * job["width"] / render.resolution_x), 1)
    render.resolution_x, render.resolution_percentage = job["width"], 100
    render.use_compositing = render.use_sequencer = False
    if job["engine"] == "CYCLES":
        set_up_cycles(scene, samples=job["samples"], **{f"{kind}_bounces": BOUNCES for kind in KINDS})
        if job["step_rate"] is not None:
            scene.cycles.volume_step_rate, scene.cycles.volume_max_steps = job["step_rate"], MOST_STEPS
        if job["single"]:
            make_single(scene)
        return
    render.engine = "GLIMMER"
    settings = scene.glimmer
    settings.filter, settings.use_samples, settings.samples = "BOX", True, job["samples"]
    settings.use_seconds = settings.use_target_error = settings.use_adaptive = False
    settings.use_max_depth = settings.use_max_scatter = False


def steps_through_volumes(scene: Any) -> list[str]:
    """How long Cycles' steps are in objects filled with what nodes vary, each in a line."""
    lines = []
    for item in scene.objects:
        for material in {slot.material for slot in item.material_slots if slot.material and slot.material.node_tree}:
            outputs = [node for node in material.node_tree.nodes if node.bl_idname == "ShaderNodeOutputMaterial"]
            shaders = [link.from_node for node in outputs for link in node.inputs["Volume"].links]
            varies = any(socket.is_linked for node in shaders for socket in node.inputs)
            if varies and not material.cycles.homogeneous_volume:
                # Object::compute_volume_step_size of Cycles, before its volumes were unbiased
                rate = scene.cycles.volume_step_rate * getattr(material.cycles, "volume_step_rate", 1.0)
                lines.append(
                    f"Cycles goes through the volume of '{item.name}' by {sum(item.dimensions) / 30.0 * rate:.3g} at a "
                    "time; where that is too far, its picture changes with --step-rate"
                )
    return lines


def main(job: dict[str, Any]) -> None:
    if addon_utils.enable("glimmer", default_set=False) is None:
        raise RuntimeError("the add-on `glimmer` did not start; the reason stands above")
    if not hasattr(bpy.types.Scene, "cycles"):
        addon_utils.enable("cycles", default_set=False)
    bpy.ops.wm.open_mainfile(filepath=job["file"], load_ui=False, use_scripts=False)
    scene, folder, engine = bpy.context.scene, Path(job["folder"]), job["engine"]
    notices: list[str] = []
    if scene.camera is None:
        scene.camera = next((item for item in scene.objects if item.type == "CAMERA"), None) or camera_on_all(scene)
        notices = [f"scene '{scene.name}' has no camera; both engines look through '{scene.camera.name}'"]
    prepare(scene, job)
    linear, cpu, wall = [], [], []
    for seed in range(job["seeds"]):
        scene.cycles.seed = scene.glimmer.seed = seed
        begin = time.process_time(), time.monotonic()
        bpy.ops.render.render()
        cpu.append(time.process_time() - begin[0])
        wall.append(time.monotonic() - begin[1])
        use_exr(scene)
        path = folder / f"{engine}.exr"
        bpy.data.images["Render Result"].save_render(str(path), scene=scene)
        linear.append(read(path))
        path.unlink()
    if engine == "CYCLES":
        notices = steps_through_volumes(scene)
    else:
        from glimmer import reports

        report = reports.last()
        notices += [*report["export"]["notices"], *report["warnings"]]
    peak_bytes = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
    scratch = folder / f"{engine}_seed.png"
    total = np.sum(linear, axis=0, dtype=np.float64)
    without = [through_view(scene, (total - picture) / max(len(linear) - 1, 1), scratch) for picture in linear]
    scratch.unlink()
    mean = through_view(scene, total / len(linear), folder / f"{engine}.png")
    np.savez(folder / f"{engine}.npz", linear=np.array(linear), mean=mean, without=np.array(without))
    told = {
        "cpu": sum(cpu),
        "wall": sum(wall),
        "peak_bytes": peak_bytes,
        "notices": notices,
        "version": bpy.app.version_string,
    }
    (folder / f"{engine}.json").write_text(json.dumps(told))


def run(job: dict[str, Any]) -> None:
    """Why there is no picture stands in ENGINE.txt, as a line."""
    try:
        main(job)
    except Exception as error:
        lines = [line.strip() for line in str(error).splitlines() if line.strip()]
        Path(job["folder"], f"{job['engine']}.txt").write_text(lines[0] if lines else type(error).__name__)
        raise


if __name__ == "__main__":
    run(json.loads(Path(sys.argv[sys.argv.index("--") + 1 if "--" in sys.argv else 1]).read_text()))
