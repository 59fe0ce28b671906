# SPDX-License-Identifier: GPL-3.0-or-later
"""What pictures must be: closed forms and quadrature in float64, none of it shared with the engine."""

from collections.abc import Callable
from functools import cache
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import integrate, special

Array = NDArray[Any]
PI = np.pi


@cache
def _legendre(n: int) -> tuple[Array, Array]:
    return np.polynomial.legendre.leggauss(n)


def gauss(a: float, b: float, n: int) -> tuple[Array, Array]:
    """Nodes and weights of Gauss and Legendre on [a, b]."""
    x, w = _legendre(n)
    return a + (b - a) * (x + 1) / 2, w * (b - a) / 2


# ---- Surfaces -----------------------------------------------------------------------------------------------------


def ggx_albedo(mu: float, alpha: float, n: int = 200) -> float:
    """Directional albedo at F = 1 of GGX with height-correlated Smith masking (Heitz 2014, equations 15, 72 and 99).

    The integral of D G2 (i.h) / mu over half vectors: with tan^2 of their angle = alpha^2 u / (1 - u), D cos is du
    dphi / 2 pi. u = 1 - (1 - x)^2 tames the end.
    """
    x, wx = gauss(0, 1, n)
    phi, wphi = gauss(0, PI, n)  # by symmetry half of the azimuths
    u = 1 - (1 - x) ** 2
    cos_h = 1 / np.sqrt(1 + alpha**2 * u / (1 - u))
    sin_h = np.sqrt(1 - cos_h**2)
    c, s = cos_h[:, None], sin_h[:, None]
    i_h = np.sqrt(1 - mu**2) * s * np.cos(phi) + mu * c
    o_z = 2 * i_h * c - mu
    seen = (i_h > 0) & (o_z > 0)

    def lam(cosine: Array) -> Array:
        return (np.sqrt(1 + alpha**2 * (1 / cosine**2 - 1)) - 1) / 2

    g2 = 1 / (1 + lam(np.array(mu)) + lam(np.where(seen, o_z, 1)))
    value = np.where(seen, g2 * i_h / (mu * c), 0)
    return float((wx * 2 * (1 - x)) @ value @ wphi / PI)


def tilted_ggx_albedo(mu: float, alpha: float, tilt: float, n: int = 2000) -> float:
    """The same of a surface whose normal is bent away from the viewer by `tilt` (radians, in the plane of incidence; mu
    is of the bent one): without what would go below the true surface. By midpoints, as that cuts through the lobe.
    """
    u = (np.arange(n) + 0.5) / n
    phi = PI * u
    u = 1 - (1 - u) ** 2
    weights = 2 * np.sqrt(1 - u) / n
    c = 1 / np.sqrt(1 + alpha**2 * u / (1 - u))[:, None]
    s = np.sqrt(1 - c**2)
    i_h = np.sqrt(1 - mu**2) * s * np.cos(phi) + mu * c
    o_x, o_z = 2 * i_h * s * np.cos(phi) - np.sqrt(1 - mu**2), 2 * i_h * c - mu
    kept = (i_h > 0) & (o_z > 0) & (o_x * np.sin(tilt) + o_z * np.cos(tilt) > 0)
    lam_i, lam_o = ((np.sqrt(1 + alpha**2 * (1 / cos**2 - 1)) - 1) / 2 for cos in (mu, np.where(kept, o_z, 1)))
    value = np.where(kept, i_h / (mu * c) / (1 + lam_i + lam_o), 0)
    return float(weights @ value.mean(axis=1))


def fresnel(cos_i: float, ior: float) -> float:
    """Reflectance of a dielectric from outside."""
    cos_t = np.sqrt(1 - (1 - cos_i**2) / ior**2)
    s, p = (cos_i - ior * cos_t) / (cos_i + ior * cos_t), (ior * cos_i - cos_t) / (ior * cos_i + cos_t)
    return float(s * s + p * p) / 2


