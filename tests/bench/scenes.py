# SPDX-License-Identifier: GPL-3.0-or-later
"""The benchmark's scenes: .blend files of blend_scenes/, some with another haze or other metal."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Haze:
    sigma_s: tuple[float, float, float]  # per length
    sigma_a: tuple[float, float, float]


@dataclass(frozen=True)
class BenchScene:
    name: str
    what: str
    blend: str  # of blend_scenes/, without its suffix
    haze: Haze | None = None  # None: as it is in the file
    roughness: float | None = None  # of every glossy node; Blender's, so the root of GGX's alpha. None: as in the file
    fewer: int = 1  # by what the samples of all but `path` are divided, where one takes long


_NONE = Haze((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
# Ten times glimmervoid's extinction, channel by channel, with an albedo of 0.99.
_THICK = Haze((0.03366, 0.0396, 0.0495), (0.00034, 0.0004, 0.0005))

SCENES = (
    BenchScene("moons_in_fog", "fog only", "moons_in_fog"),
    BenchScene("field_without_fog", "glimmervoid without its haze", "glimmervoid", haze=_NONE),
    BenchScene("glimmervoid", "metal plates in haze", "glimmervoid"),
    BenchScene(
        "thick_fog", "glimmervoid in ten times thicker haze of albedo 0.99", "glimmervoid", haze=_THICK, fewer=4
    ),
    BenchScene("smooth_metal", "glimmervoid with all metal at GGX alpha 0.02", "glimmervoid", roughness=0.02**0.5),
    BenchScene("clearing", "plates around a steel sphere, in haze", "clearing"),
)
