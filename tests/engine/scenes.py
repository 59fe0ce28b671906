# SPDX-License-Identifier: GPL-3.0-or-later
"""Scene files for tests: small scenes as dictionaries, the command that renders them, and pictures as arrays."""

import copy
import json
import os
import subprocess
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import OpenImageIO
from numpy.typing import NDArray

Scene = dict[str, Any]
Image = NDArray[np.float32]

IDENTITY = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
QUAD = {"vertices": [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], "triangles": [[0, 1, 2], [0, 2, 3]]}


def scene(**parts: Any) -> Scene:
    """A camera at (0, -10, 0) looking along +y, 8 x 6 pixels, nothing else; `parts` replace or add top-level keys."""
    return {
        "glimmer": 1,
        "film": {"width": 8, "height": 6},
        "camera": {"origin": [0, -10, 0], "target": [0, 0, 0], "fov_x": 40},
        **parts,
    }


def furnace(radiance: float = 1.0) -> Scene:
    """A grey sphere in a white environment."""
    return scene(
        materials={"grey": {"type": "lambert", "albedo": 0.5}},
        spheres=[{"center": [0, 0, 0], "radius": 2, "material": "grey"}],
        environment={"radiance": radiance},
    )


def hazy_moon() -> Scene:
    """A moon over a plate in fog: noisy everywhere, and every kind of transport at once."""
    return scene(
        film={"width": 24, "height": 16},
        materials={"grey": {"type": "lambert", "albedo": 0.6}, "moon": {"type": "light", "radiance": [3, 2, 1]}},
        meshes={"quad": QUAD},
        objects=[
            {
                "mesh": "quad",
                "material": "grey",
                "to_world": [[4, 0, 0, 0], [0, 4, 0, 0], [0, 0, 4, -1.5], [0, 0, 0, 1]],
            }
        ],
        spheres=[{"center": [1, 1, 1], "radius": 0.7, "material": "moon"}],
        medium={"sigma_a": 0.01, "sigma_s": 0.05, "g": 0.3},
    )


