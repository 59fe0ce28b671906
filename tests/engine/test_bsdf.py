# SPDX-License-Identifier: GPL-3.0-or-later
"""BSDFs: samplers against densities, weights against evaluations, Fresnel and albedos against closed forms."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from tests.engine.probe import bsdf, fresnel, sampling
from tests.engine.probe.bsdf import Lobe
from tests.engine.probe.call import Array
from tests.engine.significance import ROUNDING, Family, bin_integrals, double, histogram, relative_error, single

family = Family(size=97)
N = 200_000
WHITE = (1.0, 1.0, 1.0)
GOLD = Lobe(bsdf.CONDUCTOR, eta=(0.143, 0.375, 1.442), k=(3.983, 2.386, 1.603))


def direction(mu: float, turn: float = 0.1) -> Array:
    """The unit vector of cosine mu at a fraction of the turn."""
    r = np.sqrt((1 - mu) * (1 + mu))
    return np.array([r * np.cos(2 * np.pi * turn), r * np.sin(2 * np.pi * turn), mu])


def normalized(v: Array) -> Array:
    return v / np.sqrt((v**2).sum(-1, keepdims=True))


def turn(v: Array) -> Array:
    return (np.arctan2(double(v[:, 1]), double(v[:, 0])) / (2 * np.pi)) % 1


# A chart of the directions wi for a wo by their half vector h, in which GGX lobes of any width are smooth. With
# tan(theta_h) = alpha sqrt(v / (1 - v)), v is uniform under D cos; for each azimuth of h it is counted in units of its
# largest value that still reflects wo upward, so that the unit square is exactly the upper hemisphere of wi.


def largest_v(wo: Array, alpha: float, phi: Array) -> Array:
    """cos theta_i = A cos(2 theta_h - psi), so theta_h ends at (psi + pi/2) / 2."""
    in_plane = wo[0] * np.cos(2 * np.pi * phi) + wo[1] * np.sin(2 * np.pi * phi)
    slope = np.tan((np.arctan2(in_plane, wo[2]) + np.pi / 2) / 2) / alpha
    return slope**2 / (1 + slope**2)


CROWD = 3  # towards the horizon, where densities for a wo near it rise steeply


def from_chart(wo: Array, alpha: float, x: Array, phi: Array) -> tuple[Array, Array]:
    """wi, and its solid angle per unit of the chart."""
    v_max = largest_v(wo, alpha, phi)
    v = (1 - (1 - x) ** CROWD) * v_max
    tan2 = alpha**2 * v / (1 - v)
    cosine = 1 / np.sqrt(1 + tan2)
    sine = np.sqrt(tan2) * cosine
    h = np.stack([sine * np.cos(2 * np.pi * phi), sine * np.sin(2 * np.pi * phi), cosine], axis=1)
    cos_oh = h @ wo
    wi = 2 * cos_oh[:, None] * h - wo
    # d omega_i = 4 cos_oh d omega_h, and d cos_h / dv = cos_h^3 alpha^2 / (2 (1 - v)^2).
    return wi, 4 * cos_oh * 2 * np.pi * cosine**3 * alpha**2 / (2 * (1 - v) ** 2) * v_max * CROWD * (1 - x) ** (
        CROWD - 1
    )


def to_chart(wo: Array, alpha: float, wi: Array) -> tuple[Array, Array]:
    h = normalized(wi.astype(np.float64) + wo)
    slope2 = (h[:, 0] ** 2 + h[:, 1] ** 2) / h[:, 2] ** 2 / alpha**2
    phi = turn(h)
    x = np.minimum(1, slope2 / (1 + slope2) / largest_v(wo, alpha, phi))
    return 1 - (1 - x) ** (1 / CROWD), phi


def chart_integrals(lobes: list[Lobe], wo: Array, alpha: float, bins: int = 12) -> tuple[Array, Array]:
    """Integrals over each cell of the chart of the pdf and of f cos (channel 0)."""

    def density(x: Array, phi: Array) -> Array:
        wi, jacobian = from_chart(wo, alpha, x, phi)
        f, pdf = bsdf.evaluate(lobes, wo, wi)
        return np.stack([pdf, f[:, 0]], axis=1) * jacobian[:, None]

    # wo near the horizon: the limit of v turns within an azimuth of its cosine.
    integrals = bin_integrals(density, bins, bins, (24, 32 if wo[2] > 0.2 else 192))
    return integrals[..., 0], integrals[..., 1]


@cache
def case(name: str, mu: float) -> tuple[list[Lobe], float, Array, Array, Array]:
    """Lobes, width of the chart, wo, and its two integrals."""
    lobes, alpha = CASES[name]
    wo = double(single(direction(mu)))
    return lobes, alpha, wo, *chart_integrals(lobes, wo, alpha)


def metal(alpha: float, masking: int = bsdf.SMITH) -> Lobe:
    """F = 1 at all angles."""
    return Lobe(bsdf.CONDUCTOR, alpha=alpha, f0=WHITE, masking=masking)


MIX = [
    Lobe(bsdf.LAMBERT, weight=0.3, color=(0.8, 0.6, 0.2)),
    replace(GOLD, weight=0.5, alpha=0.3),
    Lobe(bsdf.CONDUCTOR, weight=0.2, alpha=0.6, f0=(0.9, 0.5, 0.3), masking=bsdf.SCHLICK_GGX),
]
REPORT = Lobe(bsdf.REPORT_METAL, color=(0.5, 0.5, 0.55), f0=(0.6, 0.5, 0.4), alpha=0.4)

CASES: dict[str, tuple[list[Lobe], float]] = {
    "lambert": ([Lobe(bsdf.LAMBERT, color=(0.5, 0.3, 0.1))], 1),
    **{f"metal {a}": ([metal(a)], a) for a in (1e-4, 1e-3, 0.02, 0.1, 0.5, 1.0)},
    "separable": ([metal(0.4, bsdf.SMITH_SEPARABLE)], 0.4),
    "schlick-ggx": ([metal(0.4, bsdf.SCHLICK_GGX)], 0.4),
    "gold": ([replace(GOLD, alpha=0.25)], 0.25),
    "report": ([REPORT], 0.4),
    "mix": (MIX, 0.6),
}
# In float32, wi tells the slope of h to 2^-24 / (2 mu); at mu 0.01, hundredths of alpha 1e-4: that blurs the bins.
SEEN_FROM = [(name, mu) for name in CASES for mu in (1.0, 0.6, 0.1, 0.01) if (name, mu) != ("metal 0.0001", 0.01)]


@pytest.mark.parametrize(("name", "mu"), SEEN_FROM)
def test_samples_follow_the_pdf(name: str, mu: float) -> None:
    """Chi-squared over the chart, nothing being one more bin; and the weight of every sample is eval / pdf."""
    lobes, alpha, wo, cells, _ = case(name, mu)
    u = sampling.uniform(hash_of(name, mu), N)
    s = bsdf.sample(lobes, wo, sampling.uniform(hash_of(name, mu) + 1, N)[:, 0], u)
    drawn = s.result == bsdf.SMOOTH
    assert (s.result != bsdf.SPECULAR).all()
    assert (s.wi[drawn, 2] > 0).all()
    assert np.abs((s.wi[drawn].astype(np.float64) ** 2).sum(1) - 1).max() <= 24 * ROUNDING
    counts = histogram(*to_chart(wo, alpha, s.wi[drawn]), *cells.shape)
    observed = np.append(counts.ravel(), N - drawn.sum())
    family.chi_squared(observed, np.append(cells.ravel(), max(0, 1 - cells.sum())) * N, f"{name} at {mu}")

    f, pdf = bsdf.evaluate(lobes, wo, s.wi[drawn])
    assert (pdf > 0).all()
    # The same D stands in f and pdf: their quotient is exact. The sampled density knows h better than wi does, which
    # tells its slope to 2^-24 / (2 mu), in units of alpha; and D goes with its fourth power.
    ratio = relative_error(s.weight[drawn], f.astype(np.float64) / pdf[:, None])
    assert ratio.max() <= 64 * ROUNDING / min(1, mu)
    assert relative_error(s.pdf[drawn], pdf).max() <= 64 * ROUNDING / min(alpha * mu, 1)


def hash_of(name: str, mu: float) -> int:
    return sum(map(ord, name)) * 1000 + round(mu * 100)


@pytest.mark.parametrize(("name", "mu"), SEEN_FROM)
def test_weights_estimate_the_albedo(name: str, mu: float) -> None:
    """The mean of the weights, samples that found nothing included, is the integral of f cos over the hemisphere."""
    lobes, alpha, _, _, f_cos = case(name, mu)
    seed = hash_of(name, mu) + 7
    s = bsdf.sample(lobes, direction(mu), sampling.uniform(seed, N)[:, 0], sampling.uniform(seed + 1, N))
    if len(lobes) == 1 and lobes[0].type == bsdf.LAMBERT:
        assert (s.weight[s.result == bsdf.SMOOTH] == single(lobes[0].color)).all()
        assert f_cos.sum() == pytest.approx(lobes[0].color[0], rel=1e-5)
    else:
        blur = ROUNDING / (2 * mu * alpha)  # of the slope of h in eval, as above; means feel it in second order
        family.mean(s.weight[:, 0], float(f_cos.sum()), f"albedo of {name} at {mu}", 8 * ROUNDING + 8 * blur**2)


@pytest.mark.parametrize("mu", [0.9, 0.5, 0.1])
@pytest.mark.parametrize("alpha", [0.2, 0.6, 1.0])
def test_the_bound_touches_the_horizon(alpha: float, mu: float) -> None:
    """The lowest normals still sampled reflect below the horizon, or in the best azimuth along it: no cap is wasted."""
    azimuths = (np.arange(1 << 14) * 2.0**-14).astype(np.float32)

    def highest(from_the_end: float) -> float:
        u = np.stack([azimuths, np.full(len(azimuths), 1 - from_the_end, np.float32)], axis=1)
        s = bsdf.sample([metal(alpha)], direction(mu), azimuths, u)
        return float(s.wi[:, 2].max())  # 0 where nothing was found

    assert highest(2.0**-24) <= 1e-3
    assert highest(2.0**-7) > 0


# DESIGN 3.1, F = 1, height-correlated Smith.
ALBEDOS = [
    (0.01, 0.1, 0.9941),
    (0.1, 0.1, 0.8835),
    (0.5, 0.5, 0.6983),
    (0.5, 0.05, 0.9125),
    (1, 1, 0.3069),
    (1, 0.01, 0.9538),
]


@pytest.mark.parametrize(("alpha", "mu", "listed"), ALBEDOS)
def test_directional_albedos(alpha: float, mu: float, listed: float) -> None:
    """By quadrature of eval to the last listed digit, and by the sampler's weights."""
    lobes, wo = [metal(alpha)], direction(mu)
    albedo = float(chart_integrals(lobes, wo, alpha)[1].sum())
    assert albedo == pytest.approx(listed, abs=0.5e-4 + 1e-6)
    s = bsdf.sample(lobes, wo, sampling.uniform(1, N)[:, 0], sampling.uniform(2, N))
    family.mean(s.weight[:, 0], albedo, f"albedo at alpha {alpha}, mu {mu}")
    # A property of bounded sampling: no weight exceeds F.
    assert s.weight.max() <= 1 + 8 * ROUNDING


