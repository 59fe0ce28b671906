# SPDX-License-Identifier: GPL-3.0-or-later
"""Colour and roughness of each plate: metals by weight, and patina by height, slope and noise. Plain numpy."""

import dataclasses

import numpy as np

from .layout import FieldLayout
from .noise import Floats, hills, random_unit
from .parameters import FieldParameters

_CHUNK = 1 << 14  # plates at once, whose numbers stay in a core's cache
_METAL, _ROUGHNESS, _SPOT = range(400, 403)
_PATCHES = 23  # added to the seed


@dataclasses.dataclass(frozen=True)
class FieldLook:
    colors: Floats  # (n, 3), linear
    roughnesses: Floats  # (n)
    patinas: Floats  # (n), the share of patina, 0 to 1


def look_of(layout: FieldLayout, parameters: FieldParameters) -> FieldLook:
    n = len(layout)
    colors, roughnesses, patinas = np.empty((n, 3)), np.empty(n), np.empty(n)
    # Heights count by the hills' own, so that plates keep their patina where a field grows.
    reach = parameters.hill_height if parameters.hill_height > 0 else float(np.abs(layout.heights).max(initial=0.0))
    for begin in range(0, n, _CHUNK):
        part = slice(begin, begin + _CHUNK)
        colors[part], roughnesses[part], patinas[part] = _look_of_some(layout, parameters, part, reach)
    return FieldLook(colors, roughnesses, patinas)


def _look_of_some(
    layout: FieldLayout, parameters: FieldParameters, part: slice, reach: float
) -> tuple[Floats, Floats, Floats]:
    # A plate's own number is its identity here, with the 32 bits that it is made of.
    own = (layout.randoms[part] * 2.0**32).astype(np.int64)
    zero = np.zeros_like(own)

    def random(stream: int) -> Floats:
        return random_unit(own, zero, parameters.seed, stream)

    metals = (
        (1.0, parameters.metal_color, parameters.metal_roughness),
        (parameters.second_weight, parameters.second_color, parameters.second_roughness),
        (parameters.third_weight, parameters.third_color, parameters.third_roughness),
    )
    share = np.cumsum([weight for weight, _, _ in metals])
    which = np.zeros(len(own), np.int64)
    if share[-1] > share[0]:
        which = np.minimum(np.searchsorted(share, random(_METAL) * share[-1], side="right"), len(metals) - 1)
    colors = np.array([color for _, color, _ in metals])[which]
    roughness = np.array([own_roughness for _, _, own_roughness in metals])[which]
    if parameters.roughness_spread > 0:
        roughness = roughness + parameters.roughness_spread * (2.0 * random(_ROUGHNESS) - 1.0)
    if parameters.patina == 0:
        return colors, np.clip(roughness, 0.0, 1.0), np.zeros(len(own))
    patina = _patina(layout, parameters, part, reach, random(_SPOT))
    colors += patina[:, np.newaxis] * (np.array(parameters.patina_color) - colors)
    roughness = roughness + patina * (parameters.patina_roughness - roughness)
    return colors, np.clip(roughness, 0.0, 1.0), patina


def _patina(layout: FieldLayout, parameters: FieldParameters, part: slice, reach: float, spot: Floats) -> Floats:
    """Height, slope and noise vote, each from -1 to 1 times its weight; a plate's own number blurs the border."""
    vote = 0.3 * (2.0 * spot - 1.0)
    if reach > 0:
        vote += parameters.patina_height * np.clip(1.5 * layout.heights[part] / reach, -1.0, 1.0)
    vote += parameters.patina_slope * (2.0 * np.minimum(layout.steepness[part], 1.0) - 1.0)
    if parameters.patina_noise > 0:
        x, y = layout.places[part].T
        vote += parameters.patina_noise * 2.0 * hills(x, y, parameters.patina_length, 3, parameters.seed + _PATCHES)[0]
    # Half of what is undecided is covered at an amount of a half.
    t = np.clip(vote + 2.0 * parameters.patina - 0.5, 0.0, 1.0)
    return parameters.patina * t * t * (3.0 - 2.0 * t)
