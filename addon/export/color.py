# SPDX-License-Identifier: GPL-3.0-or-later
"""Arithmetic of colours, and colour by formula: blackbody, sRGB, and the mean of Fresnel's equations."""

from math import exp, log, sqrt

import numpy as np

from ..scene.description import Floats, Rgb

# CIE XYZ to linear Rec. 709, white at D65.
TO_RGB = np.array(
    [[3.2404542, -1.5371385, -0.4985314], [-0.9692660, 1.8760108, 0.0415560], [0.0556434, -0.2040259, 1.0572252]]
)


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

    Planck's law over the fits to the CIE 1931 observer of Wyman, Sloan and Shirley 2013 ("Simple analytic
    approximations to the CIE XYZ color matching functions", multi-lobe), from 380 to 780 nm.
    """
    wavelengths = np.arange(380.0, 781.0, 5.0)
    spectrum = wavelengths**-5.0 / np.expm1(1.4387769e7 / (wavelengths * max(kelvin, 800.0)))

    def lobe(center: float, below: float, above: float) -> Floats:
        width = np.where(wavelengths < center, below, above)
        return np.exp(-0.5 * ((wavelengths - center) * width) ** 2)

    x = 1.056 * lobe(599.8, 0.0264, 0.0323) + 0.362 * lobe(442.0, 0.0624, 0.0374) - 0.065 * lobe(501.1, 0.0490, 0.0382)
    y = 0.821 * lobe(568.8, 0.0213, 0.0247) + 0.286 * lobe(530.9, 0.0613, 0.0322)
    z = 1.217 * lobe(437.0, 0.0845, 0.0278) + 0.681 * lobe(459.0, 0.0385, 0.0725)
    xyz = np.array([(spectrum * curve).sum() for curve in (x, y, z)])
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
