# SPDX-License-Identifier: GPL-3.0-or-later
"""Directions towards lights: uniform where they should be, exact for small, near, far and grazing shapes."""

import mpmath
import numpy as np
import pytest

from tests.engine.probe import sampling, shapes
from tests.engine.probe.call import Array
from tests.engine.significance import ROUNDING, Family, bin_integrals, double, histogram, relative_error

family = Family(size=37)
N = 100_000


def frame(axis: Array) -> tuple[Array, Array]:
    x = np.cross(axis, [0, 0, 1] if abs(axis[2]) < 0.9 else [1, 0, 0])
    x /= np.linalg.norm(x)
    return x, np.cross(axis, x)


def cone_coordinates(axis: Array, w: Array) -> tuple[Array, Array]:
    """1 - cos from a unit axis and the azimuth as a fraction, in float64 and without cancellation."""
    x, y = frame(axis)
    return ((w - axis) ** 2).sum(1) / 2, (np.arctan2(w @ y, w @ x) / (2 * np.pi)) % 1


def exact_one_minus_cos(s: float) -> float:
    mpmath.mp.dps = 50
    return float(1 - mpmath.sqrt(1 - mpmath.mpf(s) ** 2))


CENTRE = np.array([-26.0, 52.0, 20.0])


# ---- Spheres ----

# A direction in float32 is 3e-8 off: at R/d = 1e-6 that would blur bins of a tenth of the cone.
RATIOS = (0.9999, 0.9, 0.2, 1e-2, 1e-3, 1e-4)


@pytest.mark.parametrize("s", RATIOS)
def test_sphere_cone(s: float) -> None:
    d = np.linalg.norm(CENTRE)
    omc = exact_one_minus_cos(s)
    drawn = shapes.sample(shapes.SPHERE, [*CENTRE, s * d], sampling.uniform(1, N))
    assert drawn.found.all()
    tail, azimuth = cone_coordinates(CENTRE / d, double(drawn.wi))
    bins = 12 if s > 2e-3 else 4
    counts = histogram(tail / omc, azimuth, bins, bins)
    family.chi_squared(counts, np.full((bins, bins), N / bins**2), f"sphere of R/d {s}")
    pdf = 1 / (2 * np.pi * omc)
    assert relative_error(drawn.pdf, np.full(N, pdf)).max() <= 2 * ROUNDING
    assert (shapes.pdf(shapes.SPHERE, [*CENTRE, s * d], drawn.wi[:9]) == drawn.pdf[0]).all()


@pytest.mark.parametrize("s", [*RATIOS, 1e-5, 1e-6, 1 - 1e-12])
def test_sphere_density_and_distance(s: float) -> None:
    """The pdf against mpmath; the distance as that of the exact intersection (from u, for wi is already rounded)."""
    d = 1e4
    omc = exact_one_minus_cos(s)
    u = np.array([[x, 0.25] for x in (0, 2.0**-24, 0.3, 0.9, 0.999, 1 - 2.0**-24)], np.float32)
    drawn = shapes.sample(shapes.SPHERE, [0, 0, d, s * d], u)
    assert drawn.pdf[0] == pytest.approx(1 / (2 * np.pi * omc), rel=2 * ROUNDING)
    mpmath.mp.dps = 50
    for x, got in zip(u[:, 0], drawn.distance, strict=True):
        m, big = mpmath.mpf(s), mpmath.mpf(d)
        cosine = 1 - mpmath.mpf(float(x)) * (1 - mpmath.sqrt(1 - m * m))
        exact = big * (cosine - mpmath.sqrt(m * m - 1 + cosine * cosine))
        # s itself is a float64: 1 - s^2 has a condition of 1 / (1 - s).
        assert abs(float(got) - exact) <= exact * (2 * ROUNDING + 1e-15 / (1 - s))


def test_the_smallest_sphere_still_points_at_itself() -> None:
    """At R/d = 1e-6 the direction's rounding is 3e-8: every sample within that of the cone."""
    d = np.linalg.norm(CENTRE)
    drawn = shapes.sample(shapes.SPHERE, [*CENTRE, 1e-6 * d], sampling.uniform(2, N))
    tail, _ = cone_coordinates(CENTRE / d, double(drawn.wi))
    assert np.sqrt(2 * tail).max() <= 1e-6 + 2 * ROUNDING
    # And it is no single direction: the root mean square angle of a uniform cone is s / sqrt 2.
    assert np.sqrt(2 * tail.mean()) == pytest.approx(1e-6 / np.sqrt(2), rel=0.01)


