# SPDX-License-Identifier: GPL-3.0-or-later
"""The clearing: plates in a circle around a sphere, under five moons in haze. The scene of the report that Glimmer
grew from.

blender -b --python blend_scenes/clearing.py [-- FOLDER]
"""

import math
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
import stage

MOONS = (
    ("Red Moon", (1.0, 0.03, 0.01), 10.0, 1.5, (-8.0, 4.0, 5.2)),
    ("Green Moon", (0.03, 1.0, 0.15), 12.0, 0.7, (4.6, -3.0, 2.6)),
    ("White Moon", (1.0, 0.88, 0.7), 16.0, 1.5, (1.6, 15.0, 7.6)),
    ("Blue Moon", (0.02, 0.12, 1.0), 24.0, 1.1, (8.0, 6.0, 5.0)),
    ("Black Moon", (0.45, 0.15, 1.0), 0.05, 1.2, (-4.2, 8.5, 6.0)),
)


def build() -> None:
    scene = stage.clear()
    stage.picture(scene, 960, 540, samples=64)
    stage.haze(scene, sigma_s=(0.016, 0.017, 0.018), sigma_a=(0.003, 0.003, 0.003))
    plate = stage.surface("Plate", "ShaderNodeBsdfGlossy", Color=(0.58, 0.58, 0.60), Roughness=0.35)
    bevel = stage.surface("Bevel", "ShaderNodeBsdfGlossy", Color=(0.80, 0.79, 0.77), Roughness=0.2)
    steel = stage.surface("Sphere", "ShaderNodeBsdfGlossy", Color=(0.85, 0.83, 0.80), Roughness=0.12)
    stage.field(
        scene,
        plate,
        bevel,
        extent="RADIUS",
        radius=15.0,
        clearing=2.0,
        plate_radius=0.75,
        gap=0.06,
        thickness=0.8,
        bevel_width=0.09,
        hill_height=0.0,
        mutation_height=0.12,
        mutation_tilt=math.radians(4.0),
        mutation_shape=0.03,
        mutation_bevel=0.1,
        seed=1,
    )
    stage.sphere(scene, "Sphere", (0.0, 0.0, 1.2), 1.9, steel)
    for moon in MOONS:
        stage.moon(scene, *moon)
    stage.camera(scene, (0.0, -14.0, 4.4), (0.0, 0.0, 2.9), fov_x=62.0)


if __name__ == "__main__":
    build()
    stage.save(__file__)
