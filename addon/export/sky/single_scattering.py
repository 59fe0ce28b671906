# SPDX-License-Identifier: GPL-3.0-or-later
"""Light that the air scatters once, over the sphere of the earth, with ozone, as Blender has it from 2.90 on: Nishita,
Sirai, Tadamura and Nakamae 1993 ("Display of the earth taking into account atmospheric scattering")."""

from __future__ import annotations

from math import cos, pi, sin

import numpy as np

from ...scene.description import Floats
from .picture import SkyPicture, SunDisc, between, coarse_azimuths, mirrored, rgb_of

# Metres.
EARTH, ATMOSPHERE = 6360e3, 6420e3
RAYLEIGH_HEIGHT, MIE_HEIGHT = 8e3, 1.2e3
OZONE_MIDDLE, OZONE_HALF = 25e3, 15e3
HIGHEST = 59999.0
MIE = 2e-5  # scattering, per metre; aerosols also absorb:
MIE_EXTINCTION = 1.11 * MIE
ANISOTROPY = 0.76
STEPS = 32  # along a ray
WIDTH, HEIGHT = 512, 128
ROW_BELOW = 1.0  # what Blender 5 continues below the horizon, to a hundredth

# From 380 to 780 nm. The sun's irradiance above the air, W / (m^2 nm); scattering of air and absorption of ozone, per
# metre at sea level; the CIE 1931 observer's x, y and z. In this order:
STEP = 20.0
_SPECTRA = """
1.4575683 5.4248201e-05 3.25126850e-09 0.001368 3.9e-05 0.006450001
1.5659631 4.4185499e-05 5.85395365e-09 0.01431 0.000396 0.06785001
1.6514845 3.6351519e-05 1.97719116e-08 0.13438 0.004 0.6456
1.7149624 3.0179290e-05 7.30956876e-08 0.34828 0.023 1.74706
1.7579798 2.5263202e-05 2.00845615e-07 0.2908 0.06 1.6692
1.7825641 2.1308593e-05 4.03839581e-07 0.09564 0.13902 0.8129501
1.7909511 1.8098380e-05 6.35513359e-07 0.0049 0.323 0.272
1.7854155 1.5470571e-05 9.67070412e-07 0.06327 0.71 0.07824999
1.7681555 1.3302850e-05 1.54797400e-06 0.2904 0.954 0.0203
1.7412207 1.1501848e-05 2.09038647e-06 0.5945 0.995 0.0039
1.7064713 9.9955743e-06 2.46128056e-06 0.9163 0.87 0.001650001
1.6655609 8.7279997e-06 2.73551299e-06 1.0622 0.631 0.0008
1.6199344 7.6551370e-06 2.15125863e-06 0.8544499 0.381 0.00019
1.5708360 6.7421720e-06 1.59051841e-06 0.4479 0.175 2e-05
1.5193234 5.9613413e-06 1.12356198e-06 0.1649 0.061 0
1.4662849 5.2903460e-06 7.35275515e-07 0.04677 0.017 0
1.4124585 4.7111569e-06 4.64501304e-07 0.01135916 0.004102 0
1.3584496 4.2091048e-06 3.30960799e-07 0.002899327 0.001047 0
1.3047491 3.7721838e-06 2.25126123e-07 0.0006900786 0.0002492 0
1.2517496 3.3905126e-06 1.48791293e-07 0.0001661505 6e-05 0
1.1997600 3.0559153e-06 1.68286234e-07 4.150994e-05 1.499e-05 0
"""
_COLUMNS = np.array(_SPECTRA.split(), np.float64).reshape(-1, 6).T
IRRADIANCE, RAYLEIGH, OZONE, OBSERVER = _COLUMNS[0], _COLUMNS[1], _COLUMNS[2], _COLUMNS[3:]
# Gauss-Laguerre of eight nodes, scaled so that the last one still lies within the air.
_NODES, _WEIGHTS = np.polynomial.laguerre.laggauss(8)
_LAST = 25.0
NODES, WEIGHTS = _NODES / _LAST, _WEIGHTS * np.exp(_NODES) / _LAST


def _densities(height: Floats) -> tuple[Floats, Floats, Floats]:
    """Of air, aerosols and ozone, as parts of those at sea level or of the layer's middle."""
    ozone = np.maximum(0.0, 1.0 - np.abs(height - OZONE_MIDDLE) / OZONE_HALF)
    return np.exp(-height / RAYLEIGH_HEIGHT), np.exp(-height / MIE_HEIGHT), ozone


def _way_out(radius: Floats, cosine: Floats) -> Floats:
    """From a place so far from the earth's centre to the end of the air, `cosine` from the zenith."""
    b = radius * cosine
    return -b + np.sqrt(b * b - radius * radius + ATMOSPHERE**2)


