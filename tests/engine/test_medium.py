# SPDX-License-Identifier: GPL-3.0-or-later
"""The medium: distances against their densities, weights against what they estimate, angles against mpmath."""

import mpmath
import numpy as np
import pytest
from scipy.special import exp1

from tests.engine.probe import medium, sampling
from tests.engine.probe.call import Array
from tests.engine.significance import ROUNDING, Family, double, relative_error, single

family = Family(size=88)
N = 200_000
INF = float("inf")

# sigma_a, sigma_s, beta, t_max
MEDIA: dict[str, tuple[tuple[float, ...], tuple[float, ...], tuple[float, ...], float]] = {
    "grey": ((0.0015,) * 3, (0.0135,) * 3, (1, 1, 1), 40),
    "grey, endless": ((0.1,) * 3, (0.9,) * 3, (0.3, 0.2, 0.1), INF),
    "grey, thin": ((1e-7,) * 3, (2e-7,) * 3, (1, 1, 1), 1),
    "no absorption": ((0,) * 3, (2,) * 3, (1, 1, 1), 1),
    "coloured": ((0.1, 0.3, 0.0), (0.5, 1.0, 2.0), (1, 0.5, 0.2), 1.5),
    "coloured, endless": ((0.1, 0.3, 0.0), (0.5, 1.0, 2.0), (1, 0.5, 0.2), INF),
    "coloured, thin": ((1e-6, 0, 1e-5), (1e-5, 2e-5, 3e-5), (1, 1, 1), 0.1),
    "one channel scatters": ((0.1, 0.2, 0.0), (3.0, 0.0, 0.0), (1, 1, 1), 2),
    "one channel, endless": ((0.1, 0.2, 0.0), (3.0, 0.0, 0.0), (1, 1, 1), INF),
    "throughput in one channel": ((0.1, 0.2, 0.3), (0.3, 1.0, 5.0), (0, 1, 0), 3),
    "far apart": ((0.0, 0.0, 0.0), (1e-3, 1.0, 100.0), (1, 1, 1), 10),
}


def density_bins(edges: Array, pdf_at: Array) -> Array:
    """Integrals over the bins by Gauss-Legendre; pdf_at has the values at nodes_of(edges)."""
    _, weights = np.polynomial.legendre.leggauss(8)
    return np.asarray((pdf_at.reshape(len(edges) - 1, 8) * weights).sum(1) * np.diff(edges) / 2)


def nodes_of(edges: Array) -> Array:
    nodes, _ = np.polynomial.legendre.leggauss(8)
    return np.asarray((edges[:-1, None] + np.diff(edges)[:, None] * (nodes + 1) / 2).ravel())


def edges_of(sigma: tuple[float, ...], beta: tuple[float, ...], t_max: float) -> Array:
    """Bins on all scales of the channels that matter, from 0 to where less than e^-45 is left."""
    rates = [s for s, b in zip(sigma, beta, strict=True) if s > 0 and b > 0]
    parts = [np.linspace(0, 1, 41) * t_max if t_max < INF else [0]]
    parts += [-np.log1p(-np.linspace(0, 1, 41)[:-1]) / s for s in rates]
    parts += [np.linspace(4, 45, 80) / s for s in rates]
    edges = np.unique(np.concatenate(parts))
    return np.append(edges[edges < t_max], t_max) if t_max < INF else edges


def numbers(seed: int) -> tuple[Array, Array]:
    return sampling.uniform(seed, N)[:, 0], sampling.random_bits(seed + 1, N)


