# SPDX-License-Identifier: GPL-3.0-or-later
"""Panoramas and stereo pairs of a world that shows directions, and of bodies that show where they are seen, by Cycles
and Glimmer in turn: panorama_script.py FOLDER. Writes pictures.npz: NAME.CYCLES and NAME.GLIMMER, each (height, width,
3), and the pairs as NAME.ENGINE_L.exr and so on, without noise.
"""

import math
import sys
from pathlib import Path
from typing import Any

import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).parent))

import inside
from exact_cycles import set_up_cycles

OUT = Path(inside.words()[0])

inside.enable()
if not hasattr(bpy.types.Scene, "cycles"):
    bpy.ops.preferences.addon_enable(module="cycles")


def shown(tree: Any, kind: str, output: str, shader: Any, factor: float = 0.5) -> None:
    """The shader's colour is so much of what the node says of each place, plus a half: never below 0."""
    source, scaled = tree.nodes.new(kind), tree.nodes.new("ShaderNodeVectorMath")
    scaled.operation = "MULTIPLY_ADD"
    scaled.inputs[1].default_value, scaled.inputs[2].default_value = (factor,) * 3, (0.5,) * 3
    tree.links.new(source.outputs[output], scaled.inputs[0])
    tree.links.new(scaled.outputs[0], shader.inputs["Color"])


def glow(kind: str, output: str, factor: float = 0.5) -> Any:
    result = inside.material("ShaderNodeEmission")
    nodes = result.node_tree.nodes
    shader = next(n for n in nodes if n.bl_idname == "ShaderNodeEmission")
    shown(result.node_tree, kind, output, shader, factor)
    return result


def build() -> None:
    scene = inside.empty_scene()
    shown(scene.world.node_tree, "ShaderNodeTexCoord", "Generated", scene.world.node_tree.nodes["Background"])
    inside.ball("Places", glow("ShaderNodeNewGeometry", "Position", 0.15), (0.7, 2.0, 0.4))
    # Before, Cycles had the Window coordinates of fisheyes mirrored.
    window = "Window" if bpy.app.version >= (5, 0) else "Generated"
    inside.ball("Picture", glow("ShaderNodeTexCoord", window), (-1.9, 2.0, -0.4))
    inside.ball("Behind", glow("ShaderNodeTexCoord", "Camera", 0.1), (1.0, -2.0, 0.2))
    inside.ball("Near", glow("ShaderNodeNewGeometry", "Normal"), (0.4, 0.3, 1.6)).scale = (0.2, 0.2, 0.2)
    camera = scene.camera
    camera.location, camera.rotation_euler = (0.1, -0.2, 0.3), (1.5, 0.2, 0.3)
    camera.data.type, camera.data.clip_start, camera.data.clip_end = "PANO", 0.5, 100.0
    scene.render.resolution_x, scene.render.resolution_y = 60, 40
    scene.view_settings.view_transform = "Standard"
    scene.glimmer.samples, scene.glimmer.filter, scene.glimmer.filter_width = 4, "BLACKMAN_HARRIS", 0.01
    set_up_cycles(scene, samples=4, pixel_filter_type="BLACKMAN_HARRIS")
    scene.cycles.filter_width = 0.01


