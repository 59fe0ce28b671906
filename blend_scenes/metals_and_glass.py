# SPDX-License-Identifier: GPL-3.0-or-later
"""A row of spheres on hexagonal plates, without fog: mirror, polished to rough metals, glass and lambert.

blender -b --python blend_scenes/metals_and_glass.py [-- FOLDER]
"""

import sys
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parent))
import stage

GLOSSY = "ShaderNodeBsdfGlossy"
ROW: tuple[tuple[str, str, dict[str, Any]], ...] = (
    ("Mirror", GLOSSY, {"Color": (0.95, 0.95, 0.95), "Roughness": 0.0}),
    ("Gold", GLOSSY, {"Color": (1.0, 0.71, 0.29), "Roughness": 0.15}),
    ("Glass", "ShaderNodeBsdfGlass", {"Color": (1.0, 1.0, 1.0), "Roughness": 0.0, "IOR": 1.5}),
    ("Copper", "ShaderNodeBsdfPrincipled", {"Base_Color": (0.95, 0.48, 0.33), "Metallic": 1.0, "Roughness": 0.35}),
    ("Steel", GLOSSY, {"Color": (0.6, 0.59, 0.57), "Roughness": 0.6}),
    ("Lambert", "ShaderNodeBsdfDiffuse", {"Color": (0.6, 0.55, 0.5)}),
)
MOONS = (
    ("Warm Moon", (1.0, 0.72, 0.42), 30.0, 1.5, (-7.0, -4.0, 8.0)),
    ("Cold Moon", (0.35, 0.55, 1.0), 30.0, 1.5, (8.0, -3.0, 7.0)),
    ("Violet Moon", (0.75, 0.25, 1.0), 14.0, 0.8, (0.0, 8.0, 3.3)),
)


def build() -> None:
    scene = stage.clear()
    stage.picture(scene, 960, 360, samples=128)
    stage.haze(scene, sigma_s=(0.0, 0.0, 0.0), sky=(0.02, 0.025, 0.04))
    plate = stage.surface("Plate", GLOSSY, Color=(0.45, 0.46, 0.5), Roughness=0.4)
    bevel = stage.surface("Bevel", GLOSSY, Color=(0.75, 0.75, 0.75), Roughness=0.2)
    stage.field(
        scene,
        plate,
        bevel,
        rings=16,
        plate_radius=0.8,
        hill_height=0.0,
        mutation_height=0.05,
        mutation_shape=0.02,
        seed=4,
    )
    for index, (name, kind, inputs) in enumerate(ROW):
        material = stage.surface(name, kind, **inputs)
        stage.sphere(scene, name, (2.3 * (index - (len(ROW) - 1) / 2), 0.0, 1.05), 1.0, material)
    for moon in MOONS:
        stage.moon(scene, *moon)
    stage.camera(scene, (0.0, -11.5, 3.4), (0.0, 0.0, 1.3), fov_x=62.0)


if __name__ == "__main__":
    build()
    stage.save(__file__)
