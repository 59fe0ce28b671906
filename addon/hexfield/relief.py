# SPDX-License-Identifier: GPL-3.0-or-later
"""The ground's height and its slopes by place: hills, dunes, craters, terraces and a path. Plain numpy."""

import numpy as np

from .noise import Floats, Sloped, hills, random_unit
from .parameters import FieldParameters

# Independent sets of random numbers.
_CRATER, _CRATER_SIZE, _CRATER_X, _CRATER_Y = range(200, 204)
_WARP, _RANGE = 7, 11  # added to the seed for noise that bends and thins out dunes
_WINDWARD = 0.72  # of a dune's length, over which it rises
_RIM, _RIM_HEIGHT = 0.5, 0.3  # of a crater's radius and depth


def relief(x: Floats, y: Floats, parameters: FieldParameters, ground: Sloped | None = None) -> Sloped:
    """Height at x, y, each (n), and its derivatives by both. ground: of what hills stand on, a plane without it."""
    z, slope_x, slope_y = (np.zeros_like(x) for _ in range(3)) if ground is None else (part.copy() for part in ground)
    if parameters.hill_height > 0:
        noise = (
            dunes(x, y, parameters)
            if parameters.hill_kind == "DUNES"
            else hills(x, y, parameters.hill_wavelength, parameters.hill_octaves, parameters.seed, parameters.hill_kind)
        )
        z, slope_x, slope_y = (
            base + parameters.hill_height * part for base, part in zip((z, slope_x, slope_y), noise, strict=True)
        )
    if parameters.crater_density > 0 and parameters.crater_depth > 0:
        for size in (1.0, 0.45):
            parts = craters(x, y, parameters, size)
            z, slope_x, slope_y = z + parts[0], slope_x + parts[1], slope_y + parts[2]
    if parameters.terrace_height > 0 and parameters.terrace_flatness > 0:
        z, steep = terraces(z, parameters)
        slope_x, slope_y = slope_x * steep, slope_y * steep
    if parameters.path_width > 0:
        z, slope_x, slope_y = _with_path(x, y, (z, slope_x, slope_y), parameters)
    return z, slope_x, slope_y


def dunes(x: Floats, y: Floats, parameters: FieldParameters) -> Sloped:
    """Crests across the wind, bent by noise, that thin out along their length. Height in [-1, 1]."""
    length, octaves, seed = parameters.hill_wavelength, parameters.hill_octaves, parameters.seed
    wind_x, wind_y = -np.sin(parameters.wind), np.cos(parameters.wind)
    # Bends are longer than dunes, so that crests do not turn back on themselves.
    bend, bend_x, bend_y = hills(x, y, 3.0 * length, octaves, seed + _WARP)
    phase = (wind_x * x + wind_y * y) / length + 1.2 * bend
    phase_x, phase_y = wind_x / length + 1.2 * bend_x, wind_y / length + 1.2 * bend_y
    share = phase - np.floor(phase)
    rising = share < _WINDWARD
    run = np.where(rising, 1.0 / _WINDWARD, -1.0 / (1.0 - _WINDWARD))
    t = np.pi * np.where(rising, share * run, (share - 1.0) * run)
    wave, wave_slope = -np.cos(t), np.pi * np.sin(t) * run
    strength, strength_x, strength_y = hills(x, y, 4.0 * length, 2, seed + _RANGE)
    strength = 0.65 + 0.35 * strength
    return (
        strength * wave,
        strength * wave_slope * phase_x + 0.35 * strength_x * wave,
        strength * wave_slope * phase_y + 0.35 * strength_y * wave,
    )


def craters(x: Floats, y: Floats, parameters: FieldParameters, size: float) -> Sloped:
    """At most one crater in each cell of a square lattice, which it does not leave; size: of the largest, relative to
    the parameters' radius and depth.
    """
    radius = parameters.crater_radius * size
    side = 2.0 * radius * (1.0 + _RIM)
    stream_seed = parameters.seed + int(1000 * size)
    angle = 1.1 * size
    c, s = np.cos(angle), np.sin(angle)
    u, v = (c * x - s * y) / side, (s * x + c * y) / side
    i, j = np.floor(u).astype(np.int64), np.floor(v).astype(np.int64)
    u, v = u - i, v - j

    def random(stream: int) -> Floats:
        return random_unit(i, j, stream_seed, stream)

    scale = 1.0 / 3.0 + random(_CRATER_SIZE) * 2.0 / 3.0
    free = 1.0 - scale  # of the cell's side, that the centre may move along
    u = (u - 0.5 - (random(_CRATER_X) - 0.5) * free) * side
    v = (v - 0.5 - (random(_CRATER_Y) - 0.5) * free) * side
    own_radius = radius * scale
    depth = np.where(random(_CRATER) < parameters.crater_density, parameters.crater_depth * size * scale, 0.0)
    distance = np.sqrt(u * u + v * v) / own_radius
    inside = np.maximum(1.0 - distance * distance, 0.0)
    rim = np.maximum(1.0 - ((distance - 1.0) / _RIM) ** 2, 0.0)
    height = depth * (_RIM_HEIGHT * rim * rim - inside * inside)
    # The derivative by the distance, over the distance: finite in the middle, where a rim's is 0.
    safe = np.maximum(distance, 1e-12)
    steep = depth * (4.0 * inside - _RIM_HEIGHT * 4.0 * rim * (distance - 1.0) / (_RIM * _RIM) / safe)
    slope_u, slope_v = steep * u / own_radius**2, steep * v / own_radius**2
    return height, slope_u * c + slope_v * s, slope_v * c - slope_u * s


def terraces(z: Floats, parameters: FieldParameters) -> tuple[Floats, Floats]:
    """Heights in steps, and by what slopes are to be multiplied."""
    sharp = 1.0 / (1.0 - 0.95 * parameters.terrace_flatness)  # from 1, which changes nothing, to 20
    steps = z / parameters.terrace_height
    floor = np.floor(steps)
    t = steps - floor - 0.5
    # Half a step down and up again, each a power of the way to the cliff in the middle: level at floors.
    way = np.abs(2.0 * t)
    risen = 0.5 * np.sign(t) * (1.0 - (1.0 - way) ** sharp)
    return parameters.terrace_height * (floor + 0.5 + risen), sharp * (1.0 - way) ** (sharp - 1.0)


def _with_path(x: Floats, y: Floats, ground: Sloped, parameters: FieldParameters) -> Sloped:
    """Level across its width, and as wide again on each side to rise to the hills."""
    turn = 2.0 * np.pi / parameters.path_length
    away = x - parameters.path_bend * np.sin(turn * y)
    bend = parameters.path_bend * turn * np.cos(turn * y)
    stretch = np.sqrt(1.0 + bend * bend)
    distance = np.abs(away) / stretch
    half = 0.5 * parameters.path_width
    t = np.clip((distance - half) / parameters.path_width, 0.0, 1.0)
    keep, keep_slope = t * t * (3.0 - 2.0 * t), 6.0 * t * (1.0 - t) / parameters.path_width
    bend_slope = -parameters.path_bend * turn * turn * np.sin(turn * y)
    distance_x = np.sign(away) / stretch
    distance_y = -np.sign(away) * bend / stretch - distance * bend * bend_slope / (stretch * stretch)
    z, slope_x, slope_y = ground
    above = z + parameters.path_depth
    return (
        keep * above - parameters.path_depth,
        keep * slope_x + keep_slope * distance_x * above,
        keep * slope_y + keep_slope * distance_y * above,
    )