FISHEYE = {"fisheye_fov": math.radians(163.0)}
CASES: dict[str, dict[str, Any]] = {
    "equirectangular": {"panorama_type": "EQUIRECTANGULAR"},
    "part": {
        "panorama_type": "EQUIRECTANGULAR",
        "longitude_min": -1.0,
        "longitude_max": 2.0,
        "latitude_min": -0.5,
        "latitude_max": 1.2,
        "shift_x": 0.1,
        "shift_y": -0.15,
    },
    "equidistant": {"panorama_type": "FISHEYE_EQUIDISTANT", **FISHEYE},
    "equisolid": {"panorama_type": "FISHEYE_EQUISOLID", "fisheye_lens": 10.5, **FISHEYE},
    "equisolid, height fitted": {
        "panorama_type": "FISHEYE_EQUISOLID",
        "sensor_fit": "VERTICAL",
        "sensor_height": 20.0,
        "fisheye_lens": 7.0,
        **FISHEYE,
    },
    "polynomial": {
        "panorama_type": "FISHEYE_LENS_POLYNOMIAL",
        "fisheye_polynomial_k0": -1e-5,
        "fisheye_polynomial_k1": -0.08,
        "fisheye_polynomial_k2": -1e-4,
        "fisheye_polynomial_k3": 3e-6,
        "fisheye_polynomial_k4": -1e-7,
        **FISHEYE,
    },
    "mirror ball": {"panorama_type": "MIRRORBALL"},
    "cube face": {"panorama_type": "EQUIANGULAR_CUBEMAP_FACE"},
}
if bpy.app.version >= (5, 0):
    CASES["cylindrical"] = {
        "panorama_type": "CENTRAL_CYLINDRICAL",
        "central_cylindrical_range_u_min": -1.0,
        "central_cylindrical_range_u_max": 2.0,
        "central_cylindrical_range_v_min": -0.5,
        "central_cylindrical_range_v_max": 1.5,
        "central_cylindrical_radius": 2.0,
    }


def picture_of(settings: dict[str, Any]) -> dict[str, Any]:
    build()
    camera = bpy.context.scene.camera.data
    for name, value in settings.items():
        setattr(camera if hasattr(camera, name) else camera.cycles, name, value)
    return {engine: inside.picture(OUT / "picture.exr", engine, 1) for engine in ("CYCLES", "GLIMMER")}


# Of the stereo pair's settings those that differ from Blender's; "type" is the camera's.
PAIRS: dict[str, dict[str, Any]] = {
    "off axis": {"convergence_mode": "OFFAXIS"},
    "toe in": {"convergence_mode": "TOE", "pivot": "CENTER"},
    "parallel": {"convergence_mode": "PARALLEL", "pivot": "RIGHT"},
    "spherical": {"type": "PANO", "use_spherical_stereo": True, "use_pole_merge": True},
    "spherical, parallel": {"type": "PERSP", "use_spherical_stereo": True, "convergence_mode": "PARALLEL"},
    "two cameras": {"views": "MULTIVIEW"},
}


def write_pair(name: str, settings: dict[str, Any]) -> None:
    """As NAME.ENGINE_L.exr and NAME.ENGINE_R.exr."""
    build()
    scene = bpy.context.scene
    scene.render.use_multiview = True
    scene.render.views_format = settings.get("views", "STEREO_3D")
    scene.render.image_settings.views_format = "INDIVIDUAL"
    camera = scene.camera
    camera.name = "Eye_L"
    other = bpy.data.objects.new("Eye_R", bpy.data.cameras.new("Other"))
    other.location, other.rotation_euler = (0.5, -0.2, 0.3), (1.4, 0.1, 0.1)
    scene.collection.objects.link(other)
    camera.data.type, camera.data.lens, camera.data.shift_x = settings.get("type", "PERSP"), 20.0, 0.1
    stereo = camera.data.stereo
    stereo.interocular_distance, stereo.convergence_distance = 0.4, 2.5
    stereo.pole_merge_angle_from, stereo.pole_merge_angle_to = 0.5, 1.0
    for key, value in settings.items():
        if key not in ("type", "views"):
            setattr(stereo, key, value)
    for engine in ("CYCLES", "GLIMMER"):
        scene.render.engine = engine
        inside.render(OUT / f"{name}.{engine}.exr")
    scene.render.use_multiview = False


inside.use_format("OPEN_EXR")
pictures: dict[str, Any] = {}
for name, settings in CASES.items():
    pictures |= {f"{name}.{engine}": picture for engine, picture in picture_of(settings).items()}
for name, settings in PAIRS.items():
    write_pair(name, settings)
np.savez(OUT / "pictures.npz", **pictures)