@pytest.mark.parametrize("name", MEDIA)
def test_free_flight(name: str) -> None:
    """Distances follow the pdf, passing its probability; both kinds of weights have the means they must."""
    sigma_a, sigma_s, beta, t_max = MEDIA[name]
    flights = medium.free_flight(sigma_a, sigma_s, beta, t_max, *numbers(len(name)))
    hit = flights.scattered
    assert (flights.t[~hit] == single(t_max)).all()
    assert (flights.t[hit] < t_max).all()

    edges = edges_of(sigma_s, beta, t_max)
    cells = density_bins(edges, double(medium.free_flight_pdf(sigma_a, sigma_s, beta, nodes_of(edges))))
    counts = np.append(np.histogram(flights.t[hit], edges)[0], (~hit).sum())
    passing = flights.pdf[~hit]
    if cells.sum() * N > 5:  # in thin media one in millions scatters
        family.chi_squared(counts, np.append(cells, 1 - cells.sum()) * N, f"free flight in {name}")
    if hit.any():
        pdf = medium.free_flight_pdf(sigma_a, sigma_s, beta, flights.t[hit])
        assert relative_error(flights.pdf[hit], pdf).max() <= 16 * ROUNDING * 45
    if (~hit).any():
        assert np.ptp(passing) == 0
        share = np.array(beta) / sum(beta)
        depth = np.array([s * t_max if s > 0 else 0 for s in sigma_s])
        assert passing[0] == pytest.approx((share * np.exp(-depth)).sum(), rel=64 * ROUNDING)

    bound = sum(beta) * (1 + 64 * ROUNDING)
    for c in range(3):
        sigma_t = sigma_a[c] + sigma_s[c]
        through = np.exp(-sigma_t * t_max) if sigma_t > 0 else 1.0
        scattered = sigma_s[c] / sigma_t * -np.expm1(-sigma_t * t_max) if sigma_s[c] > 0 else 0.0
        weight = double(flights.weight[:, c])
        assert (weight >= 0).all()
        assert (beta[c] * weight <= bound).all()
        if beta[c] == 0:
            assert not weight.any()
            continue
        for part, expected in ((np.where(hit, weight, 0), scattered), (np.where(hit, 0, weight), through)):
            if not part.any():
                assert expected * N < 5  # too rare to have been seen
            elif np.ptp(part) == 0:
                # Every sample passed (or none did): the weight times its probability.
                assert part[0] * (passing[0] if len(passing) else 1) == pytest.approx(expected, abs=8 * ROUNDING)
            elif expected * N > 5:
                family.mean(part, expected, f"free flight in {name}, channel {c}", 16 * ROUNDING)


@pytest.mark.parametrize("name", MEDIA)
def test_collision(name: str) -> None:
    """Distances follow the pdf on the segment; weights estimate what scatters there, in grey without spread."""
    sigma_a, sigma_s, beta, t_max = MEDIA[name]
    sigma_t = tuple(a + s for a, s in zip(sigma_a, sigma_s, strict=True))
    collisions = medium.collision(sigma_a, sigma_s, beta, t_max, *numbers(100 + len(name)))
    assert ((collisions.t >= 0) & (collisions.t <= single(t_max))).all()

    rates = tuple(t if s > 0 else 0 for t, s in zip(sigma_t, sigma_s, strict=True))
    edges = edges_of(rates, beta, t_max)
    cells = density_bins(edges, double(medium.collision_pdf(sigma_a, sigma_s, beta, t_max, nodes_of(edges))))
    family.chi_squared(np.histogram(collisions.t, edges)[0], cells * N, f"collision in {name}")
    pdf = medium.collision_pdf(sigma_a, sigma_s, beta, t_max, collisions.t)
    assert relative_error(collisions.pdf, pdf).max() <= 16 * ROUNDING * 45

    exact = [s / t * -np.expm1(-t * t_max) if s > 0 else 0.0 for s, t in zip(sigma_s, sigma_t, strict=True)]
    bound = np.dot(beta, exact) * (1 + 256 * ROUNDING)
    for c in range(3):
        weight = double(collisions.weight[:, c])
        assert (weight >= 0).all()
        assert (beta[c] * weight <= bound).all()
        if beta[c] == 0 or sigma_s[c] == 0:
            assert not weight.any()
        elif np.ptp(weight) <= 64 * ROUNDING * weight.max():
            assert weight.mean() == pytest.approx(exact[c], rel=64 * ROUNDING)
        else:
            family.mean(weight, exact[c], f"collision in {name}, channel {c}", 16 * ROUNDING)


@pytest.mark.parametrize("tau", [1e-3, 1e-5, 1e-6, 1e-7, 1e-8, 3.0, 60.0])
def test_collision_of_any_optical_depth(tau: float) -> None:
    """DESIGN's hazard: the truncated exponential and 1 - e^-tau in float32, against mpmath."""
    mpmath.mp.dps = 40
    bits = [0, 1 << 20, 1 << 40, 1 << 60, 1 << 62, (1 << 63) + 5, (1 << 64) - (1 << 55), (1 << 64) - 1]
    s = medium.collision(0, tau, 1, 1, np.zeros(len(bits), np.float32), np.array(bits, np.uint64))
    depth = mpmath.mpf(float(single(tau)))
    for b, t, weight in zip(bits, s.t, s.weight[:, 0], strict=True):
        exact = -mpmath.log1p((mpmath.mpf(b) + 0.5) / 2**64 * mpmath.expm1(-depth)) / depth
        assert abs(float(t) - exact) <= 8 * ROUNDING * exact
        assert abs(float(weight) + mpmath.expm1(-depth)) <= 4 * ROUNDING * -mpmath.expm1(-depth)


