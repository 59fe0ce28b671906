# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders everything that test_render.py looks at, in one process: render_script.py FOLDER."""

import json
import sys
import time
from pathlib import Path
from typing import Any

import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).parent))

import inside

OUT = Path(inside.words()[0])
glimmer = inside.enable()
from glimmer import reports  # noqa: E402 - the add-on's name inside Blender
from glimmer.film import denoise, passes  # noqa: E402
from glimmer.native import render as native_render  # noqa: E402
from glimmer.properties import scene as scene_properties  # noqa: E402

facts: dict[str, Any] = {}


def new_scene() -> Any:
    scene = inside.empty_scene((0.1, 0.1, 0.15))
    inside.plane(material=inside.material("ShaderNodeBsdfDiffuse", Color=(0.5, 0.4, 0.3, 1.0)))
    ball = inside.ball("Ball", inside.material("ShaderNodeBsdfDiffuse", Color=(0.1, 0.2, 0.8, 1.0)))
    ball.pass_index = 5
    ball.active_material.pass_index = 9
    moon = inside.ball("Moon", inside.material("ShaderNodeEmission", Strength=4.0), (2.0, 0.0, 1.5), 32)
    moon.scale = (0.4, 0.4, 0.4)
    moon.glimmer.is_sphere = True
    inside.lamp("POINT", (-2.0, -2.0, 3.0), energy=100.0, shadow_soft_size=0.2)
    return scene


def stills() -> None:
    scene = new_scene()
    inside.use_format("OPEN_EXR")
    inside.render(OUT / "full.exr")
    facts["report"] = dict(reports.last())
    scene.glimmer.tile_size = 16
    inside.render(OUT / "small_tiles.exr")
    render = scene.render
    render.use_border, render.use_crop_to_border = True, True
    render.border_min_x, render.border_max_x, render.border_min_y, render.border_max_y = 0.21, 0.77, 0.13, 0.64
    inside.render(OUT / "border.exr")
    render.use_crop_to_border = False
    inside.render(OUT / "border_in_full.exr")


def settings() -> None:
    scene = new_scene()
    inside.use_format("OPEN_EXR")
    ours = scene.glimmer
    # Tails that are too heavy to certify would keep it from stopping: then the samples do.
    samples, ours.samples = ours.samples, 4096
    ours.use_target_error, ours.target_error, ours.use_adaptive = True, 0.02, True
    scene.render.threads_mode, scene.render.threads = "FIXED", 1
    inside.render(OUT / "settings.exr")
    facts["target_report"] = dict(reports.last())
    facts["target_summary"] = reports.error_summary(reports.last())
    facts["adaptive_summary"] = reports.summary(reports.last())
    ours.samples, ours.use_samples = samples, False
    ours.use_target_error, ours.use_seconds, ours.seconds, ours.use_adaptive = False, True, 0.5, False
    ours.integrator, ours.seed, ours.use_max_depth, ours.max_depth = "baseline", 7, True, 1
    scene.render.threads_mode = "AUTO"
    inside.render(OUT / "settings.exr")
    facts["time_report"] = dict(reports.last())
    ours.use_seconds, ours.use_samples, ours.use_max_depth, ours.seed = False, True, False, 0
    ours.property_unset("integrator")
    facts["integrator_numbers"] = {name: number for name, _, _, number in scene_properties.list_integrators(ours, None)}


def scene_file() -> None:
    new_scene()
    bpy.ops.glimmer.export_scene(filepath=str(OUT / "scene.json"))
    facts["engine_after_export"] = bpy.context.scene.render.engine


def layers_and_passes() -> None:
    scene = new_scene()
    inside.use_format("OPEN_EXR_MULTILAYER")
    first = bpy.context.view_layer
    for item in passes.OPTIONAL:
        setattr(item.owner(first), item.switch, True)
    without = scene.view_layers.new("Without Ball")
    without.samples = 3
    hidden = bpy.data.collections.new("Hidden")
    scene.collection.children.link(hidden)
    ball = bpy.data.objects["Ball"]
    scene.collection.objects.unlink(ball)
    hidden.objects.link(ball)
    without.layer_collection.children["Hidden"].exclude = True
    inside.render(OUT / "layers.exr")
    facts["layer_samples"] = {name: report["spp"] for name, report in reports.layers().items()}
    compositor(scene)
    scene.view_layers.remove(without)
    for item in passes.OPTIONAL:
        setattr(item.owner(first), item.switch, item.switch == passes.NOISY.switch)
    # With the pass that denoisers read alone: samples count for one pixel each where it is on.
    inside.use_format("OPEN_EXR")
    inside.render(OUT / "one_pass.exr")
    setattr(passes.NOISY.owner(first), passes.NOISY.switch, False)


