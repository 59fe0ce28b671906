# SPDX-License-Identifier: GPL-3.0-or-later
"""What the cases expect beyond tests/render/closed_forms.py: each formula derived twice, the second way only to check
the first (test_formulas.py). float64 or mpmath, nothing shared with the engine."""

from functools import cache
from typing import Any

import mpmath
import numpy as np
from numpy.typing import NDArray
from scipy import integrate

from tests.render.closed_forms import gauss, ggx_albedo, henyey_greenstein

Array = NDArray[Any]
PI = np.pi


# ---- Surfaces ------------------------------------------------------------------------------------------------------


def integrating_sphere(albedo: float, ratio: float) -> float:
    """Radiance of the wall of a sphere around a black ball of radiance 1, at its centre and `ratio` as wide: the ball
    takes ratio^2 of what leaves the wall."""
    return albedo * ratio**2 / (1 - albedo * (1 - ratio**2))


def integrating_sphere_walk(albedo: float, ratio: float, walks: int, seed: int = 1) -> tuple[float, float]:
    """The same and its standard error, by walks from the wall: each bounce is cosine-distributed, and seen from a
    sphere's inside that is a uniform point of it; the chord to it meets the ball where it passes near the centre."""
    rng = np.random.default_rng(seed)
    alive, total, weight = np.ones(walks, bool), np.zeros(walks), np.ones(walks)
    for _ in range(100_000):
        if not alive.any():
            break
        n = int(alive.sum())
        weight[alive] *= albedo
        # Cosine-distributed: sin^2 of the angle to the normal, which points at the centre, is uniform.
        hits = rng.random(n) < ratio**2
        index = np.flatnonzero(alive)
        total[index[hits]] = weight[index[hits]]
        alive[index[hits]] = False
        # Analogue absorption at the wall.
        weight[alive] = 1
        dead = rng.random(int(alive.sum())) >= albedo
        alive[np.flatnonzero(alive)[dead]] = False
    return float(total.mean()), float(total.std() / np.sqrt(walks))


def slab_transmission(reflectance: float) -> float:
    """Of a slab of glass, all reflections inside it: the sum of (1 - R)^2 R^(2 k)."""
    return (1 - reflectance) / (1 + reflectance)


def slab_transmission_series(reflectance: float) -> float:
    r = mpmath.mpf(reflectance)
    return float(mpmath.nsum(lambda k: (1 - r) ** 2 * r ** (2 * k), [0, mpmath.inf]))


def fresnel_exact(cos_i: float, ior: float) -> float:
    """Reflectance of a dielectric from outside, with 30 digits: from the angles (Fresnel's sine and tangent laws)."""
    with mpmath.workdps(30):
        i = mpmath.acos(cos_i)
        t = mpmath.asin(mpmath.sin(i) / ior)
        s = mpmath.sin(i - t) / mpmath.sin(i + t)
        p = mpmath.tan(i - t) / mpmath.tan(i + t)
        return float((s * s + p * p) / 2)


def fresnel_at_shell(b: float, radius: float, before: float, beyond: float) -> float:
    """Reflectance of a sphere between two indices for light of the invariant b = n r sin(angle) (Bouguer)."""
    i, t = (np.sqrt(1 - (b / (n * radius)) ** 2) for n in (before, beyond))
    s = (before * i - beyond * t) / (before * i + beyond * t)
    p = (beyond * i - before * t) / (beyond * i + before * t)
    return float((s * s + p * p) / 2)


def radiance_in_nested_balls(outer: float, inner: float, samples: int, seed: int = 1) -> tuple[float, float]:
    """In the middle of a ball of radius 1 and index `inner` within one of radius 3 and index `outer`, under a sky of 1,
    and its standard error: photons are followed from outside, which know flux alone and nothing of n^2. (The engine's
    own radiance, which refraction keeps, is this over inner^2.) Fluence is the
    length of their ways through a small ball over its volume."""
    rng = np.random.default_rng(seed)
    widest = outer  # what comes in with a larger b never reaches the inner ball
    small = 0.7 * outer / inner  # light comes from everywhere there
    power = PI * 4 * PI * 3**2 * (widest / 3) ** 2  # b^2 is uniform
    lengths = np.zeros(samples)
    for k in range(samples):
        b = widest * np.sqrt((k + rng.random()) / samples)
        at_outer, at_inner = fresnel_at_shell(b, 3, 1, outer), fresnel_at_shell(b, 1, outer, inner)
        chord = 2 * np.sqrt(max(small**2 - (b / inner) ** 2, 0.0))
        if rng.random() < at_outer:
            continue
        within = False  # on the way from the outer surface to the inner
        while True:
            if within:
                lengths[k] += chord
                within = rng.random() < at_inner
            elif rng.random() >= at_inner:
                within = True
                continue
            if not within and rng.random() >= at_outer:  # back at the outer surface, and out
                break
    values = lengths * power / (4 / 3 * PI * small**3) / (4 * PI)
    return float(values.mean()), float(values.std() / np.sqrt(samples))


