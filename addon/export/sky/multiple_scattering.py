# SPDX-License-Identifier: GPL-3.0-or-later
"""The sky of Blender 5.0 and later: light that the air scatters once by integration and more often by a fit, at four
wavelengths (Garcia Linan, "An efficient spectral sky", 2024: https://fgarlin.com/posts/2024-12-06-spectral_sky/)."""

from __future__ import annotations

from math import cos, pi, sin

import numpy as np

from ...scene.description import Floats
from .picture import SkyPicture, SunDisc, between, coarse_azimuths, mirrored, rgb_of

# Kilometres; four wavelengths: 630, 560, 490, 430 nm.
EARTH, THICKNESS = 6371.0, 100.0
ATMOSPHERE = EARTH + THICKNESS
GROUND_ALBEDO = 0.3
ANISOTROPY = 0.8
STEPS = 64
WIDTH, HEIGHT = 512, 256
TABLE_WIDTH, TABLE_HEIGHT = 256, 64
IRRADIANCE = np.array([1.679, 1.828, 1.986, 1.307])
RAYLEIGH = np.array([6.605e-3, 1.067e-2, 1.842e-2, 3.156e-2])
OZONE = np.array([3.472e-25, 3.914e-25, 1.349e-25, 11.03e-27]) * 334.5
AEROSOL_ABSORPTION = np.array([2.8722e-24, 4.6168e-24, 7.9706e-24, 1.3578e-23])
AEROSOL_SCATTERING = np.array([1.5908e-22, 1.7711e-22, 2.0942e-22, 2.4033e-22])
AEROSOL_DENSITY, AEROSOL_BACKGROUND, AEROSOL_HEIGHT = 1.3681e20, 2e6, 0.73
MANY_TIMES = 0.02 * np.array([0.217, 0.347, 0.594, 1.0])
TO_XYZ = np.array(
    [
        [53.386917738564668, 22.981337506691025, 0.0],
        [43.904844466369358, 71.347795700053394, 0.10250686796574131],
        [1.6137278251608962, 18.422960591455485, 31.742921188390806],
        [20.762668673810577, 2.3614213523314369, 110.48009643252140],
    ]
)


class _Air:
    """densities: of air, aerosols and ozone, 1 being the earth's."""

    def __init__(self, densities: tuple[float, float, float]) -> None:
        self._air, self._aerosols, self._ozone = densities
        cosines = np.linspace(-1.0, 1.0, TABLE_WIDTH)[None, :]
        altitudes = np.linspace(0.0, 1.0, TABLE_HEIGHT)[:, None]
        self._table = self.transmittance(*np.broadcast_arrays(cosines, altitudes))

    def scattering(self, altitude: Floats) -> tuple[Floats, Floats, Floats]:
        """By air, by aerosols, and all extinction, (..., 4) per kilometre."""
        h = altitude[..., None]
        air = RAYLEIGH * np.exp(-0.07771971 * h**1.16364243) * self._air
        log_h = np.log(np.maximum(h, 1e-4))
        ozone = OZONE * 3.78547397e20 * np.exp(-((log_h - 3.22261) ** 2) * 5.55555555 - log_h) * self._ozone
        count = AEROSOL_DENSITY * (np.exp(-h / AEROSOL_HEIGHT) + AEROSOL_BACKGROUND / AEROSOL_DENSITY) * self._aerosols
        aerosols = AEROSOL_SCATTERING * count
        return air, aerosols, air + aerosols + ozone + AEROSOL_ABSORPTION * count

    def transmittance(self, cosine: Floats, part: Floats) -> Floats:
        """(..., 4) from `part` of the air's thickness up, to the sun."""
        radius = EARTH + THICKNESS * part
        length = _way(radius, cosine, ATMOSPHERE)
        depth = np.zeros((*radius.shape, 4))
        for k in range(STEPS):
            t = (k + 0.5) / STEPS * length
            altitude = np.sqrt(radius * radius + 2.0 * radius * cosine * t + t * t) - EARTH
            depth += self.scattering(np.maximum(altitude, 0.0))[2]
        return np.exp(-depth * (length / STEPS)[..., None])

    def to_sun(self, cosine: Floats, part: Floats) -> Floats:
        """The same by table."""
        x = np.clip(cosine * 0.5 + 0.5, 0.0, 1.0) * (TABLE_WIDTH - 1)
        y = np.clip(part, 0.0, 1.0) * (TABLE_HEIGHT - 1)
        x, y = np.broadcast_arrays(x, y)
        x0, y0 = x.astype(int), y.astype(int)
        x1, y1 = np.minimum(x0 + 1, TABLE_WIDTH - 1), np.minimum(y0 + 1, TABLE_HEIGHT - 1)
        fx, fy = (x - x0)[..., None], (y - y0)[..., None]
        table = self._table
        low = table[y0, x0] * (1.0 - fx) + table[y0, x1] * fx
        high = table[y1, x0] * (1.0 - fx) + table[y1, x1] * fx
        return np.asarray(low * (1.0 - fy) + high * fy)

    def scattered_before(self, cosine: Floats, part: Floats, radius: Floats) -> Floats:
        """Radiance over the sun's irradiance of light that the ground or the air has scattered, all around."""
        one, zero = np.ones_like(part), np.zeros_like(part)
        omega = 2.0 * pi * (1.0 - np.sqrt(np.maximum(1.0 - (EARTH / radius) ** 2, 0.0)))
        from_ground = self.to_sun(one, zero) / self.to_sun(one, part)
        ground = (omega / (4.0 * pi) * GROUND_ALBEDO / pi * cosine)[..., None] * self.to_sun(cosine, zero) * from_ground
        return np.asarray(MANY_TIMES / (1.0 + 5.0 * np.exp(-17.92 * cosine))[..., None] + ground)


