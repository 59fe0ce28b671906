# SPDX-License-Identifier: GPL-3.0-or-later
"""Horizon: hills of three metals run to the end of a small planet, under five moons that come together.

blender -b --python blend_scenes/horizon.py [-- FOLDER]
"""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
import stage


def build() -> None:
    stage.world("CONVERGENCE", samples=32, plate_radius=1.6)


if __name__ == "__main__":
    build()
    stage.save(__file__)
