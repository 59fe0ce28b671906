# SPDX-License-Identifier: GPL-3.0-or-later
"""Glimmervoid: hills of bevelled metal plates that run into the haze, under five moons. The picture of the README.

blender -b --python blend_scenes/glimmervoid.py [-- FOLDER]
"""

import math
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
import stage

# The eye is low over the plates; moons are placed as it sees them.
EYE = (0.0, -118.0, -0.5)
# name, color, strength, azimuth and elevation in degrees, distance along the ground, radius
MOONS = (
    ("Red Moon", (1.0, 0.02, 0.008), 3.6, -18.0, 4.0, 125.0, 16.5),
    ("White Moon", (1.0, 0.86, 0.68), 30.0, 6.0, 15.5, 200.0, 7.0),
    ("Blue Moon", (0.02, 0.10, 1.0), 15.0, 21.0, 11.5, 50.0, 3.3),
    ("Green Moon", (0.02, 1.0, 0.12), 7.0, 1.0, -2.4, 34.0, 1.3),
    ("Black Moon", (0.45, 0.15, 1.0), 0.05, -9.5, 9.5, 62.0, 3.6),
)


def build() -> None:
    scene = stage.clear()
    stage.picture(scene, 960, 540, samples=64, exposure=0.5)
    stage.haze(scene, sigma_s=(0.0026, 0.0032, 0.0042), sigma_a=(0.0008,) * 3)
    plate = stage.surface("Plate", "ShaderNodeBsdfGlossy", Color=(0.60, 0.59, 0.58), Roughness=0.42)
    bevel = stage.surface("Bevel", "ShaderNodeBsdfGlossy", Color=(0.90, 0.88, 0.85), Roughness=0.2)
    stage.field(
        scene,
        plate,
        bevel,
        rings=81,
        gap=0.05,
        thickness=1.6,
        bevel_width=0.14,
        bevel_segments=4,
        hill_height=22.0,
        hill_wavelength=64.0,
        hill_octaves=4,
        hill_follow=0.55,
        mutation_height=0.12,
        mutation_tilt=math.radians(5.0),
        mutation_shape=0.04,
        mutation_bevel=0.12,
        prototypes=12,
        seed=2,
    )
    x, y, z = EYE
    for name, color, strength, azimuth, elevation, distance, radius in MOONS:
        a, e = math.radians(azimuth), math.radians(elevation)
        place = (x + distance * math.sin(a), y + distance * math.cos(a), z + distance * math.tan(e))
        stage.moon(scene, name, color, strength, radius, place)
    stage.camera(scene, EYE, (x, y + 100.0, z + 2.6), fov_x=60.0)


if __name__ == "__main__":
    build()
    stage.save(__file__)