def _way(radius: Floats, cosine: Floats, sphere: float) -> Floats:
    """To a sphere about the earth's centre, along a ray; below 0: never."""
    b = radius * cosine
    root = b * b - radius * radius + sphere * sphere
    far = np.sqrt(np.maximum(root, 0.0))
    near = -b - far
    return np.where(root < 0.0, -1.0, np.where(near >= 0.0, near, -b + far))


def multiple_scattering(
    sun_elevation: float,
    altitude: float,
    densities: tuple[float, float, float],
    sun_size: float | None,
    sun_intensity: float,
) -> SkyPicture:
    """Angles in radians, altitude in metres. sun_size: None for no disc."""
    air = _Air(densities)
    height = min(max(altitude, 1.0), 99999.0) / 1000.0
    rows = 2.0 * (np.arange(HEIGHT) + 0.5) / HEIGHT - 1.0
    elevations = (np.sign(rows) * rows**2 * pi / 2.0)[:, None]
    up, across = np.sin(elevations), np.cos(elevations)

    def cosine_to_sun(azimuth: Floats) -> Floats:
        return np.asarray(up * sin(sun_elevation) + across * cos(sun_elevation) * np.cos(azimuth)[None, :])

    mu = cosine_to_sun(coarse_azimuths())
    start = np.full_like(up, EARTH + height)
    to_ground = _way(start, up, EARTH)
    length = np.where(to_ground < 0.0, _way(start, up, ATMOSPHERE), to_ground)
    of_air, of_aerosols, of_all = (np.zeros((*mu.shape, 4)) for _ in range(3))
    through = np.ones((*up.shape, 4))
    step = length / STEPS
    for k in range(STEPS):
        t = (k + 0.5) * step
        radius = np.sqrt(start * start + 2.0 * start * up * t + t * t)
        local = np.maximum(radius - EARTH, 0.0)
        part = local / THICKNESS
        cosine = (start * sin(sun_elevation) + t * mu) / radius
        by_air, by_aerosols, extinction = air.scattering(local)
        kept = np.exp(-extinction * step[..., None])
        weight = through * (1.0 - kept) / np.maximum(extinction, 1e-7)
        direct = air.to_sun(cosine, part) * weight
        of_air += by_air * direct
        of_aerosols += by_aerosols * direct
        of_all += (by_air + by_aerosols) * weight * air.scattered_before(cosine, part, radius)
        through = through * kept
    azimuth = 2.0 * pi * (np.arange(WIDTH // 2) + 0.5) / WIDTH - pi
    mu = cosine_to_sun(azimuth)[..., None]
    g = ANISOTROPY
    rayleigh_phase = 3.0 / (16.0 * pi) * (1.0 + mu * mu)
    mie_phase = (1.0 - g * g) / (4.0 * pi) / (1.0 + g * g - 2.0 * g * mu) ** 1.5
    radiance = rayleigh_phase * between(of_air, azimuth) + mie_phase * between(of_aerosols, azimuth)
    radiance = radiance + between(of_all, azimuth)
    pixels = rgb_of(mirrored(radiance * IRRADIANCE @ TO_XYZ))
    sun = None
    if sun_size is not None:
        solid_angle = 2.0 * pi * (1.0 - cos(sun_size / 2.0))
        ends = []
        for angle in (sun_elevation - sun_size / 2.0, sun_elevation + sun_size / 2.0):
            spectrum = IRRADIANCE * air.transmittance(np.array(sin(angle)), np.array(height / THICKNESS)) / solid_angle
            red, green, blue = (rgb_of(spectrum @ TO_XYZ) * sun_intensity).tolist()
            ends.append((red, green, blue))
        sun = SunDisc(sun_elevation, sun_size, ends[0], ends[1])
    return SkyPicture(pixels.astype(np.float32), both=True, sun=sun)


def horizon(altitude: float) -> float:
    """The elevation in radians below which the earth hides the sun; altitude in metres."""
    return float(pi / 2.0 - np.arcsin(EARTH / (EARTH + altitude / 1000.0)))
