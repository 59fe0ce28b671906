# SPDX-License-Identifier: GPL-3.0-or-later
"""Who is told that fog without end hides the sky, or everything: only who has put no light inside, or none near."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from addon.export.dense import nearest_distance, warn_of_dense_haze
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


def at(x: float) -> d.Floats:
    matrix = np.eye(4)
    matrix[0, 3] = x
    return matrix


def far_scene(extinction: float = 1.0, **things: Any) -> d.SceneDescription:
    """A small tetrahedron at 20 m and at 30 m, seen from the origin."""
    corners = np.array([[0, 0, 0], [0.1, 0, 0], [0, 0.1, 0], [0, 0, 0.1]], np.float32)
    mesh = d.Mesh("Tetrahedron", corners, np.array([[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]], np.uint32))
    return d.SceneDescription(
        film=d.Film(8, 8),
        camera=d.Camera(np.eye(4), d.Perspective(60.0)),
        materials=(d.NamedMaterial("Grey", d.Lambert((0.5, 0.5, 0.5))),),
        objects=(d.Object("Tetrahedron", mesh, (0,), instances=np.array([at(20.0), at(30.0)])),),
        medium=d.Medium(d.BLACK, (extinction,) * 3),
        **things,
    )


NEAR_LAMP = d.PointLight("Near", (1.0, 0.0, 0.0), (1.0, 1.0, 1.0), 0.0)
NEAR_MOON = d.Spheres("Near", np.array([[4.0, 0.0, 0.0]]), np.array([1.0]), 0)


@pytest.mark.parametrize(
    ("scene", "is_told"),
    [
        (far_scene(), True),  # one sees 3.9 m
        (far_scene(extinction=0.1), False),
        (far_scene(extinction=0.0), False),
        (far_scene(lights=(NEAR_LAMP,)), False),
        (far_scene(spheres=(NEAR_MOON,)), False),
    ],
)
def test_a_haze_that_hides_everything_is_told(scene: d.SceneDescription, is_told: bool) -> None:
    notices = Notices()
    warn_of_dense_haze(scene, "World", notices)
    assert [notice.where for notice in notices.items] == (["world 'World'"] if is_told else [])


def test_the_nearest_thing_is_no_nearer_than_is_said() -> None:
    distance = nearest_distance(far_scene())
    assert distance is not None and 19.7 < distance <= 20.0
    assert nearest_distance(far_scene(spheres=(NEAR_MOON,))) == pytest.approx(3.0)