# ---- Symmetry and sums ----


@pytest.mark.parametrize("name", CASES)
def test_reciprocity(name: str) -> None:
    """f(wo, wi) = f(wi, wo) to rounding, for random pairs (and without the cosine that eval brings)."""
    lobes, _ = CASES[name]
    rng = np.random.default_rng(3)
    for _ in range(200):
        wo, wi = (direction(rng.uniform(0.05, 1), rng.random()) for _ in range(2))
        there, back = bsdf.evaluate(lobes, wo, [wi])[0][0] / wi[2], bsdf.evaluate(lobes, wi, [wo])[0][0] / wo[2]
        assert relative_error(there, back).max() <= 32 * ROUNDING


def test_a_mix_is_the_weighted_sum() -> None:
    rng = np.random.default_rng(4)
    wo = direction(0.4)
    wi = np.array([direction(rng.uniform(0.01, 1), rng.random()) for _ in range(100)])
    parts = [lobe.weight * bsdf.evaluate([replace(lobe, weight=1)], wo, wi)[0] for lobe in MIX]
    f, pdf = bsdf.evaluate(MIX, wo, wi)
    assert relative_error(f, np.sum(parts, axis=0)).max() <= 8 * ROUNDING
    select, albedo, specular, has_specular = bsdf.describe(MIX)
    assert select.sum() == pytest.approx(1, abs=4 * ROUNDING)
    pdfs = [p * bsdf.evaluate([lobe], wo, wi)[1] for p, lobe in zip(select, MIX, strict=True)]
    assert relative_error(pdf, np.sum(pdfs, axis=0)).max() <= 8 * ROUNDING
    assert (specular, has_specular) == (False, False)
    assert ((albedo > 0) & (albedo < 1)).all()


