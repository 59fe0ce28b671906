# SPDX-License-Identifier: GPL-3.0-or-later
"""Who is told that bodies of glass differ from Cycles: only who has some, in haze or where they may meet others."""

from dataclasses import replace

import numpy as np
import pytest

from addon.export.bodies import warn_of_bodies_of_glass
from addon.scene import description as d
from addon.scene.problems import Notices
from tests.render.build import Builder, box, camera, faces_apart, floor, grey, octahedron

GLASS = d.Mix(0.5, d.Glass(1.5), d.Lambert(grey(0.5)))
VIEW = camera((0, -5, 0), (0, 0, 0), 40)


def told(scene: Builder) -> list[str]:
    notices = Notices()
    warn_of_bodies_of_glass(scene.done(), "World", notices)
    return [notice.where for notice in notices.items]


def test_what_is_closed() -> None:
    whole = box((0, 0, 0), (1, 1, 1))
    assert whole.is_closed
    assert faces_apart(whole).is_closed
    assert octahedron((100, 0, 0), 1, 2).is_closed
    assert not replace(whole, triangles=whole.triangles[1:]).is_closed
    assert not replace(whole, triangles=whole.triangles[:, ::-1]).is_closed
    assert not floor().is_closed


@pytest.mark.parametrize(("inner", "is_told"), [(GLASS, True), (d.Lambert(grey(0.5)), False)])
def test_bodies_in_each_other(inner: d.Material, is_told: bool) -> None:
    scene = Builder(VIEW).mesh(box((0, 0, 0), (1, 1, 1)), GLASS).sphere((0.9, 0.5, 0.5), 0.2, inner)
    assert told(scene) == (["object 'spheres'"] if is_told else [])


def test_bodies_side_by_side() -> None:
    rows = np.tile(np.eye(4), (3, 1, 1))
    rows[:, 0, 3] = (0, 1.5, 3)
    assert told(Builder(VIEW).mesh(box((0, 0, 0), (1, 1, 1)), GLASS, instances=rows)) == []
    rows[2, 0, 3] = 2.4
    assert told(Builder(VIEW).mesh(box((0, 0, 0), (1, 1, 1)), GLASS, instances=rows)) == ["object 'box'"]


def test_sheets_are_as_in_cycles() -> None:
    scene = Builder(VIEW, medium=d.Medium(grey(0.1), grey(0.1)))
    scene.mesh(floor(), GLASS).mesh(octahedron((0, 0, 0), 1), d.Lambert(grey(0.5)))
    assert told(scene) == []
    assert told(scene.mesh(octahedron((0, 0, 0), 0.5), d.Glass(1.5))) == ["world 'World'"]