def test_transmittance() -> None:
    t = single([0, 1e-8, 0.5, 3, 80, 1000, INF])
    sigma = (0.0, 0.25, 2.0)
    exact = np.exp(-np.outer(np.minimum(double(t), 1e300), sigma))
    got = medium.transmittance((0, 0.05, 1), (0, 0.2, 1), t)
    assert np.abs(got - exact).max() <= 2 * ROUNDING
    assert got[-1].tolist() == [1, 0, 0]
    assert medium.transmittance(0, 0, t).tolist() == [[1, 1, 1]] * len(t)
    assert medium.transmittance(0, 0.5, [200])[0, 0] > 0  # beyond 87: subnormal, not lost
    assert medium.transmittance(0, 1, [1e-6])[0, 0] == single(np.exp(-1e-6))


def test_nothing_to_sample() -> None:
    """No scattering, no throughput, no length: no distance, no NaN; an absorber is exact."""
    u, bits = numbers(3)
    absorber = medium.free_flight((1, 2, 0), 0, 1, 0.5, u, bits)
    assert not absorber.scattered.any()
    assert absorber.weight[0] == pytest.approx(np.exp([-0.5, -1, 0]), rel=2 * ROUNDING)
    assert (absorber.pdf == 1).all()
    assert medium.free_flight((1, 0, 0), 0, 1, INF, u[:1], bits[:1]).weight.tolist() == [[0, 1, 1]]
    assert not medium.free_flight(1, 1, 0, 1, u, bits).scattered.any()
    assert not medium.free_flight((0, 0, 1), 1, 1, 0, u, bits).scattered.any()
    for sigma_s, beta, t_max in ((0, 1, 1), (1, 0, 1), (1, 1, 0), ((1, 2, 3), 1, 0)):
        nothing = medium.collision((1, 1, 1), sigma_s, beta, t_max, u[:100], bits[:100])
        assert not nothing.weight.any()
        assert not nothing.pdf.any()
    for scale in (1e-38, 1e-30, 1e30):  # overflow of t or of sigma t
        for sampled in (medium.free_flight, medium.collision):
            s = sampled((scale, 0, 0), (scale, 2 * scale, 0), (1, 1, 1), INF, u, bits)
            assert np.isfinite(s.weight).all()
            assert np.isfinite(s.pdf).all()


def test_the_sampler_feeds_both() -> None:
    """Through a Sampler, in both kinds of media: the same law."""
    _, keys = numbers(9)
    for sigma_s in ((0.7,) * 3, (0.5, 0.7, 1.0)):
        flights = medium.free_flight(0, sigma_s, 1, 1, keys, keys, own=True)
        family.mean(flights.scattered, -np.expm1(-double(sigma_s)).mean(), "scattering through a sampler")
        collisions = medium.collision(0, sigma_s, 1, INF, keys, keys, own=True)
        share = double(sigma_s) / sigma_s  # albedo 1 and no end: equal shares
        family.mean(collisions.t, (share / sigma_s).mean(), "distance through a sampler")


# ---- Equiangular distances ----

# a, b, h: DESIGN's h of 1e-4 and 1e-6, and less; on either side of the light and across, with and without an end.
SEGMENTS = [
    (-1, 1, 0.5), (-1, 3, 1e-4), (-1, 1, 1e-6), (0.5, 2, 1e-4), (0.5, 2, 1e-6), (0.5, 2, 0), (-2, -0.5, 1e-6),
    (-3, 1e4, 1e-2), (0, 1, 1e-3), (1, 1e6, 1), (-5, INF, 1), (0, INF, 2), (3, INF, 1e-5), (-1e4, INF, 0.01),
    (1e-3, 1.5e-3, 1), (-1e5, 1e5, 1e-3),
]  # fmt: skip


