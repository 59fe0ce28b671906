# SPDX-License-Identifier: GPL-3.0-or-later
"""How far one sees, and how dense the haze is: no Blender in here."""

from math import inf, log

# A black object far away is told from the haze before it while it differs by this much (Koschmieder 1924).
CONTRAST = 0.02


def density(visual_range: float) -> float:
    """Extinction per length of a haze in which one sees that far."""
    return -log(CONTRAST) / visual_range


def visual_range(density: float) -> float:
    return -log(CONTRAST) / density if density > 0.0 else inf
