# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders a scene on a cluster and by this machine, and exports it: cluster_script.py FOLDER SCHEDULER COMMAND."""

import json
import sys
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).parent))

import inside

OUT, SCHEDULER, COMMAND = inside.words()
bpy.ops.preferences.addon_enable(module="glimmer")
from glimmer import reports  # noqa: E402 - the add-on's name inside Blender
from glimmer.export.differences import find_differences  # noqa: E402

preferences = bpy.context.preferences.addons["glimmer"].preferences
preferences.scheduler, preferences.farm_command = SCHEDULER, COMMAND

scene = inside.empty_scene((0.5, 0.6, 0.7))
scene.render.resolution_x, scene.render.resolution_y = 30, 20
scene.render.film_transparent = True
red = inside.material("ShaderNodeBsdfDiffuse", Color=(0.8, 0.1, 0.1, 1.0))
mixed = bpy.data.materials.new("A mix, first by name")
mixed.use_nodes = True
tree = mixed.node_tree
tree.nodes.clear()
mix, output = tree.nodes.new("ShaderNodeMixShader"), tree.nodes.new("ShaderNodeOutputMaterial")
for kind, socket in (("ShaderNodeBsdfDiffuse", 1), ("ShaderNodeBsdfGlossy", 2)):
    tree.links.new(tree.nodes.new(kind).outputs[0], mix.inputs[socket])
tree.links.new(mix.outputs[0], output.inputs["Surface"])
red.pass_index, mixed.pass_index = 7, 5
inside.ball("Ball", red, segments=16).pass_index = 3
inside.plane(size=3.0, material=mixed).pass_index = 4
inside.lamp("POINT", (2.0, -2.0, 3.0), energy=500.0)
layer = bpy.context.view_layer
layer.use_pass_z = layer.use_pass_object_index = layer.use_pass_material_index = True
layer.use_pass_cryptomatte_material = layer.glimmer.use_stderr = layer.glimmer.use_albedo = True
scene.glimmer.samples, scene.glimmer.cluster_task_samples, scene.glimmer.seed = 16, 2, 5
inside.use_format("OPEN_EXR_MULTILAYER")
bpy.ops.glimmer.export_scene(filepath=f"{OUT}/scene.json")
inside.render(Path(OUT, "local.exr"))
scene.glimmer.use_cluster = True
inside.render(Path(OUT, "cluster.exr"))
before = [str(notice) for notice in find_differences(bpy.context.evaluated_depsgraph_get(), bpy.app.version)]
Path(OUT, "report.json").write_text(json.dumps({**reports.last(), "before": before}))
inside.use_format("PNG")
scene.glimmer.samples = 1_000_000
bpy.ops.wm.save_as_mainfile(filepath=f"{OUT}/endless.blend")
