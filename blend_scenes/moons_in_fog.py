# SPDX-License-Identifier: GPL-3.0-or-later
"""Five moons and nothing but fog.

blender -b --python blend_scenes/moons_in_fog.py [-- FOLDER]
"""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
import stage


def build() -> None:
    scene = stage.clear()
    stage.picture(scene, 480, 270, samples=64, exposure=-1.5)
    stage.haze(scene, sigma_s=(0.0135,) * 3, sigma_a=(0.0015,) * 3)
    module = stage.tools("moons.moon")
    for moon in module.FIVE_MOONS:
        module.create(moon, scene.collection)
    stage.camera(scene, (0.0, -4.0, 7.5), (2.0, 40.0, 13.0), fov_x=65.0)


if __name__ == "__main__":
    build()
    stage.save(__file__)