# ---- Irradiance on a plate at the origin, normal +z ----------------------------------------------------------------


def sphere_irradiance(sin_alpha: float, theta: float) -> float:
    """Of a sphere of radiance 1 and angular radius alpha at the angle theta from the normal, clipped by the horizon.

    Around the centre's direction the azimuth is integrated in closed form, the polar angle by quadrature.
    """

    def ring(gamma: float) -> float:
        a, b = np.cos(theta) * np.cos(gamma), np.sin(theta) * np.sin(gamma)
        phi = np.arccos(np.clip(-a / max(b, 1e-300), -1, 1))
        return float(2 * (a * phi + b * np.sin(phi)) * np.sin(gamma))

    alpha = np.arcsin(sin_alpha)
    kink = abs(PI / 2 - theta)
    points = [kink] if 0 < kink < alpha else None
    return float(integrate.quad(ring, 0, alpha, points=points, epsabs=0, epsrel=1e-11, limit=200)[0])


def polygon_irradiance(vertices: ArrayLike) -> float:
    """Of a polygon of radiance 1 wholly above the horizon (Lambert 1760), whichever side it shows."""
    v = np.asarray(vertices, np.float64)
    r = v / np.linalg.norm(v, axis=1, keepdims=True)
    after = np.roll(r, -1, axis=0)
    axis = np.cross(r, after)
    sine = np.linalg.norm(axis, axis=1)
    angle = np.arctan2(sine, (r * after).sum(axis=1))
    return float(abs((angle * axis[:, 2] / sine).sum()) / 2)


def surface_irradiance(center: ArrayLike, u: ArrayLike, v: ArrayLike, ellipse: bool, n: int = 200) -> float:
    """Of a lamp center + a u + b v, |a|, |b| <= 1 or inside the ellipse, of radiance 1, wholly above the horizon."""
    c, u, v = (np.asarray(a, np.float64) for a in (center, u, v))
    normal = np.cross(u, v)
    s, ws = gauss(0 if ellipse else -1, 1, n)
    t, wt = gauss(-PI if ellipse else -1, PI if ellipse else 1, n)
    s, t = np.meshgrid(s, t, indexing="ij")
    a, b, jacobian = (s * np.cos(t), s * np.sin(t), s) if ellipse else (s, t, np.ones_like(s))
    x = c + a[..., None] * u + b[..., None] * v
    d2 = (x**2).sum(axis=-1)
    return float(ws @ (jacobian * x[..., 2] * np.abs(x @ normal) / d2**2) @ wt)


# ---- Fog -----------------------------------------------------------------------------------------------------------


def henyey_greenstein(g: float, cosine: ArrayLike) -> Array:
    """cosine of the angle between the directions of propagation."""
    c = np.asarray(cosine, np.float64)
    return (1 - g * g) / (4 * PI * (1 + g * g - 2 * g * c) ** 1.5)


def sphere_source(sigma: float, radius: float, distance: float) -> float:
    """J: mean over all directions of the transmitted radiance of a sphere of radiance 1 (closed form)."""
    a, s = distance - radius, np.sqrt((distance - radius) * (distance + radius))
    e2 = [float(special.expn(2, sigma * x)) for x in (a, s)]
    bracket = s * s * (e2[0] / a - e2[1] / s) - (np.exp(-sigma * a) - np.exp(-sigma * s)) / sigma
    return float(bracket / (4 * distance))


