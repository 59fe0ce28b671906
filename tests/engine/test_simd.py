# SPDX-License-Identifier: GPL-3.0-or-later
"""Functions on sixteen lanes: both instruction sets against float64, and against each other bit by bit; and the
equiangular table that one of them fills.
"""

import numpy as np
import pytest

from tests.engine.probe import simd
from tests.engine.probe.call import Array
from tests.engine.significance import ROUNDING, Family, double
from tests.render.closed_forms import henyey_greenstein as phase

SETS = [pytest.param(False, id="AVX2")]
SETS.append(
    pytest.param(True, id="AVX-512", marks=pytest.mark.skipif(not simd.has_avx512(), reason="no such processor"))
)
MEDIA = {"grey": (0.3, 0.3, 0.3, 0.0), "coloured": (0.02, 0.3, 2.0, 0.0), "directed": (0.1, 0.1, 0.1, 0.7)}
MEDIA["coloured and directed"] = (0.02, 0.3, 2.0, -0.6)
COUNT = 128
EXP = 3e-7
"""Relative error of the exponential."""


def unit(v: Array) -> Array:
    return np.asarray(v / np.linalg.norm(v, axis=-1, keepdims=True))


def vertices(seed: int, directed: bool) -> Array:
    rng = np.random.default_rng(seed)
    columns = [rng.normal(0, 3, (COUNT, 3)), rng.uniform(0, 5, (COUNT, 3))]
    columns += [unit(rng.normal(size=(COUNT, 3)))] if directed else []
    return np.ascontiguousarray(np.concatenate(columns, axis=1).T.astype(np.float32))


def points(seed: int, count: int) -> Array:
    rng = np.random.default_rng(seed)
    return np.concatenate([rng.normal(size=(count, 3)), unit(rng.normal(size=(count, 3)))], 1).astype(np.float32)


@pytest.mark.parametrize("wide", SETS)
@pytest.mark.parametrize("name", MEDIA)
def test_connections(name: str, wide: bool) -> None:
    """Parts and sums: power, phases at both ends, transmittance, and the bounded inverse square."""
    *sigma, g = MEDIA[name]
    v, (point,), bound = vertices(1, g != 0), points(2, 1), 0.4
    found = simd.connect(wide, MEDIA[name], v, point, bound)
    way = double(v[:3].T) - double(point[:3])
    d = np.linalg.norm(way, axis=1)
    to_vertex = way / d[:, None]
    phases = phase(g, to_vertex @ double(point[3:])) * (phase(g, -(to_vertex * v[6:].T).sum(1)) if g else phase(0, d))
    values = double(v[3:6]) * np.exp(-np.outer(sigma, d)) * phases / (d * d + bound * bound)
    rounding = EXP + (64 + max(sigma) * d.max() + 200 * abs(g)) * ROUNDING
    assert np.abs(found.means / values.mean(0) - 1).max() < rounding
    expected = [*values.sum(1), values.mean(0).sum(), *values.mean(0).reshape(-1, simd.LANES).sum(0)]
    assert np.abs(found.sums / expected - 1).max() < rounding


@pytest.mark.parametrize("wide", SETS)
@pytest.mark.parametrize("name", MEDIA)
def test_targets(name: str, wide: bool) -> None:
    *sigma, g = MEDIA[name]
    v, seen, soften = vertices(3, g != 0), points(4, 5), 1.3
    found = simd.pick_targets(wide, MEDIA[name], v, seen, soften)
    way = double(v[:3].T)[None] - double(seen[:, None, :3])
    d = np.linalg.norm(way, axis=2)
    values = np.exp(-np.mean(sigma) * d) / (d * d + soften * soften)
    if g:
        values *= phase(g, -(way * v[6:].T).sum(2) / d)
    rounding = EXP + (64 + np.mean(sigma) * d.max() + 200 * abs(g)) * ROUNDING
    assert np.abs(found / values.sum(0) - 1).max() < rounding


