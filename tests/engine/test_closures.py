# SPDX-License-Identifier: GPL-3.0-or-later
"""Lobes that are not reciprocal, or lie on top of others: what facets send on to each other, layers, cloth, and
Disney's diffuse surface. Samplers against densities, weights towards the camera and from lights against evaluations,
furnaces, and the tables of directional albedos against quadrature."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from tests.engine.probe import bsdf, sampling
from tests.engine.probe.bsdf import SMOOTH, TRANSMITTED, Lobe
from tests.engine.probe.call import Array
from tests.engine.significance import ROUNDING, Family, histogram, relative_error
from tests.engine.test_bsdf import direction, turn
from tests.engine.test_transmission import TRANSLUCENT, WHITE, glass, integrals, largest_value, sphere
from tests.render.closed_forms import ggx_albedo

family = Family(size=80)
N = 200_000
BINS = 24

MULTIPLE = Lobe(bsdf.CONDUCTOR, alpha=0.5, f0=(0.9, 0.6, 0.3), flag=1)
DIPPED = Lobe(bsdf.CONDUCTOR, alpha=0.5, f0=(0.9, 0.6, 0.3), f82=(0.2, 0.5, 1.0))
PLASTIC = Lobe(bsdf.CONDUCTOR, alpha=0.4, f0=(0.04, 0.04, 0.04), curve_ior=1.5, flag=1)
FIBERS = Lobe(bsdf.SHEEN, color=(0.9, 0.7, 0.5), alpha=0.6, flag=bsdf.FIBERS)
BRUSHED = Lobe(bsdf.BRUSHED, f0=(0.9, 0.6, 0.3), eta=(0.25, 0.7, 0.1))
LAMBERT = Lobe(bsdf.LAMBERT, color=(0.8, 0.5, 0.2))
LAYERS = [
    replace(FIBERS, weight=0.5, cover=0.5),
    replace(PLASTIC, alpha=0.3, flag=0, above=0b1),
    replace(LAMBERT, above=0b11),
]
CASES: dict[str, tuple[list[Lobe], float]] = {
    "multiple scattering": ([MULTIPLE], 1),
    "edge tint": ([DIPPED], 1),
    "plastic": ([PLASTIC], 1),
    "brushed": ([BRUSHED], 1),
    "brushed, multiple": ([replace(BRUSHED, flag=1)], 1),
    "burley": ([Lobe(bsdf.BURLEY, color=(0.8, 0.5, 0.2), alpha=0.9)], 1),
    "fibers": ([FIBERS], 1),
    "smoother fibers": ([replace(FIBERS, alpha=0.3)], 1),
    "schlick sheen": ([replace(FIBERS, flag=bsdf.SCHLICK_SHEEN)], 1),
    "velvet": ([replace(FIBERS, flag=bsdf.VELVET)], 1),
    "layers": (LAYERS, 1),
    "multiple scattering in glass": ([glass(0.5, eta=(1.5, 1, 1))], 1.5),
    "multiple scattering out of glass": ([glass(0.5, eta=(1.5, 1, 1))], 1 / 1.5),
    "coated glass": ([replace(PLASTIC, alpha=0.4), replace(glass(0.5, eta=(1.5, 1, 1)), above=0b1)], 1.5),
}
RECIPROCAL = ("edge tint", "brushed", "burley", "schlick sheen", "velvet")
SEEN_FROM = [(name, mu) for name in CASES for mu in (0.9, 0.35)]


def seed(name: str, mu: float) -> int:
    return sum(map(ord, name)) * 1000 + round(mu * 100)


@pytest.mark.parametrize(("name", "mu"), SEEN_FROM)
def test_samples_follow_the_pdf(name: str, mu: float) -> None:
    lobes, eta = CASES[name]
    wo = direction(mu)
    cells, f_cos = integrals(lobes, eta, wo, BINS)
    u_lobe, u = sampling.uniform(seed(name, mu), N)[:, 0], sampling.uniform(seed(name, mu) + 1, N)
    s = bsdf.sample(lobes, wo, u_lobe, u, eta)
    drawn = s.result % TRANSMITTED == SMOOTH
    wi = s.wi[drawn].astype(np.float64)
    counts = histogram((wi[:, 2] + 1) / 2, turn(wi), BINS, BINS)
    observed = np.append(counts.ravel(), N - drawn.sum())
    family.chi_squared(observed, np.append(cells.ravel(), max(0, 1 - cells.sum())) * N, f"{name} at {mu}")
    f, pdf = bsdf.evaluate(lobes, wo, s.wi[drawn], eta)
    near = np.abs(wi[:, 2]) < 0.05
    near |= (f < 1e-4 * f.max()).any(axis=1)  # where velvet is as good as black, by an exponential
    assert relative_error(s.weight[drawn], f.astype(np.float64) / pdf[:, None])[~near].max() <= 3e-4
    family.mean(s.weight[:, 0], float(f_cos.sum()), f"albedo of {name} at {mu}", 1e-4)


@cache
def grid() -> tuple[Array, float]:
    """Directions, and the solid angle of each."""
    rows, columns = 64, 32
    z, phi = np.meshgrid((np.arange(rows) + 0.5) / rows, (np.arange(columns) + 0.5) / columns, indexing="ij")
    return sphere(z.ravel(), phi.ravel()), 4 * np.pi / (rows * columns)


# What refracts: of it f is not the same from both sides. With what passes light whatever the index beside it, too.
BOUNDARIES: dict[str, tuple[list[Lobe], float]] = {
    "into glass": ([glass(0.5)], 1.5),
    "out of glass": ([glass(0.5)], 1 / 1.5),
    "milk": ([glass(0.5, weight=0.5), replace(TRANSLUCENT, weight=0.5)], 1.5),
}


@pytest.mark.parametrize("name", [*(name for name in CASES if name not in (*RECIPROCAL, "plastic")), *BOUNDARIES])
def test_weights_from_lights(name: str) -> None:
    """Light that comes from one direction leaves by f as it is seen from each of the others, not as it is sampled."""
    lobes, eta = (CASES | BOUNDARIES)[name]
    incoming, mu = direction(0.5), 0.5
    u_lobe, u = sampling.uniform(seed(name, mu) + 2, N)[:, 0], sampling.uniform(seed(name, mu) + 3, N)
    weights = bsdf.adjoint_weights(lobes, incoming, u_lobe, u, eta)[:, 0]
    directions, solid_angle = grid()
    total = 0.0
    for out in directions:
        flip = np.array([1, 1, np.sign(out[2])])
        seen = bsdf.evaluate(lobes, out * flip, [incoming * flip], eta if out[2] > 0 else 1 / eta)[0][0, 0]
        total += float(seen) / mu * abs(out[2]) * solid_angle
    family.mean(weights, total, f"light from {name}", 2e-3)
    forth = bsdf.sample(lobes, incoming, u_lobe, u, eta).weight[:, 0]
    assert np.abs(weights - forth).sum() > 5e-3 * forth.sum(), "it is as good as reciprocal, and tests nothing"


@pytest.mark.parametrize("name", RECIPROCAL)
def test_reciprocity(name: str) -> None:
    lobes, _ = CASES[name]
    rng = np.random.default_rng(3)
    for _ in range(200):
        wo, wi = (direction(rng.uniform(0.05, 1), rng.random()) for _ in range(2))
        there, back = bsdf.evaluate(lobes, wo, [wi])[0][0] / wi[2], bsdf.evaluate(lobes, wi, [wo])[0][0] / wo[2]
        assert not there.any() or relative_error(there, back).max() <= 1e-4


# ---- Furnaces ----


@pytest.mark.parametrize("mu", [1.0, 0.7, 0.3, 0.1])
@pytest.mark.parametrize("alpha", [0.1, 0.3, 0.6, 1.0])
def test_white_facets_that_send_light_on_lose_none(alpha: float, mu: float) -> None:
    u_lobe, u = sampling.uniform(1, 50_000)[:, 0], sampling.uniform(2, 50_000)
    white = [Lobe(bsdf.CONDUCTOR, alpha=alpha, f0=WHITE, flag=1)]
    assert bsdf.sample(white, direction(mu), u_lobe, u).weight[:, 0].mean() == pytest.approx(1, abs=0.01)
    for eta in (1.5, 1 / 1.5):
        body = [glass(alpha, eta=(1.5, 1, 1))]
        assert bsdf.sample(body, direction(mu), u_lobe, u, eta).weight[:, 0].mean() == pytest.approx(1, abs=0.015)


def test_colours_of_light_that_is_sent_on() -> None:
    """Each time that a facet sends it on it takes the facet's colour: darker than the single lobe scaled up."""
    grey = Lobe(bsdf.CONDUCTOR, alpha=1, f0=(0.5, 0.5, 0.5), flag=1)
    once, again = (integrals([replace(grey, flag=flag)], 1, direction(0.8), 8)[1].sum() for flag in (0, 1))
    # F = Schlick's from .5 to 1, .5238 in the mean: F E_avg / (1 - F (1 - E_avg)) of what is missing is added.
    mean = float(bsdf.table(bsdf.MEAN_GGX, 0, 1)[0])
    albedo = float(bsdf.table(bsdf.GGX, 0.8, 1)[0])
    fresnel = 0.5 + 0.5 / 21
    assert again / once == pytest.approx(
        1 + fresnel * mean / (1 - fresnel * (1 - mean)) * (1 - albedo) / albedo, rel=1e-3
    )


