# SPDX-License-Identifier: GPL-3.0-or-later
"""What the cases expect, derived a second time."""

import mpmath
import numpy as np
import pytest
from scipy import integrate

from tests.check import direct, fog, formulas, geometry
from tests.render import closed_forms as exact

SIGMAS = 4.5
"""A right formula is further from one walk than this once in 150 000 seeds."""


@pytest.mark.parametrize("ratio", [0.3, 0.03])
def test_integrating_sphere(ratio: float) -> None:
    mean, error = formulas.integrating_sphere_walk(0.999, ratio, 20_000)
    assert error < 0.01
    assert abs(formulas.integrating_sphere(0.999, ratio) - mean) < SIGMAS * error


@pytest.mark.parametrize(("sine", "theta"), direct.SPHERES.values())
def test_sphere_over_a_plate(sine: float, theta: float) -> None:
    """Quadrature around the sphere's centre against uniform directions in its cone, clipped by the horizon."""
    walks = 400_000
    rng = np.random.default_rng(1)
    share = 1 - np.sqrt(1 - sine**2)  # of the cone, 2 pi times it its solid angle
    cosine = 1 - share * rng.random(walks)
    azimuth = 2 * np.pi * rng.random(walks)
    up = np.cos(theta) * cosine - np.sin(theta) * np.sqrt(1 - cosine**2) * np.cos(azimuth)
    values = 2 * np.pi * share * np.maximum(up, 0)
    error = values.std() / np.sqrt(walks)
    assert error < 0.02 * values.mean()
    assert abs(exact.sphere_irradiance(sine, theta) - values.mean()) < SIGMAS * error


@pytest.mark.parametrize("sine", [1e-2, 1e-4])
def test_share_of_a_light_that_is_seen(sine: float) -> None:
    """Of a grid of rays through the picture, those that meet the sphere; its edge crosses few of their cells."""
    n = 2001
    x = np.tan(2 * sine) * ((2 * np.arange(n) + 1) / n - 1)
    across = x[:, None] ** 2 + x[None] ** 2  # of the ray (x, 1, z): sin^2 to the axis is this over 1 + this
    share = float((across / (1 + across) < sine**2).mean())
    assert direct.share_seen(sine) == pytest.approx(share, rel=1e-3)


def test_horizon_of_a_planet() -> None:
    """Its expansion for a height far below the radius against the dip acos(R / (R + h)), row by row of the picture."""
    height, radius, half = geometry.EYE, geometry.PLANET, float(np.tan(geometry.HORIZON_VIEW / 2))
    with mpmath.workdps(30):
        dip = float(mpmath.tan(mpmath.acos(radius / (mpmath.mpf(radius) + height))))
    x = half * ((2 * np.arange(1001) + 1) / 1001 - 1)
    sky = (half + dip * np.sqrt(1 + x**2)) / (2 * half)  # the horizon's cone, cut by the picture's plane
    assert geometry.horizon() == pytest.approx(sky.mean(), rel=2e-5)


def test_ball_of_glass_in_a_lens() -> None:
    """The integral over the lens against points on it."""
    sigma = 2.0
    u = np.random.default_rng(1).random(400_000)  # squares of the distances from its middle
    values = np.exp(-sigma * (1 - np.sqrt(np.maximum(0.25 - u, 0))))
    error = values.std() / np.sqrt(len(u))
    assert abs(geometry.through_lens(sigma) - values.mean()) < SIGMAS * error < 2e-3


@pytest.mark.parametrize("degrees", [1, 45, 80, 89])
def test_fresnel_and_slab(degrees: float) -> None:
    cosine = float(np.cos(np.radians(degrees)))
    r = exact.fresnel(cosine, 1.5)
    assert r == pytest.approx(formulas.fresnel_exact(cosine, 1.5), rel=1e-10)
    assert formulas.slab_transmission(r) == pytest.approx(formulas.slab_transmission_series(r), rel=1e-12)


def test_nested_glass() -> None:
    """What is 1 over n^2 everywhere, whatever is around the innermost ball: by photons."""
    mean, error = formulas.radiance_in_nested_balls(1.5, 2.4, 20_000)
    assert error < 0.01 * mean
    assert abs(mean - 2.4**2) < SIGMAS * error


@pytest.mark.parametrize("alpha", [1e-4, 1e-3, 1e-2, 0.1, 0.5, 1])
@pytest.mark.parametrize("mu", [1, 0.5, 0.1, 0.01, 0.001])
def test_metal(alpha: float, mu: float) -> None:
    mean, error = formulas.ggx_albedo_walk(mu, alpha, 100_000)
    assert error < 2e-3
    assert abs(exact.ggx_albedo(mu, alpha) - mean) < SIGMAS * error + 2e-5


@pytest.mark.parametrize(("c", "mu"), [(0.5, 1.0), (0.9, 0.1), (0.99, 0.5)])
def test_half_space(c: float, mu: float) -> None:
    """Iteration of the integral equation against the closed form."""
    assert exact.half_space_albedo(c, mu) == pytest.approx(1 - np.sqrt(1 - c) * formulas.h_function(c, mu), rel=1e-9)


@pytest.mark.parametrize(("c", "r"), [(0.5, 1), (0.9, 0.1), (0.9, 3), (0.99, 1), (0.999, 1)])
def test_endless_fog(c: float, r: float) -> None:
    """The Fourier integral against singular eigenfunctions."""
    assert exact.infinite_fluence(c, r) == pytest.approx(formulas.infinite_fluence_modes(c, r), rel=1e-7)


