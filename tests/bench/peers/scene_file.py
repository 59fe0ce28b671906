# SPDX-License-Identifier: GPL-3.0-or-later
"""What the peers read of a scene file (engine/cli/SCENE_FORMAT.md): as much as the add-on writes for the benchmark's
scenes. Whatever else a scene asks for raises UnsupportedError, so that no peer renders another scene unnoticed.

Needs numpy alone: every peer has a virtual environment of its own.
"""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]


class UnsupportedError(Exception):
    """What of the scene cannot be said to a peer, in words."""


@dataclass(frozen=True)
class Light:
    """Black surface of constant radiance."""

    radiance: tuple[float, ...]


@dataclass(frozen=True)
class Metal:
    """GGX conductor whose reflectance no angle changes."""

    alpha: float
    reflectance: tuple[float, ...]


Material = Light | Metal


@dataclass(frozen=True)
class Mesh:
    """Triangles of one material, and where they stand."""

    material: str
    vertices: Array  # (n, 3) float32
    normals: Array | None  # (n, 3) float32; None: flat
    triangles: Array  # (m, 3) uint32
    to_world: Array  # (instances, 4, 4) float64


@dataclass(frozen=True)
class Sphere:
    material: str
    center: tuple[float, ...]
    radius: float


@dataclass(frozen=True)
class Scene:
    width: int
    height: int
    camera: Array  # (4, 4); looks along -z, y up
    fov_x: float  # degrees
    clip: tuple[float, float]
    materials: dict[str, Material]
    meshes: list[Mesh]
    spheres: list[Sphere]
    sigma_a: tuple[float, ...]
    sigma_s: tuple[float, ...]
    g: float

    def fog(self) -> bool:
        return max(self.sigma_a + self.sigma_s) > 0


def _only(found: dict[str, Any], allowed: str, where: str) -> None:
    extra = sorted(set(found) - set(allowed.split()))
    if extra:
        raise UnsupportedError(f"{where}: {', '.join(extra)}")


def _color(value: Any) -> tuple[float, ...]:
    return tuple(np.broadcast_to(np.asarray(value, np.float64), 3).tolist())


def _material(name: str, found: dict[str, Any]) -> Material:
    kind, where = found["type"], f'material "{name}"'
    if kind == "light":
        _only(found, "type radiance", where)
        return Light(_color(found["radiance"]))
    if kind != "conductor":
        raise UnsupportedError(f"{where}: {kind}")
    _only(found, "type alpha f0 f90 masking", where)  # the peers mask as they do
    if "f0" not in found or _color(found["f0"]) != _color(found.get("f90", 1)):
        raise UnsupportedError(f"{where}: Fresnel")
    return Metal(found["alpha"], _color(found["f0"]))


def read_ply(path: Path) -> tuple[Array, Array | None, Array]:
    """Vertices, normals and triangles of a binary .ply as the add-on writes it."""
    data = path.read_bytes()
    head, mark, body = data.partition(b"end_header\n")
    lines = head.decode("ascii").split("\n")
    properties = [line.split()[2] for line in lines if line.startswith("property float ")]
    counts = {line.split()[1]: int(line.split()[2]) for line in lines if line.startswith("element ")}
    if not mark or "format binary_little_endian 1.0" not in lines or properties[:3] != ["x", "y", "z"]:
        raise UnsupportedError(f"{path.name}: another kind of .ply")
    size = counts["vertex"] * len(properties)
    values = np.frombuffer(body, "<f4", size).reshape(-1, len(properties))
    faces = np.frombuffer(body, [("count", "u1"), ("corners", "<i4", 3)], counts["face"], size * 4)
    if np.any(faces["count"] != 3) or len(body) != size * 4 + faces.nbytes:
        raise UnsupportedError(f"{path.name}: not triangles alone")
    normals = values[:, 3:6].copy() if properties[3:6] == ["nx", "ny", "nz"] else None
    return values[:, :3].copy(), normals, faces["corners"].astype(np.uint32)


