# SPDX-License-Identifier: GPL-3.0-or-later
"""Describes the scenes of blend_scenes/ inside a Blender: as their scripts build them and as their files hold them.

    blender -b --python scene_checks.py -- WHAT OUT.json     or     python scene_checks.py WHAT OUT.json

WHAT is "open" for {scene: {"plates": ..., "instances": ..., "mean": of a small render}}; "compare" for the first two
and "built" and "file", descriptions made of what the scene depends on by walking Blender's own lists of properties; or
"furnace" for the mean and the standard error of pictures. test_scenes.py judges.
"""

import importlib
import json
import sys
from pathlib import Path
from typing import Any

import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).parent))
from exact_cycles import use_exr

SCENES = Path(__file__).resolve().parents[2] / "blend_scenes"
sys.path.insert(0, str(SCENES))
stage = importlib.import_module("stage")

# Of a session, not of a scene.
_SKIPPED = {"rna_type", "filepath", "name_full", "tag", "is_evaluated", "select", "show_expanded", "active_index"}
_LISTS = ("objects", "materials", "worlds", "cameras", "node_groups", "collections")


def properties(struct: Any) -> dict[str, Any]:
    """What can be set on a struct: numbers, texts, and the names of other datablocks."""
    found: dict[str, Any] = {}
    for prop in struct.bl_rna.properties:
        name = prop.identifier
        if name in _SKIPPED or name.startswith(("select", "bl_")) or prop.is_readonly:
            continue
        value = getattr(struct, name)
        if prop.type in {"BOOLEAN", "INT", "FLOAT"} and prop.is_array:
            found[name] = np.array(value).ravel().tolist()
        elif prop.type == "ENUM" and prop.is_enum_flag:
            found[name] = sorted(value)
        elif prop.type in {"BOOLEAN", "INT", "FLOAT", "STRING", "ENUM"}:
            found[name] = value
        elif prop.type == "POINTER" and isinstance(value, bpy.types.ID):
            found[name] = value.name
    return found


def tree(nodes: Any) -> dict[str, Any]:
    links = [
        f"{link.from_node.name}.{link.from_socket.identifier} -> {link.to_node.name}.{link.to_socket.identifier}"
        for link in nodes.links
    ]
    described = {}
    for node in nodes.nodes:
        inputs = {socket.identifier: properties(socket) for socket in node.inputs}
        described[node.name] = {"type": node.bl_idname, "properties": properties(node), "inputs": inputs}
    return {"nodes": described, "links": sorted(links)}


def mesh(data: Any) -> dict[str, Any]:
    co = np.empty(3 * len(data.vertices), np.float32)
    data.vertices.foreach_get("co", co)
    attributes = {}
    for attribute in data.attributes:
        member = {"FLOAT_VECTOR": ("vector", 3, np.float32), "INT": ("value", 1, np.int32)}.get(attribute.data_type)
        if attribute.name.startswith("glimmer") and member is not None:
            values = np.empty(member[1] * len(attribute.data), member[2])
            attribute.data.foreach_get(member[0], values)
            attributes[attribute.name] = values.tolist()
    return {
        "vertices": co.tolist(),
        "faces": [list(polygon.vertices) for polygon in data.polygons],
        "slots": [polygon.material_index for polygon in data.polygons],
        "smooth": [polygon.use_smooth for polygon in data.polygons],
        "sharp": [edge.use_edge_sharp for edge in data.edges],
        "materials": [material and material.name for material in data.materials],
        "attributes": attributes,
    }


def describe() -> dict[str, Any]:
    bpy.context.view_layer.update()
    scene = bpy.context.scene
    found: dict[str, Any] = {
        "render": properties(scene.render),
        "view": properties(scene.view_settings),
        "cycles": properties(scene.cycles),
        "glimmer": properties(scene.glimmer),
        "scene": {"camera": scene.camera.name, "world": scene.world.name},
        "meshes": {data.name: mesh(data) for data in bpy.data.meshes},
    }
    for name in _LISTS:
        found[name] = {data.name: properties(data) for data in getattr(bpy.data, name)}
    for data in (*bpy.data.materials, *bpy.data.worlds):
        found[f"nodes of {data.name}"] = tree(data.node_tree)
    for data in bpy.data.node_groups:
        found[f"nodes of {data.name}"] = tree(data)
    for data in bpy.data.collections:
        found["collections"][data.name]["objects"] = [obj.name for obj in data.objects]
    for obj in bpy.data.objects:
        found["objects"][obj.name] |= {
            "in the scene": obj.name in scene.collection.objects,
            "glimmer": properties(obj.glimmer),
            "field": properties(obj.glimmer_field),
            "slots": [slot.material and slot.material.name for slot in obj.material_slots],
            "modifiers": [properties(modifier) for modifier in obj.modifiers],
        }
    return found


def plates() -> tuple[int, int]:
    """How many plates the file has: as the bulk export finds them, and as Blender's own loop does."""
    depsgraph = bpy.context.evaluated_depsgraph_get()
    export = stage.tools("hexfield.export").export_instances
    results = [export(obj.evaluated_get(depsgraph), depsgraph) for obj in bpy.context.scene.objects]
    exported = sum(len(matrices) for result in results if result is not None for _, matrices, _ in result)
    return exported, sum(instance.is_instance for instance in depsgraph.object_instances)


def rendered_mean(picture: Path, width: int, height: int) -> float:
    """Of a render of the open file, which is written to `picture`."""
    render = bpy.context.scene.render
    render.resolution_x, render.resolution_y, render.resolution_percentage = width, height, 100
    use_exr(bpy.context.scene)
    render.filepath = str(picture)
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(str(picture))
    pixels = np.empty(4 * width * height, np.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    return float(pixels.reshape(-1, 4)[:, :3].mean(dtype=np.float64))


def furnace(picture: Path) -> dict[str, Any]:
    """Mean and standard error of the furnace over renders by Glimmer, a seed each: pixels share light paths, so theirs
    are not independent.
    """
    renders = 64
    bpy.ops.wm.open_mainfile(filepath=str(SCENES / "furnace.blend"))
    settings = bpy.context.scene.glimmer
    settings.samples = 32
    means = []
    for seed in range(renders):
        settings.seed = seed
        means.append(rendered_mean(picture, 96, 54))
    return {"mean": np.mean(means), "error": np.std(means, ddof=1) / np.sqrt(renders), "renders": renders}


def main(what: str, path: str) -> None:
    stage.addon()
    if what == "furnace":
        Path(path).write_text(json.dumps(furnace(Path(path).with_suffix(".exr"))))
        return
    results: dict[str, dict[str, Any]] = {}
    for script in sorted(SCENES.glob("*.py")):
        if script.stem in ("stage", "render_blend"):  # what the builders share; what `build.py render` runs
            continue
        result = results.setdefault(script.stem, {})
        if what == "compare":
            importlib.import_module(script.stem).build()
            result["built"] = describe()
        bpy.ops.wm.open_mainfile(filepath=str(script.with_suffix(".blend")))
        if what == "compare":
            result["file"] = describe()
        result["plates"], result["instances"] = plates()
        if what == "open":
            bpy.context.scene.glimmer.samples = 4
            result["mean"] = rendered_mean(Path(path).with_suffix(".exr"), 64, 36)
    Path(path).write_text(json.dumps(results))


if __name__ == "__main__":
    main(*sys.argv[-2:])