def every_key(folder: Path) -> Scene:
    """A scene with every key of the format; its files are written to `folder`."""
    rng = np.random.default_rng(1)
    instances = np.tile(np.eye(3, 4, dtype=np.float32), (5, 1, 1))
    instances[:, :, 3] = rng.uniform(-2, 2, (5, 3))
    np.save(folder / "plates.npy", instances)
    np.save(folder / "plates4.npy", np.tile(np.eye(4), (2, 1, 1)))
    np.save(folder / "indices.npy", np.arange(5, dtype=np.uint32))
    np.save(folder / "many.npy", rng.uniform(-3, 3, (7, 3)))
    np.save(folder / "more.npy", rng.uniform(-3, 3, (7, 3)))
    np.save(folder / "radii.npy", rng.uniform(0.1, 0.2, 7).astype(np.float32))
    np.save(folder / "vertices.npy", np.array(QUAD["vertices"], np.float64))
    np.save(folder / "triangles.npy", np.array(QUAD["triangles"], np.int32))
    np.save(folder / "normals.npy", np.tile([0.0, 0.0, 1.0], (4, 1)))
    np.save(folder / "uvs.npy", np.zeros((4, 2), np.float32))
    np.save(folder / "slots.npy", np.array([0, 1], np.uint16))
    write_ply(folder / "hex.ply", QUAD["vertices"], [[0, 1, 2, 3]])
    (folder / "tetra.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n")
    write_image(folder / "sky.exr", np.linspace(0.1, 0.4, 96, dtype=np.float32).reshape(4, 8, 3))
    emission = [0.1, 0.2, 0.3]
    return {
        "glimmer": 1,
        "film": {
            "width": 16,
            "height": 12,
            "filter": {"type": "blackman_harris", "width": 1.5},
            "crop": [2, 1, 14, 11],
            "exposure": 1.25,
            "pixel_aspect": 0.95,
            "transparent": False,
            "transparent_glass": 0.01,
            "mist": {"start": 3, "depth": 20, "falloff": 1},
        },
        "camera": {
            "origin": [0, -8, 2],
            "target": [0, 0, 0],
            "up": [0, 0, 1],
            "fov_x": 60,
            "shift": [0.1, -0.1],
            "lens_radius": 0.01,
            "focus_distance": 8,
            "aperture": {"blades": 5, "rotation": 10, "ratio": 1.5},
            "clip": [0.1, None],
        },
        "materials": {
            "plate": {
                "type": "mix",
                "weight": 0.25,
                "a": {"type": "lambert", "albedo": [0.5, 0.5, 0.55]},
                "b": "metal",
                "emission": emission,
            },
            "metal": {
                "type": "conductor",
                "alpha": 0.25,
                "eta": [2.6, 2.4, 2.2],
                "k": 3.3,
                "masking": "smith_separable",
                "emission": emission,
            },
            "gold": {"type": "conductor", "alpha": 0, "f0": [1, 0.8, 0.3], "masking": "schlick_ggx"},
            "wax": {"type": "lambert", "albedo": 0.5, "emission": 0.5},
            "mirror": {"type": "mirror", "reflectance": 1, "emission": 0},
            "glass": {"type": "glass", "ior": 1.5, "fresnel": "schlick"},
            "old": {"type": "report_metal", "albedo": 0.2, "f0": 0.7, "alpha": 0.3, "emission": 0},
            "moon": {"type": "light", "radiance": [30, 2, 1]},
            "gone": {"type": "null"},
            "leaf": {
                "type": "add",
                "a": {"type": "lambert", "albedo": 0.4, "roughness": 0.5, "facets": "multiple"},
                "b": {"type": "mix", "weight": 0.5, "a": {"type": "translucent", "albedo": 0.3}, "b": "pane"},
                "emission": emission,
            },
            "pane": {"type": "transparent", "transmittance": [0.9, 0.5, 0.1]},
            "frosted": {
                "type": "glass",
                "ior": 1.4,
                "alpha": 0.2,
                "reflection": 0.9,
                "transmission": [0.8, 0.9, 1],
                "lobes": "both",
                "emission": 0,
            },
        },
        "meshes": {
            "hex": {"file": "hex.ply", "slots": [0, 1]},
            "tetra": {"file": "tetra.obj"},
            "quad": {**QUAD, "normals": [[0, 0, 1]] * 4, "uvs": [[0, 0], [1, 0], [1, 1], [0, 1]]},
            "files": {
                "vertices": "vertices.npy",
                "triangles": "triangles.npy",
                "normals": "normals.npy",
                "uvs": "uvs.npy",
                "slots": "slots.npy",
            },
        },
        "objects": [
            {"mesh": "quad", "material": "plate", "to_world": [*IDENTITY[:2], [0, 0, 1, 0.6], IDENTITY[3]], "index": 7},
            {"mesh": "hex", "materials": ["plate", "gold"], "instances": "plates.npy", "indices": "indices.npy"},
            {"mesh": "files", "materials": ["wax", "old", "metal"], "instances": "plates4.npy"},
            {"mesh": "tetra", "material": "gone"},
        ],
        "spheres": [
            {"center": [-2, 3, 2], "radius": 0.5, "material": "moon", "index": 9},
            {"centers": "many.npy", "radius": 0.3, "material": "mirror"},
            {"centers": "more.npy", "radii": "radii.npy", "material": "gold"},
            {"centers": [[1.5, -3, 1], [-1, -3, 1]], "radii": [0.5, 0.2], "material": "glass"},
        ],
        "lights": [
            {"type": "point", "position": [0, 0, 5], "intensity": 10, "radius": 0.1},
            {
                "type": "spot",
                "position": [1, 0, 5],
                "intensity": [10, 5, 1],
                "direction": [0, 0, -2],
                "angle": 45,
                "blend": 0.15,
                "radius": 0,
            },
            {"type": "sun", "direction": [0, 1, -1], "irradiance": 1, "angle": 0.5},
            {"type": "area", "to_world": copy.deepcopy(IDENTITY), "size": [1, 2], "shape": "ellipse", "radiance": 3},
        ],
        "environment": {"image": "sky.exr", "strength": 0.5, "to_world": IDENTITY},
        "medium": {"sigma_a": 0.0015, "sigma_s": [0.0135, 0.01, 0.02], "g": -0.2},
        "render": {"max_depth": 8, "max_scatter": None},
    }


def changed(original: Scene, path: tuple[str | int, ...], value: Any) -> Scene:
    """A copy with one value replaced or added."""
    result = copy.deepcopy(original)
    place: Any = result
    for key in path[:-1]:
        place = place[key]
    place[path[-1]] = value
    return result


def removed(original: Scene, path: tuple[str | int, ...]) -> Scene:
    """A copy without one key."""
    result = copy.deepcopy(original)
    place: Any = result
    for key in path[:-1]:
        place = place[key]
    del place[path[-1]]
    return result


