# SPDX-License-Identifier: GPL-3.0-or-later
"""Who is told that fog without end hides the sky: only who has put no light inside."""

from types import SimpleNamespace
from typing import Any

import pytest

from addon.export.world import warn_of_black_sky
from addon.scene import description as d
from addon.scene.problems import Notices

FOG = d.Medium((0.1, 0.1, 0.1), (0.1, 0.1, 0.1))
SUN = d.SunLight("Sun", (0.0, 0.0, -1.0), (1.0, 1.0, 1.0), 0.5)
LAMP = d.PointLight("Lamp", (0.0, 0.0, 1.0), (1.0, 1.0, 1.0), 0.0)


@pytest.mark.parametrize(
    ("lights", "medium", "shines", "is_told"),
    [
        ((), FOG, False, True),
        ((SUN,), FOG, False, True),
        ((SUN, LAMP), FOG, False, False),
        ((), FOG, True, False),
        ((SUN,), None, False, False),
    ],
)
def test_only_a_dark_fog_is_warned_of(lights: Any, medium: Any, shines: bool, is_told: bool) -> None:
    notices = Notices()
    world: Any = SimpleNamespace(name="World")
    warn_of_black_sky(world, d.Environment(radiance=(0.05, 0.05, 0.05)), lights, medium, notices, shines)
    assert bool(notices.items) == is_told
