# SPDX-License-Identifier: GPL-3.0-or-later
"""SceneDescription -> a scene file of the command line: JSON, with meshes as .ply and long lists as .npy beside it.

The sidecars lie in a folder named after the scene file, since a scene may only name files below its own folder.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import asdict
from itertools import accumulate
from math import isinf
from pathlib import Path
from typing import Any

import numpy as np

from . import description as d
from .exr import write_exr
from .ply import write_ply
from .problems import GlimmerError
from .program import INPUTS, RESOURCES, Instruction, Output, Program, Texture

Json = dict[str, Any]

# The command line takes the rest of these from its own options.
RENDER_KEYS = ("max_depth", "max_scatter")


def write_scene(scene: d.SceneDescription, path: Path) -> None:
    """Raises GlimmerError when it cannot be written."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        document = _Writer(path).document(scene)
        path.write_text(json.dumps(document, indent=1) + "\n")
    except OSError as error:
        raise GlimmerError(f"The scene file {path} cannot be written: {error.strerror or error}") from error


def material_numbers(scene: d.SceneDescription) -> list[int]:
    """The engine's number of each material where the scene comes from its file: in their order, and the parts of a mix
    before it.
    """
    return [number - 1 for number in accumulate(_count(item.material) for item in scene.materials)]


def _count(material: d.Material) -> int:
    """With its parts."""
    return 1 + sum(_count(part) for part in d.parameters(material).values() if isinstance(part, d.Material))


def _numbers(array: Any) -> Any:
    return np.asarray(array, np.float64).tolist()


