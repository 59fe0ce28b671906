# SPDX-License-Identifier: GPL-3.0-or-later
"""Fresnel reflectance, GGX's density and smooth glass against complex float64 and mpmath."""

import mpmath
import numpy as np
import pytest

from tests.engine.probe import fresnel, sampling
from tests.engine.probe.call import Array
from tests.engine.significance import ROUNDING, Family, double, relative_error, single

family = Family(size=4)
COSINES = single([1, 0.999, 0.9, 0.7, 0.5, 0.3, 0.1, 0.03, 1e-2, 1e-3, 1e-5, 1e-8, 0])


def exact_fresnel(cos_i: Array, n: Array) -> Array:
    """The textbook equations with a complex index, in 40 digits."""
    mpmath.mp.dps = 40
    out = []
    for c, index in np.broadcast(cos_i, n):
        cosine, m = mpmath.mpf(float(c)), mpmath.mpc(complex(index))
        root = mpmath.sqrt(m**2 - (1 - cosine**2))
        if cosine == 0 or (root == 0 and m == 1):
            out.append(mpmath.mpf(0 if m == 1 else 1))
            continue
        r_s = (cosine - root) / (cosine + root)
        r_p = (m**2 * cosine - root) / (m**2 * cosine + root)
        out.append((abs(r_s) ** 2 + abs(r_p) ** 2) / 2)
    return np.array([float(r) for r in out])


METALS = [
    (0.143, 3.983),
    (0.375, 2.386),
    (1.442, 1.603),
    (2.6, 3.3),
    (0.05, 0.01),
    (10, 0),
    (1.5, 0),
    (0.7, 1e-4),
    (0.2, 20),
]


@pytest.mark.parametrize(("eta", "k"), METALS)
def test_conductor(eta: float, k: float) -> None:
    n = double(single(eta)) + 1j * double(single(k))
    got = fresnel.conductor(COSINES, eta, k)
    assert np.abs(got - exact_fresnel(COSINES, n)).max() <= 16 * ROUNDING
    assert got[-1] == 1


def test_conductor_at_its_limits() -> None:
    """An index that leaves nothing behind, total reflection from k = 0, and the critical angle: finite, in [0, 1]."""
    grid = np.array([(c, e, k) for c in COSINES for e in (1e-6, 0.5, 1, 1.0001, 50) for k in (0, 1e-10, 1e-3, 1e4)])
    got = fresnel.conductor(*grid.T)
    assert np.isfinite(got).all()
    assert ((got >= 0) & (got <= 1 + 4 * ROUNDING)).all()
    assert fresnel.conductor(0.5, 0.5, 0)[0] == 1
    assert fresnel.conductor(0.5, 1, 0)[0] <= ROUNDING


@pytest.mark.parametrize("eta", [1.5, 1 / 1.5, 1.33, 2.4, 1 / 2.4, 10, 0.1, 1.01, 1.0001, 0.9999, 1.000001, 1])
def test_dielectric(eta: float) -> None:
    """To a few roundings of the reflectance itself: at 1.0001 it is 2.5e-9, and the textbook form has no digit left."""
    n = double(single(eta))
    # Not within a rounding of the critical angle, where the reflectance has a vertical tangent.
    cosines = COSINES[np.abs(double(COSINES) ** 2 + n * n - 1) > 1e-6 * (n != 1)]
    got, exact = fresnel.dielectric(cosines, eta), exact_fresnel(cosines, n)
    assert np.abs(got - exact).max() <= 16 * ROUNDING
    if n == 1:
        assert not got.any()
        return
    assert got[cosines == 0].tolist() == [1] * int((cosines == 0).sum())
    assert (got[double(cosines) ** 2 <= 1 - n * n] == 1).all()
    # Relative to R_s / 2, for R_p alone passes through 0.
    partial = double(cosines) ** 2 > 1 - n * n
    assert relative_error(got[partial], exact[partial]).max() <= 64 * ROUNDING


def test_schlick() -> None:
    f0 = 0.3
    expected = f0 + (1 - f0) * (1 - double(COSINES)) ** 5
    assert relative_error(fresnel.schlick(COSINES, f0), expected).max() <= 8 * ROUNDING
    falling = f0 + (0.1 - f0) * (1 - double(COSINES)) ** 5
    assert relative_error(fresnel.schlick(COSINES, f0, 0.1), falling).max() <= 16 * ROUNDING
    assert (fresnel.schlick(COSINES, f0, f0) == single(f0)).all()
    for eta in (1.5, 1.0001, 10):
        r0 = ((double(single(eta)) - 1) / (double(single(eta)) + 1)) ** 2
        assert fresnel.dielectric_schlick(1, eta)[0] == pytest.approx(r0, rel=1e-6)
        assert fresnel.dielectric_schlick(0, eta)[0] == 1
    # From within: continuous into total reflection.
    critical = np.sqrt(1 - 1 / 1.5**2)
    below, above = fresnel.dielectric_schlick([critical - 1e-4, critical + 1e-6], 1 / 1.5)
    assert below == 1
    assert above > 0.97


