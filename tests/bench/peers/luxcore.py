# SPDX-License-Identifier: GPL-3.0-or-later
"""LuxCore (PATHCPU, Sobol): reads a scene file and renders it by its path tracer."""

import math
import os
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pyluxcore

from tests.bench.peers.job import Render, Rendered, cpu_seconds, serve
from tests.bench.peers.scene_file import Array, Light, Material, Mesh, Metal, Scene


def _unit_sphere(rings: int = 32) -> tuple[Array, Array]:
    """Vertices and triangles, of the area of the unit sphere and so, being convex, of its mean silhouette."""
    theta = np.linspace(0, math.pi, rings + 1)[1:-1, np.newaxis]
    phi = np.linspace(0, 2 * math.pi, 2 * rings, endpoint=False)[np.newaxis]
    body = np.stack(np.broadcast_arrays(np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)), -1)
    vertices = np.concatenate([body.reshape(-1, 3), [[0, 0, 1], [0, 0, -1]]])
    at = np.arange(body.shape[0] * body.shape[1]).reshape(body.shape[:2])
    right = np.roll(at, -1, axis=1)
    north, south = np.full_like(at[0], at.size), np.full_like(at[0], at.size + 1)
    triangles = np.concatenate(
        [
            np.stack([at[:-1], at[1:], right[1:]], -1).reshape(-1, 3),
            np.stack([at[:-1], right[1:], right[:-1]], -1).reshape(-1, 3),
            np.stack([north, at[0], right[0]], -1),
            np.stack([at[-1], south, right[-1]], -1),
        ]
    )
    a, b, c = (vertices[triangles[:, corner]] for corner in range(3))
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2
    return vertices * math.sqrt(4 * math.pi / area), triangles


def _material(name: str, material: Material) -> dict[str, Any]:
    key = f"scene.materials.{name}"
    if isinstance(material, Light):
        return {
            f"{key}.type": "matte",
            f"{key}.kd": [0.0, 0.0, 0.0],
            f"{key}.emission": list(material.radiance),
        }
    # Fresnel's factor runs from the colour to 1 at grazing; a constant one it does not have.
    return {
        f"{key}.type": "metal2",
        f"{key}.fresnel": f"fresnel_{name}",
        f"scene.textures.fresnel_{name}.type": "fresnelcolor",
        f"scene.textures.fresnel_{name}.kr": list(material.reflectance),
        f"{key}.uroughness": material.alpha,
        f"{key}.vroughness": material.alpha,
    }


def _properties(values: dict[str, Any]) -> Any:
    made = pyluxcore.Properties()
    for key, value in values.items():
        made.Set(pyluxcore.Property(key, value))
    return made


def _rows(values: Array) -> list[tuple[Any, ...]]:
    return [tuple(row) for row in values.tolist()]


def _columns(matrix: Array) -> list[float]:
    return [float(value) for value in matrix.T.ravel()]


def _camera(scene: Scene) -> dict[str, Any]:
    origin = scene.camera[:3, 3]
    # LuxCore's angle is the one of the longer side.
    half = math.tan(math.radians(scene.fov_x) / 2) * max(1.0, scene.height / scene.width)
    angle = 2 * math.degrees(math.atan(half))
    # Its pictures stand one row lower than the camera says (measured by the centres of small lights): the window, in
    # halves of the longer side, is moved by that.
    x, y = (length / max(scene.width, scene.height) for length in (scene.width, scene.height))
    row = 2 * y / scene.height
    return {
        "scene.camera.type": "perspective",
        "scene.camera.screenwindow": [-x, x, -y - row, y - row],
        "scene.camera.lookat.orig": origin.tolist(),
        "scene.camera.lookat.target": (origin - scene.camera[:3, 2]).tolist(),
        "scene.camera.up": scene.camera[:3, 1].tolist(),
        "scene.camera.fieldofview": angle,
        "scene.camera.cliphither": scene.clip[0],
        "scene.camera.clipyon": scene.clip[1],
        "scene.camera.autofocus.enable": False,
    }


