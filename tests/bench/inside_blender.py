# SPDX-License-Identifier: GPL-3.0-or-later
"""The benchmark's work inside Blender, on one scene: blender -b --python inside_blender.py -- JOB.json

JOB.json holds "scene" (.blend), "width", "height", "export" (where Glimmer's scene file goes), "folder" (for the
pictures of Cycles), "cycles" ([[samples, seed], ...] or []) and "result": the JSON file to write, with Blender's
version and, for each render, its samples, its seed, the CPU seconds (user + system) of this process meanwhile, and
its picture.
"""

import json
import math
import os
import sys
from pathlib import Path
from typing import Any

import addon_utils
import bpy


def cpu_seconds() -> float:
    times = os.times()
    return times.user + times.system


def correct_spheres(scene: Any) -> None:
    """Cycles has no spheres. Scales their meshes to the area of the sphere and so, being convex, to its mean
    silhouette: as they are in the file, they lack 0.3 % of that. Finer meshes would do too, but the 82 000 lit
    triangles of 64 x 128 faces cost Cycles a quarter to a third more time a sample.
    """
    for mesh in {obj.data for obj in scene.objects if obj.type == "MESH" and obj.glimmer.is_sphere}:
        area = sum(polygon.area for polygon in mesh.polygons)
        scale = math.sqrt(4 * math.pi / area)
        if not 1 < scale < 1.01:
            raise RuntimeError(f"{mesh.name}: the area of a unit sphere's mesh is {area}")
        for vertex in mesh.vertices:
            vertex.co *= scale
        mesh.update()


def set_up_cycles(scene: Any) -> None:
    """Nothing that biases, and the sampling that suits fog best. What a version does not know is left out."""
    scene.render.engine = "CYCLES"
    settings = {
        "device": "CPU",
        "use_denoising": False,
        "use_adaptive_sampling": False,
        "sample_clamp_direct": 0.0,
        "sample_clamp_indirect": 0.0,
        "blur_glossy": 0.0,
        "caustics_reflective": True,
        "caustics_refractive": True,
        "pixel_filter_type": "BOX",
        "use_light_tree": True,
        "volume_biased": True,
    }
    bounces = ("max", "diffuse", "glossy", "transmission", "volume", "transparent_max")
    settings |= {f"{kind}_bounces": 1024 for kind in bounces}
    for name, value in settings.items():
        if hasattr(scene.cycles, name):
            setattr(scene.cycles, name, value)
    scene.world.cycles.volume_sampling = "MULTIPLE_IMPORTANCE"


def render(scene: Any, samples: int, seed: int) -> float:
    scene.cycles.samples, scene.cycles.seed = samples, seed
    before = cpu_seconds()
    bpy.ops.render.render()
    return cpu_seconds() - before


def main(job: dict[str, Any]) -> None:
    if addon_utils.enable("glimmer", default_set=False) is None:
        raise RuntimeError("the add-on `glimmer` did not start; the reason stands above")
    if not hasattr(bpy.types.Scene, "cycles"):
        addon_utils.enable("cycles", default_set=False)
    bpy.ops.wm.open_mainfile(filepath=job["scene"])
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y = job["width"], job["height"]
    scene.render.resolution_percentage = 100
    scene.glimmer.filter = "BOX"
    bpy.ops.glimmer.export_scene(filepath=job["export"])
    renders: list[dict[str, Any]] = []
    if job["cycles"]:
        correct_spheres(scene)
        set_up_cycles(scene)
        image = scene.render.image_settings
        if hasattr(image, "media_type"):  # 5.0 on
            image.media_type = "IMAGE"
        image.file_format, image.color_mode, image.color_depth = "OPEN_EXR", "RGB", "32"
        render(scene, 1, 0)  # what only the first render of a process does
        for samples, seed in job["cycles"]:
            cpu = render(scene, samples, seed)
            picture = Path(job["folder"]) / f"cycles_{samples}_{seed}.exr"
            bpy.data.images["Render Result"].save_render(str(picture), scene=scene)
            renders.append({"samples": samples, "seed": seed, "cpu": cpu, "picture": str(picture)})
    Path(job["result"]).write_text(json.dumps({"version": bpy.app.version_string, "renders": renders}))


if __name__ == "__main__":
    main(json.loads(Path(sys.argv[sys.argv.index("--") + 1]).read_text()))
