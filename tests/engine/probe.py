# SPDX-License-Identifier: GPL-3.0-or-later
"""The engine's kernels in bulk, through libglimmer_probe (engine/probe): arrays in, arrays out.

u has shape (n, 2), directions (n, 3).
"""

import ctypes
import os
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[Any]

LAMBERT, MIRROR, CONDUCTOR, REPORT_METAL = range(4)
SMITH, SMITH_SEPARABLE, SCHLICK_GGX = range(3)
UNIFORM_SPHERE, COSINE_HEMISPHERE, CONE, DISK, TRIANGLE_BARYCENTRICS = range(5)
SPHERE, RECTANGLE, ELLIPSE, TRIANGLE, SUN = range(5)
NOTHING, SMOOTH, SPECULAR = range(3)


@cache
def library() -> ctypes.CDLL:
    """The library in GLIMMER_LIB_DIR, else in the repository's build folder."""
    default = Path(__file__).resolve().parents[2] / "build" / "lib"
    path = Path(os.environ.get("GLIMMER_LIB_DIR", default)) / "libglimmer_probe.so"
    if not path.exists():
        raise FileNotFoundError(f"{path} is missing; run `python3 build.py build`")
    return ctypes.CDLL(str(path))


def _argument(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        if not value.flags.c_contiguous:
            raise ValueError("an array that is not C-contiguous")
        return ctypes.c_void_p(value.ctypes.data)
    if isinstance(value, np.float32):
        return ctypes.c_float(float(value))
    if isinstance(value, np.float64):
        return ctypes.c_double(float(value))
    if isinstance(value, np.uint64):
        return ctypes.c_uint64(int(value))
    return value  # int: a C int; ctypes structures


def _call(name: str, *arguments: Any, returns: Any = None) -> Any:
    function = getattr(library(), name)
    function.restype = returns
    return function(*map(_argument, arguments))


def _f32(values: ArrayLike, *shape: int) -> Array:
    array = np.ascontiguousarray(values, np.float32)
    return np.ascontiguousarray(np.broadcast_to(array, shape)) if shape else array


def _f64(values: ArrayLike) -> Array:
    return np.ascontiguousarray(values, np.float64)


def _empty(*shape: int, kind: Any = np.float32) -> Array:
    return np.zeros(shape, kind)


def uniform(seed: int, n: int) -> Array:
    """(n, 2) float32 multiples of 2^-24 in [0, 1), as the engine's own."""
    bits = np.random.default_rng(seed).integers(0, 1 << 24, (n, 2))
    return (bits * 2.0**-24).astype(np.float32)


def random_bits(seed: int, n: int) -> Array:
    """(n) uint64."""
    return np.random.default_rng(seed).integers(0, 1 << 64, n, np.uint64)


# ---- sampling ----


def mix64(x: int) -> int:
    return int(_call("probe_mix64", np.uint64(x), returns=ctypes.c_uint64))


def hash64(a: int, b: int) -> int:
    return int(_call("probe_hash64", np.uint64(a), np.uint64(b), returns=ctypes.c_uint64))


class Numbers(NamedTuple):
    next_1d: Array
    next_2d: Array
    next_exponential: Array
    next_bits: Array
    stratified_1d: Array
    stratified_2d: Array
    stratified_bits: Array


def sampler(
    seed: int, x: ArrayLike, y: ArrayLike, replicate: ArrayLike, index: ArrayLike, *, skip: int = 0, stratum: int = 0
) -> Numbers:
    """What Samplers of these keys (broadcast) give after `skip` numbers, each drawn from its own copy."""
    keys = [
        np.ascontiguousarray(k, np.uint32) for k in np.broadcast_arrays(*map(np.atleast_1d, (x, y, replicate, index)))
    ]
    n = len(keys[0])
    bits = [_empty(n, kind=np.uint64) for _ in range(2)]
    out = Numbers(_empty(n), _empty(n, 2), _empty(n), bits[0], _empty(n), _empty(n, 2), bits[1])
    _call("probe_sampler", np.uint64(seed), *keys, np.uint64(n), skip, stratum, *out)
    return out


def exponential(bits: Array, tau: float | None = None) -> Array:
    out = _empty(len(bits))
    if tau is None:
        _call("probe_exponential", bits, np.uint64(len(bits)), out)
    else:
        _call("probe_truncated_exponential", bits, np.float32(tau), np.uint64(len(bits)), out)
    return out


def warp(kind: int, u: Array, parameter: float = 0) -> tuple[Array, Array]:
    """Points (n, 3) and densities (n)."""
    out, pdf = _empty(len(u), 3), _empty(len(u))
    _call("probe_warp", kind, np.float32(parameter), u, np.uint64(len(u)), out, pdf)
    return out, pdf


def one_minus_cos(s: float) -> float:
    return float(_call("probe_one_minus_cos", np.float32(s), returns=ctypes.c_float))


def alias_table(weights: ArrayLike, u: Array) -> tuple[Array, Array, Array, Array] | None:
    """Indices (n), their pmf (n), the pmf of every entry, the rest of the number (n); None for an empty table."""
    w, n = _f64(weights), len(u)
    index, pmf, every, rest = _empty(n, kind=np.uint32), _empty(n), _empty(len(w)), _empty(n)
    coarse, fine = np.ascontiguousarray(u[:, 0]), np.ascontiguousarray(u[:, 1])
    found = _call(
        "probe_alias_table",
        w,
        np.uint64(len(w)),
        coarse,
        fine,
        np.uint64(n),
        index,
        pmf,
        every,
        rest,
        returns=ctypes.c_int,
    )
    return (index, pmf, every, rest) if found else None


def distribution_2d(weights: ArrayLike, u: Array) -> tuple[Array, Array, Array, Array] | None:
    """uv (n, 2), pdf of the sample, pdf by its twin, and the pdf of every texel; None for an empty distribution."""
    w, n = _f32(weights), len(u)
    uv, pdf, twin, texels = _empty(n, 2), _empty(n), _empty(n), _empty(*w.shape)
    found = _call(
        "probe_distribution_2d", w, np.uint64(w.shape[1]), np.uint64(w.shape[0]), u, np.uint64(n),
        uv, pdf, twin, texels, returns=ctypes.c_int,
    )  # fmt: skip
    return (uv, pdf, twin, texels) if found else None


# ---- bsdf ----


class _Lobe(ctypes.Structure):
    _fields_ = (
        *((name, ctypes.c_int32) for name in ("type", "use_f0", "masking")),
        *((name, ctypes.c_float) for name in ("weight", "alpha")),
        *((name, ctypes.c_float * 3) for name in ("color", "eta", "k", "f0")),
    )


Colour = tuple[float, float, float]


@dataclass(frozen=True)
class Lobe:
    """f0 given means Schlick; else eta and k."""

    type: int
    weight: float = 1
    color: Colour = (0, 0, 0)
    alpha: float = 0
    f0: Colour | None = None
    eta: Colour = (1, 1, 1)
    k: Colour = (0, 0, 0)
    masking: int = SMITH


def _lobes(lobes: Sequence[Lobe]) -> tuple[Any, Any]:
    out = (_Lobe * len(lobes))()
    for c, lobe in zip(out, lobes, strict=True):
        c.type, c.use_f0, c.masking, c.weight, c.alpha = (
            lobe.type,
            lobe.f0 is not None,
            lobe.masking,
            lobe.weight,
            lobe.alpha,
        )
        c.color[:], c.eta[:], c.k[:], c.f0[:] = lobe.color, lobe.eta, lobe.k, lobe.f0 or (0, 0, 0)
    return out, np.uint64(len(lobes))


def bsdf_eval(lobes: Sequence[Lobe], wo: ArrayLike, wi: ArrayLike) -> tuple[Array, Array]:
    """f |cos_i| (n, 3) and pdf (n)."""
    directions = _f32(wi)
    n = len(directions)
    f, pdf = _empty(n, 3), _empty(n)
    _call("probe_bsdf_eval", *_lobes(lobes), _f32(wo), directions, np.uint64(n), f, pdf)
    return f, pdf


class BsdfSamples(NamedTuple):
    wi: Array
    weight: Array
    pdf: Array
    result: Array  # NOTHING, SMOOTH or SPECULAR; the others are 0 where there is nothing


def bsdf_sample(lobes: Sequence[Lobe], wo: ArrayLike, u_lobe: Array, u: Array) -> BsdfSamples:
    n = len(u)
    out = BsdfSamples(_empty(n, 3), _empty(n, 3), _empty(n), _empty(n, kind=np.int32))
    _call("probe_bsdf_sample", *_lobes(lobes), _f32(wo), np.ascontiguousarray(u_lobe), u, np.uint64(n), *out)
    return out


def bsdf_describe(lobes: Sequence[Lobe]) -> tuple[Array, Array, bool, bool]:
    """Selection probabilities, albedo, is_specular, has_specular."""
    select, albedo, flags = _empty(len(lobes)), _empty(3), _empty(2, kind=np.int32)
    _call("probe_bsdf_describe", *_lobes(lobes), select, albedo, flags)
    return select, albedo, bool(flags[0]), bool(flags[1])


def _fresnel(kind: int, cos_i: ArrayLike, eta: ArrayLike, k: ArrayLike = 0) -> Array:
    c, e, extinction = (_f32(a) for a in np.broadcast_arrays(*map(np.atleast_1d, (cos_i, eta, k))))
    out = _empty(len(c))
    _call("probe_fresnel", kind, c, e, extinction, np.uint64(len(c)), out)
    return out


def fresnel_conductor(cos_i: ArrayLike, eta: ArrayLike, k: ArrayLike) -> Array:
    return _fresnel(0, cos_i, eta, k)


def fresnel_dielectric(cos_i: ArrayLike, eta: ArrayLike) -> Array:
    return _fresnel(1, cos_i, eta)


def fresnel_schlick(cos_i: ArrayLike, f0: ArrayLike, f90: ArrayLike = 1) -> Array:
    return _fresnel(2, cos_i, f0, f90)


def fresnel_dielectric_schlick(cos_i: ArrayLike, eta: ArrayLike) -> Array:
    return _fresnel(3, cos_i, eta)


def ggx_d(h: ArrayLike, alpha: float) -> Array:
    normals = _f32(h)
    out = _empty(len(normals))
    _call("probe_ggx_d", normals, np.float32(alpha), np.uint64(len(normals)), out)
    return out


class GlassSamples(NamedTuple):
    wi: Array
    weight: Array
    probability: Array
    transmitted: Array


def glass(wo: ArrayLike, eta: ArrayLike, u: ArrayLike, schlick: bool = False) -> GlassSamples:
    directions = _f32(wo)
    n = len(directions)
    out = GlassSamples(_empty(n, 3), _empty(n, 3), _empty(n), _empty(n, kind=np.int32))
    _call("probe_glass", directions, _f32(eta, n), int(schlick), _f32(u, n), np.uint64(n), *out)
    return out


# ---- medium ----


def _sigma(absorption: ArrayLike, scattering: ArrayLike) -> Array:
    return np.ascontiguousarray(np.stack([_f32(absorption, 3), _f32(scattering, 3)]))


def transmittance(absorption: ArrayLike, scattering: ArrayLike, t: ArrayLike) -> Array:
    distances = _f32(t)
    out = _empty(len(distances), 3)
    _call("probe_transmittance", _sigma(absorption, scattering), distances, np.uint64(len(distances)), out)
    return out


class Flights(NamedTuple):
    t: Array
    scattered: Array
    weight: Array
    pdf: Array


def free_flight(
    absorption: ArrayLike,
    scattering: ArrayLike,
    beta: ArrayLike,
    t_max: float,
    u: Array,
    bits: Array,
    own: bool = False,
) -> Flights:
    """own: numbers from Sampler(bits[i], 0, 0, 0, 0) in place of u and bits."""
    n = len(bits)
    t, scattered, weight, pdf = _empty(n), _empty(n, kind=np.int32), _empty(n, 3), _empty(n)
    sigma, coarse = _sigma(absorption, scattering), np.ascontiguousarray(u)
    _call(
        "probe_free_flight", sigma, _f32(beta, 3), np.float32(t_max), coarse, bits, int(own), np.uint64(n),
        t, scattered, weight, pdf,
    )  # fmt: skip
    return Flights(t, scattered.astype(bool), weight, pdf)


def free_flight_pdf(absorption: ArrayLike, scattering: ArrayLike, beta: ArrayLike, t: ArrayLike) -> Array:
    distances = _f32(t)
    pdf = _empty(len(distances))
    sigma = _sigma(absorption, scattering)
    _call("probe_free_flight_pdf", sigma, _f32(beta, 3), distances, np.uint64(len(distances)), pdf)
    return pdf


class Collisions(NamedTuple):
    t: Array
    weight: Array
    pdf: Array


def collision(
    absorption: ArrayLike,
    scattering: ArrayLike,
    beta: ArrayLike,
    t_max: float,
    u: Array,
    bits: Array,
    own: bool = False,
) -> Collisions:
    n = len(bits)
    out = Collisions(_empty(n), _empty(n, 3), _empty(n))
    sigma, coarse = _sigma(absorption, scattering), np.ascontiguousarray(u)
    _call("probe_collision", sigma, _f32(beta, 3), np.float32(t_max), coarse, bits, int(own), np.uint64(n), *out)
    return out


def collision_pdf(absorption: ArrayLike, scattering: ArrayLike, beta: ArrayLike, t_max: float, t: ArrayLike) -> Array:
    distances = _f32(t)
    pdf = _empty(len(distances))
    sigma, n = _sigma(absorption, scattering), np.uint64(len(distances))
    _call("probe_collision_pdf", sigma, _f32(beta, 3), np.float32(t_max), distances, n, pdf)
    return pdf


def phase_sample(g: float, before: ArrayLike, u: Array) -> tuple[Array, Array]:
    """Directions of propagation (n, 3) and their densities (n)."""
    out, pdf = _empty(len(u), 3), _empty(len(u))
    _call("probe_phase_sample", np.float32(g), _f32(before), u, np.uint64(len(u)), out, pdf)
    return out, pdf


def phase_of_cosine(g: float, cosine: ArrayLike) -> Array:
    c = _f32(cosine)
    out = _empty(len(c))
    _call("probe_phase_cos", np.float32(g), c, np.uint64(len(c)), out)
    return out


def phase_of_directions(g: float, before: ArrayLike, after: ArrayLike) -> Array:
    directions = _f32(after)
    out = _empty(len(directions))
    _call("probe_phase_directions", np.float32(g), _f32(before), directions, np.uint64(len(directions)), out)
    return out


def equiangular(a: float, b: float, h: float, u: ArrayLike) -> Array:
    numbers = _f32(u)
    t = _empty(len(numbers))
    _call("probe_equiangular", np.float32(a), np.float32(b), np.float32(h), numbers, np.uint64(len(numbers)), t)
    return t


def equiangular_pdf(a: float, b: float, h: float, t: ArrayLike) -> Array:
    distances = _f32(t)
    pdf = _empty(len(distances))
    _call(
        "probe_equiangular_pdf", np.float32(a), np.float32(b), np.float32(h), distances, np.uint64(len(distances)), pdf
    )
    return pdf


# ---- light shapes ----


class Directions(NamedTuple):
    wi: Array
    distance: Array
    pdf: Array
    found: Array


def _shape(shape: ArrayLike) -> Array:
    flat = np.zeros(9)
    values = _f64(shape).ravel()
    flat[: len(values)] = values
    return flat


def shape_sample(kind: int, shape: ArrayLike, u: Array) -> Directions:
    """shape: 9 numbers, see engine/probe/shapes_probe.cpp (fewer are filled up)."""
    n = len(u)
    wi, distance, pdf, found = _empty(n, 3), _empty(n), _empty(n), _empty(n, kind=np.int32)
    _call("probe_shape_sample", kind, _shape(shape), u, np.uint64(n), wi, distance, pdf, found)
    return Directions(wi, distance, pdf, found.astype(bool))


def shape_pdf(kind: int, shape: ArrayLike, wi: ArrayLike) -> Array:
    directions = _f32(wi)
    pdf = _empty(len(directions))
    _call("probe_shape_pdf", kind, _shape(shape), directions, np.uint64(len(directions)), pdf)
    return pdf


def solid_angle(rectangle: ArrayLike) -> float:
    return float(_call("probe_solid_angle", _shape(rectangle), returns=ctypes.c_double))


def sun_projected_solid_angle(sun: ArrayLike) -> float:
    return float(_call("probe_sun_projected_solid_angle", _shape(sun), returns=ctypes.c_double))


class ErrorEstimate(NamedTuple):
    """Of engine/src/film/error.h."""

    relmse: float
    low: float
    high: float
    largest_share: float
    x: int
    y: int
    log_error: float
    without: Array  # (8)

    @property
    def certifiable(self) -> bool:
        return self.largest_share <= 0.1 or self.relmse == 0


def error_estimate(sums: ArrayLike, samples: int, look: int = 1) -> ErrorEstimate:
    """sums (height, width, 8, 3) of the replicates of a film after `samples` samples a pixel."""
    values = _f32(sums)
    height, width, replicates, channels = values.shape
    assert (replicates, channels) == (8, 3)
    result = np.empty(15)
    _call("probe_error", values, width, height, np.uint64(samples), look, result)
    relmse, low, high, share, x, y, log_error = map(float, result[:7])
    return ErrorEstimate(relmse, low, high, share, int(x), int(y), log_error, result[7:])


def student_quantile(tail: float, degrees: int) -> float:
    return float(_call("probe_student_quantile", np.float64(tail), degrees, returns=ctypes.c_double))


def fall_rate(
    seconds: ArrayLike, relmse: ArrayLike, log_error: ArrayLike, without: ArrayLike
) -> tuple[float, float, float]:
    """power, low, high of a curve of n points, at 1, 2, 4, ... samples; without: (n, 8)."""
    arrays = [np.ascontiguousarray(a, np.float64) for a in (seconds, relmse, log_error, without)]
    result = np.empty(3)
    _call("probe_rate", *arrays, np.uint64(len(arrays[0])), result)
    return float(result[0]), float(result[1]), float(result[2])


def sample_plan(sums: ArrayLike) -> Array:
    """(height, width, 8) samples a pass that adaptive sampling plans for replicates whose sums (height, width, 8, 3)
    are these after two passes of each."""
    values = _f32(sums)
    height, width, replicates, channels = values.shape
    assert (replicates, channels) == (8, 3)
    rates = np.empty((height, width, 8), np.float32)
    _call("probe_plan", values, width, height, rates)
    return rates


# ---- loops over vertices and nodes, and the table of a line --------------------------------------------------------

LANES = NODES = 16


def has_avx512() -> bool:
    return bool(_call("probe_has_avx512", returns=ctypes.c_int))


class Connections(NamedTuple):
    parts: Array  # (n)
    sums: Array  # (20): r, g, b, mean of them, that by lane


def connect(wide: bool, medium: ArrayLike, vertices: ArrayLike, point: ArrayLike, bound: float) -> Connections:
    """medium (4): extinction by channel, g. vertices (6 or 9, n): position, power, flight. point (6): place, view."""
    v = _f32(vertices)
    n = v.shape[1]
    parts, sums = _empty(n), _empty(4 + LANES)
    _call(
        *("probe_connect", int(wide), _f32(medium), v, int(len(v) == 9), np.uint64(n), _f32(point)),
        *(np.float32(bound), parts, sums),
    )
    return Connections(parts, sums)


def weigh(wide: bool, medium: ArrayLike, vertices: ArrayLike, points: ArrayLike, soften: float) -> Array:
    """points (m, 6); returns targets (n)."""
    v, p = _f32(vertices), _f32(points)
    n = v.shape[1]
    targets = _empty(n)
    _call(
        *("probe_weigh", int(wide), _f32(medium), v, int(len(v) == 9), np.uint64(n), p, np.uint64(len(p))),
        *(np.float32(soften), targets),
    )
    return targets


def line_nodes(wide: bool, medium: ArrayLike, shape: ArrayLike) -> Array:
    """shape (8): t_foot, h, h2, radius, distance, cut, x_first, x_step. Returns the density (16), the last source."""
    density = _empty(NODES + 1)
    _call("probe_line_nodes", int(wide), _f32(medium), _f64(shape), density)
    return density


class LineSamples(NamedTuple):
    t: Array
    pdf: Array


def line(sigma: ArrayLike, g: float, segment: ArrayLike, light: ArrayLike, u: ArrayLike) -> LineSamples:
    """sigma (2, 3): absorption, scattering. segment (7): origin, direction, end. light (4): centre, radius."""
    numbers = _f32(u)
    t, pdf = _empty(len(numbers)), _empty(len(numbers))
    _call(
        *("probe_line", _f32(sigma), np.float32(g), _f32(segment), _f32(light), numbers, np.uint64(len(numbers))),
        *(t, pdf),
    )
    return LineSamples(t, pdf)


def line_pdf(sigma: ArrayLike, g: float, segment: ArrayLike, light: ArrayLike, t: ArrayLike) -> Array:
    at = _f32(t)
    pdf = _empty(len(at))
    _call(
        *("probe_line_pdf", _f32(sigma), np.float32(g), _f32(segment), _f32(light), at, np.uint64(len(at)), pdf),
    )
    return pdf