def _fog(scene: Scene) -> dict[str, Any]:
    if not scene.fog():
        return {}
    return {
        "scene.volumes.fog.type": "homogeneous",
        "scene.volumes.fog.absorption": list(scene.sigma_a),
        "scene.volumes.fog.scattering": list(scene.sigma_s),
        "scene.volumes.fog.asymmetry": [scene.g] * 3,
        "scene.volumes.fog.multiscattering": True,
        "scene.world.volume.default": "fog",
        "scene.camera.volume": "fog",
        "scene.camera.autovolume.enable": False,
    }


def _add_meshes(made: Any, meshes: list[Mesh], ids: dict[str, str]) -> None:
    for index, mesh in enumerate(meshes):
        normals = None if mesh.normals is None else _rows(mesh.normals)
        made.DefineMesh(f"mesh_{index}", _rows(mesh.vertices), _rows(mesh.triangles), normals, None, None, None)
        objects: dict[str, Any] = {}
        for number, place in enumerate(mesh.to_world):
            key = f"scene.objects.m{index}_{number}"
            objects |= {f"{key}.shape": f"mesh_{index}", f"{key}.material": ids[mesh.material]}
            objects[f"{key}.transformation"] = _columns(place)
        made.Parse(_properties(objects))


def _scene(scene: Scene) -> Any:
    made = pyluxcore.Scene()
    made.Parse(_properties(_camera(scene) | _fog(scene)))
    ids = {name: f"material_{index}" for index, name in enumerate(scene.materials)}
    for name, material in scene.materials.items():
        made.Parse(_properties(_material(ids[name], material)))
    _add_meshes(made, scene.meshes, ids)
    vertices, triangles = _unit_sphere()
    for index, sphere in enumerate(scene.spheres):
        placed = vertices * sphere.radius + np.array(sphere.center)
        smooth = _rows(vertices) if isinstance(scene.materials[sphere.material], Metal) else None
        made.DefineMesh(f"sphere_{index}", _rows(placed), _rows(triangles), smooth, None, None, None)
        key = f"scene.objects.sphere_{index}"
        made.Parse(_properties({f"{key}.shape": f"sphere_{index}", f"{key}.material": ids[sphere.material]}))
    return made


def _settings(scene: Scene, samples: int, seed: int) -> dict[str, Any]:
    unlimited = 1024
    return {
        "renderengine.type": "PATHCPU",
        "renderengine.seed": seed + 1,
        "sampler.type": "SOBOL",
        "film.width": scene.width,
        "film.height": scene.height,
        "film.filter.type": "NONE",
        "film.imagepipelines.0.0.type": "NOP",
        "film.outputs.0.type": "RGB",
        "film.outputs.0.filename": "unused.exr",
        "path.pathdepth.total": unlimited,
        "path.pathdepth.diffuse": unlimited,
        "path.pathdepth.glossy": unlimited,
        "path.pathdepth.specular": unlimited,
        "path.clamping.variance.maxvalue": 0.0,
        "path.forceblackbackground.enable": False,
        "lightstrategy.type": "LOG_POWER",
        "batch.haltspp": samples,
    }


def start(scene: Scene) -> Render:
    pyluxcore.Init(lambda message: None)
    made = _scene(scene)

    def once(samples: int, seed: int, picture: Path | None) -> Rendered:
        config = pyluxcore.RenderConfig(_properties(_settings(scene, samples, seed)), made)
        session = pyluxcore.RenderSession(config)
        session.Start()
        cpu, wall = cpu_seconds(), time.monotonic()
        while not session.HasDone():
            time.sleep(0.002)
            session.UpdateStats()
        session.Stop()
        cpu, wall = cpu_seconds() - cpu, time.monotonic() - wall
        session.UpdateStats()
        total = session.GetStats().Get("stats.renderengine.total.samplecount").GetFloat()
        if picture is not None:
            session.GetFilm().SaveOutput(str(picture), pyluxcore.FilmOutputType.RGB, pyluxcore.Properties())
        return Rendered(total / (scene.width * scene.height), cpu, wall)

    once(1, 0, None)
    return once


if __name__ == "__main__":
    serve(sys.argv[1:], start)
    sys.stdout.flush()
    os._exit(0)  # pyluxcore aborts when Python ends
