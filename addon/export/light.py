# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's lamps -> the engine's, in the units of Cycles (which differ between its versions)."""

from __future__ import annotations

from dataclasses import replace
from math import degrees, pi, sin
from typing import TYPE_CHECKING

import numpy as np

from ..scene.description import (
    BLACK,
    AreaLight,
    Floats,
    Lamp,
    LampFlags,
    LampProfile,
    PointLight,
    Rays,
    Rgb,
    SpotLight,
    SunLight,
)
from ..scene.problems import Notices, place
from ..scene.program import Op
from .camera import rigid
from .color import scaled
from .nodes import Nodes
from .translate.emitted import emitted, program_of
from .translate.image import Images

if TYPE_CHECKING:
    import bpy

Version = tuple[int, ...]

UNLIMITED_BOUNCES = 1024  # the most that Cycles takes, and its default
LEAST_SPREAD = pi / 180.0  # of an area lamp, in radians; Cycles makes less wider


def point_intensity(power: float) -> float:
    """W/sr of a point or spot of a power in W; a spot's cone cuts it and does not concentrate it. All versions."""
    return power / (4.0 * pi)


def area_radiance(power: float, area: float, version: Version) -> float:
    """W/(m^2 sr) of an area lamp of a power in W: a Lambertian emitter from 4.2, its old unit of P/4 before."""
    return power / (pi * area) if version >= (4, 2) else power / (4.0 * area)


def sun_irradiance(strength: float) -> float:
    """W/m^2 at normal incidence. All versions."""
    return strength


def ellipse_or_rectangle_area(size: tuple[float, float], ellipse: bool) -> float:
    return size[0] * size[1] * (pi / 4.0 if ellipse else 1.0)


def has_round_lamps(version: Version) -> bool:
    """Whether a lamp of a size may be a sphere, a spot is as bright at its rim as in its middle, and the sun's radiance
    is even."""
    return version >= (4, 0)


def export_lamp(
    item: bpy.types.Object,
    matrix: Floats,
    rays: Rays,
    version: Version,
    notices: Notices,
    images: Images | None = None,
) -> Lamp | None:
    """The lamp of an evaluated object at a matrix (4, 4); None where it gives no light. rays: that meet it."""
    data = item.data
    if data.type == "AREA" and getattr(getattr(data, "cycles", None), "is_portal", False):
        return None  # it only tells Cycles where to look for the sky
    where = place(item.name)
    color, profile = _color(data, matrix, where, notices, images)
    power = data.energy * 2.0 ** getattr(data, "exposure", 0.0)
    _note_differences(item, matrix, where, version, notices)
    if power <= 0.0 or not any(color):
        if power < 0.0:
            notices.add(where, "a lamp of negative power gives no light")
        return None
    flags = replace(_flags(data, rays, version), profile=profile)
    is_old = not has_round_lamps(version)
    direction = tuple(float(v) for v in -matrix[:3, 2])
    position = (float(matrix[0, 3]), float(matrix[1, 3]), float(matrix[2, 3]))
    if data.type == "SUN":
        if not getattr(data, "normalize", True):
            # The strength is then that of a disc of one square metre at a distance of one metre.
            power *= pi * sin(data.angle / 2.0) ** 2 if data.angle > 0.0 else 1.0
        irradiance = scaled(color, sun_irradiance(power))
        axis = (direction[0], direction[1], direction[2])
        return SunLight(item.name, axis, irradiance, degrees(data.angle), is_old, flags)
    if data.type == "AREA":
        return _area(item.name, data, matrix, color, power, version, flags)
    if not getattr(data, "normalize", True):
        # The power is then that of one square metre of the disc that it shows.
        power *= 4.0 * (pi * data.shadow_soft_size**2 if data.shadow_soft_size > 0.0 else 1.0)
    intensity = scaled(color, point_intensity(power))
    radius = data.shadow_soft_size
    is_disk = is_old or data.use_soft_falloff
    if data.type == "SPOT":
        axis = (direction[0], direction[1], direction[2])
        cone = (degrees(data.spot_size), data.spot_blend)
        return SpotLight(item.name, position, axis, intensity, *cone, radius, is_disk, is_old, flags)
    return PointLight(item.name, position, intensity, radius, is_disk, flags)


def _flags(data: bpy.types.Light, rays: Rays, version: Version) -> LampFlags:
    cycles = getattr(data, "cycles", None)  # None: Cycles is switched off
    # Before 4.2 the first was EEVEE's alone.
    shadows = data.use_shadow if version >= (4, 2) else getattr(cycles, "cast_shadow", True)
    bounces = getattr(cycles, "max_bounces", UNLIMITED_BOUNCES)
    return LampFlags(rays, bool(shadows), bounces if bounces < UNLIMITED_BOUNCES else None)


def _area(
    name: str,
    data: bpy.types.AreaLight,
    matrix: Floats,
    color: Rgb,
    power: float,
    version: Version,
    flags: LampFlags,
) -> AreaLight | None:
    scale = np.linalg.norm(matrix[:3, :2], axis=0)
    both = data.shape in ("RECTANGLE", "ELLIPSE")
    size = (float(data.size * scale[0]), float((data.size_y if both else data.size) * scale[1]))
    ellipse = data.shape in ("DISK", "ELLIPSE")
    area = ellipse_or_rectangle_area(size, ellipse)
    if area <= 0.0:
        return None
    radiance = area_radiance(power, area if getattr(data, "normalize", True) else 1.0, version)
    spread = degrees(max(data.spread, LEAST_SPREAD)) if data.spread < pi - 1e-4 else 180.0
    return AreaLight(name, rigid(matrix), size, scaled(color, radiance), ellipse, spread, flags)


def _color(
    data: bpy.types.Light, matrix: Floats, where: str, notices: Notices, images: Images | None
) -> tuple[Rgb, LampProfile | None]:
    """The colour, and what it is multiplied by where its nodes give more than one."""
    color: Rgb = (data.color[0], data.color[1], data.color[2])
    if getattr(data, "use_temperature", False):
        color = tuple(a * b for a, b in zip(color, data.temperature_color, strict=True))
    if not data.use_nodes or data.node_tree is None:
        return color, None
    nodes = Nodes(data, where, notices, images)
    nodes.lamp = data.type
    surface = nodes.surface_of_output()
    factor = BLACK if surface is None else emitted(nodes, surface)
    if not isinstance(factor, Op):
        return (color[0] * factor[0], color[1] * factor[1], color[2] * factor[2]), None
    program = program_of(nodes, factor, "they are left out")
    return color, None if program is None else LampProfile(program, matrix)


def _note_differences(item: bpy.types.Object, matrix: Floats, where: str, version: Version, notices: Notices) -> None:
    data = item.data
    if not getattr(getattr(data, "cycles", None), "use_multiple_importance_sampling", True):
        notices.add(where, "shows in mirrors, where a lamp without Multiple Importance does not show in Cycles")
    if data.type == "SPOT" and data.use_square:
        notices.add(where, "a square spot is not supported; it is round")
    scale = np.linalg.norm(matrix[:3, :3], axis=0)
    if data.type == "SPOT" and has_round_lamps(version) and not np.allclose(scale, scale[0], rtol=1e-3):
        notices.add(where, "a spot whose object is stretched is not supported; its cone is round")
