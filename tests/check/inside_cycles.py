# SPDX-License-Identifier: GPL-3.0-or-later
"""The suite's scenes in Cycles, within Blender: blender -b --python inside_cycles.py -- JOB.json

JOB.json holds "scenes" (a list of {"name", "scene", "lamps", "samples", "max_scatter"}), "seeds", "folder" (for the
pictures, SCENE_SEED.exr) and "result": the JSON file to write, with Blender's version, what was set of Cycles and its
CPU seconds by scene. A "scene" is a SceneDescription: dataclasses as objects that have their class's name under "is".
"""

import json
import math
import os
import sys
from pathlib import Path
from typing import Any

import bmesh
import bpy
from mathutils import Matrix

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "blender"))

from exact_cycles import MOST_BOUNCES, set_up_cycles, use_exr

SPLITS = 4  # of the icosahedron that stands for a sphere: 1280 faces; far from the origin finer ones collapse


# ---- Materials -----------------------------------------------------------------------------------------------------


def strength_and_color(value: list[float]) -> tuple[float, tuple[float, float, float, float]]:
    """Cycles takes colours beyond 1, Blender's sockets do not all."""
    strength = max(value) or 1.0
    return strength, (value[0] / strength, value[1] / strength, value[2] / strength, 1.0)


class Nodes:
    """The shader nodes of a material or a world."""

    def __init__(self, owner: Any) -> None:
        owner.use_nodes = True
        self._tree = owner.node_tree
        self._tree.nodes.clear()
        self._end: Any = None

    def add(self, kind: str, **values: Any) -> Any:
        """A node; values of its sockets by name, _ for blanks, or of its properties."""
        node = self._tree.nodes.new(kind)
        for name, value in values.items():
            if name.islower():
                setattr(node, name, value)
            else:
                node.inputs[name.replace("_", " ")].default_value = value
        return node

    def join(self, kind: str, a: Any, b: Any, first: int = 0, **values: Any) -> Any:
        node = self.add(kind, **values)
        self._tree.links.new(a.outputs[0], node.inputs[first])
        self._tree.links.new(b.outputs[0], node.inputs[first + 1])
        return node

    def end(self, kind: str, socket: str, node: Any) -> None:
        self._end = self._end or self._tree.nodes.new(kind)  # of several only one would count
        self._tree.links.new(node.outputs[0], self._end.inputs[socket])

    def emission(self, radiance: list[float]) -> Any:
        strength, color = strength_and_color(radiance)
        return self.add("ShaderNodeEmission", Color=color, Strength=strength)

    def surface(self, m: dict[str, Any]) -> Any:
        node = self._alone(m)
        if any(m.get("emission", ())):
            return self.join("ShaderNodeAddShader", node, self.emission(m["emission"]))
        return node

    def _alone(self, m: dict[str, Any]) -> Any:
        kind = m["is"]
        if kind == "Lambert":
            return self.add("ShaderNodeBsdfDiffuse", Color=(*m["albedo"], 1.0), Roughness=0.0)
        if kind == "Mirror":
            return self.add("ShaderNodeBsdfGlossy", distribution="SHARP", Color=(*m["reflectance"], 1.0), Roughness=0.0)
        if kind == "Conductor" and m["f0"] is not None and min(m["f0"]) == 1.0:  # no angle changes that
            roughness = math.sqrt(m["alpha"])
            return self.add("ShaderNodeBsdfGlossy", distribution="GGX", Color=(1, 1, 1, 1), Roughness=roughness)
        if kind == "Glass":
            white = (1.0, 1.0, 1.0, 1.0)
            return self.add("ShaderNodeBsdfGlass", distribution="SHARP", Color=white, Roughness=0.0, IOR=m["ior"])
        if kind == "Light":
            return self.emission(m["radiance"])
        if kind == "Mix":
            a, b = self.surface(m["a"]), self.surface(m["b"])
            return self.join("ShaderNodeMixShader", b, a, first=1, Fac=m["weight"])
        raise ValueError(f"{kind} has no counterpart in Cycles")


def make_material(m: dict[str, Any]) -> Any:
    item = bpy.data.materials.new(m["is"])
    nodes = Nodes(item)
    nodes.end("ShaderNodeOutputMaterial", "Surface", nodes.surface(m))
    return item


def make_world(environment: dict[str, Any], medium: dict[str, Any] | None) -> Any:
    world = bpy.data.worlds.new("World")
    nodes = Nodes(world)
    strength, color = strength_and_color(environment["radiance"])
    nodes.end("ShaderNodeOutputWorld", "Surface", nodes.add("ShaderNodeBackground", Color=color, Strength=strength))
    if medium is not None:
        scattering, tint = strength_and_color(medium["sigma_s"])
        density, color = strength_and_color(medium["sigma_a"])
        passes = tuple(1.0 - c for c in color[:3])
        fog = nodes.join(
            "ShaderNodeAddShader",
            nodes.add("ShaderNodeVolumeScatter", Color=tint, Density=scattering, Anisotropy=medium["g"]),
            nodes.add("ShaderNodeVolumeAbsorption", Color=(*passes, 1.0), Density=density),
        )
        nodes.end("ShaderNodeOutputWorld", "Volume", fog)
    world.cycles.homogeneous_volume = True
    return world