def transparent() -> None:
    """A ball before the sky and a holdout, beside Cycles."""
    scene = new_scene()
    bpy.data.objects.remove(bpy.data.objects["Floor"])
    inside.ball("Hole", location=(-1.5, -1.0, 1.0), segments=32).is_holdout = True
    scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.pixel_filter_type = 8, False, "BOX"
    scene.glimmer.filter = "BOX"
    inside.use_format("OPEN_EXR")
    scene.render.image_settings.color_mode = "RGBA"
    for name, is_transparent in (("clear", True), ("opaque", False)):
        scene.render.film_transparent = is_transparent
        for engine in ("GLIMMER", "CYCLES"):
            scene.render.engine = engine
            inside.render(OUT / f"{name}_{engine.lower()}.exr")
    scene.render.image_settings.color_mode = "RGB"
    scene.render.film_transparent = False
    scene.glimmer.property_unset("filter")


def denoised() -> None:
    scene = new_scene()
    inside.use_format("OPEN_EXR_MULTILAYER")
    scene.glimmer.use_denoising, scene.glimmer.samples = True, 4
    inside.render(OUT / "denoised.exr")
    facts["denoised_report"] = dict(reports.last())
    scene.glimmer.use_denoising = False
    inside.render(OUT / "plain.exr")
    scene.view_layers[0].cycles.denoising_store_passes = True
    inside.render(OUT / "not_denoised.exr")
    scene.view_layers[0].cycles.denoising_store_passes = False
    scene.glimmer.samples = 8
    if denoise.find() is not None:
        facts["quick"] = quickly_denoised()


def quickly_denoised() -> dict[str, Any]:
    """As a 3D view is."""
    noisy = np.random.default_rng(1).exponential(size=(64, 96, 3)).astype(np.float32)
    flat = np.full_like(noisy, 0.5)
    with denoise.open_denoiser() as denoiser:
        shown = denoiser.quick_picture(noisy, flat, flat, lambda: True)
        try:
            denoiser.quick_picture(noisy, flat, flat, lambda: False)
        except denoise.StoppedError:
            stopped = True
        again = denoiser.quick_picture(noisy, flat, flat, lambda: True)
    return {
        "mean": float(shown.mean()),
        "spread": float(shown.std()),
        "stopped": stopped,
        "again": float(np.abs(again - shown).max()),
    }


def groups_and_mattes() -> None:
    """Light groups, and Cryptomatte beside Cycles' and through Blender's own node."""
    scene = new_scene()
    inside.use_format("OPEN_EXR_MULTILAYER")
    layer = scene.view_layers[0]
    for name in ("key", "moon", "sky"):
        layer.lightgroups.add().name = name
    bpy.data.objects["POINT"].lightgroup, scene.world.lightgroup = "key", "sky"
    bpy.data.objects["Moon"].lightgroup = "moon"
    bpy.data.objects["Moon"].parent = bpy.data.objects["Ball"]
    layer.use_pass_cryptomatte_object = layer.use_pass_cryptomatte_asset = layer.use_pass_cryptomatte_material = True
    layer.pass_cryptomatte_depth = 4
    scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.pixel_filter_type = 8, False, "BOX"
    scene.glimmer.filter = "BOX"
    for engine in ("GLIMMER", "CYCLES"):
        scene.render.engine = engine
        inside.render(OUT / f"groups_{engine.lower()}.exr")
    scene.render.engine = "GLIMMER"
    layer.use_pass_cryptomatte_asset = layer.use_pass_cryptomatte_material = False
    tree, output = compositor_tree(scene)
    node = tree.nodes.new("CompositorNodeCryptomatteV2")
    node.source, node.scene, node.layer_name, node.matte_id = "RENDER", scene, "ViewLayer.CryptoObject", "Ball"
    tree.links.new(node.outputs["Matte"], output.inputs[0])
    shown = tree.nodes.new("CompositorNodeRLayers")  # 3.4 renders nothing without it
    tree.links.new(shown.outputs["Image"], node.inputs["Image"])
    inside.use_format("OPEN_EXR")
    inside.render(OUT / "matte.exr")
    leave_compositor(scene)


def compositor_tree(scene: Any) -> tuple[Any, Any]:
    """Without nodes but the one of the output."""
    if hasattr(scene, "compositing_node_group"):  # 5.0
        tree = scene.compositing_node_group = bpy.data.node_groups.new("Compositor", "CompositorNodeTree")
        tree.interface.new_socket("Image", in_out="OUTPUT", socket_type="NodeSocketColor")
        output = tree.nodes.new("NodeGroupOutput")
    else:
        scene.use_nodes = True
        tree = scene.node_tree
        tree.nodes.clear()
        output = tree.nodes.new("CompositorNodeComposite")
    return tree, output


