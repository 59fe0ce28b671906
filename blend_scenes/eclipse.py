# SPDX-License-Identifier: GPL-3.0-or-later
"""Eclipse: a black moon before a white one, and the ring of light that it leaves over cracked plates.

blender -b --python blend_scenes/eclipse.py [-- FOLDER]
"""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
import stage


def build() -> None:
    stage.world("BLACK_ECLIPSE", samples=32)


if __name__ == "__main__":
    build()
    stage.save(__file__)