def exact_equiangular(a: float, b: float, h: float) -> tuple[mpmath.mpf, mpmath.mpf, mpmath.mpf]:
    """atan(a/h), the angle, and h, in 50 digits, from the float32 that the engine sees."""
    mpmath.mp.dps = 50
    x, y, z = (mpmath.mpf(float(single(v))) for v in (a, b, h))
    z = max(z, mpmath.mpf(10) ** -18, mpmath.mpf("1e-9") * max(abs(x), 0 if mpmath.isinf(y) else abs(y)))
    start = mpmath.atan(x / z)
    return start, (mpmath.pi / 2 if mpmath.isinf(y) else mpmath.atan(y / z)) - start, z


@pytest.mark.parametrize(("a", "b", "h"), SEGMENTS)
def test_equiangular_inverts_the_angle(a: float, b: float, h: float) -> None:
    start, angle, z = exact_equiangular(a, b, h)
    u = single([0, 2.0**-24, 1e-4, 0.1, 0.3, 0.5, 0.7, 0.9, 0.9999, 1 - 2.0**-24])
    t = medium.equiangular(a, b, h, u)
    pdf = medium.equiangular_pdf(a, b, h, t)
    for fraction, got, density in zip(u, t, pdf, strict=True):
        theta = start + mpmath.mpf(float(fraction)) * angle
        exact = z * mpmath.tan(theta)
        # Roundings of the angle, measured from the nearer end of the full turn, and of t itself; 1 - u is exact.
        spread = abs(z / mpmath.cos(theta) ** 2) * min(mpmath.pi / 2 - theta, mpmath.pi / 2 + theta)
        assert abs(float(got) - exact) <= ROUNDING * (6 * spread + 4 * abs(exact) + 8 * z)
        at = mpmath.mpf(float(got))
        assert abs(float(density) * (z * z + at * at) * angle / z - 1) <= 12 * ROUNDING


@pytest.mark.parametrize(("a", "b", "h"), SEGMENTS)
def test_equiangular_follows_its_pdf(a: float, b: float, h: float) -> None:
    """In bins of equal angle, which h / ((h^2 + t^2) angle) makes equal."""
    start, angle, z = (float(v) for v in exact_equiangular(a, b, h))
    t = double(medium.equiangular(a, b, h, sampling.uniform(5, N)[:, 0]))
    assert ((t >= single(a)) & (t <= single(b))).all()
    # The angle from the nearer end of the turn, so that the far tail keeps its digits; edges likewise.
    from_end, first = np.arctan2(z, t), float(np.arctan2(z, double(single(b))))
    counts = np.histogram((from_end - first) / angle, 100, (0, 1))[0]
    family.chi_squared(counts, np.full(100, N / 100), f"equiangular {a}, {b}, {h}")
    assert start + angle <= np.pi / 2 + 1e-9
    assert medium.equiangular_pdf(a, b, h, [a - 1.0]).tolist() == [0]
    if b < INF:
        assert medium.equiangular_pdf(a, b, h, [b + 1.0]).tolist() == [0]


def test_equiangular_of_an_empty_segment() -> None:
    assert medium.equiangular_pdf(1, 1, 0.5, [1]).tolist() == [0]
    assert medium.equiangular(1, 1, 0.5, [0.3]).tolist() == [1]


def test_airlight_by_both_densities() -> None:
    """Light of a point that a ray leaves radially from distance 1, scattered back: by two densities, against E_1."""
    sigma = 0.8
    # int_0^inf e^(-2 s t) / (1 + t)^2 dt = 1 - 2 s e^(2 s) E1(2 s)
    exact = 1 - 2 * sigma * np.exp(2 * sigma) * exp1(2 * sigma)
    u, bits = numbers(11)
    collisions = medium.collision(0, sigma, 1, INF, u, bits)
    t = double(collisions.t)
    estimate = double(collisions.weight[:, 0]) / sigma * np.exp(-sigma * t) / (1 + t) ** 2
    family.mean(estimate, exact, "by exponential distances")
    # Behind the light the offset runs from 1; as h -> 0 the density is 1 / t^2 and the estimate e^(-2 s t) alone.
    offset = medium.equiangular(1, INF, 1e-6, u)
    pdf, t = double(medium.equiangular_pdf(1, INF, 1e-6, offset)), double(offset)
    family.mean(np.exp(-2 * sigma * (t - 1)) / t**2 / pdf, exact, "by equiangular distances")