# Medium; t_foot, distance to the line, radius, end of the segment.
LINES: dict[str, tuple[tuple[float, float, float, float], tuple[float, float, float, float]]] = {
    "before a moon": ((0.015, 0.015, 0.015, 0.0), (20, 5, 2, 100)),
    "coloured and directed": ((0.01, 0.1, 0.5, 0.5), (20, 5, 2, 60)),
    "light behind": ((0.1, 0.1, 0.1, 0.0), (-10, 3, 1, 50)),
    "close to a point": ((0.1, 0.1, 0.1, 0.0), (7, 1e-3, 0, 20)),
    "a far point": ((1e-5, 1e-5, 1e-5, 0.0), (1e5, 10, 0, 2e5)),
    "within a light": ((0.5, 0.5, 0.5, 0.0), (0.3, 0.2, 4, 9)),
    "above a world": ((0.1, 0.1, 0.1, 0.0), (1.7 + 1e7, 100, 1e7, 3)),
    "a narrow peak": ((0.1, 0.1, 0.1, 0.9999), (20, 1e-3, 1e-4, 30)),
    "a narrow peak behind": ((0.1, 0.1, 0.1, -0.9999), (20, 1e-3, 1e-4, 30)),
    "tiny": ((1e6, 1e6, 1e6, 0.0), (1e-6, 3e-7, 1e-7, 5e-6)),
    "huge": ((1e-9, 1e-9, 1e-9, 0.0), (1e9, 3e8, 1e8, 5e9)),
}


def shape_of(name: str) -> tuple[float, ...]:
    t_foot, nearest, radius, cut = LINES[name][1]
    distance = np.hypot(t_foot, nearest)
    h = np.sqrt(nearest**2 + radius**2 / 4 + 1e-12 * distance**2)
    x = [(t - t_foot) / (h + np.hypot(h, t - t_foot)) for t in (0, cut)]
    return t_foot, h, nearest**2, radius, distance, cut, x[0], (x[1] - x[0]) / (simd.NODES - 1)


@pytest.mark.parametrize("wide", SETS)
@pytest.mark.parametrize("name", LINES)
def test_equiangular_nodes(name: str, wide: bool) -> None:
    """Densities at the nodes, up to one factor: cone of the light, transmittance, phase."""
    *sigma, g = LINES[name][0]
    shape = shape_of(name)
    t_foot, h, h2, radius, distance, cut, x_first, x_step = (np.longdouble(v) for v in shape)
    found = simd.equiangular_nodes(wide, LINES[name][0], shape)
    x = x_first + x_step * np.arange(simd.NODES)
    s = h * 2 * x / ((1 - x) * (1 + x))
    s[0], s[-1] = -t_foot, cut - t_foot
    d2 = np.maximum(h2 + s * s, radius**2 if radius > 0 else h * h)
    sine2 = np.minimum(radius**2 / d2, 1)
    source = 2 / (d2 * (1 + np.sqrt(1 - sine2)))
    beyond = np.maximum(np.maximum(s + t_foot, 0) + np.sqrt(d2) - distance, 0)
    source *= np.mean([np.exp(-np.longdouble(c) * beyond) for c in sigma], axis=0)
    if g:
        source *= phase(float(np.float32(g)), -s / np.sqrt(h2 + s * s))
    values = source * (1 + x * x) / ((1 - x) * (1 + x)) ** 2
    # Of the way beyond the shortest, float32 keeps 2^-24 of the way itself; of the cone's cosine half of the digits
    # where it is 0, close to the surface.
    way = EXP + (100 + 4 * max(sigma) * float(cut)) * ROUNDING
    rounding = way + double(ROUNDING / np.maximum(np.sqrt(1 - sine2), np.sqrt(ROUNDING)))
    brightest = int(np.argmax(values))
    assert (np.abs(found[:-1] / double(values) * double(values[brightest]) / found[brightest] - 1) < 2 * rounding).all()
    assert found[-1] / found[-2] == pytest.approx(float(source[-1] / (2 * values[-1])), rel=rounding[-1])


@pytest.mark.skipif(not simd.has_avx512(), reason="no such processor")
@pytest.mark.parametrize("seed", range(20))
def test_both_instruction_sets_give_the_same_bits(seed: int) -> None:
    for medium in MEDIA.values():
        v, seen = vertices(seed, medium[3] != 0), points(seed + 100, 4)
        narrow, wide = (simd.connect(w, medium, v, seen[0], 0.4) for w in (False, True))
        assert (narrow.means == wide.means).all() and (narrow.sums == wide.sums).all()
        assert (simd.pick_targets(False, medium, v, seen, 1.3) == simd.pick_targets(True, medium, v, seen, 1.3)).all()
    for name, (medium, _) in LINES.items():
        shape = np.array(shape_of(name)) * np.random.default_rng(seed).uniform(0.9, 1.1, 8)
        assert (simd.equiangular_nodes(False, medium, shape) == simd.equiangular_nodes(True, medium, shape)).all()


