# SPDX-License-Identifier: GPL-3.0-or-later
"""What people's files hold, where no Blender is needed to see it: doubled faces, sheen of dark hues."""

from typing import Any

import numpy as np
import pytest

from addon.export import principled
from addon.export.mesh import doubled_faces
from addon.scene.description import Mesh, Sheen

SQUARE = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], np.float32)


def test_faces_that_lie_on_others_are_counted_whatever_their_vertices_are_called() -> None:
    triangles = np.array([(0, 1, 2), (0, 2, 3)], np.uint32)
    assert doubled_faces(Mesh("Square", SQUARE, triangles)) == 0
    twice = np.concatenate([SQUARE, SQUARE[::-1]])
    assert doubled_faces(Mesh("Twice", twice, np.array([(0, 1, 2), (0, 2, 3), (5, 6, 7)], np.uint32))) == 1


class Inputs:
    def __init__(self) -> None:
        self.notices: list[str] = []

    def notice(self, what: str) -> None:
        self.notices.append(what)


@pytest.mark.parametrize(("color", "count"), [((0.5, 0.2, 0.1), 1), ((1.74, 0.3, 1.74), 2), ((4.0, 0.0, 1.0), 4)])
def test_sheen_beyond_white_is_shared_by_several_lobes(color: tuple[float, float, float], count: int) -> None:
    inputs: Any = Inputs()
    lobes = principled._velvets(inputs, color)
    assert len(lobes) == count and inputs.notices == []
    colors = [lobe.color for lobe in lobes if isinstance(lobe, Sheen)]
    assert np.max(colors) <= 1.0
    np.testing.assert_allclose(np.sum(colors, axis=0), color)


def test_sheen_that_is_too_bright_is_cut_and_told() -> None:
    inputs: Any = Inputs()
    assert len(principled._velvets(inputs, (9.0, 0.0, 0.0))) == principled.MOST_SHEENS
    assert "cut to 4" in inputs.notices[0]