@pytest.mark.parametrize("alpha", [0.05, 0.3, 0.9])
@pytest.mark.parametrize("ior", [1.1, 1.5, 2.5])
def test_a_white_base_under_plastic_is_white(alpha: float, ior: float) -> None:
    """What the layer reflects is what it takes from the base: seen from anywhere all light comes back."""
    f0 = ((ior - 1) / (ior + 1)) ** 2
    lobes = [replace(PLASTIC, alpha=alpha, f0=(f0,) * 3, curve_ior=ior), replace(LAMBERT, color=WHITE, above=0b1)]
    u_lobe, u = sampling.uniform(3, 50_000)[:, 0], sampling.uniform(4, 50_000)
    for mu in (1.0, 0.5, 0.2, 0.05):
        assert bsdf.sample(lobes, direction(mu), u_lobe, u).weight[:, 0].mean() == pytest.approx(1, abs=0.01)


@pytest.mark.parametrize("mu", [1.0, 0.5, 0.1])
def test_a_smooth_layer_takes_what_it_reflects(mu: float) -> None:
    """Exact: a mirror above, whose reflectance at an angle is what Lambert's lobe beneath does not get."""
    lobes = [
        Lobe(bsdf.CONDUCTOR, alpha=0, f0=(0.04,) * 3, curve_ior=1.5, weight=0.25, cover=0.25),
        replace(LAMBERT, color=WHITE, above=0b1),
    ]
    u_lobe, u = sampling.uniform(5, N)[:, 0], sampling.uniform(6, N)
    family.mean(bsdf.sample(lobes, direction(mu), u_lobe, u).weight[:, 0], 1, f"under a mirror at {mu}", 1e-5)


