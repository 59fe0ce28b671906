# SPDX-License-Identifier: GPL-3.0-or-later
"""The order in which Blender's nodes number the members of a collection."""

import re


def natural_key(name: str) -> list[tuple[int, int, str]]:
    """Sorts as people count, without regard to case: "Plate 2" before "plate 10"."""
    parts = re.findall(r"\d+|\D+", name)
    return [(0, int(part), "") if part.isdigit() else (1, 0, part.lower()) for part in parts]
