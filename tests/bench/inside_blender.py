# SPDX-License-Identifier: GPL-3.0-or-later
"""The benchmark's work inside Blender, on one scene: blender -b --python inside_blender.py -- JOB.json

JOB.json holds "scene" (.blend), "haze" (null, or "sigma_s" and "sigma_a") and "roughness" (null, or a number) to put in
place of the file's, "width", "height", "result" (the JSON file to write, with Blender's version) and one of "export"
(where Glimmer's scene file goes) and "cycles": [[samples, seed], ...]. Cycles' pictures go into "folder", each with its
record (see store.py) as soon as it is there; CPU and wall seconds are those of this process meanwhile.
"""

import json
import math
import resource
import sys
import time
from pathlib import Path
from typing import Any

import addon_utils
import bpy

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "blender"))

from exact_cycles import set_up_cycles, use_exr  # noqa: E402 - a neighbour by name


def change(scene: Any, haze: dict[str, list[float]] | None, roughness: float | None) -> None:
    """Makes a variant of the scene."""
    if haze is not None:
        sys.path.insert(0, str(ROOT / "blend_scenes"))
        import stage

        stage.haze(scene, tuple(haze["sigma_s"]), tuple(haze["sigma_a"]))  # type: ignore[arg-type]
    if roughness is None:
        return
    trees = [material.node_tree for material in bpy.data.materials if material.use_nodes]
    glossy = [node for tree in trees for node in tree.nodes if node.bl_idname.startswith("ShaderNodeBsdf")]
    if not glossy or any("Roughness" not in node.inputs for node in glossy):
        raise RuntimeError("a variant in roughness needs materials that have one")
    for node in glossy:
        node.inputs["Roughness"].default_value = roughness


def facet() -> None:
    """Takes all meshes but spheres' their shading normals. Where a reflection off one goes below the true surface,
    Glimmer drops it, and Cycles bends the normal until it does not: another picture (see the benchmark's page).
    """
    meshes = [obj for obj in bpy.data.objects if obj.type == "MESH"]
    for mesh in {obj.data for obj in meshes} - {obj.data for obj in meshes if obj.glimmer.is_sphere}:
        mesh.polygons.foreach_set("use_smooth", [False] * len(mesh.polygons))
        mesh.update()


def correct_spheres(scene: Any) -> None:
    """Cycles has no spheres. Scales their meshes to the area of the sphere and so, being convex, to its mean
    silhouette: as they are in the file, they lack 0.2 % of that. Finer meshes would do too, but the 82 000 lit
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


def render(scene: Any, samples: int, seed: int) -> tuple[float, float]:
    """CPU and wall seconds."""
    scene.cycles.samples, scene.cycles.seed = samples, seed
    cpu, wall = time.process_time(), time.monotonic()
    bpy.ops.render.render()
    return time.process_time() - cpu, time.monotonic() - wall


def render_all(scene: Any, folder: Path, tasks: list[list[int]]) -> None:
    sys.path.insert(0, str(ROOT))
    from tests.bench.store import picture_of, write_record

    correct_spheres(scene)
    set_up_cycles(scene)
    use_exr(scene)
    render(scene, 1, 0)  # what only the first render of a process does
    for samples, seed in tasks:
        cpu, wall = render(scene, samples, seed)
        bpy.data.images["Render Result"].save_render(str(picture_of(folder, samples, seed)), scene=scene)
        peak_bytes = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
        write_record(folder, samples, seed, samples, cpu, wall, peak_bytes, 0, None)


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
    change(scene, job["haze"], job["roughness"])
    facet()
    if "export" in job:
        bpy.ops.glimmer.export_scene(filepath=job["export"])
    else:
        render_all(scene, Path(job["folder"]), job["cycles"])
    Path(job["result"]).write_text(json.dumps({"version": bpy.app.version_string}))


if __name__ == "__main__":
    main(json.loads(Path(sys.argv[sys.argv.index("--") + 1]).read_text()))