def sphere_scattering(sigma: float, g: float, radius: float, to_center: Array, direction: Array, n: int = 48) -> float:
    """Integral over a sphere of radiance 1, seen from the origin, of the transmitted radiance times the phase function
    towards -direction."""
    d = np.linalg.norm(to_center)
    axis = to_center / d
    beta = np.arccos(np.clip(axis @ direction, -1, 1))
    # q from 0 at the axis to 1 at the rim, sin gamma = R/d sqrt(1 - (1-q)^2): the rim's square root is gone.
    q, wq = gauss(0, 1, n)
    phi, wphi = gauss(0, PI, n)
    k = radius / d
    w = 1 - q
    sine = k * np.sqrt(1 - w**2)
    cosine = np.sqrt(1 - sine**2)
    nearest = d * cosine - radius * w
    jacobian = k * k * w / cosine  # sin gamma dgamma = -k^2 w dw / cos gamma
    angle = np.cos(beta) * cosine[:, None] + np.sin(beta) * sine[:, None] * np.cos(phi)
    value = jacobian[:, None] * np.exp(-sigma * nearest)[:, None] * henyey_greenstein(g, angle)
    return float(2 * wq @ value @ wphi)


def along_ray(source: Callable[[float], float], foot: float, height: float, end: float) -> float:
    """Integral of source(t) over [0, end], end may be infinite: in the angle about a light at `foot` on the ray and
    `height` beside it."""
    low = np.arctan2(-foot, height)
    high = np.arctan2(end - foot, height) if np.isfinite(end) else PI / 2
    edges = np.linspace(low, high, 17)
    total = 0.0
    for a, b in pairwise(edges):
        angle, weight = gauss(float(a), float(b), 12)
        t = foot + height * np.tan(angle)
        total += sum(w * height / np.cos(p) ** 2 * source(float(x)) for p, x, w in zip(angle, t, weight, strict=True))
    return total


def point_airlight(
    sigma_t: float, sigma_s: float, g: float, to_light: ArrayLike, direction: Array, end: float
) -> float:
    """Light of a point of intensity 1 scattered once into the ray from the origin."""
    p = np.asarray(to_light, np.float64)
    foot = float(p @ direction)
    height = float(np.linalg.norm(p - foot * direction))

    def source(t: float) -> float:
        v = p - t * direction
        d = float(np.linalg.norm(v))
        return float(sigma_s * np.exp(-sigma_t * (t + d)) * henyey_greenstein(g, v @ direction / d) / d**2)

    return along_ray(source, foot, height, end)


def sun_airlight(sigma: float, height: float, foot: float) -> float:
    """The same for g = 0, albedo 1 and no end, by Sun, Ramamoorthi, Narasimhan and Nayar (2005), equation 11: the
    special function integrated from the ray's start to its end."""
    start = np.arctan2(-foot, height) / 2 + PI / 4
    integral = integrate.quad(lambda xi: np.exp(-sigma * height * np.tan(xi)), start, PI / 2, epsrel=1e-11)[0]
    return float(sigma * np.exp(-sigma * foot) / (4 * PI * height) * 2 * integral)


def sphere_airlight(
    sigma_t: float, sigma_s: float, g: float, radius: float, to_center: ArrayLike, direction: Array, end: float
) -> float:
    """Light of a sphere of radiance 1 scattered once into the ray from the origin."""
    c = np.asarray(to_center, np.float64)
    foot = float(c @ direction)
    height = float(np.linalg.norm(c - foot * direction))

    def source(t: float) -> float:
        scattered = sphere_scattering(sigma_t, g, radius, c - t * direction, direction)
        return float(sigma_s * np.exp(-sigma_t * t) * scattered)

    return along_ray(source, foot, max(height, radius / 2), end)


@cache
def _chandrasekhar(c: float) -> tuple[Array, Array, Array]:
    """Nodes and weights on [0, 1] and H there, by iteration of 1/H = sqrt(1 - c) + c/2 int x H(x) / (mu + x) dx."""
    y, wy = gauss(0, 1, 200)
    x, w = y**2, wy * 2 * y  # H is not smooth at 0
    kernel = c / 2 * w * x / (x[:, None] + x)
    h = np.ones_like(x)
    for _ in range(2000):
        before, h = h, 1 / (np.sqrt(1 - c) + kernel @ h)
        if np.abs(h - before).max() < 1e-13:
            break
    return x, w, h


