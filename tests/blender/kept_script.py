# SPDX-License-Identifier: GPL-3.0-or-later
"""Edits one after another, as a 3D view sees them: kept_script.py FACTS.json.

After each the scene is exported with what was kept of the exports before, and once more from nothing. Notes what was
read anew, and whether both are the same.
"""

import json
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).parent))

import inside

OUT = Path(inside.words()[0])
glimmer = inside.enable()
from glimmer.export.camera import export_camera  # noqa: E402 - the add-on's name inside Blender
from glimmer.export.film import export_film, export_view_settings  # noqa: E402
from glimmer.export.kept import Kept  # noqa: E402
from glimmer.export.scene import Exported, View, export_scene  # noqa: E402
from glimmer.jobs import BULK_READERS  # noqa: E402
from glimmer.scene.fingerprint import Fingerprints  # noqa: E402

kept = Kept()
fingerprints = Fingerprints()


def follow(_scene: Any, depsgraph: Any) -> None:
    kept.follow(depsgraph.updates)


bpy.app.handlers.depsgraph_update_post.append(follow)


def export(of: Kept) -> Exported:
    depsgraph = bpy.context.evaluated_depsgraph_get()

    def view(scene: Any, notices: Any) -> View:
        film = export_film(scene, notices)
        camera = export_camera(scene.camera.evaluated_get(depsgraph), (film.width, film.height), notices)
        return View(film, camera, export_view_settings(scene))

    return export_scene(depsgraph, view, bpy.app.version, BULK_READERS, kept=of)


def principled(name: str) -> Any:
    result = bpy.data.materials.new(name)
    result.use_nodes = True
    return result


def input_of(material: Any, name: str) -> Any:
    return next(node for node in material.node_tree.nodes if node.type == "BSDF_PRINCIPLED").inputs[name]


def linked(material: Any, kind: str, output: str) -> Any:
    """A node of this kind, which gives the colour."""
    node = material.node_tree.nodes.new(kind)
    material.node_tree.links.new(node.outputs[output], input_of(material, "Base Color"))
    return node


def build() -> None:
    inside.empty_scene((0.1, 0.2, 0.3))
    inside.ball("Ball", principled("Red"), (2.0, 0.0, 1.0), 16)
    inside.ball("Smooth", principled("Blue"), (-2.0, 0.0, 1.0), 8).modifiers.new("Subdivision", "SUBSURF")
    inside.ball("Moon", inside.material("ShaderNodeEmission"), (0.0, 3.0, 3.0), 16).glimmer.is_sphere = True
    inside.lamp("POINT", (2.0, -2.0, 3.0), energy=500.0)
    follower = inside.ball("Follower", principled("Looking"), (0.0, 0.0, 4.0), 8)
    target = bpy.data.objects.new("Target", None)
    bpy.context.scene.collection.objects.link(target)
    linked(follower.active_material, "ShaderNodeTexCoord", "Object").object = target
    grouped = inside.ball("Grouped", principled("Grouped"), (4.0, 0.0, 4.0), 8)
    group = bpy.data.node_groups.new("Group", "ShaderNodeTree")
    if hasattr(group, "interface"):
        group.interface.new_socket("Color", in_out="OUTPUT", socket_type="NodeSocketColor")
    else:
        group.outputs.new("NodeSocketColor", "Color")
    color = group.nodes.new("ShaderNodeRGB")
    group.links.new(color.outputs[0], group.nodes.new("NodeGroupOutput").inputs[0])
    node = grouped.active_material.node_tree.nodes.new("ShaderNodeGroup")
    node.node_tree = group
    grouped.active_material.node_tree.links.new(node.outputs[0], input_of(grouped.active_material, "Base Color"))
    image = bpy.data.images.new("Image", 4, 4)
    image.filepath_raw, image.file_format = str(OUT.with_name("image.png")), "PNG"
    image.save()
    textured = inside.ball("Textured", principled("Textured"), (-4.0, 0.0, 4.0), 8)
    linked(textured.active_material, "ShaderNodeTexImage", "Color").image = bpy.data.images.load(
        str(OUT.with_name("image.png"))
    )
    bpy.ops.glimmer.add_hexagon_field(rings=6)
    bpy.context.view_layer.objects.active.name = "Field"


def item(name: str) -> Any:
    return bpy.data.objects[name]


def move(name: str) -> None:
    item(name).location.x += 0.25


