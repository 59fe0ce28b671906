# SPDX-License-Identifier: GPL-3.0-or-later
"""Five moons around each other over the hills: a loop of 100 frames, in which each goes around once, twice or thrice.

blender -b --python blend_scenes/five_moons_orbit.py [-- FOLDER]
"""

import math
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
import stage

# What the moons orbit is a place in the sky ahead.
CENTER = (0.0, 150.0, 42.0)
# name, distance, and how often it goes around in the loop
ORBITS = (
    ("Green Moon", 12.0, 3),
    ("White Moon", 20.0, 2),
    ("Black Moon", 29.0, 1),
    ("Blue Moon", 38.0, 1),
    ("Red Moon", 48.0, 1),
)


def build() -> None:
    scene, _ = stage.world("CONVERGENCE", samples=32, plate_radius=1.8)
    scene.frame_start, scene.frame_end = 1, 100
    scene.frame_set(1)
    orbit = stage.tools("moons.orbit")
    for index, (name, distance, turns) in enumerate(ORBITS):
        path = stage.tools("moons.kepler").Orbit(
            center=CENTER,
            semi_axis=distance,
            period=100.0 / turns,
            inclination=math.radians(20.0),
            phase=math.radians(72.0 * index),
        )
        scene.objects[name].scale *= 0.65
        orbit.put_on_orbit(scene.objects[name], path)
    scene.frame_set(1)


if __name__ == "__main__":
    build()
    stage.save(__file__)