def ggx_albedo_walk(mu: float, alpha: float, samples: int, seed: int = 1) -> tuple[float, float]:
    """Directional albedo of GGX at F = 1 and its standard error, by visible normals (Heitz 2018) in float64 and the
    masking of what leaves, height-correlated."""
    rng = np.random.default_rng(seed)
    i = np.array([np.sqrt(1 - mu * mu), 0, mu])
    v = np.array([alpha * i[0], 0, i[2]])
    v /= np.linalg.norm(v)
    t1 = np.array([0.0, 1, 0])
    t2 = np.cross(v, t1)
    r, phi = np.sqrt(rng.random(samples)), 2 * PI * rng.random(samples)
    p1, p2 = r * np.cos(phi), r * np.sin(phi)
    s = 0.5 * (1 + v[2])
    p2 = (1 - s) * np.sqrt(1 - p1**2) + s * p2
    n = p1[:, None] * t1 + p2[:, None] * t2 + np.sqrt(np.maximum(0, 1 - p1**2 - p2**2))[:, None] * v
    h = np.stack([alpha * n[:, 0], alpha * n[:, 1], np.maximum(0, n[:, 2])], axis=1)
    h /= np.linalg.norm(h, axis=1, keepdims=True)
    o = 2 * (h @ i)[:, None] * h - i

    def lam(c: Array) -> Array:
        return (np.sqrt(1 + alpha**2 * (1 - c * c) / (c * c)) - 1) / 2

    up = o[:, 2] > 0
    weight = np.zeros(samples)
    li = float(lam(np.array(mu)))
    weight[up] = (1 + li) / (1 + li + lam(o[up, 2]))
    return float(weight.mean()), float(weight.std() / np.sqrt(samples))


@cache
def metal_loss(alpha: float) -> float:
    """Of uniform light, what single reflection by GGX of that alpha and F = 1 loses: 2 int (1 - albedo(mu)) mu dmu."""
    mu, w = gauss(0, 1, 24)
    return float(2 * sum(w * mu * (1 - np.array([ggx_albedo(float(m), alpha) for m in mu]))))


# ---- Fog -----------------------------------------------------------------------------------------------------------


@cache
def h_function(c: float, mu: float) -> float:
    """Chandrasekhar's H for isotropic scattering in closed form (Hopf 1934, Busbridge 1960):
    ln H(mu) = -mu/pi int_0^(pi/2) ln(1 - c t cot t) / (cos^2 t + mu^2 sin^2 t) dt."""

    def integrand(t: float) -> float:
        cot = t / np.tan(t) if t > 1e-8 else 1.0
        return float(np.log1p(-c * cot) / (np.cos(t) ** 2 + mu**2 * np.sin(t) ** 2))

    value = integrate.quad(integrand, 0, PI / 2, epsabs=0, epsrel=1e-11, limit=400)[0]
    return float(np.exp(-mu / PI * value))


def infinite_fluence_modes(c: float, r: float) -> float:
    """Fluence around a point of unit power in an endless medium of albedo c, sigma_t 1, by singular eigenfunctions
    (Case and Zweifel 1967, section 4.6): a discrete mode of length nu0 and a continuum."""
    with mpmath.workdps(25):
        guess = 1 / np.sqrt(3 * (1 - c)) if c > 0.6 else 1.05
        if c > 0.6:
            nu0 = mpmath.findroot(lambda n: c * n * mpmath.atanh(1 / n) - 1, guess)
        else:
            nu0 = 1 / mpmath.findroot(lambda k: c * mpmath.atanh(k) - k, [0.5, 0.9999], solver="anderson")
        norm0 = c * nu0**3 / 2 * (c / (nu0**2 - 1) - 1 / nu0**2)
        discrete = mpmath.exp(-r / nu0) / (nu0 * norm0)

        def continuum(nu: Any) -> Any:
            norm = nu * ((1 - c * nu * mpmath.atanh(nu)) ** 2 + (mpmath.pi * c * nu / 2) ** 2)
            return mpmath.exp(-r / nu) / (nu * norm)

        rest = mpmath.quad(continuum, [0, 0.1, 0.5, 0.9, 0.99, 0.9999, 1])
        return float((discrete + rest) / (4 * mpmath.pi * r))