def tint(name: str) -> None:
    input_of(bpy.data.materials[name], "Base Color").default_value = (0.1, 0.7, 0.2, 1.0)


def reshape(name: str) -> None:
    item(name).data.vertices[0].co.x += 0.1
    item(name).data.update()


def tint_plates() -> None:
    """A color in place of those that the plates have each."""
    material = item("Field").material_slots[0].material
    socket = input_of(material, "Base Color")
    for link in socket.links:
        material.node_tree.links.remove(link)
    socket.default_value = (0.9, 0.5, 0.2, 1.0)


def nothing() -> None:
    pass


def select() -> None:
    item("Ball").select_set(True)
    bpy.context.view_layer.objects.active = item("Ball")


def rename() -> None:
    item("Ball").name = "Kubus"


def rename_back() -> None:
    item("Kubus").name = "Ball"


def set_group_color() -> None:
    node = next(node for node in bpy.data.node_groups["Group"].nodes if node.type == "RGB")
    node.outputs[0].default_value = (0.2, 0.2, 0.9, 1.0)


def paint() -> None:
    nodes = bpy.data.materials["Textured"].node_tree.nodes
    image = next(node.image for node in nodes if node.type == "TEX_IMAGE")
    image.pixels = np.full(4 * 4 * 4, 0.5, np.float32).tolist()
    image.update()


def set_rings() -> None:
    item("Field").glimmer_field.rings = 7


def assign() -> None:
    item("Ball").active_material = bpy.data.materials["Blue"]


def move_and_tint() -> None:
    move("Ball")
    tint("Blue")
    reshape("Ball")


def next_frame() -> None:
    bpy.context.scene.frame_set(bpy.context.scene.frame_current + 1)


def replace_object() -> None:
    """Another of the same name, with another mesh."""
    bpy.data.objects.remove(item("Ball"))
    inside.ball("Ball", bpy.data.materials["Red"], (2.0, 0.0, 1.0), 24)


def add_curve() -> None:
    """From here on instances are listed one by one."""
    data = bpy.data.curves.new("Curve", "CURVE")
    data.bevel_depth = 0.2
    spline = data.splines.new("POLY")
    spline.points.add(1)
    spline.points[1].co = (0.0, 2.0, 1.0, 1.0)
    bpy.context.scene.collection.objects.link(bpy.data.objects.new("Curve", data))


def bend_curve() -> None:
    item("Curve").data.splines[0].points[1].co = (1.0, 2.0, 1.0, 1.0)


def undo() -> None:
    """As the view does then."""
    bpy.ops.ed.undo_push(message="Before")
    move("Moon")
    bpy.ops.ed.undo_push(message="Moved")
    bpy.ops.ed.undo()
    kept.clear()


EDITS: dict[str, Callable[[], None]] = {
    "first": nothing,
    "nothing": nothing,
    "select": select,
    "rename": rename,
    "rename back": rename_back,
    "move a ball": lambda: move("Ball"),
    "move a moon": lambda: move("Moon"),
    "move a lamp": lambda: move("POINT"),
    "move the field": lambda: move("Field"),
    "tint a ball": lambda: tint("Red"),
    "tint a ball with modifiers": lambda: tint("Blue"),
    "tint plates": tint_plates,
    "reshape a ball": lambda: reshape("Ball"),
    "reshape a moon": lambda: reshape("Moon"),
    "set rings": set_rings,
    "move a texture's space": lambda: move("Target"),
    "set a group's color": set_group_color,
    "paint": paint,
    "assign a material": assign,
    "move and tint and reshape": move_and_tint,
    "next frame": next_frame,
    "replace an object": replace_object,
    "add a curve": add_curve,
    "move a ball beside a curve": lambda: move("Ball"),
    "bend the curve": bend_curve,
}
if bpy.app.background and hasattr(bpy.ops.ed, "undo_push") and bpy.app.binary_path:
    EDITS["undo"] = undo

build()
facts: dict[str, Any] = {}
before = b""
for name, edit in EDITS.items():
    edit()
    bpy.context.view_layer.update()
    kept.reads.clear()
    found = export(kept)
    reads = dict(kept.reads)
    fresh = export(Kept())
    digest = fingerprints.of(found.scene)
    facts[name] = {
        "reads": reads,
        "is_new": digest != before,
        "is_right": digest == Fingerprints().of(fresh.scene),
        "same_notices": found.notices == fresh.notices,
    }
    before = digest
OUT.write_text(json.dumps(facts))
