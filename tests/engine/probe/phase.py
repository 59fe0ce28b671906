# SPDX-License-Identifier: GPL-3.0-or-later
"""The phase function."""

import numpy as np
from numpy.typing import ArrayLike

from tests.engine.probe.call import Array, call, empty, f32


def sample(g: float, before: ArrayLike, u: Array) -> tuple[Array, Array]:
    """Directions of propagation (n, 3) and their densities (n)."""
    out, pdf = empty(len(u), 3), empty(len(u))
    call("probe_phase_sample", np.float32(g), f32(before), u, np.uint64(len(u)), out, pdf)
    return out, pdf


def of_cosine(g: float, cosine: ArrayLike) -> Array:
    c = f32(cosine)
    out = empty(len(c))
    call("probe_phase_cos", np.float32(g), c, np.uint64(len(c)), out)
    return out


def of_directions(g: float, before: ArrayLike, after: ArrayLike) -> Array:
    directions = f32(after)
    out = empty(len(directions))
    call("probe_phase_directions", np.float32(g), f32(before), directions, np.uint64(len(directions)), out)
    return out
