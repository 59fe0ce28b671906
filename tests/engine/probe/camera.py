# SPDX-License-Identifier: GPL-3.0-or-later
"""Cameras of all kinds. Rays are (n, 7): origin, direction, length."""

import ctypes
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from tests.engine.probe.call import Array, call, empty, f32

PERSPECTIVE, ORTHOGRAPHIC, PANORAMIC = range(3)
EQUIRECTANGULAR, EQUIDISTANT, EQUISOLID, POLYNOMIAL, MIRROR_BALL, CUBE_FACE, CYLINDRICAL = range(7)


class _Camera(ctypes.Structure):
    _fields_ = (
        ("type", ctypes.c_int32),
        *((name, ctypes.c_float * 3) for name in ("right", "up", "forward")),
        ("half_width", ctypes.c_float),
        ("aspect", ctypes.c_float),
        ("shift", ctypes.c_float * 2),
        *((name, ctypes.c_float) for name in ("lens_radius", "focus_distance", "clip_start", "clip_end")),
        ("panorama", ctypes.c_int32),
        ("longitude", ctypes.c_float * 2),
        ("latitude", ctypes.c_float * 2),
        *((name, ctypes.c_float) for name in ("half_angle", "focal_length")),
        ("polynomial", ctypes.c_float * 5),
        ("window", ctypes.c_float * 4),
        ("blades", ctypes.c_uint32),
        ("rotation", ctypes.c_float),
        ("scale", ctypes.c_float * 2),
    )


@dataclass(frozen=True)
class Camera:
    type: int
    axes: Array  # (3, 3): right, up, forward
    half_width: float = 0.8
    aspect: float = 0.6
    shift: tuple[float, float] = (0.0, 0.0)
    lens_radius: float = 0.0
    focus_distance: float = 1.0
    clip_start: float = 0.0
    clip_end: float = float("inf")
    panorama: int = 0
    longitude: tuple[float, float] = (-np.pi, np.pi)
    latitude: tuple[float, float] = (-np.pi / 2, np.pi / 2)
    half_angle: float = np.pi / 2
    focal_length: float = 0.3
    polynomial: tuple[float, ...] = (0.0, np.pi, 0.0, 0.0, 0.0)
    window: tuple[float, float, float, float] = (0.0, 0.0, 1.0, 1.0)
    blades: int = 0
    rotation: float = 0.0
    scale: tuple[float, float] = (1.0, 1.0)

    def made(self) -> Any:
        c = _Camera(self.type)
        for name, axis in zip(("right", "up", "forward"), self.axes, strict=True):
            getattr(c, name)[:] = axis
        c.half_width, c.aspect, c.lens_radius, c.focus_distance = (
            self.half_width,
            self.aspect,
            self.lens_radius,
            self.focus_distance,
        )
        c.shift[:], c.clip_start, c.clip_end = self.shift, self.clip_start, self.clip_end
        c.panorama, c.half_angle, c.focal_length = self.panorama, self.half_angle, self.focal_length
        c.longitude[:], c.latitude[:], c.polynomial[:] = self.longitude, self.latitude, self.polynomial
        c.window[:] = self.window
        c.blades, c.rotation, c.scale[:] = self.blades, self.rotation, self.scale
        return ctypes.byref(c)


class Projected(NamedTuple):
    seen: Array  # (n)
    film: Array  # (n, 2)
    rays: Array  # (n, 7), to the point
    area: Array  # (n): what the whole film would see across the ray


def generate(camera: Camera, film: ArrayLike, lens: ArrayLike) -> Array:
    points = f32(film)
    n = len(points)
    rays = empty(n, 7)
    call("probe_camera_generate", camera.made(), points, f32(lens, n, 2), np.uint64(n), rays)
    return rays


def lens_points(camera: Camera, disk: ArrayLike) -> Array:
    """(n, 2): points of the aperture."""
    points = f32(disk)
    out = empty(len(points), 2)
    call("probe_camera_lens", camera.made(), points, np.uint64(len(points)), out)
    return out


def is_on_lens(camera: Camera, lens: ArrayLike) -> Array:
    points = f32(lens)
    inside = empty(len(points), kind=np.int32)
    call("probe_camera_is_on_lens", camera.made(), points, np.uint64(len(points)), inside)
    return inside == 1


def lens_area(camera: Camera) -> float:
    """Over that of the unit disk."""
    return float(call("probe_camera_lens_area", camera.made(), returns=ctypes.c_float))


def is_seeing(camera: Camera, film: ArrayLike) -> Array:
    points = f32(film)
    seeing = empty(len(points), kind=np.int32)
    call("probe_camera_is_seeing", camera.made(), points, np.uint64(len(points)), seeing)
    return seeing == 1


def places(camera: Camera, film: ArrayLike) -> Array:
    """(n, 2): all places of the film where what is seen at one is seen."""
    found = empty(64, 2)
    count = call("probe_camera_places", camera.made(), f32(film), np.uint64(len(found)), found, returns=ctypes.c_uint64)
    return found[:count]


def is_invertible(camera: Camera) -> bool:
    return bool(call("probe_camera_is_invertible", camera.made(), returns=ctypes.c_int32))


def project(camera: Camera, x: ArrayLike, lens: ArrayLike) -> Projected:
    points = f32(x)
    n = len(points)
    out = Projected(empty(n, kind=np.int32), empty(n, 2), empty(n, 7), empty(n))
    call("probe_camera_project", camera.made(), points, f32(lens, n, 2), np.uint64(n), *out)
    return out


def clip(camera: Camera, rays: ArrayLike, film: Sequence[float]) -> Array:
    """film: begin and end of the part, x y x y. (n, 2)"""
    lines = f32(rays)
    parts = empty(len(lines), 2)
    call("probe_camera_clip", camera.made(), lines, f32(film), np.uint64(len(lines)), parts)
    return parts


def sample_seen(
    camera: Camera, ray: ArrayLike, part: ArrayLike, extinction: float, u: ArrayLike
) -> tuple[Array, Array]:
    """t and pdf, (n) each."""
    numbers = f32(u)
    n = len(numbers)
    t, pdf = empty(n), empty(n)
    call(
        "probe_camera_sample_seen",
        camera.made(),
        f32(ray),
        f32(part),
        np.float32(extinction),
        numbers,
        np.uint64(n),
        t,
        pdf,
    )
    return t, pdf


def sees(camera: Camera, sphere: ArrayLike, film: ArrayLike) -> Array:
    """sphere: centre and radius."""
    points = f32(film)
    seen = empty(len(points), kind=np.int32)
    call("probe_camera_sees", camera.made(), f32(sphere), points, np.uint64(len(points)), seen)
    return seen


def start_region(camera: Camera) -> Array:
    """Centre and radius."""
    region = empty(4)
    call("probe_camera_start_region", camera.made(), region)
    return region