# ---- Tables and curves ----


def test_tables_are_the_integrals() -> None:
    rng = np.random.default_rng(1)
    for alpha, mu in rng.uniform((0.02, 0.03), (1, 1), (40, 2)):
        assert float(bsdf.table(bsdf.GGX, mu, alpha)[0]) == pytest.approx(ggx_albedo(mu, alpha), abs=5e-3)
    mus, weights = np.polynomial.legendre.leggauss(40)
    for alpha in (0.1, 0.5, 1.0):
        albedos = np.array([ggx_albedo(float(mu), alpha) for mu in (mus + 1) / 2])
        mean = float((albedos * (mus + 1) / 2 * weights).sum())
        assert float(bsdf.table(bsdf.MEAN_GGX, 0, alpha)[0]) == pytest.approx(mean, abs=5e-3)


@pytest.mark.parametrize("ior", [1.2, 1.5, 2.4])
@pytest.mark.parametrize("alpha", [0.2, 0.7])
def test_the_rise_of_reflectance_is_the_lobes_own(alpha: float, ior: float) -> None:
    black = Lobe(bsdf.CONDUCTOR, alpha=alpha, f0=(0, 0, 0), curve_ior=ior)
    for mu in (0.95, 0.5, 0.2):
        rise = float(bsdf.table(bsdf.FRESNEL_RISE, mu, alpha, ior)[0])
        own = integrals([black], 1, direction(mu), 8)[1].sum() / ggx_albedo(mu, alpha)
        assert rise == pytest.approx(own, abs=0.01 + 0.02 * rise)


def test_edge_tint_is_what_it_says() -> None:
    """Schlick's curve times the tint where the cosine is 1/7, and untouched at normal incidence and at grazing."""
    smooth = replace(DIPPED, alpha=0)
    for mu, factor in ((1.0, 1.0), (1 / 7, 0.2), (1e-5, 1.0)):
        s = bsdf.sample([smooth], direction(mu), np.zeros(1, np.float32), np.zeros((1, 2), np.float32))
        schlick = 0.9 + 0.1 * (1 - mu) ** 5
        assert s.weight[0, 0] == pytest.approx(schlick * factor, rel=1e-3 if mu < 0.01 else 1e-5)


@pytest.mark.parametrize("name", ["multiple scattering", "brushed", "burley", "schlick sheen"])
def test_bounds_hold(name: str) -> None:
    lobes, eta = CASES[name]
    bound = bsdf.max_value(lobes)
    assert 0.05 * bound <= largest_value(lobes, eta) <= bound * (1 + 1e-5)


def test_fibers_are_dark_from_above_and_bright_at_grazing() -> None:
    """The lobe's integral is the fit of its albedo, and no cosine's lobe gains light by being transformed."""
    for roughness in (0.2, 0.5, 1.0):
        lobe = replace(FIBERS, color=WHITE, alpha=roughness)
        seen = [integrals([lobe], 1, direction(mu), 12)[1].sum() for mu in (1.0, 0.3, 0.05)]
        assert seen[0] < seen[1] < seen[2] <= 1 + 16 * ROUNDING
        pdf = integrals([lobe], 1, direction(0.3), 12)[0].sum()
        assert pdf == pytest.approx(1, abs=2e-3)
