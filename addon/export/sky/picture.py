# SPDX-License-Identifier: GPL-3.0-or-later
"""What a sky model gives: a picture of directions, and the disc of the sun."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...scene.description import Floats, Rgb
from ..color import TO_RGB


@dataclass(frozen=True)
class SunDisc:
    """Radiance runs evenly from the lowest to the highest point; towards the limb it darkens."""

    elevation: float  # radians
    size: float  # full angle, radians
    bottom: Rgb  # radiance at the lowest point
    top: Rgb


@dataclass(frozen=True)
class SkyPicture:
    """(height, width, 3) radiance, bottom row first.

    Columns: the azimuth from the sun's, from -pi to pi, clockwise seen from above. Rows: the square root of the
    elevation, so that the horizon has more of them: from the horizon up, or with `both` from straight down to straight
    up."""

    pixels: Floats
    both: bool
    below: float = 0.0  # the row, of a picture from the horizon up, that fades out below it
    sun: SunDisc | None = None


def rgb_of(xyz: Floats) -> Floats:
    """(..., 3); colours out of the gamut are cut."""
    return np.maximum(xyz @ TO_RGB.T, 0.0)


COARSE = 65  # azimuths at which models integrate; what multiplies the phase functions is smooth between them


def coarse_azimuths() -> Floats:
    """From opposite the sun to the sun."""
    return np.linspace(-np.pi, 0.0, COARSE)


def between(coarse: Floats, azimuths: Floats) -> Floats:
    """(rows, COARSE, channels) -> (rows, azimuths, channels)."""
    at = (azimuths + np.pi) / np.pi * (COARSE - 1)
    low = np.clip(at.astype(int), 0, COARSE - 2)
    rest = (at - low)[None, :, None]
    return coarse[:, low] * (1.0 - rest) + coarse[:, low + 1] * rest


def mirrored(half: Floats) -> Floats:
    """(height, width, ...) from its left half: the sun stands in the middle."""
    return np.concatenate([half, half[:, ::-1]], axis=1)