def half_space_albedo(c: float, mu: float) -> float:
    """Plane albedo of a half space that scatters isotropically with albedo c: 1 - H(mu) sqrt(1 - c)."""
    x, w, h = _chandrasekhar(c)
    inverse = np.sqrt(1 - c) + c / 2 * ((w * x * h) / (mu + x)).sum()
    return float(1 - np.sqrt(1 - c) / inverse)


def spherical_albedo(c: float) -> float:
    """The same under light that is the same from everywhere."""
    x, w, h = _chandrasekhar(c)
    return float(1 - 2 * np.sqrt(1 - c) * (w * x * h).sum())


@cache
def infinite_fluence(c: float, r: float) -> float:
    """Fluence at the optical distance r from an isotropic point of unit power in an infinite medium of albedo c: the
    uncollided light, that scattered once in real space, the rest by its Fourier integral, which falls as k^-2."""
    direct = np.exp(-r) / (4 * PI * r * r)
    # One collision: the line of sight of the field e^-d / (4 pi d^2), over all directions.
    theta, weight = gauss(0, PI, 96)
    once = 0.0
    for angle, w in zip(theta, weight, strict=True):
        foot, height = r * np.cos(angle), r * np.sin(angle)

        def source(t: float, foot: float = foot, height: float = height) -> float:
            d2 = (t - foot) ** 2 + height**2
            return float(np.exp(-t - np.sqrt(d2)) / (4 * PI * d2))

        once += c / 2 * w * np.sin(angle) * along_ray(source, foot, height, np.inf)

    def rest(k: float) -> float:
        a = np.arctan(k) / k
        return float(k * c * c * a**3 / (1 - c * a))

    tail = integrate.quad(rest, 1e-9, np.inf, weight="sin", wvar=r, limit=400, limlst=400, epsabs=1e-10)[0]
    return float(direct + once + tail / (2 * PI * PI * r))


# ---- Environment images --------------------------------------------------------------------------------------------


def environment(image: Array, directions: Array) -> Array:
    """(n, 3): an equirectangular picture (height, width, 3), centre along +y, z up, u to the right (+x), bilinear."""
    height, width, _ = image.shape
    x, y, z = directions.T
    u = (0.5 + np.arctan2(x, y) / (2 * PI)) * width - 0.5
    v = np.clip(np.arccos(np.clip(z, -1, 1)) / PI * height - 0.5, 0, height - 1)
    x0, y0 = np.floor(u).astype(int), np.floor(v).astype(int)
    fx, fy = (u - x0)[:, None], (v - y0)[:, None]
    y1 = np.minimum(y0 + 1, height - 1)
    top = image[y0, x0 % width] * (1 - fx) + image[y0, (x0 + 1) % width] * fx
    bottom = image[y1, x0 % width] * (1 - fx) + image[y1, (x0 + 1) % width] * fx
    mixed: Array = top * (1 - fy) + bottom * fy
    return mixed


def environment_irradiance(image: Array, to_world: Array, n: int = 600) -> Array:
    """(3): on a plate whose normal is +z; midpoint rule in cos^2 and azimuth."""
    s = (np.arange(n) + 0.5) / n
    cos2, phi = (a.ravel() for a in np.meshgrid(s, 2 * PI * s, indexing="ij"))
    sine, cosine = np.sqrt(1 - cos2), np.sqrt(cos2)
    directions = np.stack([sine * np.cos(phi), sine * np.sin(phi), cosine], axis=1)
    mean: Array = environment(image, directions @ to_world[:3, :3]).mean(axis=0)
    return PI * mean


def spot_falloff(angle: float, full_angle: float, blend: float) -> float:
    """Blender's: a smooth step of the cosine over the part `blend` of the cone."""
    edge = np.cos(np.radians(full_angle) / 2)
    over = np.cos(angle) - edge
    s = np.clip(over / ((1 - edge) * blend), 0, 1) if blend > 0 else float(over > 0)
    return float(s * s * (3 - 2 * s))