@pytest.mark.parametrize("centre", [(0.0, 0.0, 0.0), (0.3, -0.2, 0.6), (0.6, 0.0, 0.8)])
def test_inside_a_sphere(centre: tuple[float, float, float]) -> None:
    """Also on its surface: all directions, and the far side."""
    drawn = shapes.sample(shapes.SPHERE, [*centre, 1], sampling.uniform(3, N))
    w = double(drawn.wi)
    counts = histogram((w[:, 2] + 1) / 2, (np.arctan2(w[:, 1], w[:, 0]) / (2 * np.pi)) % 1, 12, 12)
    family.chi_squared(counts, np.full((12, 12), N / 144), f"inside at {centre}")
    assert relative_error(drawn.pdf, np.full(N, 1 / (4 * np.pi))).max() <= 2 * ROUNDING
    reached = w * double(drawn.distance)[:, None] - centre
    assert np.abs((reached**2).sum(1) - 1).max() <= 16 * ROUNDING
    assert (drawn.distance >= 0).all()


# ---- The sun ----


@pytest.mark.parametrize("angle", [180.0, 60.0, 0.53, 0.01])
def test_sun(angle: float) -> None:
    travels = np.array([0.3, -2.0, -1.0])
    towards = -travels / np.linalg.norm(travels)
    drawn = shapes.sample(shapes.SUN, [*travels, angle], sampling.uniform(4, N))
    omc = 2 * np.sin(np.radians(angle) / 4) ** 2
    tail, azimuth = cone_coordinates(towards, double(drawn.wi))
    family.chi_squared(histogram(tail / omc, azimuth, 8, 8), np.full((8, 8), N / 64), f"sun of {angle}")
    assert np.isinf(drawn.distance).all()
    assert relative_error(drawn.pdf, np.full(N, 1 / (2 * np.pi * omc))).max() <= 2 * ROUNDING
    twin = shapes.pdf(shapes.SUN, [*travels, angle], drawn.wi)
    inside = tail < omc * (1 - 1e-3)
    assert (twin[inside] == drawn.pdf[inside]).all()
    assert not shapes.pdf(shapes.SUN, [*travels, angle], -drawn.wi[inside]).any()
    projected = np.pi * np.sin(np.radians(angle / 2)) ** 2
    assert shapes.sun_projected_solid_angle([*travels, angle]) == pytest.approx(projected, rel=1e-12)


def test_a_sun_without_size() -> None:
    drawn = shapes.sample(shapes.SUN, [0, 0, -2, 0], sampling.uniform(5, 10))
    assert (drawn.wi == [0, 0, 1]).all()
    assert (drawn.pdf == 1).all()
    assert not shapes.pdf(shapes.SUN, [0, 0, -2, 0], [[0, 0, 1]]).any()


# ---- Flat shapes ----

# Each is charted by the unit square, in which what is uniform by area, or by solid angle for the rectangle, is smooth.
POSITIONS = {
    "in front": ((0.2, -0.3, 1.5), 1.0),
    "aside": ((3.0, 1.0, 0.5), 1.0),
    "behind": ((-1.0, 2.0, -2.0), 1.0),
    "close": ((0.1, 0.05, 0.02), 1.0),
    "edge on": ((4.0, 0.3, 0.01), 1.0),
    "far": ((300.0, 200.0, 100.0), 1.0),
    "tiny": ((3.0, 4.0, 5.0), 2e-3),
    "huge": ((100.0, -3000.0, 5.0), 1e4),
}
TILT = np.array([[0.8, 0.0, 0.6], [0.36, 0.8, -0.48], [-0.48, 0.6, 0.64]])  # a rotation


def placed(kind: int, position: str) -> tuple[Array, Array, Array, Array, Array]:
    """The nine numbers of a shape of extent 1 times scale seen from a position over its centre; centre and axes."""
    seen_from, scale = POSITIONS[position]
    x, y, z = TILT.T
    centre = -(TILT @ np.array(seen_from))
    half_x, half_y = x * 0.5 * scale, y * 0.8 * scale
    if kind == shapes.RECTANGLE:
        shape = [centre - half_x - half_y, 2 * half_x, 2 * half_y]
    elif kind == shapes.ELLIPSE:
        shape = [centre, half_x, half_y]
    else:
        shape = [centre - half_x - half_y, centre + half_x - half_y, centre + half_y]
    return np.concatenate(shape), centre, half_x, half_y, z


