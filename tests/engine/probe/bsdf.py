# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces of one or more lobes."""

import ctypes
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from tests.engine.probe.call import Array, call, empty, f32

LAMBERT, MIRROR, CONDUCTOR, REPORT_METAL, DIELECTRIC, TRANSPARENT = range(6)
TRANSLUCENT, OREN_NAYAR, BURLEY, SHEEN, BRUSHED, SUBSURFACE = range(6, 12)
WHOLE, BASE, RETRO = range(3)
RANDOM_WALK, FIXED_RADIUS, SKIN = range(3)
REFRACTED, DIFFUSE, BOTH = range(3)
FIBERS, SCHLICK_SHEEN, VELVET = range(3)
SMITH, SMITH_SEPARABLE, SCHLICK_GGX = range(3)
NOTHING, SMOOTH, SPECULAR = range(3)
TRANSMITTED = 4  # added to the last two


class _Lobe(ctypes.Structure):
    _fields_ = (
        *((name, ctypes.c_int32) for name in ("type", "use_f0", "masking", "flag", "above")),
        *((name, ctypes.c_float) for name in ("weight", "alpha", "cover")),
        *((name, ctypes.c_float * 3) for name in ("color", "eta", "k", "f0")),
        ("curve_ior", ctypes.c_float),
        ("f82", ctypes.c_float * 3),
    )


Colour = tuple[float, float, float]


@dataclass(frozen=True)
class Lobe:
    """f0 given means a curve from it to 1; else eta and k. Of a dielectric `eta` is (IOR, 0 for refraction alone, 1
    with multiple scattering), `color` its transmission and `f0` its reflection; of what is brushed `eta` is (both
    widths, turn of the tangent). `flag`: multiple scattering of a conductor and of Oren-Nayar, the model of a sheen. Of
    what is diffuse `alpha` is the roughness. Of subsurface `f0` is the radius, `curve_ior` the anisotropy, `eta` (IOR),
    `flag` the model and `masking` the entry; of Burley `flag` is the part. `above`: a
    bit for each of the lobes that lie above this one."""

    type: int
    weight: float = 1
    color: Colour = (0, 0, 0)
    alpha: float = 0
    f0: Colour | None = None
    eta: Colour = (1, 1, 1)
    k: Colour = (0, 0, 0)
    masking: int = SMITH
    flag: int = 0
    above: int = 0
    cover: float = 1
    curve_ior: float = 0
    f82: Colour = (1, 1, 1)


def _lobes(lobes: Sequence[Lobe]) -> tuple[Any, Any]:
    out = (_Lobe * len(lobes))()
    for c, lobe in zip(out, lobes, strict=True):
        c.type, c.use_f0, c.masking, c.flag, c.weight, c.alpha = (
            lobe.type,
            lobe.f0 is not None,
            lobe.masking,
            lobe.flag,
            lobe.weight,
            lobe.alpha,
        )
        c.above, c.cover, c.curve_ior, c.f82[:] = lobe.above, lobe.cover, lobe.curve_ior, lobe.f82
        c.color[:], c.eta[:], c.k[:], c.f0[:] = lobe.color, lobe.eta, lobe.k, lobe.f0 or (0, 0, 0)
    return out, np.uint64(len(lobes))


def evaluate(lobes: Sequence[Lobe], wo: ArrayLike, wi: ArrayLike, eta: float = 1) -> tuple[Array, Array]:
    """f |cos_i| (n, 3) and pdf (n). eta: index on the other side / index on the side of wo."""
    directions = f32(wi)
    n = len(directions)
    f, pdf = empty(n, 3), empty(n)
    call("probe_bsdf_eval", *_lobes(lobes), np.float32(eta), f32(wo), directions, np.uint64(n), f, pdf)
    return f, pdf


class BsdfSamples(NamedTuple):
    wi: Array
    weight: Array
    pdf: Array
    result: Array  # NOTHING, SMOOTH or SPECULAR, and TRANSMITTED; the others are 0 where there is nothing


def sample(lobes: Sequence[Lobe], wo: ArrayLike, u_lobe: Array, u: Array, eta: float = 1) -> BsdfSamples:
    n = len(u)
    out = BsdfSamples(empty(n, 3), empty(n, 3), empty(n), empty(n, kind=np.int32))
    call(
        "probe_bsdf_sample",
        *_lobes(lobes),
        np.float32(eta),
        f32(wo),
        np.ascontiguousarray(u_lobe),
        u,
        np.uint64(n),
        *out,
    )
    return out


def adjoint_weights(lobes: Sequence[Lobe], wo: ArrayLike, u_lobe: Array, u: Array, eta: float = 1) -> Array:
    """(n, 3): of what sample() returns, where light flows the other way."""
    n = len(u)
    out = empty(n, 3)
    call(
        "probe_bsdf_adjoint",
        *_lobes(lobes),
        np.float32(eta),
        f32(wo),
        np.ascontiguousarray(u_lobe),
        u,
        np.uint64(n),
        out,
    )
    return out


class Coefficients(NamedTuple):
    sigma_t: Array
    alpha: Array
    weight: Array


def subsurface_medium(lobe: Lobe) -> Coefficients:
    out = Coefficients(empty(3), empty(3), empty(3))
    call("probe_subsurface_medium", _lobes([lobe])[0], *out)
    return out


GGX, MEAN_GGX, FRESNEL_RISE, DIELECTRIC_GGX = range(4)


def table(kind: int, cosine: ArrayLike, alpha: ArrayLike, ior: ArrayLike = 1.5) -> Array:
    """(n): a table of bsdf/ggx_albedo.h."""
    inputs = [np.ascontiguousarray(x) for x in np.broadcast_arrays(f32(cosine), f32(alpha), f32(ior))]
    out = empty(inputs[0].size)
    call("probe_ggx_albedo", kind, *inputs, np.uint64(inputs[0].size), out)
    return out


def describe(lobes: Sequence[Lobe]) -> tuple[Array, Array, bool, bool]:
    """Selection probabilities, albedo, is_specular, has_specular."""
    select, albedo, flags = empty(len(lobes)), empty(3), empty(2, kind=np.int32)
    call("probe_bsdf_describe", *_lobes(lobes), select, albedo, flags, empty(1))
    return select, albedo, bool(flags[0]), bool(flags[1])


def max_value(lobes: Sequence[Lobe]) -> float:
    """What no f cos_o exceeds."""
    out = empty(1)
    call("probe_bsdf_describe", *_lobes(lobes), empty(len(lobes)), empty(3), empty(2, kind=np.int32), out)
    return float(out[0])