def write_scene(folder: Path, content: Scene | str, name: str = "scene.json") -> Path:
    """Writes a scene (or any text) and returns its path."""
    path = folder / name
    path.write_text(content if isinstance(content, str) else json.dumps(content))
    return path


def write_ply(path: Path, vertices: Any, faces: list[list[int]]) -> None:
    """A .ply in text."""
    rows = np.asarray(vertices)
    lines = [
        "ply",
        "format ascii 1.0",
        f"element vertex {len(rows)}",
        *(f"property float {axis}" for axis in "xyz"),
        f"element face {len(faces)}",
        "property list uchar int vertex_indices",
        "end_header",
        *(" ".join(str(number) for number in row) for row in rows),
        *(" ".join(str(number) for number in [len(face), *face]) for face in faces),
    ]
    path.write_text("\n".join(lines) + "\n")


def write_image(path: Path, pixels: NDArray[Any]) -> None:
    """(height, width, channels) uint8 or float32, in the format of the path's ending; stored as they are."""
    height, width, channels = pixels.shape
    output = OpenImageIO.ImageOutput.create(str(path))
    spec = OpenImageIO.ImageSpec(width, height, channels, "uint8" if pixels.dtype == np.uint8 else "float")
    spec.attribute("oiio:UnassociatedAlpha", 1)
    assert output is not None and output.open(str(path), spec), path
    assert output.write_image(np.ascontiguousarray(pixels)), output.geterror()
    output.close()


def run_glimmer(*arguments: Any, timeout: float = 120, **options: Any) -> "subprocess.CompletedProcess[str]":
    """The command of GLIMMER_BIN, its output captured as text."""
    command = [os.environ["GLIMMER_BIN"], *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, timeout=timeout, check=False, **options)


@dataclass(frozen=True)
class Exr:
    """A picture that the command wrote: (height, width) float32 a channel, of the data window."""

    channels: dict[str, Image]
    attributes: dict[str, Any]
    window: tuple[int, int, int, int]
    """x0, y0, x1, y1"""
    size: tuple[int, int]
    """width and height of the whole picture"""

    def layer(self, name: str = "", components: str = "RGB") -> Image:
        """(height, width, components) of a layer; "" is the picture itself."""
        return np.stack([self.channels[f"{name}.{c}" if name else c] for c in components], axis=-1)

    @property
    def rgb(self) -> Image:
        return self.layer()


def read_pixels(path: Path, kind: str = "float") -> tuple[OpenImageIO.ImageSpec, NDArray[Any]]:
    """Any picture, as it is stored: its specification and (height, width, channels) float32, or as "uint8"."""
    config = OpenImageIO.ImageSpec()
    config.attribute("oiio:UnassociatedAlpha", 1)
    file = OpenImageIO.ImageInput.open(str(path), config)
    assert file is not None, f"{path}: {OpenImageIO.geterror()}"
    spec = file.spec()
    pixels = file.read_image(kind)
    assert pixels is not None, file.geterror()
    file.close()
    return spec, np.asarray(pixels).reshape(spec.height, spec.width, spec.nchannels)


def read_pfm(path: Path) -> Image:
    """(height, width, 3), top row first, of a little-endian .pfm (whose rows stand from the bottom up)."""
    header, data = path.read_bytes().split(b"\n-1.0\n", 1)
    magic, size = header.split(b"\n")
    assert magic == b"PF"
    width, height = map(int, size.split())
    return np.frombuffer(data, "<f4").reshape(height, width, 3)[::-1]


def read_exr(path: Path) -> Exr:
    """Every channel of an .exr."""
    spec, pixels = read_pixels(path)
    return Exr(
        channels={name: pixels[..., i] for i, name in enumerate(spec.channelnames)},
        attributes={attribute.name: attribute.value for attribute in spec.extra_attribs},
        window=(spec.x, spec.y, spec.x + spec.width, spec.y + spec.height),
        size=(spec.full_width, spec.full_height),
    )


def render(folder: Path, content: Scene, *options: Any, name: str = "out") -> Exr:
    """Renders a scene by the command and reads the picture; what it says when it fails is the test's message."""
    path = write_scene(folder, content, f"{name}.json")
    output = folder / f"{name}.exr"
    done = run_glimmer(path, "-o", output, "--quiet", *options)
    assert done.returncode == 0, done.stderr
    return read_exr(output)
