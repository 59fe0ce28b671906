# SPDX-License-Identifier: GPL-3.0-or-later
"""Lamps whose light a program multiplies: by where it goes, by where it comes from, by how far that is."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from addon.scene import description as d
from addon.scene.program import Op, compile_program
from tests.render.build import WHITE, Builder, camera, floor
from tests.render.statistics import Measurement, Pictures, check_same

IDENTITY = np.eye(4)
TURNED = np.array([[0.0, 0.0, 2.0, 0.0], [1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]])


def geometry(what: str) -> Op:
    return Op("geometry", (1.0,), (what, "center"), None)


RAY_LENGTH = Op("geometry_number", (), ("ray_length",), None)


def profile(factor: Op, to_world: Any = IDENTITY) -> d.LampProfile:
    return d.LampProfile(compile_program([factor]), to_world)


def with_profile(lamp: Any, given: d.LampProfile) -> Any:
    return replace(lamp, flags=replace(lamp.flags, profile=given))


def picture(lamp: Any) -> Any:
    """Of a floor in its light, seen from above; a pixel is .1 wide."""
    view = d.Camera(np.array([[1.0, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 9], [0, 0, 0, 1]]), d.Orthographic(1.6))
    scene = Builder(view).mesh(floor(half=3), d.Lambert(WHITE)).lamp(lamp)
    return Pictures(Measurement(scene.done(), "path", samples=64))(1)


X, Y = np.meshgrid(np.arange(-0.75, 0.8, 0.1), -np.arange(-0.75, 0.8, 0.1))
POINT = d.PointLight("point", (0.2, -0.1, 0.5), WHITE)
TO_FLOOR = np.stack([X - 0.2, Y + 0.1, np.full_like(X, -0.5)], axis=-1)
DISTANCE = np.linalg.norm(TO_FLOOR, axis=-1)


@pytest.mark.parametrize(
    ("factor", "to_world", "expected"),
    [
        (geometry("incoming"), IDENTITY, TO_FLOOR / DISTANCE[..., None]),
        (geometry("normal"), IDENTITY, TO_FLOOR / DISTANCE[..., None]),
        (geometry("position"), IDENTITY, np.broadcast_to((0.2, -0.1, 0.5), TO_FLOOR.shape)),
        # Normals go by the transposed inverse of the matrix from the object to the world.
        (
            geometry("object_normal"),
            TURNED,
            (n := TO_FLOOR @ TURNED[:3, :3]) / np.linalg.norm(n, axis=-1, keepdims=True),
        ),
        (Op("combine", (RAY_LENGTH, 1.0, 0.0), (), None), IDENTITY, np.stack([DISTANCE, X * 0 + 1, X * 0], axis=-1)),
    ],
)
def test_what_a_program_knows(factor: Op, to_world: Any, expected: Any) -> None:
    """Without noise but for the width of a pixel. What is negative is dark."""
    plain = picture(POINT)
    found = picture(with_profile(POINT, profile(factor, to_world))) / plain
    clear = np.abs(expected) > 0.1  # elsewhere a pixel is partly dark
    assert np.abs(found - np.maximum(expected, 0))[clear].max() < 0.02 * np.abs(expected).max()


LAMPS = {
    "point": d.PointLight("point", (0, 0, 1.2), (2, 2, 2)),
    "sphere": d.PointLight("sphere", (0, 0, 1.2), (2, 2, 2), 0.3),
    "disk": d.PointLight("disk", (0, 0, 1.2), (2, 2, 2), 0.3, is_disk=True),
    "spot": d.SpotLight("spot", (0, 0, 1.2), (0, 0.6, -0.8), (4, 4, 4), 120, 0.5, 0.2),
    "area": d.AreaLight("area", np.array([[1.0, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 1.2], [0, 0, 0, 1]]), (1, 2), WHITE),
    "sun": d.SunLight("sun", (0.3, 0.2, -1), (2, 2, 2), 5),
}


# Relatives of lamps that stay, and take long.
LONG = ("point", "sphere", "disk", "spot")


@pytest.mark.parametrize("name", [pytest.param(name, marks=[pytest.mark.full] * (name in LONG)) for name in LAMPS])
def test_light_paths_and_camera_paths_see_the_same(name: str) -> None:
    """In a cloud, where light that is traced from the lamp brings what scattered more than once."""
    sun = name == "sun"
    turn = Op("vector_math", (geometry("incoming"), (1.0, 0.5, 0.0), (0.4, 0.4, 0.8), 1.0), ("multiply_add",), None)
    lamp = with_profile(LAMPS[name], profile(turn))
    cloud = d.Medium((0.02, 0.02, 0.02), (0.3, 0.3, 0.3))
    scene = Builder(camera((0, -5, 2), (0, 0, 0.7), 40), 8, 8, medium=None if sun else cloud)
    scene.mesh(floor(half=3), d.Lambert((0.5, 0.5, 0.5))).lamp(lamp)
    if sun:
        scene.sphere((0, 0, 1), 1, d.Null(), interior=cloud)
    made = scene.done()
    shared, alone = (Pictures(Measurement(made, i, samples=8)) for i in ("path", "path-no-light-vertices"))
    check_same(
        lambda seed: shared(seed).mean(axis=(0, 1)), lambda seed: alone(seed).mean(axis=(0, 1)), within=0.05, what=name
    )