@cache
def endless_fluence(r: float) -> float:
    """The same for albedo 1: the discrete mode is 3 / (4 pi r), diffusion's; a point's light never dies out."""
    with mpmath.workdps(25):

        def continuum(nu: Any) -> Any:
            norm = nu * ((1 - nu * mpmath.atanh(nu)) ** 2 + (mpmath.pi * nu / 2) ** 2)
            return mpmath.exp(-r / nu) / (nu * norm)

        return float((3 + mpmath.quad(continuum, [0, 0.1, 0.5, 0.9, 0.99, 0.9999, 1])) / (4 * mpmath.pi * r))


@cache
def _slab_source(c: float, depth: float, mu0: float, n: int) -> tuple[Array, Array, Array]:
    """Points, weights and the source function of a slab of fog lit at mu0 by flux mu0 pi from above, isotropic: the
    integral equation J = c/4 e^(-t/mu0) + c/2 int E1(|t - s|) J ds, its singular kernel by subtraction."""
    from scipy.special import expn

    t, w = gauss(-1, 1, n)
    # Denser at both ends, where J has infinite slope.
    x = depth / 2 * (1 + np.sin(PI / 2 * t))
    w = w * depth / 2 * PI / 2 * np.cos(PI / 2 * t)
    kernel = expn(1, np.abs(x[:, None] - x[None]) + np.eye(n))
    np.fill_diagonal(kernel, 0)
    whole = 2 - expn(2, x) - expn(2, depth - x)  # int E1(|t - s|) ds
    matrix = np.eye(n) - c / 2 * (kernel * w + np.diag(whole - kernel @ w))
    j = np.linalg.solve(matrix, c / 4 * np.exp(-x / mu0))
    return x, w, j


@cache
def slab_albedo(c: float, depth: float, mu0: float) -> float:
    """Share of a beam at mu0 that a slab of fog sends back: flux out over flux in."""
    x, w, j = _slab_source(c, depth, mu0, 800)
    from scipy.special import expn

    return float(2 * (w * j * expn(2, x)).sum() / mu0)


@cache
def slab_transmittance(c: float, depth: float, mu0: float) -> float:
    """Share that goes through it, scattered or not."""
    x, w, j = _slab_source(c, depth, mu0, 800)
    from scipy.special import expn

    return float(2 * (w * j * expn(2, depth - x)).sum() / mu0 + np.exp(-depth / mu0))


def slab_walk(c: float, depth: float, mu0: float, walks: int, seed: int = 1) -> NDArray[np.float64]:
    """(2, 2): albedo and transmittance, each with its standard error, by random walks."""
    rng = np.random.default_rng(seed)
    x, mu, weight = np.zeros(walks), np.full(walks, mu0), np.ones(walks)
    back, through = np.zeros(walks), np.zeros(walks)
    index = np.arange(walks)
    while len(index):
        x[index] += mu[index] * rng.exponential(size=len(index))
        up, down = x[index] < 0, x[index] > depth
        back[index[up]], through[index[down]] = weight[index[up]], weight[index[down]]
        index = index[~up & ~down]
        weight[index] *= c
        index = index[weight[index] > 1e-12] if c < 1 else index
        mu[index] = rng.uniform(-1, 1, len(index))
    return np.array([[a.mean(), a.std() / np.sqrt(walks)] for a in (back, through)])


def point_airlight_exact(sigma_t: float, sigma_s: float, g: float, height: float, foot: float, end: float) -> float:
    """Light of a point of intensity 1, `height` beside a ray and `foot` along it, scattered once into the ray; adaptive
    quadrature in the angle about the light."""

    def integrand(angle: float) -> float:
        t = foot + height * np.tan(angle)
        distance = height / np.cos(angle)
        cosine = (foot - t) / distance
        phase = float(henyey_greenstein(g, cosine))
        return float(sigma_s * np.exp(-sigma_t * (t + distance)) * phase / height)

    low, high = np.arctan2(-foot, height), (PI / 2 if np.isinf(end) else np.arctan2(end - foot, height))
    points = [a for a in (-PI / 2 + 0.02, PI / 2 - 0.02, 0.0) if low < a < high]
    return float(integrate.quad(integrand, low, high, points=points, epsabs=0, epsrel=1e-11, limit=800)[0])
