# SPDX-License-Identifier: GPL-3.0-or-later
"""Mitsuba 3 (llvm_ad_rgb): reads a scene file and renders it by `path`, or in fog by `volpath`."""

import sys
from pathlib import Path
from typing import Any

import drjit as dr
import mitsuba as mi
import numpy as np

from tests.bench.peers.job import Render, Rendered, measured, serve
from tests.bench.peers.scene_file import Light, Material, Mesh, Scene, in_the_world


def _rgb(value: tuple[float, ...]) -> dict[str, Any]:
    return {"type": "rgb", "value": list(value)}


def _bsdf(material: Material) -> Any:
    """A constant reflectance: the perfect mirror's Fresnel times a colour. Mitsuba's GGX masks separably."""
    if isinstance(material, Light):
        return mi.load_dict({"type": "diffuse", "reflectance": _rgb((0, 0, 0))})
    metal = {"type": "roughconductor", "material": "none", "distribution": "ggx", "alpha": material.alpha}
    metal["specular_reflectance"] = _rgb(material.reflectance)
    return mi.load_dict({"type": "twosided", "bsdf": metal})


def _mesh(mesh: Mesh, bsdf: Any) -> Any:
    properties = mi.Properties()
    properties["bsdf"] = bsdf
    properties["face_normals"] = mesh.normals is None
    made = mi.Mesh(
        "mesh", len(mesh.vertices), len(mesh.triangles), has_vertex_normals=mesh.normals is not None, props=properties
    )
    parameters = mi.traverse(made)
    parameters["vertex_positions"] = mesh.vertices.ravel()
    if mesh.normals is not None:
        parameters["vertex_normals"] = mesh.normals.ravel()
    parameters["faces"] = mesh.triangles.ravel()
    parameters.update()
    return made


def _sensor(scene: Scene) -> dict[str, Any]:
    # Mitsuba's camera looks along +z, with x to the left.
    to_world = scene.camera @ np.diag([-1.0, 1.0, -1.0, 1.0])
    film = {"type": "hdrfilm", "width": scene.width, "height": scene.height, "pixel_format": "rgb"}
    film |= {"component_format": "float32", "rfilter": {"type": "box"}}
    sensor = {"type": "perspective", "fov": scene.fov_x, "fov_axis": "x", "to_world": mi.ScalarTransform4f(to_world)}
    sensor |= {"near_clip": scene.clip[0], "far_clip": scene.clip[1], "film": film}
    return sensor


def _world(scene: Scene) -> dict[str, Any]:
    world: dict[str, Any] = {"type": "scene", "sensor": _sensor(scene)}
    # No limit on depth; Russian roulette where Mitsuba has it by default.
    world["integrator"] = {"type": "volpath" if scene.fog() else "path", "max_depth": -1}
    if scene.fog():
        sigma_a, sigma_s = np.array(scene.sigma_a), np.array(scene.sigma_s)
        albedo = sigma_s / np.maximum(sigma_a + sigma_s, 1e-30)
        phase = {"type": "hg", "g": scene.g} if scene.g else {"type": "isotropic"}
        world["fog"] = {"type": "homogeneous", "sigma_t": _rgb(tuple((sigma_a + sigma_s).tolist()))}
        world["fog"] |= {"albedo": _rgb(tuple(albedo.tolist())), "phase": phase}
        world["sensor"]["medium"] = {"type": "ref", "id": "fog"}
    bsdfs = {name: _bsdf(material) for name, material in scene.materials.items()}
    for index, sphere in enumerate(scene.spheres):
        shape = {"type": "sphere", "center": list(sphere.center), "radius": sphere.radius}
        shape["bsdf"] = bsdfs[sphere.material]
        material = scene.materials[sphere.material]
        if isinstance(material, Light):
            shape["emitter"] = {"type": "area", "radiance": _rgb(material.radiance)}
        world[f"sphere_{index}"] = shape
    # No instances: Mitsuba would trace its code for each of the 20 000 (more than eight minutes).
    for index, mesh in enumerate(in_the_world(scene.meshes)):
        world[f"mesh_{index}"] = _mesh(mesh, bsdfs[mesh.material])
    return world


def start(scene: Scene) -> Render:
    mi.set_variant("llvm_ad_rgb")
    world = mi.load_dict(_world(scene))

    def once(samples: int, seed: int) -> Any:
        picture = mi.render(world, spp=samples, seed=seed)
        dr.eval(picture)
        dr.sync_thread()
        return picture

    once(1, 0)  # compiles

    def render(samples: int, seed: int, picture: Path) -> Rendered:
        made: list[Any] = []
        cpu, wall = measured(lambda: made.append(once(samples, seed)))
        mi.Bitmap(made[0]).write(str(picture))
        return Rendered(samples, cpu, wall)

    return render


if __name__ == "__main__":
    serve(sys.argv[1:], start)