def test_scattered_fluence() -> None:
    """In fog of three extinctions, the direct light taken off."""
    r = np.array(fog.THREE_DECADES)
    modes = [formulas.infinite_fluence_modes(0.9, float(x)) - np.exp(-x) / (4 * np.pi * x * x) for x in r]
    assert fog.scattered_fluence(0.9, fog.THREE_DECADES, 1) == pytest.approx(r * r * np.array(modes), rel=2e-5)


def test_endless_white_fog() -> None:
    """The limit: what is left is of the order of the root of 3 (1 - c)."""
    assert formulas.endless_fluence(1) == pytest.approx(formulas.infinite_fluence_modes(1 - 1e-10, 1), rel=4e-5)


def test_thin_fog_before_a_wall() -> None:
    """Two quadratures over the ball of light against the solid angle that it fills, in closed form, along the ray."""
    radius, center = fog.BIG

    def share(t: float) -> float:
        """Of all directions at t."""
        sine = radius / np.hypot(center[0], center[1] - t)
        return float(sine**2 / (1 + np.sqrt(1 - sine**2)) / 2)

    integral = integrate.quad(share, 0, fog.WALL, points=[2.0, 3.0, 4.0], epsrel=1e-11)[0]
    sigma = 1e-8
    airlight = exact.sphere_airlight(sigma, sigma, 0, radius, center, fog.ALONG, fog.WALL)
    assert airlight / sigma == pytest.approx(integral, rel=2e-7)  # the depth is 1e-7


@pytest.mark.parametrize(("c", "depth", "mu"), [(0.9, 1.0, 0.5), (1.0, 10.0, 1.0)])
def test_slab_of_fog(c: float, depth: float, mu: float) -> None:
    """The integral equation against random walks; without absorption nothing is lost."""
    quadrature = np.array([formulas.slab_albedo(c, depth, mu), formulas.slab_transmittance(c, depth, mu)])
    walked = formulas.slab_walk(c, depth, mu, 100_000)
    assert (walked[:, 1] < 2e-3).all()
    assert (np.abs(quadrature - walked[:, 0]) < SIGMAS * walked[:, 1]).all()
    if c == 1:
        assert quadrature.sum() == pytest.approx(1, rel=1e-8)


@pytest.mark.parametrize("sigma", [1e-8, 1e-4, 0.1, 3])
def test_isotropic_airlight(sigma: float) -> None:
    """Adaptive quadrature against the special function of Sun et al. (2005)."""
    assert formulas.point_airlight_exact(sigma, sigma, 0, 1, 3, np.inf) == pytest.approx(
        exact.sun_airlight(sigma, 1, 3), rel=1e-8
    )


@pytest.mark.parametrize("sigma", [0.1, 3])
@pytest.mark.parametrize("g", [-0.99, -0.7, 0.7, 0.99])
def test_airlight(g: float, sigma: float) -> None:
    """Adaptive quadrature in the plane of ray and light against Gauss and Legendre in space."""
    along = np.array([0, 1.0, 0])
    assert formulas.point_airlight_exact(sigma, sigma, g, 1, 3, np.inf) == pytest.approx(
        exact.point_airlight(sigma, sigma, g, (1, 3, 0), along, np.inf), rel=2e-5
    )


@pytest.mark.parametrize(
    ("sigma_t", "g", "radius", "center", "end"),
    [
        (0.1, 0.3, 0.3, (0.5, 1.5, 0), np.inf),
        (1.02, 0.3, 0.3, (0.5, 1.5, 0), np.inf),
        (3.2, 0.3, 0.3, (0.5, 1.5, 0), np.inf),
        (3.0, 0.0, 0.1, (0.5, 1.5, 0), np.inf),
        (0.12, 0.0, 0.5, (0, 3.5, -2), 2.0),
    ],
)
def test_airlight_of_a_sphere(
    sigma_t: float, g: float, radius: float, center: tuple[float, float, float], end: float
) -> None:
    """Quadrature against random points of the ray and random directions to the light, of radiance 1, at albedo 1."""
    walks = 400_000
    rng = np.random.default_rng(1)
    range_ = 1 - np.exp(-sigma_t * end)
    t = -np.log1p(-rng.random(walks) * range_) / sigma_t
    to_center = np.asarray(center) - t[:, None] * fog.ALONG
    distance = np.linalg.norm(to_center, axis=1)
    assert (distance > radius).all()
    axis = to_center / distance[:, None]
    share = 1 - np.sqrt(1 - (radius / distance) ** 2)
    cosine = 1 - share * rng.random(walks)
    sine = np.sqrt(1 - cosine**2)
    side = np.cross(axis, [0.0, 0.0, 1.0])
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    azimuth = 2 * np.pi * rng.random(walks)[:, None]
    direction = cosine[:, None] * axis + sine[:, None] * (
        np.cos(azimuth) * side + np.sin(azimuth) * np.cross(axis, side)
    )
    near = distance * cosine - np.sqrt(np.maximum(radius**2 - (distance * sine) ** 2, 0))
    phase = exact.henyey_greenstein(g, direction @ fog.ALONG)
    values = range_ * 2 * np.pi * share * phase * np.exp(-sigma_t * near)
    error = values.std() / np.sqrt(walks)
    assert error < 0.01 * values.mean()
    expected = exact.sphere_airlight(sigma_t, sigma_t, g, radius, center, fog.ALONG, end)
    assert abs(expected - values.mean()) < SIGMAS * error
