# SPDX-License-Identifier: GPL-3.0-or-later
"""The references themselves, against published tables, each other and values computed elsewhere at high precision."""

import numpy as np
import pytest

from tests.render import closed_forms as exact

ALONG = np.array([0.0, 1.0, 0.0])


@pytest.mark.parametrize(
    ("alpha", "mu", "listed"),
    [
        (0.01, 0.1, 0.9941),
        (0.1, 0.1, 0.8835),
        (0.5, 0.5, 0.6983),
        (0.5, 0.05, 0.9125),
        (1, 1, 0.3069),
        (1, 0.01, 0.9538),
    ],
)
def test_directional_albedo(alpha: float, mu: float, listed: float) -> None:
    """To the last listed digit; and the quadrature has converged far beyond."""
    assert abs(exact.ggx_albedo(mu, alpha) - listed) <= 0.6e-4
    assert abs(exact.ggx_albedo(mu, alpha) - exact.ggx_albedo(mu, alpha, 320)) < 2e-5


@pytest.mark.parametrize(
    ("sine", "theta", "listed"), [(0.5, 1.3, 0.226580766), (0.5, 1.8, 0.0237033624), (0.9, 1.0, 1.53837691)]
)
def test_clipped_sphere(sine: float, theta: float, listed: float) -> None:
    assert exact.sphere_irradiance(sine, theta) == pytest.approx(listed, rel=5e-9)


def test_sphere_above_the_horizon() -> None:
    assert exact.sphere_irradiance(0.3, 0.7) == pytest.approx(np.pi * 0.09 * np.cos(0.7), rel=1e-10)


def test_polygon_and_quadrature_agree() -> None:
    center, u, v = np.array([1.0, -0.5, 3.0]), np.array([0.5, 0.0, 0.3]), np.array([0.0, 0.7, -0.2])
    corners = [center - u - v, center + u - v, center + u + v, center - u + v]
    assert exact.polygon_irradiance(corners) == pytest.approx(
        exact.surface_irradiance(center, u, v, ellipse=False), rel=1e-10
    )


def test_disk_overhead() -> None:
    """pi R^2 / (R^2 + h^2)."""
    value = exact.surface_irradiance((0, 0, 3), (2, 0, 0), (0, 2, 0), ellipse=True)
    assert value == pytest.approx(np.pi * 4 / 13, rel=1e-10)


def test_source_of_a_sphere_light() -> None:
    """The closed form, the quadrature over its cone, and a value computed elsewhere."""
    assert exact.sphere_source(0.5, 1, 2) == pytest.approx(0.036715536837, rel=1e-11)
    cone = exact.sphere_scattering(0.5, 0, 1, np.array([2.0, 0, 0]), ALONG)
    assert cone == pytest.approx(exact.sphere_source(0.5, 1, 2), rel=1e-10)


def test_airlight_of_a_point() -> None:
    assert exact.point_airlight(0.1, 0.1, 0, (1, 3, 0), ALONG, np.inf) == pytest.approx(
        exact.sun_airlight(0.1, 1, 3), rel=1e-7
    )


def test_airlight_of_a_small_sphere() -> None:
    """A sphere of radius R and radiance 1/(pi R^2) far away is a point of intensity 1."""
    r = 1e-3
    sphere = exact.sphere_airlight(0.1, 0.08, 0.6, r, (1, 3, 0), ALONG, 10) / (np.pi * r * r)
    assert sphere == pytest.approx(exact.point_airlight(0.1, 0.08, 0.6, (1, 3, 0), ALONG, 10), rel=1e-3)


@pytest.mark.parametrize(
    ("c", "values"),
    [(0.5, (0.1152258777, 0.1601444334, 0.2417207764)), (0.9, (0.4149474791, 0.5079389069, 0.6293358207))],
)
def test_half_space(c: float, values: tuple[float, float, float]) -> None:
    for mu, value in zip((1, 0.5, 0.1), values, strict=True):
        assert exact.half_space_albedo(c, mu) == pytest.approx(value, abs=1e-9)


@pytest.mark.parametrize(("r", "value"), [(0.1, 8.91897694), (1, 0.143283862), (5, 0.00291512507)])
def test_infinite_medium(r: float, value: float) -> None:
    assert exact.infinite_fluence(0.9, r) == pytest.approx(value, rel=2e-8)


def test_environment_directions() -> None:
    """Texel centres: up is the top row, +y the middle, +x to the right of it."""
    image = np.random.default_rng(1).random((4, 8, 3))
    for row in range(4):
        for column in range(8):
            v, u = np.pi * (row + 0.5) / 4, 2 * np.pi * ((column + 0.5) / 8 - 0.5)
            direction = np.array([[np.sin(v) * np.sin(u), np.sin(v) * np.cos(u), np.cos(v)]])
            assert exact.environment(image, direction)[0] == pytest.approx(image[row, column], rel=1e-9)
    flat = np.full((4, 8, 3), 0.7)
    assert exact.environment_irradiance(flat, np.eye(4)) == pytest.approx(np.full(3, 0.7 * np.pi), rel=1e-9)
