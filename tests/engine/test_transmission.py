# SPDX-License-Identifier: GPL-3.0-or-later
"""Lobes that pass light to the other side of a surface, and rough diffuse reflection: samplers against densities over
the whole sphere of directions, weights against evaluations, furnaces, reciprocity, bounds."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from tests.engine.probe import bsdf, sampling
from tests.engine.probe.bsdf import SMOOTH, TRANSMITTED, Lobe
from tests.engine.probe.call import Array
from tests.engine.significance import ROUNDING, Family, bin_integrals, histogram, relative_error
from tests.engine.test_bsdf import direction, turn

family = Family(size=200)
N = 200_000
BINS = 24
WHITE = (1.0, 1.0, 1.0)


def glass(alpha: float, **parts: Any) -> Lobe:
    return replace(Lobe(bsdf.DIELECTRIC, alpha=alpha, color=WHITE, f0=WHITE, eta=(1.5, 1, 0)), **parts)


ROUGH_DIFFUSE = Lobe(bsdf.OREN_NAYAR, color=(0.8, 0.5, 0.2), alpha=0.7)
TRANSLUCENT = Lobe(bsdf.TRANSLUCENT, color=(0.7, 0.5, 0.3))
CASES: dict[str, tuple[list[Lobe], float]] = {
    **{f"into glass {a}": ([glass(a)], 1.5) for a in (0.25, 0.5, 1.0)},
    **{f"out of glass {a}": ([glass(a)], 1 / 1.5) for a in (0.25, 0.5, 1.0)},
    "coloured": ([glass(0.5, color=(0.9, 0.6, 0.3), f0=(0.3, 0.6, 0.9))], 1.5),
    "refraction alone": ([glass(0.5, eta=(1.5, 0, 0))], 1 / 1.5),
    "schlick": ([glass(0.5, flag=1)], 1.33),
    "translucent": ([TRANSLUCENT], 1),
    "rough diffuse": ([ROUGH_DIFFUSE], 1),
    "rough diffuse, multiple": ([replace(ROUGH_DIFFUSE, flag=1)], 1),
    "mix": (
        [
            glass(0.4, weight=0.4),
            Lobe(bsdf.LAMBERT, weight=0.3, color=(0.5, 0.4, 0.3)),
            replace(TRANSLUCENT, weight=0.2),
            replace(ROUGH_DIFFUSE, weight=0.1),
        ],
        1.5,
    ),
}
SEEN_FROM = [(name, mu) for name in CASES for mu in (1.0, 0.6, 0.15)]


def sphere(z: Array, phi: Array) -> Array:
    """Directions by their place in the unit square: z from -1 to 1 and the turn, both uniform in solid angle."""
    cosine = 2 * z - 1
    r = np.sqrt((1 - cosine) * (1 + cosine))
    return np.stack([r * np.cos(2 * np.pi * phi), r * np.sin(2 * np.pi * phi), cosine], axis=1)


def integrals(lobes: list[Lobe], eta: float, wo: Array, bins: int = BINS) -> tuple[Array, Array]:
    """Over each cell of the sphere: of the pdf, and of f |cos| (channel 0)."""

    def density(z: Array, phi: Array) -> Array:
        f, pdf = bsdf.evaluate(lobes, wo, sphere(z, phi), eta)
        return np.stack([pdf, f[:, 0]], axis=1) * 4 * np.pi

    cells = bin_integrals(density, bins, bins, (40, 40))
    return cells[..., 0], cells[..., 1]


def seed(name: str, mu: float) -> int:
    return sum(map(ord, name)) * 1000 + round(mu * 100)


@pytest.mark.parametrize(("name", "mu"), SEEN_FROM)
def test_samples_follow_the_pdf(name: str, mu: float) -> None:
    """Chi-squared over the sphere, nothing being one more bin; the weight of a sample is eval / pdf, and the mean of
    the weights is the integral of f |cos|."""
    lobes, eta = CASES[name]
    wo = direction(mu)
    cells, f_cos = integrals(lobes, eta, wo)
    s = bsdf.sample(lobes, wo, sampling.uniform(seed(name, mu), N)[:, 0], sampling.uniform(seed(name, mu) + 1, N), eta)
    drawn = s.result % TRANSMITTED == SMOOTH
    assert (drawn | (s.result == bsdf.NOTHING)).all()
    wi = s.wi[drawn].astype(np.float64)
    assert ((wi[:, 2] < 0) == (s.result[drawn] >= TRANSMITTED)).all()
    assert np.abs((wi**2).sum(1) - 1).max() <= 32 * ROUNDING
    counts = histogram((wi[:, 2] + 1) / 2, turn(wi), BINS, BINS)
    observed = np.append(counts.ravel(), N - drawn.sum())
    family.chi_squared(observed, np.append(cells.ravel(), max(0, 1 - cells.sum())) * N, f"{name} at {mu}")
    f, pdf = bsdf.evaluate(lobes, wo, s.wi[drawn], eta)
    # A refracted direction tells its normal to a few roundings over |eta - 1| alpha and its own cosine.
    near = np.abs(wi[:, 2]) < 0.05
    assert relative_error(s.weight[drawn], f.astype(np.float64) / pdf[:, None])[~near].max() <= 2e-4
    error = relative_error(s.pdf[drawn], pdf)[~near]
    assert np.quantile(error, 0.999) <= 1e-4
    assert error.max() <= 1e-2  # at the critical angle
    family.mean(s.weight[:, 0], float(f_cos.sum()), f"albedo of {name} at {mu}", 1e-4)


@pytest.mark.parametrize("eta", [1.33, 1.5, 1 / 1.5])
@pytest.mark.parametrize("alpha", [0.01, 0.1, 0.3, 0.6, 1.0])
def test_white_glass_gains_nothing(alpha: float, eta: float) -> None:
    """From grazing to normal: no weight above 1, and rough glass loses no more than single scattering must."""
    for mu in (1.0, 0.7, 0.4, 0.1, 0.01):
        u, u_lobe = sampling.uniform(5, 50_000), sampling.uniform(6, 50_000)[:, 0]
        s = bsdf.sample([glass(alpha)], direction(mu), u_lobe, u, eta)
        assert s.weight.max() <= 1 + 16 * ROUNDING
        if mu >= 0.1:
            assert s.weight[:, 0].mean() > 1 - 2.5 * alpha


@pytest.mark.parametrize("name", CASES)
def test_reciprocity(name: str) -> None:
    """f / |cos_i| from above is that from below times eta^2 where light passes, and the same where it is reflected."""
    lobes, eta = CASES[name]
    flip = np.array([1, 1, -1])
    rng = np.random.default_rng(3)
    seen = 0
    for _ in range(400):
        wo = direction(rng.uniform(0.05, 1), rng.random())
        wi = direction(rng.uniform(0.05, 1), rng.random()) * [1, 1, rng.choice([-1, 1])]
        there = bsdf.evaluate(lobes, wo, [wi], eta)[0][0] / abs(wi[2])
        if wi[2] > 0:
            back = bsdf.evaluate(lobes, wi, [wo], eta)[0][0] / wo[2]
        else:
            back = eta**2 * bsdf.evaluate(lobes, wi * flip, [wo * flip], 1 / eta)[0][0] / wo[2]
            if name in ("mix",):  # Lambert's lobe on the other side knows no eta: a surface of both is not physical
                continue
        seen += there.any()
        if there.max() > 1e-4:
            assert relative_error(there, back).max() <= 2e-3
    assert seen > 30


def largest_value(lobes: list[Lobe], eta: float) -> float:
    """The largest f |cos theta_o| of many pairs of directions, which bsdf.max_value must bound."""
    largest = 0.0
    for mu in (1.0, 0.7, 0.4, 0.1, 0.01):
        wi = sphere(*np.random.default_rng(1).random((2, 20_000)))
        f = bsdf.evaluate(lobes, direction(mu), wi, eta)[0] / np.abs(wi[:, 2:])
        largest = max(largest, float(f.max()) * mu)
    return largest


@pytest.mark.parametrize("name", ["translucent", "rough diffuse", "rough diffuse, multiple"])
def test_bounds_hold(name: str) -> None:
    lobes, eta = CASES[name]
    bound = bsdf.max_value(lobes)
    assert 0.3 * bound <= largest_value(lobes, eta) <= bound * (1 + 1e-5)


def test_rough_diffuse_multiple_scattering_is_white() -> None:
    """White facets that send on what they get lose nothing, whatever their roughness."""
    for roughness in (0.0, 0.3, 1.0):
        lobe = Lobe(bsdf.OREN_NAYAR, color=WHITE, alpha=roughness, flag=1)
        for mu in (1.0, 0.5, 0.05):
            assert integrals([lobe], 1, direction(mu), 8)[1].sum() == pytest.approx(1, abs=2e-3)


def test_no_roughness_is_lambert() -> None:
    z, phi = np.random.default_rng(1).random((2, 100))
    wi = sphere(0.5 + z / 2, phi)
    smooth, lambert = Lobe(bsdf.OREN_NAYAR, color=(0.8, 0.5, 0.2)), Lobe(bsdf.LAMBERT, color=(0.8, 0.5, 0.2))
    for a, b in zip(
        bsdf.evaluate([smooth], direction(0.4), wi), bsdf.evaluate([lambert], direction(0.4), wi), strict=True
    ):
        assert relative_error(a, b).max() <= 8 * ROUNDING


def test_equal_indices_bend_nothing() -> None:
    u = sampling.uniform(8, 1000)
    wo = direction(0.3)
    s = bsdf.sample([glass(0.5)], wo, u[:, 0], u, 1)
    assert (s.result == bsdf.SPECULAR + TRANSMITTED).all()
    assert np.abs(s.wi + wo).max() <= 8 * ROUNDING
    assert (s.weight == 1).all()


@pytest.mark.parametrize("mu", [1e-4, 1e-7, 1e-20])
def test_grazing_directions_stay_finite(mu: float) -> None:
    u, u_lobe = sampling.uniform(8, 20_000), sampling.uniform(9, 20_000)[:, 0]
    wo = np.array([1, 0, mu])
    for lobes, eta in CASES.values():
        s = bsdf.sample(lobes, wo, u_lobe, u, eta)
        f, pdf = bsdf.evaluate(lobes, wo, s.wi[s.result != bsdf.NOTHING], eta)
        for values in (s.weight, s.pdf, f, pdf):
            assert np.isfinite(values).all()
            assert (values >= 0).all()