# ---- Things --------------------------------------------------------------------------------------------------------


def put(name: str, data: Any, matrix: Any) -> Any:
    item = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(item)
    item.matrix_world = matrix
    return item


def add_object(item: dict[str, Any], materials: list[Any]) -> None:
    mesh = bpy.data.meshes.new(item["name"])
    mesh.from_pydata(item["mesh"]["vertices"], [], item["mesh"]["triangles"])
    mesh.materials.append(materials[item["materials"][0]])
    for instance in item["instances"] or [Matrix()]:
        put(item["name"], mesh, Matrix(item["to_world"]) @ Matrix(instance))


def ball() -> Any:
    """A closed mesh of the area of the unit sphere and so, being convex, of its mean silhouette."""
    mesh, shape = bpy.data.meshes.new("ball"), bmesh.new()
    bmesh.ops.create_icosphere(shape, subdivisions=SPLITS, radius=1.0)
    scale = math.sqrt(4 * math.pi / sum(face.calc_area() for face in shape.faces))
    bmesh.ops.scale(shape, vec=(scale, scale, scale), verts=shape.verts)
    shape.to_mesh(mesh)
    shape.free()
    return mesh


def add_point(position: list[float], intensity: list[float], radius: float) -> None:
    """intensity: W/sr, a quarter of a pi of Blender's power."""
    strength, color = strength_and_color(intensity)
    lamp = bpy.data.lights.new("point", "POINT")
    lamp.energy, lamp.color, lamp.shadow_soft_size = 4 * math.pi * strength, color[:3], radius
    lamp.cycles.max_bounces = MOST_BOUNCES
    put("point", lamp, Matrix.Translation(position))


def add_spheres(item: dict[str, Any], descriptions: list[dict[str, Any]], materials: list[Any], lamps: bool) -> None:
    m = descriptions[item["material"]]
    for center, radius in zip(item["centers"], item["radii"], strict=True):
        if lamps and m["is"] == "Light":
            add_point(center, [math.pi * radius**2 * c for c in m["radiance"]], radius)
            continue
        mesh = ball()
        mesh.materials.append(materials[item["material"]])
        put("ball", mesh, Matrix.Translation(center) @ Matrix.Scale(radius, 4))


def make_camera(camera: dict[str, Any]) -> Any:
    data = bpy.data.cameras.new("Camera")
    data.sensor_fit, data.sensor_width = "HORIZONTAL", 36.0
    data.lens = 18.0 / math.tan(math.radians(camera["projection"]["fov_x"]) / 2)
    data.clip_start, data.clip_end = 1e-6, 1e12  # the first is the least that Blender takes
    return put("Camera", data, Matrix(camera["to_world"]))


def make_scene(description: dict[str, Any], lamps: bool) -> Any:
    """Replaces all that there is."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    if not hasattr(bpy.types.Scene, "cycles"):
        bpy.ops.preferences.addon_enable(module="cycles")
    scene = bpy.context.scene
    scene.camera = make_camera(description["camera"])
    film = description["film"]
    scene.render.resolution_x, scene.render.resolution_y = film["width"], film["height"]
    scene.render.resolution_percentage = 100
    scene.world = make_world(description["environment"], description["medium"])
    descriptions = [named["material"] for named in description["materials"]]
    materials = [make_material(m) for m in descriptions]
    for item in description["objects"]:
        add_object(item, materials)
    for item in description["spheres"]:
        add_spheres(item, descriptions, materials, lamps)
    for lamp in description["lights"]:
        if lamp["is"] != "PointLight":
            raise ValueError(f"{lamp['is']} is not made here")
        add_point(lamp["position"], lamp["intensity"], lamp["radius"])
    return scene


# ---- Rendering -----------------------------------------------------------------------------------------------------


def set_up(scene: Any, samples: int, max_scatter: int) -> dict[str, Any]:
    """What is set of Cycles."""
    use_exr(scene)
    scattering = {"volume_bounces": max_scatter - 1} if max_scatter >= 0 else {}
    return set_up_cycles(scene, samples=samples, **scattering)


def cpu_seconds() -> float:
    times = os.times()
    return times.user + times.system


def main(job: dict[str, Any]) -> None:
    told: dict[str, Any] = {"version": bpy.app.version_string, "cpu": {}}
    for number, item in enumerate(job["scenes"]):
        scene = make_scene(item["scene"], item["lamps"])
        told["settings"] = set_up(scene, item["samples"], item["max_scatter"])
        before = cpu_seconds()
        for seed in range(job["seeds"]):
            scene.cycles.seed = seed
            bpy.ops.render.render()
            picture = Path(job["folder"]) / f"{number}_{seed}.exr"
            bpy.data.images["Render Result"].save_render(str(picture), scene=scene)
        told["cpu"][item["name"]] = cpu_seconds() - before
    Path(job["result"]).write_text(json.dumps(told))


if __name__ == "__main__":
    main(json.loads(Path(sys.argv[sys.argv.index("--") + 1]).read_text()))
