# SPDX-License-Identifier: GPL-3.0-or-later
"""Shader AOVs, holdout shaders and ambient occlusion by Cycles and Glimmer in turn: passes_script.py FOLDER. Writes
CYCLES.exr and GLIMMER.exr, each with all passes, and notices.json.
"""

import json
import sys
from pathlib import Path
from typing import Any

import bpy

sys.path.insert(0, str(Path(__file__).parent))

import inside
from exact_cycles import set_up_cycles

OUT = Path(inside.words()[0])
SAMPLES = 64

glimmer = inside.enable()
if not hasattr(bpy.types.Scene, "cycles"):
    bpy.ops.preferences.addon_enable(module="cycles")


def aov_node(tree: Any, name: str) -> Any:
    node = tree.nodes.new("ShaderNodeOutputAOV")
    if hasattr(node, "aov_name"):
        node.aov_name = name
    else:
        node.name = name
    return node


def with_aovs(material: Any, value: float) -> Any:
    """Places in the colour AOV, and a number, that a group gives, in the other."""
    tree = material.node_tree
    place = tree.nodes.new("ShaderNodeNewGeometry")
    tree.links.new(place.outputs["Position"], aov_node(tree, "Places").inputs["Color"])
    group = bpy.data.node_groups.new("Numbers", "ShaderNodeTree")
    aov_node(group, "Number").inputs["Value"].default_value = value
    tree.nodes.new("ShaderNodeGroup").node_tree = group
    return material


def mixed_with_holdout(share: float) -> Any:
    material = inside.material("ShaderNodeBsdfDiffuse", Color=(0.7, 0.6, 0.5, 1.0))
    tree = material.node_tree
    surface = next(n for n in tree.nodes if n.bl_idname == "ShaderNodeOutputMaterial").inputs["Surface"]
    diffuse, hole, mix = (
        surface.links[0].from_node,
        tree.nodes.new("ShaderNodeHoldout"),
        tree.nodes.new("ShaderNodeMixShader"),
    )
    mix.inputs["Fac"].default_value = share
    tree.links.new(diffuse.outputs[0], mix.inputs[1])
    tree.links.new(hole.outputs[0], mix.inputs[2])
    tree.links.new(mix.outputs[0], surface)
    return material


def build() -> Any:
    scene = inside.empty_scene((0.4, 0.5, 0.6))
    inside.plane(size=4.0, material=with_aovs(inside.material("ShaderNodeBsdfDiffuse"), 0.25))
    inside.ball("Hole", mixed_with_holdout(0.75), (-1.0, 0.0, 0.8)).scale = (0.8, 0.8, 0.8)
    inside.ball("Ball", with_aovs(inside.material("ShaderNodeBsdfDiffuse"), 0.5), (1.2, 0.3, 0.8)).scale = (0.8,) * 3
    pane = with_aovs(inside.material("ShaderNodeBsdfTransparent"), 2.0)
    inside.plane("Pane", 0.5, pane).location = (0.3, -2.0, 1.5)
    scene.render.film_transparent = True
    scene.world.light_settings.distance = 1.5
    layer = bpy.context.view_layer
    layer.use_pass_ambient_occlusion = True
    for name, kind in (("Places", "COLOR"), ("Number", "VALUE"), ("Nobody", "COLOR")):
        aov = layer.aovs.add()
        aov.name, aov.type = name, kind
    scene.render.resolution_x, scene.render.resolution_y = 36, 24
    scene.glimmer.samples, scene.glimmer.filter, scene.glimmer.filter_width = SAMPLES, "BLACKMAN_HARRIS", 0.01
    set_up_cycles(scene, samples=SAMPLES, pixel_filter_type="BLACKMAN_HARRIS")
    scene.cycles.filter_width = 0.01
    return scene


scene = build()
inside.use_format("OPEN_EXR_MULTILAYER")
for engine in ("CYCLES", "GLIMMER"):
    scene.render.engine = engine
    inside.render(OUT / f"{engine}.exr")
(OUT / "notices.json").write_text(json.dumps([str(notice) for notice in glimmer.reports.last().get("notices", [])]))