def leave_compositor(scene: Any) -> None:
    if hasattr(scene, "compositing_node_group"):
        scene.compositing_node_group = None
    else:
        scene.use_nodes = False


def compositor(scene: Any) -> None:
    """The picture is the albedo pass, by way of the compositor."""
    tree, output = compositor_tree(scene)
    layers = tree.nodes.new("CompositorNodeRLayers")
    facts["names"] = [item.name(bpy.app.version) for item in passes.OPTIONAL]
    facts["sockets"] = [socket.name for socket in layers.outputs if socket.enabled]
    tree.links.new(layers.outputs["Albedo"], output.inputs[0])
    inside.use_format("OPEN_EXR")
    inside.render(OUT / "composited.exr")
    leave_compositor(scene)


def animation() -> None:
    scene = new_scene()
    inside.use_format("OPEN_EXR")
    scene.frame_start, scene.frame_end = 1, 3
    moon = bpy.data.objects["Moon"]
    moon.keyframe_insert("location", frame=2)
    moon.location.z += 1.0
    moon.keyframe_insert("location", frame=3)
    inside.render(OUT / "fixed_", animation=True)
    facts["meshes_kept"] = sum(len(cache) for cache in native_render._meshes.values())
    scene.glimmer.use_seed_per_frame = scene.glimmer.use_curve_files = True
    inside.render(OUT / "per_frame_", animation=True)
    scene.glimmer.use_seed_per_frame = scene.glimmer.use_curve_files = False
    facts["last_curve"] = reports.last()["curve"]


def hexagon_field() -> None:
    inside.empty_scene((0.5, 0.5, 0.5))
    bpy.ops.glimmer.add_hexagon_field()
    field = bpy.context.object
    field.glimmer_field.rings = 82  # 3 n (n + 1) + 1 = 20 419 plates
    bpy.context.view_layer.update()
    start = time.perf_counter()
    inside.render(OUT / "field.exr")
    facts["field_wall_seconds"] = time.perf_counter() - start
    facts["field_report"] = dict(reports.last())


class Drawn:
    """Stands for a panel's layout, and remembers what is written on it."""

    def __init__(self) -> None:
        self.lines: list[str] = []

    def column(self, **_: Any) -> "Drawn":
        return self

    def label(self, text: str = "", **_: Any) -> None:
        self.lines.append(text)


def differences() -> None:
    """What is not rendered as in Cycles: of a mesh, of a text that is only an instance, of a lamp and of the camera."""
    from glimmer.ui import differences as panel

    scene = new_scene()
    bpy.data.objects["Ball"].active_material = inside.material("ShaderNodeBsdfToon")
    text = bpy.data.curves.new("Text", "FONT")
    text.materials.append(inside.material("ShaderNodeBsdfToon"))
    collection = bpy.data.collections.new("Texts")
    collection.objects.link(bpy.data.objects.new("Text", text))
    text.body, text.extrude = "Text", 0.1
    empty = bpy.data.objects.new("Empty", None)
    empty.instance_type, empty.instance_collection = "COLLECTION", collection
    scene.collection.objects.link(empty)
    inside.lamp("AREA", (0.0, 0.0, 4.0), energy=-1.0)
    scene.camera.data.dof.use_dof, scene.camera.data.dof.aperture_ratio = True, 2.0
    missing = inside.plane("Hidden", 1.0, inside.material("ShaderNodeBsdfToon"))
    missing.hide_render = True
    layout = Drawn()
    found = panel.differences(bpy.context)
    panel.draw_notices(layout, list(found), bpy.context)
    material = bpy.data.objects["Ball"].active_material.name
    facts["differences"] = [str(notice) for notice in found]
    facts["differences_drawn"] = layout.lines
    facts["differences_of_material"] = [str(notice) for notice in panel.of_material(found, material)]
    inside.use_format("OPEN_EXR")
    inside.render(OUT / "differences.exr")
    facts["differences_rendered"] = reports.last()["export"]["notices"]
    bpy.data.objects["Ball"].active_material = None
    bpy.context.view_layer.update()
    panel._state.next_search = 0.0
    facts["differences_after_edit"] = [str(notice) for notice in panel.differences(bpy.context)]


stills()
differences()
settings()
scene_file()
layers_and_passes()
transparent()
denoised()
animation()
hexagon_field()
groups_and_mattes()
(OUT / "facts.json").write_text(json.dumps(facts))