def _optical_depths(radius: Floats, cosine: Floats) -> Floats:
    """(3, ...): of air, aerosols and ozone of density 1, out of the air."""
    length = _way_out(radius, cosine)
    sums = np.zeros((3, *length.shape))
    for node, weight in zip(NODES.tolist(), WEIGHTS.tolist(), strict=True):
        t = node * length
        height = np.sqrt(radius * radius + 2.0 * radius * cosine * t + t * t) - EARTH
        sums += np.stack(_densities(height)) * weight
    return sums * length


def _radiance(elevations: Floats, sun_elevation: float, altitude: float, densities: tuple[float, ...]) -> Floats:
    """(rows, WIDTH / 2, 3) XYZ; columns by azimuth from the sun's, from -pi on."""
    up, across = np.sin(elevations)[:, None], np.cos(elevations)[:, None]

    def cosine_to_sun(azimuth: Floats) -> Floats:
        return np.asarray(up * sin(sun_elevation) + across * cos(sun_elevation) * np.cos(azimuth)[None, :])

    mu = cosine_to_sun(coarse_azimuths())
    start = EARTH + altitude
    segment = _way_out(np.full_like(up, start), up) / STEPS
    air, dust, ozone = densities
    own = np.zeros((3, *up.shape))
    by_air, by_dust = (np.zeros((*mu.shape, len(IRRADIANCE)), np.float32) for _ in range(2))
    coefficients = np.stack([RAYLEIGH * air, np.full_like(RAYLEIGH, MIE_EXTINCTION * dust), OZONE * ozone])
    for k in range(STEPS):
        t = (k + 0.5) * segment
        radius = np.sqrt(start * start + 2.0 * start * up * t + t * t)
        local = _densities(radius - EARTH)
        own += np.stack(local) * segment
        to_sun = (start * sin(sun_elevation) + t * mu) / radius
        radius = np.broadcast_to(radius, to_sun.shape)
        depths = np.moveaxis(own + _optical_depths(radius, to_sun), 0, -1)
        lit = (to_sun >= 0.0) | (radius * radius * (1.0 - to_sun * to_sun) > EARTH**2)
        light = np.exp(-(depths @ coefficients).astype(np.float32)) * (lit * segment)[..., None].astype(np.float32)
        by_air += light * local[0][..., None].astype(np.float32)
        by_dust += light * local[1][..., None].astype(np.float32)
    azimuth = 2.0 * pi * np.arange(WIDTH // 2) / WIDTH - pi
    mu = cosine_to_sun(azimuth)[..., None]
    g2 = ANISOTROPY**2
    rayleigh_phase = 3.0 / (16.0 * pi) * (1.0 + mu * mu)
    mie_phase = 3.0 * (1.0 - g2) * (1.0 + mu * mu)
    mie_phase /= 8.0 * pi * (2.0 + g2) * (1.0 + g2 - 2.0 * ANISOTROPY * mu) ** 1.5
    observer = OBSERVER.T * STEP
    of_air = between((by_air * (IRRADIANCE * RAYLEIGH * air)) @ observer, azimuth)
    of_dust = between((by_dust * (IRRADIANCE * MIE * dust)) @ observer, azimuth)
    return np.asarray(rayleigh_phase * of_air + mie_phase * of_dust)


def single_scattering(
    sun_elevation: float,
    altitude: float,
    densities: tuple[float, float, float],
    sun_size: float | None,
    sun_intensity: float,
    old_rows: bool,
) -> SkyPicture:
    """Angles in radians, altitude in metres; densities of air, aerosols and ozone, 1 being the earth's. sun_size: None
    for no disc. old_rows: where rows stand before Blender 5.0."""
    height = min(max(altitude, 1.0), HIGHEST)
    numbers = np.arange(HEIGHT) / HEIGHT
    highest = pi / 2.0 + pi / 4.0 / HEIGHT if old_rows else pi / 2.0
    elevations = highest * numbers**2
    pixels = rgb_of(mirrored(_radiance(elevations, sun_elevation, height, densities)))
    if not old_rows:
        pixels[0] = 0.0
    sun = None if sun_size is None else _sun(sun_elevation, height, densities, sun_size, sun_intensity)
    return SkyPicture(pixels.astype(np.float32), both=False, below=0.0 if old_rows else ROW_BELOW, sun=sun)


def _sun(
    elevation: float, altitude: float, densities: tuple[float, float, float], size: float, intensity: float
) -> SunDisc | None:
    bottom, top = max(elevation - size / 2.0, 0.0), max(elevation + size / 2.0, 0.0)
    if top <= 0.0:
        return None
    solid_angle = 2.0 * pi * (1.0 - cos(size / 2.0))
    ends = []
    for angle in (bottom, top):
        depths = _optical_depths(np.array(EARTH + altitude), np.array(sin(angle)))
        extinction = RAYLEIGH * depths[0] * densities[0] + MIE_EXTINCTION * depths[1] * densities[1]
        xyz = OBSERVER @ (IRRADIANCE * np.exp(-extinction)) * STEP / solid_angle
        red, green, blue = (rgb_of(xyz) * intensity).tolist()
        ends.append((red, green, blue))
    return SunDisc(elevation, size, ends[0], ends[1])