# ---- the table ------------------------------------------------------------------------------------------------------

N = 100_000
BINS = 64
family = Family(size=len(LINES))


@pytest.mark.parametrize("name", LINES)
def test_distances_follow_their_density(name: str) -> None:
    """And the density is positive all along the segment."""
    medium, (t_foot, nearest, radius, cut) = LINES[name]
    sigma = np.array([[0.1 * c for c in medium[:3]], [0.9 * c for c in medium[:3]]])
    segment, light = (0, 0, 0, 1, 0, 0, cut), (t_foot, nearest, 0, radius)
    u = np.random.default_rng(len(name)).random(N).astype(np.float32)
    samples = simd.equiangular_table(sigma, medium[3], segment, light, np.minimum(u, 1 - ROUNDING))
    assert (samples.pdf > 0).all() and np.isfinite(samples.pdf).all()
    assert ((samples.t >= 0) & (samples.t <= np.float32(cut))).all()
    # Bins by its own quantiles, narrow in its tails; each integrated.
    tails = np.geomspace(1e-7, 1 / BINS, 100)
    quantiles = np.r_[tails, np.linspace(0, 1, BINS)[1:-1], 1 - tails]
    others = simd.equiangular_table(sigma, medium[3], segment, light, quantiles).t
    between = (double(others) + double(np.nextafter(others, np.float32(np.inf)))) / 2  # samples are float32
    edges = np.unique(np.r_[0, between[between < np.float32(cut)], np.float32(cut)])
    nodes, weights = np.polynomial.legendre.leggauss(8)
    at = edges[:-1, None] + np.diff(edges)[:, None] * (nodes + 1) / 2
    pdf = double(simd.equiangular_pdf(sigma, medium[3], segment, light, at.ravel())).reshape(at.shape)
    assert (pdf > 0).all()
    family.chi_squared(
        np.histogram(samples.t, edges)[0], (pdf * weights).sum(1) * np.diff(edges) / 2 * N, f"equiangular table, {name}"
    )


INF = float("inf")
TAILS = {
    "long": ((0.09, 0.09, 0.09), (-10, 3, 1, 400)),
    "endless": ((0.09, 0.09, 0.09), (-10, 3, 1, INF)),
    "short": ((0.09, 0.09, 0.09), (-10, 3, 1, 46)),
    "one channel does not scatter": ((0, 0.02, 0.09), (20, 5, 2, INF)),
}


@pytest.mark.parametrize("name", TAILS)
def test_the_tail(name: str) -> None:
    """Between the distances of u = 1 - 2^-k the density has 2^-(k + 1), as far as float32 can tell u: beyond nine mean
    free paths, where the table ends, too."""
    sigma_s, (t_foot, nearest, radius, end) = TAILS[name]
    line = (((0.01, 0.01, 0.01), sigma_s), 0, (0, 0, 0, 1, 0, 0, end), (t_foot, nearest, 0, radius))
    u = 1 - 2.0 ** -np.arange(1, 19)
    t = double(simd.equiangular_table(*line, u).t)
    assert (np.diff(t) > 0).all()
    at = t[:-1, None] + np.diff(t)[:, None] * (np.arange(10_000) + 0.5) / 10_000  # the table has kinks at its nodes
    mass = double(simd.equiangular_pdf(*line, at.ravel())).reshape(at.shape).mean(1) * np.diff(t)
    density = double(simd.equiangular_pdf(*line, t))
    resolved = 8 * ROUNDING + (density * t)[1:] * ROUNDING + (density * t)[:-1] * ROUNDING  # u and t are float32
    assert (np.abs(mass - np.diff(u)) < resolved).all(), mass / np.diff(u)
    if end == INF:
        distance, slowest = np.hypot(t_foot, nearest), 0.01 + min(s for s in sigma_s if s > 0)
        way = distance + 9 / slowest
        assert t[-1] > (way**2 - distance**2) / (2 * (way - t_foot)), "no sample beyond the table"
