# SPDX-License-Identifier: GPL-3.0-or-later
"""Dunes: waves of golden plates at the dawn of a blue moon.

blender -b --python blend_scenes/dunes.py [-- FOLDER]
"""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
import stage


def build() -> None:
    stage.world("BLUE_DAWN", samples=32)


if __name__ == "__main__":
    build()
    stage.save(__file__)