class _Writer:
    def __init__(self, path: Path) -> None:
        self._folder = path.with_name(path.stem + "_data")
        self._mesh_names: dict[bytes, str] = {}
        self._material_names: list[str] = []
        self._varies: list[bool] = []  # whether a material has a program, which may ask for numbers of its object
        self._meshes: Json = {}
        self._programs: Json = {}
        self._media: dict[Program, str] = {}  # the names of their programs
        self._textures: Json = {}
        self._texture_names: dict[bytes, str] = {}
        self._arrays = 0

    def document(self, scene: d.SceneDescription) -> Json:
        self._material_names = _unique([item.name for item in scene.materials])
        self._varies = [item.program is not None for item in scene.materials]
        named = zip(self._material_names, scene.materials, strict=True)
        result: Json = {
            "glimmer": 1,
            "film": _film(scene.film),
            "camera": _camera(scene.camera),
            "textures": self._textures,
            "programs": self._programs,
            "materials": {name: self._material(name, item) for name, item in named},
            "meshes": self._meshes,
            "objects": [self._object(item) for item in scene.objects],
            "spheres": [self._spheres(item) for item in scene.spheres],
            "lights": [{**_lamp(lamp), **self._profile(lamp)} for lamp in scene.lights],
            "environment": self._environment(scene.environment),
        }
        if scene.medium is not None:
            result["medium"] = _medium(scene.medium)
        result["render"] = {key: getattr(scene.settings, key) for key in RENDER_KEYS}
        return {key: value for key, value in result.items() if value or key not in ("textures", "programs")}

    def _save(self, kind: str, array: Any) -> str:
        name = f"{kind}_{self._arrays}.npy"
        self._arrays += 1
        self._folder.mkdir(parents=True, exist_ok=True)
        np.save(self._folder / name, array)
        return f"{self._folder.name}/{name}"

    def _mesh(self, mesh: d.Mesh) -> str:
        """The name of a mesh of the file, written when it is first asked for."""
        if mesh.digest not in self._mesh_names:
            name = self._mesh_names[mesh.digest] = f"mesh_{len(self._mesh_names)}"
            self._folder.mkdir(parents=True, exist_ok=True)
            write_ply(mesh, self._folder / f"{name}.ply")
            self._meshes[name] = {"file": f"{self._folder.name}/{name}.ply"}
            if mesh.slots is not None:
                self._meshes[name]["slots"] = self._save("slots", mesh.slots)
            if mesh.attributes:
                self._meshes[name]["attributes"] = {
                    item.name: {"domain": item.domain, "values": self._save("attribute", item.values)}
                    for item in mesh.attributes
                }
        return self._mesh_names[mesh.digest]

    def _profile(self, lamp: d.Lamp) -> Json:
        profile = lamp.flags.profile
        if profile is None:
            return {}
        program = self._program(f"light {lamp.name}", profile.program)
        return {"profile": {"factor": {"program": program, "output": 0}, "to_world": _numbers(profile.to_world)}}

    def _material(self, name: str, item: d.NamedMaterial) -> Json:
        program = None if item.program is None else self._program(f"material {name}", item.program)
        result = _material(item.material, program)
        if item.normal is not None:
            result[item.normal_key] = _parameter(item.normal, program)
        if item.aovs:
            result["aovs"] = {f"aov_{slot}": _parameter(output, program) for slot, output in item.aovs}
        return result

    def _program(self, name: str, program: Program) -> str:
        """Its name, which no other has."""
        self._programs[name] = {
            "steps": [self._step(program, item) for item in program.instructions],
            "outputs": [f"r{number}" for number in program.outputs],
        }
        return name

    def _step(self, program: Program, item: Instruction) -> Json:
        result: Json = {"op": item.op}
        if item.modes:
            result["modes"] = list(item.modes)
        inputs = INPUTS[item.op]
        result["in"] = [
            f"r{number}" if number >= 0 else _constant(program.constants[-1 - number], kind)
            for number, kind in zip(item.inputs, inputs, strict=True)
        ]
        result["out"] = f"r{item.out}"
        resource = RESOURCES.get(item.op)
        if resource == "table":
            table = program.tables[item.resource]
            rows = self._save("table", table.rows)
            result["table"] = {"rows": rows, "low": table.low, "high": table.high}
        elif resource == "texture":
            result["texture"] = self._texture(program.textures[item.resource])
        elif resource == "attribute":
            result["attribute"] = program.attributes[item.resource]
        return result

    def _texture(self, texture: Texture) -> str:
        """The name of a texture of the file, written when it is first asked for."""
        if texture.digest not in self._texture_names:
            name = self._texture_names[texture.digest] = f"{texture.name} #{len(self._texture_names)}"
            floats = texture.pixels.dtype != np.uint8
            pixels = texture.pixels.astype(np.float32) if floats else texture.pixels
            self._textures[name] = {"file": self._save("texture", pixels)}
            if texture.srgb:
                self._textures[name]["srgb"] = True
        return self._texture_names[texture.digest]

    def _object(self, item: d.Object) -> Json:
        result: Json = {"mesh": self._mesh(item.mesh)}
        names = [self._material_names[number] for number in item.materials]
        if len(names) == 1:
            result["material"] = names[0]
        else:
            result["materials"] = names
        if item.motion is None:
            result["to_world"] = _numbers(item.to_world)
        else:
            result["motion"] = [_numbers(step) for step in item.motion]
        if item.instances is not None:
            result["instances"] = self._save("instances", item.instances)
        if item.color != (1.0, 1.0, 1.0, 1.0):
            result["color"] = list(item.color)
        varies = any(self._varies[number] for number in item.materials)
        randoms = np.asarray(item.random if varies else 0.0, np.float64).reshape(-1)
        if item.instances is not None and varies and len(randoms) == len(item.instances):
            result["randoms"] = self._save("randoms", randoms)
        elif randoms[0] != 0.0:
            result["random"] = float(randoms[0])
        if item.attributes:
            result["attributes"] = {entry.name: self._save("attribute", entry.values) for entry in item.attributes}
        if item.object_index:
            result["index"] = item.object_index
        if item.shadow_terminator:
            result["shadow_terminator"] = item.shadow_terminator
        if item.interior is not None:
            result["interior"] = self._interior(item.interior)
        return {**result, **_visibility(item)}

    def _spheres(self, spheres: d.Spheres) -> Json:
        if len(spheres.centers) == 1:
            result: Json = {"center": _numbers(spheres.centers[0]), "radius": float(spheres.radii[0])}
        else:
            centers = self._save("centers", np.asarray(spheres.centers, np.float64))
            result = {"centers": centers, "radii": self._save("radii", np.asarray(spheres.radii, np.float64))}
        result["material"] = self._material_names[spheres.material]
        if spheres.object_index:
            result["index"] = spheres.object_index
        if spheres.interior is not None:
            result["interior"] = self._interior(spheres.interior)
        return {**result, **_visibility(spheres)}

    def _interior(self, medium: d.Medium) -> Json:
        program = None
        if medium.program is not None:
            if medium.program not in self._media:
                self._media[medium.program] = self._program(f"medium {len(self._media)}", medium.program)
            program = self._media[medium.program]
        values = {"sigma_a": medium.sigma_a, "sigma_s": medium.sigma_s, "g": medium.g}
        if medium.emission != d.BLACK:
            values["emission"] = medium.emission
        return {key: _parameter(value, program) for key, value in values.items()}

    def _environment(self, environment: d.Environment) -> Json:
        visible = _visible(environment.rays, d.EVERY_RAY)
        if environment.light_group:
            visible["light_group"] = environment.light_group
        if environment.program is not None:
            result: Json = {"radiance": {"program": self._program("environment", environment.program), "output": 0}}
            if environment.sun is not None:
                result["sun"] = {"direction": list(environment.sun.direction), "angle": environment.sun.angle}
            return {**result, **visible}
        if environment.image is None:
            return {"radiance": list(environment.radiance), **visible}
        self._folder.mkdir(parents=True, exist_ok=True)
        write_exr(environment.image, self._folder / "environment.exr")
        return {
            "image": f"{self._folder.name}/environment.exr",
            "strength": environment.radiance[0],
            "to_world": _numbers(environment.to_world),
            **visible,
        }


