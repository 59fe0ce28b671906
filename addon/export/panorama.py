# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's panoramic cameras -> Panorama. The settings are Cycles' before Blender 5.0, the camera's since."""

from __future__ import annotations

from math import degrees
from typing import TYPE_CHECKING, Any

from ..scene import description as d
from ..scene.problems import GlimmerError

if TYPE_CHECKING:
    import bpy

Window = tuple[float, float, float, float]

# What each panorama type is made by, besides the sensor.
POLYNOMIAL = (
    "fisheye_polynomial_k0",
    "fisheye_polynomial_k1",
    "fisheye_polynomial_k2",
    "fisheye_polynomial_k3",
    "fisheye_polynomial_k4",
)
SETTINGS: dict[str, tuple[str, ...]] = {
    "EQUIRECTANGULAR": ("latitude_min", "latitude_max", "longitude_min", "longitude_max"),
    "FISHEYE_EQUIDISTANT": ("fisheye_fov",),
    "FISHEYE_EQUISOLID": ("fisheye_lens", "fisheye_fov"),
    "FISHEYE_LENS_POLYNOMIAL": ("fisheye_fov", *POLYNOMIAL),
    "MIRRORBALL": (),
    "EQUIANGULAR_CUBEMAP_FACE": (),
    "CENTRAL_CYLINDRICAL": (
        "central_cylindrical_range_v_min",
        "central_cylindrical_range_v_max",
        "central_cylindrical_range_u_min",
        "central_cylindrical_range_u_max",
        "central_cylindrical_radius",
    ),
}


def settings_of(data: bpy.types.Camera) -> Any:
    """What has the settings of a panorama; None where that is Cycles and the add-on is switched off."""
    return data if hasattr(data, "panorama_type") else getattr(data, "cycles", None)


def panorama(camera_object: bpy.types.Object, sensor: float, window: Window) -> d.Panorama:
    """sensor: millimetres across the whole picture."""
    settings = settings_of(camera_object.data)
    if settings is None:
        raise GlimmerError(
            f"Camera '{camera_object.name}' is panoramic, which Cycles has the settings of: enable its add-on"
        )
    fov = degrees(settings.fisheye_fov)
    match settings.panorama_type:
        case "EQUIRECTANGULAR":
            longitude = degrees(settings.longitude_min), degrees(settings.longitude_max)
            latitude = _angles(settings.latitude_min), _angles(settings.latitude_max)
            return d.Equirectangular(longitude, latitude, window)
        case "FISHEYE_EQUIDISTANT":
            return d.FisheyeEquidistant(fov, window)
        case "FISHEYE_EQUISOLID":
            return d.FisheyeEquisolid(settings.fisheye_lens / sensor, fov, window)
        case "FISHEYE_LENS_POLYNOMIAL":
            coefficients = (getattr(settings, name) for name in POLYNOMIAL)
            return d.FisheyePolynomial(tuple(-k * sensor**i for i, k in enumerate(coefficients)), fov, window)
        case "MIRRORBALL":
            return d.MirrorBall(window)
        case "EQUIANGULAR_CUBEMAP_FACE":
            return d.CubeFace(window)
        case "CENTRAL_CYLINDRICAL":
            across = settings.central_cylindrical_range_u_min, settings.central_cylindrical_range_u_max
            up = settings.central_cylindrical_range_v_min, settings.central_cylindrical_range_v_max
            radius = settings.central_cylindrical_radius
            return d.Cylindrical((degrees(across[0]), degrees(across[1])), (up[0] / radius, up[1] / radius), window)
        case other:
            raise GlimmerError(f"Camera '{camera_object.name}' has a panorama type that is not supported, {other}")


def _angles(latitude: float) -> float:
    """A quarter turn in float32 is more than 90 degrees."""
    return min(max(degrees(latitude), -90.0), 90.0)