def angles(centre: Array, half: Array) -> tuple[float, float, float, float]:
    """Where the first edge stands, as an angle over the foot of the perpendicular, to the other; height and foot."""
    foot = -float(centre @ half) / float(np.linalg.norm(half))
    normal_part = centre - TILT[:, :2] @ (TILT[:, :2].T @ centre)
    height, extent = float(np.linalg.norm(normal_part)), float(np.linalg.norm(half))
    start, end = np.arctan2([-extent - foot, extent - foot], height)
    return float(start), float(end - start), height, foot


def plane_coordinates(kind: int, points: Array, centre: Array, half_x: Array, half_y: Array) -> tuple[Array, Array]:
    a = (points - centre) @ half_x / (half_x @ half_x)
    b = (points - centre) @ half_y / (half_y @ half_y)
    if kind == shapes.RECTANGLE:
        out = []
        for t, half in ((a, half_x), (b, half_y)):
            start, turn, height, foot = angles(centre, half)
            out.append((np.arctan2(t * np.linalg.norm(half) - foot, height) - start) / turn)
        return out[0], out[1]
    if kind == shapes.ELLIPSE:
        return a * a + b * b, (np.arctan2(b, a) / (2 * np.pi)) % 1
    rest = (1 - b) / 2  # 1 at the base, 0 at the apex; halves of the base run from -rest to rest
    return rest**2, (a / rest + 1) / 2


def plane_points(kind: int, x: Array, y: Array, centre: Array, half_x: Array, half_y: Array) -> tuple[Array, Array]:
    """Points of the chart, and the area per unit of it."""
    area = np.full(len(x), np.linalg.norm(np.cross(half_x, half_y)))
    if kind == shapes.RECTANGLE:
        axes = []
        for t, half in ((x, half_x), (y, half_y)):
            start, turn, height, foot = angles(centre, half)
            extent, angle = np.linalg.norm(half), start + t * turn
            axes.append((height * np.tan(angle) + foot) / extent)
            area = area * height * turn / np.cos(angle) ** 2 / extent
        a, b = axes
    elif kind == shapes.ELLIPSE:
        a, b = np.sqrt(x) * np.cos(2 * np.pi * y), np.sqrt(x) * np.sin(2 * np.pi * y)
        area = np.pi * area
    else:
        rest = np.sqrt(x)
        a, b = rest * (2 * y - 1), 1 - 2 * rest
        area = 2 * area
    return centre + a[:, None] * half_x + b[:, None] * half_y, area


SHAPES = {"rectangle": shapes.RECTANGLE, "ellipse": shapes.ELLIPSE, "triangle": shapes.TRIANGLE}


@pytest.mark.parametrize("position", POSITIONS)
@pytest.mark.parametrize("name", SHAPES)
def test_flat_shapes(name: str, position: str) -> None:
    """Samples follow the pdf, the pdf integrates to 1, its twin agrees, and the distance ends on the shape."""
    kind = SHAPES[name]
    shape, centre, half_x, half_y, normal = placed(kind, position)
    drawn = shapes.sample(kind, shape, sampling.uniform(6, N))
    assert drawn.found.all()
    w = double(drawn.wi)
    assert np.abs((w**2).sum(1) - 1).max() <= 8 * ROUNDING

    def density(x: Array, y: Array) -> Array:
        points, area = plane_points(kind, x, y, centre, half_x, half_y)
        d2 = (points**2).sum(1)
        wi = points / np.sqrt(d2)[:, None]
        return double(shapes.pdf(kind, shape, wi)) * np.abs(wi @ normal) / d2 * area

    # Where w meets the plane, rather than w times the rounded distance.
    height = float(centre @ normal)
    points = w * (height / (w @ normal))[:, None]
    reached = w * double(drawn.distance)[:, None]
    skew = np.abs(w @ normal).min()
    assert np.abs(np.linalg.norm(reached - points, axis=1) / drawn.distance).max() <= 8 * ROUNDING / skew
    coordinates = plane_coordinates(kind, points, centre, half_x, half_y)
    # The rounding of w moves points across edges, by 2^-24 d / skew.
    bins = 8
    blur = ROUNDING * float(drawn.distance.max()) / skew / float(np.linalg.norm(half_x))
    cells = bin_integrals(density, bins, bins, (32, 32))
    assert blur < 1e-3
    family.chi_squared(histogram(*coordinates, bins, bins), cells * N, f"{name} {position}")
    twin = shapes.pdf(kind, shape, drawn.wi)
    hit = twin > 0
    assert (~hit).mean() <= 4 * blur + 5 / N
    assert relative_error(drawn.pdf[hit], twin[hit]).max() <= 64 * ROUNDING / skew
    assert not shapes.pdf(kind, shape, -drawn.wi).any()