def _visible(rays: d.Rays, usual: d.Rays) -> Json:
    if rays == usual:
        return {}
    return {"visible": [ray.name.lower() for ray in d.Rays if ray in rays and ray.name]}


def _visibility(item: d.Object | d.Spheres) -> Json:
    numbers = {"matte": item.matte, "light_group": item.light_group}
    return {
        **_visible(item.rays, d.EVERY_RAY),
        **({"holdout": True} if item.is_holdout else {}),
        **{key: number for key, number in numbers.items() if number},
    }


def _unique(names: list[str]) -> list[str]:
    """Names of linked files may coincide; those of a scene file must not."""
    seen: dict[str, int] = {}
    result = []
    for name in names:
        count = seen[name] = seen.get(name, -1) + 1
        result.append(name if count == 0 else f"{name} #{count}")
    return result


def _medium(medium: d.Medium) -> Json:
    result = {key: _parameter(getattr(medium, key), None) for key in ("sigma_a", "sigma_s", "g")}
    if medium.falloff is not None:
        result["height"], result["scale_height"] = medium.falloff.height, medium.falloff.scale_height
    return result


def _film(film: d.Film) -> Json:
    result: Json = {"width": film.width, "height": film.height}
    if film.filter == "box":
        result["filter"] = "box"
    else:
        result["filter"] = {"type": film.filter, "width": film.filter_width}
    if film.crop is not None:
        result["crop"] = list(film.crop)
    if film.exposure != 1.0:
        result["exposure"] = film.exposure
    if film.transparent:
        result["transparent"] = True
    if film.transparent_glass is not None:
        result["transparent_glass"] = film.transparent_glass
    if film.occlusion_distance != d.Film.occlusion_distance:
        result["occlusion_distance"] = film.occlusion_distance
    if film.pixel_aspect != 1.0:
        result["pixel_aspect"] = film.pixel_aspect
    if film.mist != d.Mist():
        result["mist"] = {"start": film.mist.start, "depth": film.mist.depth, "falloff": film.mist.falloff}
    return result


