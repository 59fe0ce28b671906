# SPDX-License-Identifier: GPL-3.0-or-later
"""Two analytic skies over turbidity: Preetham, Shirley and Smits 1999 ("A practical analytic model for daylight") and
Hosek and Wilkie 2012 ("An analytic model for full spectral sky-dome radiance").

hosek_wilkie.npy holds the coefficients that Hosek and Wilkie published with their paper, for the CIE XYZ channels:
(channel, ground albedo 0 or 1, turbidity 1 to 10, control point of the quintic, nine coefficients and the radiance).
Copyright 2012 - 2013 Lukas Hosek and Alexander Wilkie, under the 3-clause BSD licence.
"""

from __future__ import annotations

from functools import cache
from math import comb, pi
from pathlib import Path

import numpy as np

from ...scene.description import Floats
from .picture import SkyPicture, mirrored, rgb_of

WIDTH, HEIGHT = 1024, 512
LEAST_ABOVE_HORIZON = 0.001  # radians: below, both models repeat the horizon
LUMENS = 683.0


@cache
def _coefficients() -> Floats:
    return np.load(Path(__file__).with_name("hosek_wilkie.npy")).astype(np.float64)


def _angles(sun_zenith: float) -> tuple[Floats, Floats]:
    """The zenith angle and the angle from the sun of each pixel of the left half."""
    rows = 2.0 * (np.arange(HEIGHT) + 0.5) / HEIGHT - 1.0
    zenith = (pi / 2.0 - np.sign(rows) * rows**2 * pi / 2.0)[:, None]
    azimuth = (2.0 * pi * (np.arange(WIDTH // 2) + 0.5) / WIDTH - pi)[None, :]
    cosine = np.sin(zenith) * np.sin(sun_zenith) * np.cos(azimuth) + np.cos(zenith) * np.cos(sun_zenith)
    gamma = np.arccos(np.clip(cosine, -1.0, 1.0))
    return np.minimum(zenith, pi / 2.0 - LEAST_ABOVE_HORIZON), gamma


def _perez(c: Floats, zenith: Floats, gamma: Floats) -> Floats:
    falloff = 1.0 + c[0] * np.exp(c[1] / np.cos(zenith))
    return falloff * (1.0 + c[2] * np.exp(c[3] * gamma) + c[4] * np.cos(gamma) ** 2)


# Appendix A.2 of the paper: slope and offset by turbidity of the five coefficients of Y, x and y.
_PEREZ = np.array(
    [
        [[0.1787, -1.4630], [-0.3554, 0.4275], [-0.0227, 5.3251], [0.1206, -2.5771], [-0.0670, 0.3703]],
        [[-0.0193, -0.2592], [-0.0665, 0.0008], [-0.0004, 0.2125], [-0.0641, -0.8989], [-0.0033, 0.0452]],
        [[-0.0167, -0.2608], [-0.0950, 0.0092], [-0.0079, 0.2102], [-0.0441, -1.6537], [-0.0109, 0.0529]],
    ]
)
# Chromaticities at the zenith: rows by falling powers of turbidity, columns by falling powers of the sun's angle.
_ZENITH_X = np.array(
    [[0.00166, -0.00375, 0.00209, 0.0], [-0.02903, 0.06377, -0.03202, 0.00394], [0.11693, -0.21196, 0.06052, 0.25886]]
)
_ZENITH_Y = np.array(
    [[0.00275, -0.00610, 0.00317, 0.0], [-0.04214, 0.08970, -0.04153, 0.00516], [0.15346, -0.26756, 0.06670, 0.26688]]
)
_BLENDER_LUMINANCE = 0.06  # Blender's scale of the zenith's luminance


def preetham(sun_zenith: float, turbidity: float) -> SkyPicture:
    """sun_zenith in radians."""
    t, s = turbidity, sun_zenith
    chi = (4.0 / 9.0 - t / 120.0) * (pi - 2.0 * s)
    luminance = ((4.0453 * t - 4.9710) * np.tan(chi) - 0.2155 * t + 2.4192) * _BLENDER_LUMINANCE
    powers_of_t, powers_of_s = np.array([t * t, t, 1.0]), np.array([s**3, s * s, s, 1.0])
    zeniths = (luminance, powers_of_t @ _ZENITH_X @ powers_of_s, powers_of_t @ _ZENITH_Y @ powers_of_s)
    zenith, gamma = _angles(s)
    lum, x, y = (
        value * _perez(c, zenith, gamma) / _perez(c, np.array(0.0), np.array(s))
        for value, c in zip(zeniths, _PEREZ @ np.array([t, 1.0]), strict=True)
    )
    scale = np.where(y != 0.0, lum / np.where(y != 0.0, y, 1.0), 0.0)
    xyz = np.stack([x * scale, np.where(y != 0.0, lum, 0.0), (1.0 - x - y) * scale], axis=-1)
    return SkyPicture(mirrored(rgb_of(xyz)).astype(np.float32), both=True)


def hosek_wilkie(sun_zenith: float, turbidity: float, ground_albedo: float) -> SkyPicture:
    """sun_zenith in radians."""
    zenith_of_sun = min(max(sun_zenith, 0.0), pi / 2.0)
    t = (1.0 - zenith_of_sun / (pi / 2.0)) ** (1.0 / 3.0)
    bezier = np.array([comb(5, k) * (1.0 - t) ** (5 - k) * t**k for k in range(6)])
    table = np.einsum("catkn,k->catn", _coefficients(), bezier)
    table = table[:, 0] * (1.0 - ground_albedo) + table[:, 1] * ground_albedo
    turbid = min(max(turbidity, 1.0), 10.0)
    low = min(int(turbid), 9)
    table = table[:, low - 1] * (low + 1 - turbid) + table[:, low] * (turbid - low)
    zenith, gamma = _angles(zenith_of_sun)
    cosine, cosine_of_sun = np.cos(zenith), np.cos(gamma)
    channels = []
    for c in table:
        mie = (1.0 + cosine_of_sun**2) / (1.0 + c[8] ** 2 - 2.0 * c[8] * cosine_of_sun) ** 1.5
        inner = c[2] + c[3] * np.exp(c[4] * gamma) + c[5] * cosine_of_sun**2 + c[6] * mie + c[7] * np.sqrt(cosine)
        channels.append((1.0 + c[0] * np.exp(c[1] / (cosine + 0.01))) * inner * c[9])
    pixels = rgb_of(np.stack(channels, axis=-1)) * (2.0 * pi / LUMENS)
    return SkyPicture(mirrored(pixels).astype(np.float32), both=True)