def _places(found: dict[str, Any], folder: Path) -> Array:
    to_world = np.asarray(found.get("to_world", np.eye(4)), np.float64)
    if "instances" not in found:
        return to_world[np.newaxis]
    instances = np.load(folder / found["instances"]).astype(np.float64)
    if instances.shape[1] == 3:
        last = np.broadcast_to([[[0.0, 0.0, 0.0, 1.0]]], (len(instances), 1, 4))
        instances = np.concatenate([instances, last], axis=1)
    return to_world @ instances


def _meshes(told: dict[str, Any], folder: Path) -> list[Mesh]:
    result = []
    for index, found in enumerate(told.get("objects", [])):
        _only(found, "mesh material materials to_world instances index indices", f"objects[{index}]")
        source = told["meshes"][found["mesh"]]
        _only(source, "file slots", f'mesh "{found["mesh"]}"')
        vertices, normals, triangles = read_ply(folder / source["file"])
        names = found.get("materials") or [found["material"]]
        slots = np.load(folder / source["slots"]) if "slots" in source else np.zeros(len(triangles), int)
        places = _places(found, folder)
        # A normal of length 0 says that the face is flat.
        flat = np.ones(len(triangles), bool)
        if normals is not None:
            flat = np.any(np.all(normals[triangles] == 0, axis=2), axis=1)
        for slot, name in enumerate(names):
            for part in (flat, ~flat):
                used, corners = np.unique(triangles[(slots == slot) & part], return_inverse=True)
                if len(used):
                    smooth = None if normals is None or part is flat else normals[used]
                    result.append(Mesh(name, vertices[used], smooth, corners.reshape(-1, 3).astype(np.uint32), places))
    return result


def in_the_world(meshes: list[Mesh]) -> list[Mesh]:
    """For each material one mesh of its flat and one of its smooth triangles, without instances."""
    kinds: dict[tuple[str, bool], list[Mesh]] = {}
    for mesh in meshes:
        kinds.setdefault((mesh.material, mesh.normals is None), []).append(mesh)
    return [_joined(alike) for alike in kinds.values()]


def _joined(meshes: list[Mesh]) -> Mesh:
    vertices, normals, triangles, first = [], [], [], 0
    for mesh in meshes:
        for place in mesh.to_world:
            vertices.append((mesh.vertices @ place[:3, :3].T + place[:3, 3]).astype(np.float32))
            if mesh.normals is not None:
                turned = mesh.normals @ np.linalg.inv(place[:3, :3])
                normals.append((turned / np.linalg.norm(turned, axis=1, keepdims=True)).astype(np.float32))
            triangles.append(mesh.triangles + np.uint32(first))
            first += len(mesh.vertices)
    smooth = np.concatenate(normals) if normals else None
    return Mesh(meshes[0].material, np.concatenate(vertices), smooth, np.concatenate(triangles), np.eye(4)[np.newaxis])


def read_scene(path: Path) -> Scene:
    told = json.loads(path.read_text())
    _only(told, "glimmer film camera materials meshes objects spheres lights environment medium render", "scene")
    film, camera, medium = told["film"], told["camera"], told.get("medium", {})
    _only(film, "width height filter", "film")
    _only(camera, "to_world fov_x clip", "camera")
    for index, found in enumerate(told.get("spheres", [])):
        _only(found, "center radius material index", f"spheres[{index}]")
    if film.get("filter", "box") != "box":
        raise UnsupportedError("a filter other than box")
    if told.get("lights"):
        raise UnsupportedError("lamps")
    if told.get("environment", {"radiance": 0}) not in ({"radiance": 0}, {"radiance": [0.0, 0.0, 0.0]}):
        raise UnsupportedError("an environment that shines")
    if any(limit is not None for limit in told.get("render", {}).values()):
        raise UnsupportedError("a limit on depth")
    return Scene(
        film["width"],
        film["height"],
        np.asarray(camera["to_world"], np.float64),
        camera["fov_x"],
        tuple(camera.get("clip", (1e-2, 1e4))),
        {name: _material(name, found) for name, found in told["materials"].items()},
        _meshes(told, path.parent),
        [Sphere(s["material"], tuple(s["center"]), s["radius"]) for s in told.get("spheres", [])],
        _color(medium.get("sigma_a", 0)),
        _color(medium.get("sigma_s", 0)),
        medium.get("g", 0.0),
    )