def _camera(camera: d.Camera) -> Json:
    result: Json = {}
    if camera.motion is None:
        result["to_world"] = _numbers(camera.to_world)
    else:
        result["motion"] = [_numbers(step) for step in camera.motion]
    match camera.projection:
        case d.Perspective(fov_x):
            result["fov_x"] = fov_x
        case d.Orthographic(width):
            result["type"], result["width"] = "orthographic", width
        case panorama:
            result["type"] = panorama.TYPE
            result |= {name: list(v) if isinstance(v, tuple) else v for name, v in asdict(panorama).items()}
    if camera.stereo is not None:
        result["stereo"] = {"offset": camera.stereo.offset, "merge": list(camera.stereo.merge)}
        if not isinf(camera.stereo.convergence):
            result["stereo"]["convergence"] = camera.stereo.convergence
    if any(camera.shift):
        result["shift"] = list(camera.shift)
    if camera.lens_radius > 0.0:
        result["lens_radius"], result["focus_distance"] = camera.lens_radius, camera.focus_distance
        if camera.aperture != d.Aperture():
            result["aperture"] = asdict(camera.aperture)
    if camera.clip_start != 0.0 or not isinf(camera.clip_end):
        result["clip"] = [camera.clip_start, None if isinf(camera.clip_end) else camera.clip_end]
    return result


def _constant(value: Any, kind: str) -> Any:
    return float(value[0]) if kind == "n" else _numbers(value)


def _material(material: d.Material, program: str | None) -> Json:
    values = {key: _parameter(value, program) for key, value in d.parameters(material).items()}
    return {"type": material.TYPE, **values}


def _parameter(value: Any, program: str | None) -> Any:
    """Numbers and words as they are, colours as lists, a part of a mix in place, what a program gives by its name."""
    if isinstance(value, d.Material):
        return _material(value, program)
    if isinstance(value, Output):
        return {"program": program, "output": value.index}
    return list(value) if isinstance(value, tuple) else value


def _lamp(lamp: d.Lamp) -> Json:
    flags = lamp.flags
    result = {**_LAMPS[type(lamp)](lamp), **_visible(flags.rays, d.LAMP_RAYS)}
    if not flags.shadows:
        result["shadows"] = False
    if flags.max_bounces is not None:
        result["max_bounces"] = flags.max_bounces
    if flags.light_group:
        result["light_group"] = flags.light_group
    return result


def _radius(lamp: d.PointLight | d.SpotLight) -> Json:
    if lamp.radius <= 0.0:
        return {}
    return {"radius": lamp.radius, **({"shape": "disk"} if lamp.is_disk else {})}


def _point(lamp: d.PointLight) -> Json:
    return {"type": "point", "position": list(lamp.position), "intensity": list(lamp.intensity), **_radius(lamp)}


def _spot(lamp: d.SpotLight) -> Json:
    return {
        "type": "spot",
        "position": list(lamp.position),
        "direction": list(lamp.direction),
        "intensity": list(lamp.intensity),
        "angle": lamp.angle,
        "blend": lamp.blend,
        **({"times_cosine": True} if lamp.times_cosine else {}),
        **_radius(lamp),
    }


def _sun(lamp: d.SunLight) -> Json:
    return {
        "type": "sun",
        "direction": list(lamp.direction),
        "irradiance": list(lamp.irradiance),
        "angle": lamp.angle,
        **({"shape": "tangent"} if lamp.is_tangent else {}),
    }


def _area(lamp: d.AreaLight) -> Json:
    return {
        "type": "area",
        "to_world": _numbers(lamp.to_world),
        "size": list(lamp.size),
        "shape": "ellipse" if lamp.ellipse else "rectangle",
        "radiance": list(lamp.radiance),
        **({"spread": lamp.spread} if lamp.spread < 180.0 else {}),
    }


_LAMPS: dict[type, Callable[[Any], Json]] = {
    d.PointLight: _point,
    d.SpotLight: _spot,
    d.SunLight: _sun,
    d.AreaLight: _area,
}