def test_specular_lobes_in_a_mix() -> None:
    """Mirror, smooth metal and Lambert: deltas come with weight / probability of selection, drawn that often."""
    mix = [
        Lobe(bsdf.MIRROR, weight=0.25, color=(0.9, 0.8, 0.7)),
        replace(GOLD, weight=0.35, alpha=9e-5),
        Lobe(bsdf.LAMBERT, weight=0.4, color=(0.5, 0.5, 0.5)),
        Lobe(bsdf.MIRROR, weight=0, color=WHITE),
    ]
    select, _, specular, has_specular = bsdf.describe(mix)
    assert select[3] == 0
    assert (specular, has_specular) == (False, True)
    assert bsdf.describe(mix[:2])[2:] == (True, True)
    wo = direction(0.7, 0.3)
    s = bsdf.sample(mix, wo, sampling.uniform(5, N)[:, 0], sampling.uniform(6, N))
    delta = s.result == bsdf.SPECULAR
    assert np.abs(s.wi[delta] - wo * [-1, -1, 1]).max() <= ROUNDING
    metal = fresnel.conductor(0.7, GOLD.eta, GOLD.k)
    mirror = np.abs(s.pdf - select[0]) < ROUNDING
    counts = [(delta & mirror).sum(), (delta & ~mirror).sum(), (s.result == bsdf.SMOOTH).sum()]
    family.chi_squared(counts, select[:3].astype(np.float64) * N, "choice of a lobe")
    for chosen, own, lobe in ((delta & mirror, (0.9, 0.8, 0.7), 0), (delta & ~mirror, metal, 1)):
        expected = np.array(own) * mix[lobe].weight / select[lobe]
        assert relative_error(s.weight[chosen], np.broadcast_to(expected, (chosen.sum(), 3))).max() <= 16 * ROUNDING
    assert np.abs(s.weight[s.result == bsdf.SMOOTH] - 0.5 * 0.4 / select[2]).max() <= 8 * ROUNDING
    f, pdf = bsdf.evaluate(mix, wo, [wo * [-1, -1, 1]])
    assert f[0] == pytest.approx(np.full(3, 0.4 * 0.5 / np.pi * wo[2]), rel=1e-5)
    assert pdf[0] == pytest.approx(select[2] * wo[2] / np.pi, rel=1e-5)


