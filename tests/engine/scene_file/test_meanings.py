# SPDX-License-Identifier: GPL-3.0-or-later
"""Every value of the scene file changes the picture or a layer of it."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from tests.engine import scenes
from tests.engine.scenes import Scene, changed, every_key

pytestmark = pytest.mark.usefixtures("glimmer_command")


# Each value that means something, changed: (path, other value). The picture, or a layer of it, must change with it.
MEANINGS: list[tuple[tuple[str | int, ...], Any]] = [
    (("film", "filter"), "box"),
    (("film", "filter", "width"), 3),
    (("film", "exposure"), 2),
    (("film", "pixel_aspect"), 0.8),
    (("camera", "origin", 0), 1),
    (("camera", "target", 0), 1),
    (("camera", "up"), [0.2, 0, 1]),
    (("camera", "fov_x"), 50),
    (("camera", "shift", 0), 0),
    (("camera", "shift", 1), 0),
    (("camera", "lens_radius"), 0.2),
    (("camera", "focus_distance"), 5),
    (("camera", "aperture", "blades"), 3),
    (("camera", "aperture", "rotation"), 40),
    (("camera", "aperture", "ratio"), 0.7),
    (("camera", "clip"), [7, 9]),
    (("materials", "plate", "weight"), 0.5),
    (("materials", "plate", "a", "albedo"), 0.1),
    (("materials", "plate", "b"), "gold"),
    (("materials", "plate", "emission"), 2),
    (("materials", "metal", "alpha"), 0.5),
    (("materials", "metal", "eta"), 1.5),
    (("materials", "metal", "k"), 1),
    (("materials", "metal", "masking"), "smith"),
    (("materials", "metal", "masking"), "schlick_ggx"),
    (("materials", "metal", "emission"), 2),
    (("materials", "gold", "f0"), 0.2),
    (("materials", "gold", "f90"), 0.2),
    (("materials", "gold", "alpha"), 0.5),
    (("materials", "wax", "albedo"), 0.1),
    (("materials", "wax", "emission"), 1),
    (("materials", "mirror", "reflectance"), 0.5),
    (("materials", "mirror", "emission"), 1),
    (("materials", "glass", "ior"), 1.2),
    (("materials", "glass", "fresnel"), "exact"),
    (("materials", "old", "albedo"), 0.9),
    (("materials", "old", "f0"), 0.1),
    (("materials", "old", "alpha"), 0.9),
    (("materials", "old", "emission"), 1),
    (("materials", "moon", "radiance"), 7),
    (("meshes", "quad", "normals"), [[0.3, 0, 1]] * 4),
    (("meshes", "hex", "slots"), [1, 1]),
    (("meshes", "files", "slots"), [1, 0]),
    (("objects", 0, "index"), 8),
    (("objects", 0, "material"), "wax"),
    (("objects", 0, "to_world", 2, 3), 0.3),
    (("objects", 0, "visible"), ["diffuse", "glossy"]),
    (("objects", 0, "holdout"), True),
    (("objects", 1, "materials"), ["gold", "wax"]),
    (("objects", 1, "indices"), [4, 4, 4, 4, 4]),
    (("objects", 1, "to_world"), [[1, 0, 0, 1], *scenes.IDENTITY[1:]]),
    (("objects", 3, "material"), "wax"),
    (("spheres", 0, "center", 0), -1),
    (("spheres", 0, "radius"), 0.8),
    (("spheres", 0, "index"), 4),
    (("spheres", 0, "visible"), ["diffuse", "shadow"]),
    (("spheres", 0, "holdout"), True),
    (("spheres", 1, "radius"), 0.4),
    (("spheres", 2, "radii"), [0.2] * 7),
    (("spheres", 3, "material"), "wax"),
    (("lights", 0, "position", 0), 2),
    (("lights", 0, "intensity"), 3),
    (("lights", 0, "radius"), 1),
    (("lights", 0, "visible"), ["glossy"]),
    (("lights", 0, "shape"), "disk"),
    (("lights", 0, "shadows"), False),
    (("lights", 0, "max_bounces"), 0),
    (("lights", 1, "intensity"), 40),
    (("lights", 1, "times_cosine"), True),
    (("lights", 2, "shape"), "tangent"),
    (("lights", 1, "direction"), [0, 0.5, -2]),
    (("lights", 1, "angle"), 90),
    (("lights", 1, "blend"), 1),
    (("lights", 1, "radius"), 0.5),
    (("lights", 2, "direction"), [0, 0, -1]),
    (("lights", 2, "irradiance"), 3),
    (("lights", 2, "angle"), 20),
    (("lights", 3, "to_world", 2, 3), 2),
    (("lights", 3, "size", 1), 3),
    (("lights", 3, "shape"), "rectangle"),
    (("lights", 3, "radiance"), 5),
    (("lights", 3, "spread"), 60),
    (("lights", 3, "visible"), ["camera", "diffuse", "glossy"]),
    (("environment", "strength"), 1),
    (("environment", "visible"), ["diffuse"]),
    (("environment", "to_world"), [[0, -1, 0, 0], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]),
    (("render", "max_depth"), 1),
]


FOG_MEANINGS: list[tuple[tuple[str | int, ...], Any]] = [
    (("medium", "sigma_a"), 0.1),
    (("medium", "sigma_s"), 0.1),
    (("medium", "g"), 0.5),
    (("render", "max_scatter"), 0),
]


INTERIOR = {"sigma_a": 0.1, "sigma_s": 0.2, "g": 0.1, "emission": 0.1}
INTERIOR_MEANINGS: list[tuple[tuple[str | int, ...], Any]] = [
    ((kind, 0, "interior", key), value)
    for kind in ("objects", "spheres")
    for key, value in (("sigma_a", 0.5), ("sigma_s", [0.1, 0.2, 0.5]), ("g", -0.5), ("emission", 0))
]


ORTHOGRAPHIC_MEANINGS: list[tuple[tuple[str | int, ...], Any]] = [
    (("camera", "width"), 5),
    *(meaning for meaning in MEANINGS if meaning[0][0] == "camera" and meaning[0][1] != "fov_x"),
]


# A number that differs from those of panorama(), by camera type and key.
PANORAMA_KEYS: dict[str, dict[str, Any]] = {
    "equirectangular": {"longitude": [-100, 90], "latitude": [-70, 50]},
    "cylindrical": {"longitude": [-100, 90], "elevation": [-1, 0.9]},
    "fisheye_equidistant": {"fov": 120},
    "fisheye_equisolid": {"fov": 70, "focal_length": 0.4},
    "fisheye_polynomial": {"fov": 70, "polynomial": [0.1, 2, 0.1, 0.1, 0.1]},
    "mirror_ball": {},
    "cube_face": {},
}


def all_layers(folder: Path, content: Scene) -> dict[str, NDArray[Any]]:
    options = ("--spp", 4, "--aov", "object_index,material_index,normal,depth")
    return scenes.render(folder, content, *options).channels


@pytest.mark.parametrize("fog", [False, True], ids=["clear", "fog"])
def test_every_value_means_something(fog: bool, tmp_path: Path) -> None:
    """Nothing is read and then forgotten. Without fog, through which the environment cannot be seen, and with it."""
    base = every_key(tmp_path)
    base["film"].update(width=32, height=24, crop=[0, 0, 32, 24])
    base["lights"][3]["to_world"][2][3] = 3
    if not fog:
        del base["medium"]
    check_meanings(tmp_path, base, FOG_MEANINGS if fog else MEANINGS)


def test_every_value_of_an_orthographic_camera_means_something(tmp_path: Path) -> None:
    base = every_key(tmp_path)
    base["film"].update(width=32, height=24, crop=[0, 0, 32, 24])
    del base["medium"], base["camera"]["fov_x"]
    base["camera"].update(type="orthographic", width=8)
    check_meanings(tmp_path, base, ORTHOGRAPHIC_MEANINGS)


@pytest.mark.parametrize("kind", PANORAMA_KEYS)
def test_every_value_of_a_panorama_means_something(kind: str, tmp_path: Path) -> None:
    base = every_key(tmp_path)
    base["film"].update(width=32, height=24, crop=[0, 0, 32, 24])
    camera = base["camera"]
    del base["medium"], camera["fov_x"], camera["shift"]
    camera.update(type=kind, window=[0, 0, 1, 0.9])
    needed = {"fisheye_equisolid": {"focal_length": 0.3}, "fisheye_polynomial": {"polynomial": [0, 2, 0, 0, 0]}}
    camera.update(needed.get(kind, {}))
    check_meanings(
        tmp_path,
        base,
        [
            (("camera", "window"), [0.1, 0, 1, 1]),
            *((("camera", key), value) for key, value in PANORAMA_KEYS[kind].items()),
            *(m for m in MEANINGS if m[0][0] == "camera" and m[0][1] not in ("fov_x", "shift")),
        ],
    )


def test_every_value_of_an_interior_means_something(tmp_path: Path) -> None:
    base = every_key(tmp_path)
    base["film"].update(width=32, height=24, crop=[0, 0, 32, 24])
    base["objects"][0] = {"mesh": "tetra", "material": "gone", "interior": dict(INTERIOR)}
    base["spheres"][0].update(material="gone", interior=dict(INTERIOR))
    check_meanings(tmp_path, base, INTERIOR_MEANINGS)


def check_meanings(folder: Path, base: Scene, meanings: list[tuple[tuple[str | int, ...], Any]]) -> None:
    reference = all_layers(folder, base)
    assert all(np.array_equal(channel, reference[name]) for name, channel in all_layers(folder, base).items())
    forgotten = []
    for path, value in meanings:
        layers = all_layers(folder, changed(base, path, value))
        if all(np.array_equal(layers[name], reference[name]) for name in reference):
            forgotten.append(".".join(map(str, path)))
    assert not forgotten


PASSES: list[tuple[tuple[str | int, ...], Any, str]] = [
    (("film", "mist"), {"start": 7}, "mist.Z"),
    (("film", "mist"), {"depth": 90}, "mist.Z"),
    (("film", "mist"), {"falloff": 0.5}, "mist.Z"),
    (("film", "transparent"), True, "R"),
    (("spheres", 0, "matte"), 7, "object_matte.0"),
    (("objects", 0, "matte"), 7, "object_matte.0"),
    (("spheres", 0, "light_group"), 2, "light_group_2.R"),
    (("objects", 0, "light_group"), 2, "light_group_2.R"),
    (("lights", 0, "light_group"), 2, "light_group_2.R"),
    (("environment", "light_group"), 2, "light_group_2.R"),
]


def test_every_value_of_passes_means_something(tmp_path: Path) -> None:
    content = scenes.furnace(0.5)
    content["materials"]["grey"]["emission"] = 0.1
    content["meshes"] = {"quad": scenes.QUAD}
    content["objects"] = [
        {"mesh": "quad", "material": "grey", "to_world": [*scenes.IDENTITY[:2], [0, 0, 1, 2.5], [0, 0, 0, 1]]}
    ]
    content["lights"] = [{"type": "point", "position": [0, -5, 5], "intensity": 9}]
    options = ("--spp", 4, "--aov", "mist,object_matte,light_group_2")
    before = scenes.render(tmp_path, content, *options)
    for path, value, channel in PASSES:
        after = scenes.render(tmp_path, changed(content, path, value), *options)
        assert not np.array_equal(before.channels[channel], after.channels[channel]), path
