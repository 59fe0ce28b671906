# SPDX-License-Identifier: GPL-3.0-or-later
"""Constants that the engine and the add-on each hold, and that must agree: read from their sources."""

import re
from pathlib import Path

ROOT = Path(__file__).parents[2]


def constant(file: str, pattern: str) -> float:
    found = re.search(pattern, (ROOT / file).read_text(), re.MULTILINE)
    assert found, f"{file} has no {pattern}"
    return float(found[1])


def test_metal_is_a_mirror_below_the_same_roughness() -> None:
    ours = constant("addon/export/material.py", r"^MIRROR_ALPHA = (\S+)$")
    assert ours == constant("engine/src/bsdf/ggx.h", r"kSmoothAlpha = ([^f;]+)f;$")