@pytest.mark.parametrize("alpha", [1.0, 0.1, 1e-2, 1e-3, 1e-4])
def test_ggx_density_of_normals(alpha: float) -> None:
    """DESIGN's hazard: c^2 (alpha^2 - 1) + 1 in float32 is 3.4 % off at 1e-3 and infinite at 1e-4."""
    mpmath.mp.dps = 40
    a = mpmath.mpf(float(np.float32(alpha)))
    tangents = np.array([0, 0.01, 0.3, 1, 3, 10, 100]) * alpha
    h = single([(t / np.sqrt(1 + t * t) * 0.6, t / np.sqrt(1 + t * t) * 0.8, 1 / np.sqrt(1 + t * t)) for t in tangents])
    for normal, got in zip(h, fresnel.ggx_d(h, alpha), strict=True):
        x, y, z = (mpmath.mpf(float(v)) for v in normal)
        exact = a**2 / (mpmath.pi * (a**2 * z**2 + x**2 + y**2) ** 2)
        assert abs((float(got) - exact) / exact) <= 12 * ROUNDING


# ---- Glass ----

INDICES = (0.1, 1 / 1.5, 0.9999, 1, 1.0001, 1.33, 1.5, 10)


def incident(cosines: Array) -> Array:
    sines = np.sqrt((1 - cosines) * (1 + cosines))
    return np.stack([0.6 * sines, -0.8 * sines, cosines], axis=1).astype(np.float32)


@pytest.mark.parametrize("schlick", [False, True])
@pytest.mark.parametrize("eta", INDICES)
def test_glass_reflects_and_refracts(eta: float, schlick: bool) -> None:
    wo = incident(double(COSINES))
    n = double(single(eta))
    reflectance = (fresnel.dielectric_schlick if schlick else fresnel.dielectric)(COSINES, eta)
    up, down = fresnel.glass(wo, eta, 0, schlick), fresnel.glass(wo, eta, 1 - 2.0**-24, schlick)
    for s in (up, down):
        assert all(np.isfinite(v).all() for v in s)
        chosen = np.where(s.transmitted == 1, 1 - reflectance, reflectance)
        assert np.abs(s.probability - chosen).max() <= ROUNDING
        assert (s.probability > 0).all()
    reflected = up.transmitted == 0
    assert (reflected == (reflectance > 0)).all()
    assert (up.wi[reflected] == wo[reflected] * [-1, -1, 1]).all()
    assert (up.weight[reflected] == 1).all()
    through = down.transmitted == 1
    # The last number below 1 is transmitted unless reflection is total to a rounding.
    assert through[reflectance < 1 - 2.0**-23].all()
    assert not through[reflectance == 1].any()
    wi = down.wi[through].astype(np.float64)
    assert np.abs(wi[:, :2] + wo[through, :2] / n).max(initial=0) <= 2 * ROUNDING / min(eta, 1)  # Snell
    assert np.abs((wi**2).sum(1) - 1).max(initial=0) <= 8 * ROUNDING / min(eta, 1) ** 2
    assert (wi[COSINES[through] > 0, 2] < 0).all()
    assert (down.weight[through] == 1).all()  # of radiance / n^2


def test_equal_indices_do_nothing() -> None:
    wo = incident(double(COSINES))
    s = fresnel.glass(wo, 1, 0)
    assert s.transmitted.all()
    assert np.abs(s.wi + wo).max() <= ROUNDING
    assert (s.weight == 1).all()


@pytest.mark.parametrize("eta", [1.0001, 1.33, 1.5, 10])
def test_refraction_reverses(eta: float) -> None:
    """Back through the same boundary: the old direction and the same probability."""
    wo = incident(np.linspace(0.05, 1, 200))
    into = fresnel.glass(wo, eta, 1 - 2.0**-24)
    back = fresnel.glass(into.wi * [1, 1, -1], single(1) / single(eta), 1 - 2.0**-24)
    assert into.transmitted.all()
    assert back.transmitted.all()
    # cos_t of the way back has the condition eta^2 / cos.
    assert np.abs(-back.wi[:, 2] - wo[:, 2]).max() <= 8 * ROUNDING * eta**2 / 0.05
    assert np.abs(back.probability - into.probability).max() <= 64 * ROUNDING * eta**2


@pytest.mark.parametrize("cosine", [1.0, 0.4, 0.05])
@pytest.mark.parametrize("eta", [1.5, 1 / 1.5])
def test_choice_follows_fresnel(eta: float, cosine: float) -> None:
    """A furnace of the same radiance / n^2 on each side sends that back; the reflected share is Fresnel's."""
    n = 100_000
    u = sampling.uniform(7, n)[:, 0]
    s = fresnel.glass(np.broadcast_to(incident(np.array([cosine])), (n, 3)), eta, u)
    assert (s.weight == 1).all()
    exact = exact_fresnel(single([cosine]), double(single([eta])))[0]
    if exact == pytest.approx(1):
        assert not s.transmitted.any()
    else:
        family.mean(1 - s.transmitted, exact, f"reflection at {cosine} into {eta}")
