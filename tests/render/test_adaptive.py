# SPDX-License-Identifier: GPL-3.0-or-later
"""Adaptive sampling is unbiased, and so is what a render says of its error, where naive rules fail worst: pixels that
see a small bright plate with one sample in a dozen, alone in the dark."""

import numpy as np
import pytest

from addon.scene import description as d
from tests.engine.library import Render, Scene
from tests.render.build import BLACK, Builder, camera, grey, quad
from tests.render.statistics import Array, check_mean

PIXELS, SPACING, SAMPLES = 48, 12, 40
SHARE = 1 / 12
RADIANCE = 5.0


def hot_pixels() -> Array:
    """(n, 2): row and column."""
    first = SPACING // 2
    places = np.arange(first, PIXELS, SPACING)
    return np.array([(row, column) for row in places for column in places])


def plates() -> Scene:
    """Shining plates that face the camera and each cover SHARE of one pixel, farther from each other than a plan
    looks around."""
    pixel = 2 * np.tan(np.radians(20)) / PIXELS  # at distance 1
    scene = Builder(camera((0, 0, 0), (0, 1, 0), 40), PIXELS, PIXELS, environment=d.Environment(BLACK))
    half = np.sqrt(SHARE) / 2 * pixel
    for row, column in hot_pixels():
        center = ((column + 0.5 - PIXELS / 2) * pixel, 1, (PIXELS / 2 - row - 0.5) * pixel)
        scene.mesh(quad(center, (half, 0, 0), (0, 0, half)), d.Light(grey(RADIANCE)))
    return Scene(scene.done())


@pytest.fixture(scope="module")
def world() -> Scene:
    return plates()


def hot(picture: Array) -> Array:
    rows, columns = hot_pixels().T
    return picture[rows, columns, 0].astype(np.float64)


def test_mean(world: Scene) -> None:
    """Of the picture, and of the light passes, which are kept in one sum."""

    def means(seed: int) -> Array:
        with Render(
            world, seed=seed, samples=SAMPLES, adaptive=1, threads=1, passes=("emission", "sample_count")
        ) as render:
            counts = hot(render.run().read("sample_count"))
            assert counts.max() > 1.3 * counts.min(), "a plan that changes nothing tests nothing"
            return np.array([hot(render.read(name)).mean() for name in ("combined", "emission")])

    check_mean(means, [SHARE * RADIANCE] * 2, within=0.05, what="bright plates")


@pytest.mark.full
def test_standard_error(world: Scene) -> None:
    """In the mean its square is the squared error."""
    variance = SHARE * (1 - SHARE) * RADIANCE**2 / SAMPLES

    def one_plus_difference(seed: int) -> float:
        with Render(world, seed=seed, samples=SAMPLES, adaptive=1, threads=1, passes=("stderr",)) as render:
            picture, stderr = (hot(render.run().read()), hot(render.read("stderr")))
        return float(1 + (stderr**2 - (picture - SHARE * RADIANCE) ** 2).mean() / variance)

    check_mean(one_plus_difference, 1, within=0.15, what="claimed variance less squared error")
