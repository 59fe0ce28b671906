# SPDX-License-Identifier: GPL-3.0-or-later
"""What moves while the shutter is open, against closed forms: how long each place is covered, and how it is turned."""

from dataclasses import replace
from math import cos, sin

import numpy as np
import pytest

from addon.scene import description as d
from tests.engine.library import Render, Scene
from tests.render.build import Array, Builder, camera, floor, grey, look_at, sky
from tests.render.statistics import Measurement, Pictures, blocks, check_mean, check_same, strata
from tests.render.test_integrators_agree import light_by_way_of_metal

SIDE = 16  # pixels, and the length that they show


def from_above() -> d.Camera:
    """x to the right."""
    return d.Camera(look_at((0, 0, 10), (0, 0, 0), (0, 1, 0)), d.Orthographic(SIDE))


def moved(*x: float) -> Array:
    steps = np.tile(np.eye(4), (len(x), 1, 1))
    steps[:, 0, 3] = x
    return steps


def covered_until(x: Array, places: tuple[float, ...]) -> Array:
    """The part of the time for which an edge that goes through these places, to the right, is left of x."""
    return np.interp(x, places, np.linspace(0, 1, len(places)))


@pytest.mark.parametrize(("integrator", "places"), [("path", (-6.0, 2.0, 4.0)), ("baseline", (-4.0, 4.0))])
def test_an_edge_that_moves(integrator: str, places: tuple[float, ...]) -> None:
    """Across pixels without a filter: what is seen of the sky behind it grows evenly between the places."""
    scene = Builder(from_above(), SIDE, SIDE, environment=sky(1))
    edge = floor(0, 30, (-33, 0))  # its right side at 0: the plate's middle is .1 half widths to the right
    scene.mesh(edge, d.Lambert(grey(0)), motion=moved(*places))
    columns = np.arange(SIDE) + 0.5 - SIDE / 2
    pictures = Pictures(Measurement(scene.done(), integrator, samples=64))
    check_mean(
        lambda seed: pictures(seed).mean(axis=(0, 2)), covered_until(columns, places), within=0.1, what=integrator
    )


def test_a_camera_that_moves() -> None:
    """Past an edge that keeps still, and never at an even pace."""
    places = (-6.0, 2.0, 4.0)
    camera = from_above()
    motion = np.stack([step @ camera.to_world for step in moved(*(-x for x in places))])
    scene = Builder(replace(camera, motion=motion), SIDE, SIDE, environment=sky(1))
    scene.mesh(floor(0, 30, (-33, 0)), d.Lambert(grey(0)))
    columns = np.arange(SIDE) + 0.5 - SIDE / 2
    pictures = Pictures(Measurement(scene.done(), "path", samples=64))
    check_mean(lambda seed: pictures(seed).mean(axis=(0, 2)), covered_until(columns, places), within=0.1, what="camera")


@pytest.mark.full
@pytest.mark.timeout(900)
def test_splats_on_a_camera_that_moves() -> None:
    """Half of the light was thrown into the fog by smooth metal: the mean is that of cameras that keep still, each at a
    moment of its own."""
    view = camera((3, -3, 2.2), (3, 4, 2.2), 30)
    places = np.array([[-1, 0, -0.6], [0, 0.5, 0], [0.6, -0.3, 1.4]])
    film = d.Film(16, 12)

    def at(offsets: Array) -> Array:
        steps = np.tile(view.to_world, (len(offsets), 1, 1))
        steps[:, :3, 3] += offsets
        return steps

    def still(seed: int) -> Array:
        pictures: list[Array] = []
        for t in strata(np.random.default_rng(seed), 8):
            offset = np.array([np.interp(t, [0, 0.5, 1], places[:, axis]) for axis in range(3)])
            scene = light_by_way_of_metal().seen_by(replace(view, to_world=at(offset[None])[0]), film).done()
            pictures.append(Pictures(Measurement(scene, "path", samples=4))(8 * seed + len(pictures)))
        return blocks(np.mean(pictures, axis=0), 4)

    moving = light_by_way_of_metal().seen_by(replace(view, motion=at(places)), film).done()
    pictures = Pictures(Measurement(moving, "path", samples=32))
    check_same(lambda seed: blocks(pictures(seed), 4), still, within=0.08, what="a camera that moves")


def test_depths_are_of_the_moment() -> None:
    """A camera that comes down to a floor and turns about its axis the while: the mean depth is that of the middle."""
    steps = np.stack([look_at((0, 0, z), (0, 0, 0), (sin(a), cos(a), 0)) for z, a in ((10, 0.0), (8, 0.4), (6, 0.9))])
    camera = d.Camera(steps[0], d.Perspective(20), motion=steps)
    scene = Builder(camera, 4, 4, environment=sky(1)).mesh(floor(0, 40), d.Lambert(grey(0.5)))
    with Render(Scene(scene.done()), integrator="path", samples=1024, seed=0, passes=("depth",)) as render:
        np.testing.assert_allclose(render.run().read("depth"), 8, atol=2e-2)


def test_normals_turn_with_it() -> None:
    """A plate that leans over: its matrix is interpolated, and its normal is that of the matrix at each moment."""
    angle = 0.9
    steps = np.tile(np.eye(4), (2, 1, 1))
    steps[1, 1:3, 1:3] = [[cos(angle), -sin(angle)], [sin(angle), cos(angle)]]
    scene = Builder(from_above(), 4, 4, environment=sky(1)).mesh(floor(0, 40), d.Lambert(grey(0.5)), motion=steps)
    t = (np.arange(4000) + 0.5) / 4000
    linear = (1 - t)[:, None, None] * steps[0, :3, :3] + t[:, None, None] * steps[1, :3, :3]
    normals = np.linalg.inv(linear).transpose(0, 2, 1)[:, :, 2]
    expected = (normals / np.linalg.norm(normals, axis=1)[:, None]).mean(axis=0)
    with Render(Scene(scene.done()), integrator="path", samples=1024, seed=0, passes=("normal",)) as render:
        seen = render.run().read("normal").astype(np.float64).mean(axis=(0, 1))
    np.testing.assert_allclose(seen, expected, atol=2e-3)


def test_a_half_turn_needs_more_steps() -> None:
    """Interpolated matrices fold up in its middle: it is held still, and says so."""
    steps = np.tile(np.eye(4), (2, 1, 1))
    steps[1, :2, :2] *= -1
    scene = Builder(from_above(), 4, 4, environment=sky(1)).mesh(floor(0, 40), d.Lambert(grey(0.5)), motion=steps)
    assert Scene(scene.done()).warnings() == ["folding_motion"]


def test_what_shines_is_held_still() -> None:
    """Where it is in the middle of its motion, and it says so."""
    scene = Builder(from_above(), SIDE, SIDE).mesh(floor(0, 2, (-0.2, 0)), d.Light(grey(1)), motion=moved(-6, 4, 6))
    done = Scene(scene.done())
    assert done.warnings() == ["shining_motion"]
    with Render(done, integrator="path", samples=4, seed=0) as render:
        seen = render.run().read("combined")[SIDE // 2, :, 0]
    assert list(np.flatnonzero(seen > 0.5)) == list(range(SIDE // 2 + 2, SIDE // 2 + 6))