def test_nothing_below_the_surface() -> None:
    for lobes, _ in CASES.values():
        f, pdf = bsdf.evaluate(lobes, direction(0.3), np.array([[0.5, 0.1, -0.86], [1, 0, 0]]))
        assert not f.any()
        assert not pdf.any()


def test_black_and_empty() -> None:
    u = sampling.uniform(7, 100)
    assert (bsdf.sample([], direction(0.5), u[:, 0], u).result == bsdf.NOTHING).all()
    assert bsdf.describe([])[2:] == (True, False)
    black = [Lobe(bsdf.LAMBERT, weight=0.5), Lobe(bsdf.LAMBERT, weight=0.5)]
    assert bsdf.describe(black)[0].tolist() == [0.5, 0.5]
    assert not bsdf.sample(black, direction(0.5), u[:, 0], u).weight.any()


@pytest.mark.parametrize("mu", [1e-4, 1e-7, 1e-20])
def test_grazing_directions_stay_finite(mu: float) -> None:
    """At any cosine of wo, and alpha: finite weights and densities; a white metal reflects at most what arrives."""
    u, u_lobe = sampling.uniform(8, 20_000), sampling.uniform(9, 20_000)[:, 0]
    wo = np.array([1, 0, mu])
    for lobes, _ in CASES.values():
        s = bsdf.sample(lobes, wo, u_lobe, u)
        drawn = s.result == bsdf.SMOOTH
        f, pdf = bsdf.evaluate(lobes, wo, s.wi[drawn])
        for values in (s.weight, s.pdf, f, pdf):
            assert np.isfinite(values).all()
            assert (values >= 0).all()
        if lobes[0].f0 == WHITE and lobes[0].masking == bsdf.SMITH:
            assert s.weight.max() <= 1 + 16 * ROUNDING