@pytest.mark.parametrize("position", POSITIONS)
@pytest.mark.parametrize("name", SHAPES)
def test_flat_shapes_end_at_their_edges(name: str, position: str) -> None:
    """A hundredth within the outline the density is positive, a hundredth outside it is 0."""
    kind = SHAPES[name]
    shape, centre, half_x, half_y, _ = placed(kind, position)
    t = (np.arange(50) + 0.5) / 50
    if kind == shapes.ELLIPSE:
        a, b = np.cos(2 * np.pi * t), np.sin(2 * np.pi * t)
    elif kind == shapes.RECTANGLE:
        a, b = np.r_[2 * t - 1, 2 * t - 1, t * 0 + 1, t * 0 - 1], np.r_[t * 0 + 1, t * 0 - 1, 2 * t - 1, 2 * t - 1]
    else:
        a, b = np.r_[2 * t - 1, t, -t], np.r_[t * 0 - 1, 1 - 2 * t, 1 - 2 * t]
    edge = a[:, None] * half_x + b[:, None] * half_y
    for scale, inside in ((0.99, True), (1.01, False)):
        points = centre + scale * edge
        wi = points / np.linalg.norm(points, axis=1, keepdims=True)
        assert ((shapes.pdf(kind, shape, wi) > 0) == inside).all()


def solid_angle_of_triangle(a: Array, b: Array, c: Array) -> mpmath.mpf:
    """Van Oosterom and Strackee 1983, in 50 digits."""
    mpmath.mp.dps = 50
    u, v, w = (mpmath.matrix([mpmath.mpf(float(x)) for x in p]) for p in (a, b, c))

    def dot(p: mpmath.matrix, q: mpmath.matrix) -> mpmath.mpf:
        return sum(p[i] * q[i] for i in range(3))

    lu, lv, lw = (mpmath.sqrt(dot(p, p)) for p in (u, v, w))
    triple = mpmath.det(mpmath.matrix([list(u), list(v), list(w)]))
    return abs(2 * mpmath.atan2(abs(triple), lu * lv * lw + dot(u, v) * lw + dot(u, w) * lv + dot(v, w) * lu))


@pytest.mark.parametrize("position", POSITIONS)
def test_solid_angle_of_a_rectangle(position: str) -> None:
    shape, *_ = placed(shapes.RECTANGLE, position)
    corner, x, y = shape[:3], shape[3:6], shape[6:]
    exact = solid_angle_of_triangle(corner, corner + x, corner + x + y)
    exact += solid_angle_of_triangle(corner, corner + x + y, corner + y)
    assert abs(shapes.solid_angle(shape) - exact) <= 64 * 2.0**-53 * 2 * np.pi
    drawn = shapes.sample(shapes.RECTANGLE, shape, sampling.uniform(7, 10))
    if exact > 1e-7:
        assert drawn.pdf[0] == pytest.approx(float(1 / exact), rel=2 * ROUNDING + 1e-14 / float(exact))
        assert np.ptp(drawn.pdf) == 0


@pytest.mark.parametrize("name", SHAPES)
def test_from_the_plane_of_the_shape(name: str) -> None:
    """Edge on there is nothing to see, outside or on the shape itself; and no NaN."""
    kind = SHAPES[name]
    for offset in ((5.0, 0.0), (0.0, -9.0), (0.1, 0.1)):
        x, y, _ = TILT.T
        centre = x * offset[0] + y * offset[1]
        shape = {
            shapes.RECTANGLE: [centre - x - y, 2 * x, 2 * y],
            shapes.ELLIPSE: [centre, x, y],
            shapes.TRIANGLE: [centre - x - y, centre + x - y, centre + y],
        }[kind]
        drawn = shapes.sample(kind, np.concatenate(shape), sampling.uniform(8, 1000))
        # Rounding may leave a cosine of 1e-17, hence an enormous density, but nothing that is no number.
        assert np.isfinite(drawn.pdf).all()
        assert (drawn.pdf[drawn.found] > 1e6).all() or offset == (0.1, 0.1)
        assert np.isfinite(drawn.wi).all()
    assert not shapes.sample(kind, [0, 0, 0, 1, 0, 0, 0, 1, 0], sampling.uniform(9, 100)).found.any()


def test_degenerate_triangle() -> None:
    assert not shapes.sample(shapes.TRIANGLE, [0, 0, 1, 1, 0, 1, 2, 0, 1], sampling.uniform(9, 100)).found.any()
    assert not shapes.pdf(shapes.TRIANGLE, [0, 0, 1, 1, 0, 1, 2, 0, 1], [[0, 0, 1]]).any()
