# SPDX-License-Identifier: GPL-3.0-or-later
"""Arithmetic of colours, and colour by formula: blackbody, sRGB, and the mean of Fresnel's equations."""

from math import exp, log, sqrt

import numpy as np

from ..scene.description import Floats, Rgb
from . import observer

# CIE XYZ to linear Rec. 709, white at D65.
TO_RGB = np.array(
    [[3.2404542, -1.5371385, -0.4985314], [-0.9692660, 1.8760108, 0.0415560], [0.0556434, -0.2040259, 1.0572252]]
)

BLACKBODY_RANGE = (800.0, 12000.0)  # kelvins, beyond which the colour stays


def scaled(color: Rgb, factor: float) -> Rgb:
    return (color[0] * factor, color[1] * factor, color[2] * factor)


def add_colors(a: Rgb, b: Rgb) -> Rgb:
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def lerp(a: Rgb, b: Rgb, t: float) -> Rgb:
    return (a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t, a[2] + (b[2] - a[2]) * t)


def srgb_to_linear(values: Floats) -> Floats:
    """IEC 61966-2-1, elementwise."""
    low, high = values / 12.92, ((np.maximum(values, 0.0) + 0.055) / 1.055) ** 2.4
    return np.where(values <= 0.04045, low, high)


def luminance(color: Rgb) -> float:
    """Of linear Rec. 709."""
    return 0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2]


def blackbody(kelvin: float) -> Rgb:
    """Linear Rec. 709 of luminance 1, colours outside of the gamut cut to 0.

    Planck's law over the CIE 1931 observer, between the temperatures beyond which Blender's renderers keep the colour.
    """
    wavelengths = observer.FIRST + observer.STEP * np.arange(len(observer.XYZ))
    spectrum = wavelengths**-5.0 / np.expm1(1.4387769e7 / (wavelengths * np.clip(kelvin, *BLACKBODY_RANGE)))
    xyz = spectrum @ observer.XYZ
    red, green, blue = np.maximum(TO_RGB @ (xyz / xyz[1]), 0.0)
    return float(red), float(green), float(blue)


# Absorption by a unit of each pigment of hair (d'Eon et al. 2011, "An energy-conserving hair reflectance model").
EUMELANIN: Rgb = (0.506, 0.841, 1.653)
PHEOMELANIN: Rgb = (0.343, 0.733, 1.924)


def hair_reflectance(absorption: Rgb, radial_roughness: float = 0.3) -> Rgb:
    """The colour that much hair has: equation 9 of Chiang et al. 2016 ("A practical and controllable hair and fur model
    for production path tracing"), the other way round."""
    x = radial_roughness
    scale = 5.969 - 0.215 * x + 2.532 * x**2 - 10.73 * x**3 + 5.574 * x**4 + 0.245 * x**5
    r, g, b = (exp(-scale * sqrt(max(sigma, 0.0))) for sigma in absorption)
    return r, g, b


def mean_fresnel(ior: float) -> float:
    """Reflectance of a smooth dielectric for diffuse unpolarised light from outside: 2 int F(mu) mu d mu.

    The closed form of Egan and Hilgeman 1973 for ior > 1; below 1 the reciprocal relation, with its total reflection.
    """
    n = ior
    if abs(n - 1.0) < 1e-4:
        return 0.0
    if n < 1.0:
        return 1.0 - n * n * (1.0 - mean_fresnel(1.0 / n))
    n2, n4 = n * n, n**4
    return (
        0.5
        + (n - 1.0) * (3.0 * n + 1.0) / (6.0 * (n + 1.0) ** 2)
        + n2 * (n2 - 1.0) ** 2 / (n2 + 1.0) ** 3 * log((n - 1.0) / (n + 1.0))
        - 2.0 * n**3 * (n2 + 2.0 * n - 1.0) / ((n2 + 1.0) * (n4 - 1.0))
        + 8.0 * n4 * (n4 + 1.0) / ((n2 + 1.0) * (n4 - 1.0) ** 2) * log(n)
    )


def ior_of_normal_reflectance(f0: float) -> float:
    """The index of refraction whose reflectance at normal incidence is f0."""
    root = sqrt(min(max(f0, 0.0), 0.999))
    return (1.0 + root) / (1.0 - root)
