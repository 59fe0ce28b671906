# SPDX-License-Identifier: GPL-3.0-or-later
"""The Henyey-Greenstein phase function, from isotropic to a needle."""

import mpmath
import numpy as np
import pytest

from tests.engine.probe import phase, sampling
from tests.engine.probe.call import Array
from tests.engine.significance import ROUNDING, Family, double, histogram, relative_error, single

family = Family(size=25)
N = 200_000
ANISOTROPIES = (0, 1e-8, -1e-6, 1e-4, 1e-2, 0.3, -0.5, 0.9, -0.99, 0.99, 0.999, -0.9999)
BEFORE = np.array([0.48, -0.6, 0.64])


def exact_phase(g: float, cosine: mpmath.mpf) -> mpmath.mpf:
    return (1 - g * g) / (4 * mpmath.pi * (1 + g * g - 2 * g * cosine) ** mpmath.mpf(1.5))


def uniform_coordinate(g: float, before: Array, after: Array) -> Array:
    """The cumulative distribution of the cosine, from the tail |before - after|^2 / 2 = 1 - cos, in float64."""
    if g == 0:
        return (1 + after @ before) / 2
    h = abs(g)
    tail = ((np.sign(g) * before - after) ** 2).sum(1) / 2
    d = np.sqrt((1 - h) ** 2 + 2 * h * tail)
    # P(1 - cos < tail); from (1 - h^2)/(2 h) (1/(1 - h) - 1/d), without the cancellation.
    share = (1 + h) * tail / (d * (d + 1 - h))
    return share if g < 0 else 1 - share


@pytest.mark.parametrize("g", ANISOTROPIES)
def test_directions_follow_the_phase_function(g: float) -> None:
    """The exact cumulative distribution of the sampled cosines is uniform, and so is the azimuth."""
    before = double(single(BEFORE))
    after, pdf = phase.sample(g, BEFORE, sampling.uniform(3, N))
    exact_g = float(single(g))
    w = double(after)
    assert np.abs((w**2).sum(1) - 1).max() <= 8 * ROUNDING
    x, y = np.cross(before, [0, 0, 1]), np.cross(before, np.cross(before, [0, 0, 1]))
    azimuth = (np.arctan2(w @ y / np.linalg.norm(y), w @ x / np.linalg.norm(x)) / (2 * np.pi)) % 1
    cells = histogram(uniform_coordinate(exact_g, before, w), azimuth, 16, 16)
    family.chi_squared(cells, np.full((16, 16), N / 256), f"g = {g}")
    if abs(g) > 1e-4:
        family.mean(w @ before, exact_g, f"mean cosine of g = {g}", 8 * ROUNDING)
    # The twin sees the direction rounded to float32, which is 1e-7 of a peak 1 - |g| wide.
    twin = phase.of_directions(g, BEFORE, after)
    assert relative_error(pdf, twin).max() <= 32 * ROUNDING / (1 - abs(g))


@pytest.mark.parametrize("g", ANISOTROPIES)
def test_values(g: float) -> None:
    """By cosine and by directions, against mpmath; and the integral over the sphere is 1."""
    mpmath.mp.dps = 40
    exact_g = mpmath.mpf(float(single(g)))
    cosines = single([-1, -0.999, -0.5, 0, 0.3, 0.9, 0.999, 1])
    for c, got in zip(cosines, phase.of_cosine(g, cosines), strict=True):
        exact = exact_phase(exact_g, mpmath.mpf(float(c)))
        assert abs((float(got) - exact) / exact) <= 12 * ROUNDING
    angles = np.array([0, 1e-4, 1e-2, 0.5, 2, 3, 3.14])
    after = single(np.stack([np.sin(angles), 0 * angles, np.cos(angles)], axis=1))
    for w, got in zip(after, phase.of_directions(g, [0, 0, 1], after), strict=True):
        x, z = mpmath.mpf(float(w[0])), mpmath.mpf(float(w[2]))
        # 1 -+ cos of the rounded vectors as they are, without supposing unit length.
        tail = (x * x + (z - (1 if g >= 0 else -1)) ** 2) / 2
        exact = exact_phase(abs(exact_g), 1 - tail)
        assert abs((float(got) - exact) / exact) <= 16 * ROUNDING
    # In the variable in which the peak is wide: its logarithm, 1 - cos = narrow / (2 h) (ratio^t - 1).
    nodes, weights = np.polynomial.legendre.leggauss(64)
    t, h = (nodes + 1) / 2, max(abs(float(exact_g)), 1e-3)
    narrow = (1 - h) ** 2 / (2 * h)
    ratio = 1 + 2 / narrow
    tail, slope = np.minimum(2, narrow * (ratio**t - 1)), narrow * ratio**t * np.log(ratio)
    w = single(np.stack([np.sqrt(tail * (2 - tail)), 0 * t, (1 - tail) * (1 if g >= 0 else -1)], axis=1))
    values = double(phase.of_directions(g, [0, 0, 1], w))
    assert 2 * np.pi * (weights / 2 * values * slope).sum() == pytest.approx(1, abs=1e-5)


def test_convention() -> None:
    """g > 0 goes on forward: the cosine is between the directions of propagation."""
    after, _ = phase.sample(0.8, [0, 0, 1], sampling.uniform(1, N))
    family.mean(after[:, 2], float(single(0.8)), "forward", 8 * ROUNDING)
    assert phase.of_cosine(0.8, [1])[0] > phase.of_cosine(0.8, [-1])[0]


@pytest.mark.parametrize("axis", [(0, 0, 1), (0, 0, -1), (1, 0, 0), (0, -1, 0)])
def test_every_frame(axis: tuple[int, int, int]) -> None:
    after, _ = phase.sample(0.5, axis, sampling.uniform(2, N))
    family.mean(double(after) @ axis, 0.5, f"about {axis}")
