# SPDX-License-Identifier: GPL-3.0-or-later
"""Sky Texture: a picture of the model's sky that a program looks up, and its sun."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import acos, atan2, cos, degrees, pi, sin
from typing import TYPE_CHECKING, Any

import numpy as np

from ...scene.description import SkySun
from ...scene.program import Texture
from ..sky import daylight
from ..sky.multiple_scattering import horizon, multiple_scattering
from ..sky.picture import SkyPicture, SunDisc
from ..sky.single_scattering import single_scattering
from .surface import fact, place
from .values import Number, Triple, Value, added, lerp, math, op, product, scaled

if TYPE_CHECKING:
    from ..nodes import Nodes
    from ..sockets import Source

LIMB_DARKENING = 0.6
LEAST_SUN = 1e-4  # radians


@dataclass(frozen=True)
class _Sky:
    """A model and its parameters, without where the sun stands around."""

    kind: str
    sun_zenith: float
    numbers: tuple[float, ...]
    sun_size: float | None


@lru_cache(maxsize=4)
def _picture(sky: _Sky) -> tuple[SkyPicture, Texture]:
    if sky.kind == "PREETHAM":
        picture = daylight.preetham(sky.sun_zenith, sky.numbers[0])
    elif sky.kind == "HOSEK_WILKIE":
        picture = daylight.hosek_wilkie(sky.sun_zenith, *sky.numbers)
    else:
        altitude, intensity, air, dust, ozone = sky.numbers
        elevation, densities = pi / 2.0 - sky.sun_zenith, (air, dust, ozone)
        if sky.kind == "MULTIPLE_SCATTERING":
            picture = multiple_scattering(elevation, altitude, densities, sky.sun_size, intensity)
        else:
            old = sky.kind == "NISHITA"
            picture = single_scattering(elevation, altitude, densities, sky.sun_size, intensity, old)
    return picture, Texture("sky", np.ascontiguousarray(picture.pixels))


def _read(node: Any) -> tuple[_Sky, float]:
    """And the azimuth of its sun, from +y clockwise."""
    kind = node.sky_type
    if kind in ("PREETHAM", "HOSEK_WILKIE"):
        x, y, z = node.sun_direction.normalized()
        numbers: tuple[float, ...] = (node.turbidity,)
        if kind == "HOSEK_WILKIE":
            numbers = (node.turbidity, node.ground_albedo)
        return _Sky(kind, acos(min(max(z, -1.0), 1.0)), numbers, None), atan2(x, y)
    dust = node.dust_density if hasattr(node, "dust_density") else node.aerosol_density
    numbers = (node.altitude, node.sun_intensity, node.air_density, dust, node.ozone_density)
    size = max(node.sun_size, LEAST_SUN) if node.sun_disc else None
    return _Sky(kind, pi / 2.0 - node.sun_elevation, numbers, size), float(node.sun_rotation)


def sky_texture(nodes: Nodes, source: Source) -> Value:
    node = source.node
    sky, azimuth = _read(node)
    picture, texture = _picture(sky)
    # With a sun, Blender takes the direction as it is and hides the socket.
    is_asked = node.inputs[0].enabled
    direction = nodes.texture_place(source, "generated") if is_asked else place(nodes, "generated")
    x, y, z = (op("separate", direction, modes=(axis,)) for axis in "xyz")
    u = math("fraction", math("multiply_add", math("arctan2", x, y), 0.5 / pi, 0.5 - azimuth / (2.0 * pi)))
    elevation = math("arcsine", z)
    rows = len(picture.pixels)
    row: Number
    if picture.both:
        part = math("sqrt", math("multiply", math("absolute", elevation), 2.0 / pi))
        row = math("multiply_add", math("multiply", part, math("sign", elevation)), 0.5, 0.5)
    else:
        part = math("sqrt", math("multiply", math("maximum", elevation, 0.0), 2.0 / pi))
        row = _choice(math("less_than", z, 0.0), (picture.below + 0.5) / rows, part)
    modes = ("flat", "linear", "extend", "as_is")
    color: Triple = op("image", op("combine", u, row, 0.0), 0.0, modes=modes, resource=texture)
    if not picture.both:
        # Black ground, which the horizon fades into.
        fade = math("maximum", math("multiply_add", math("minimum", z, 0.0), 2.5, 1.0), 0.0)
        color = scaled(color, math("multiply", fade, math("multiply", fade, fade)))
    if picture.sun is not None:
        towards = _towards(picture.sun, azimuth)
        disc = _disc(picture.sun, towards, direction, elevation)
        lowest = -horizon(node.altitude) if picture.both else 0.0
        shown = math("greater_than", elevation, lowest)
        if _take_sun(nodes, source, picture.sun, towards):
            shown = product(shown, fact("sun_disc"))
        color = added(color, scaled(disc, shown))
    return color if not isinstance(color, tuple) else (color[0], color[1], color[2])


def _choice(condition: Number, a: Number, b: Number) -> Number:
    """a where the condition is 1, b where it is 0."""
    return op("mix_number", condition, b, a)


def _towards(sun: SunDisc, azimuth: float) -> tuple[float, float, float]:
    across = cos(sun.elevation)
    return across * sin(azimuth), across * cos(azimuth), sin(sun.elevation)


def _disc(sun: SunDisc, towards: tuple[float, float, float], direction: Triple, elevation: Number) -> Triple:
    """Its radiance, black beside it. By distances: a cosine of so small an angle has no digits left."""
    away = (-towards[0], -towards[1], -towards[2])
    half = math("arctan2", op("distance", direction, towards), op("distance", direction, away))
    part = math("multiply", half, 4.0 / sun.size)
    rest = math("subtract", 1.0, math("multiply", part, part))
    limb = math("multiply_add", math("sqrt", math("maximum", rest, 0.0)), LIMB_DARKENING, 1.0 - LIMB_DARKENING)
    height = math("multiply_add", elevation, 1.0 / sun.size, 0.5 - sun.elevation / sun.size)
    return scaled(lerp(sun.bottom, sun.top, height), math("multiply", limb, math("greater_than", rest, 0.0)))


def _take_sun(nodes: Nodes, source: Source, sun: SunDisc, towards: tuple[float, float, float]) -> bool:
    """Whether the disc's light comes from a lamp; else it is found in the sky by chance."""
    if not nodes.is_sky:
        return False
    own = SkySun((-towards[0], -towards[1], -towards[2]), degrees(sun.size))
    vector = source.node.inputs[0]
    bent = vector.enabled and not nodes.is_free(source, vector)
    if bent or (nodes.sky_sun is not None and nodes.sky_sun != own):
        what = "stands in a bent sky" if bent else "is a second one in its sky"
        nodes.notice(source.node, f"the sun {what}: its light is noisier than that of a lamp")
        return False
    nodes.sky_sun = own
    return True
