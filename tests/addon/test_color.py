# SPDX-License-Identifier: GPL-3.0-or-later

from math import sqrt

import numpy as np
import pytest
from numpy.typing import NDArray

from addon.export.color import blackbody, ior_of_normal_reflectance, luminance, mean_fresnel, srgb_to_linear


def fresnel(cosine: NDArray[np.float64], ior: float) -> NDArray[np.float64]:
    """Unpolarised, from outside of a dielectric; 1 beyond the critical angle."""
    under = ior * ior - 1.0 + cosine * cosine
    g = np.sqrt(np.maximum(under, 0.0))
    value = 0.5 * ((g - cosine) / (g + cosine)) ** 2
    value *= 1.0 + ((cosine * (g + cosine) - 1.0) / (cosine * (g - cosine) + 1.0)) ** 2
    return np.where(under > 0.0, value, 1.0)


@pytest.mark.parametrize("ior", [0.7, 1.05, 1.33, 1.5, 2.4])
def test_mean_fresnel_is_the_integral(ior: float) -> None:
    cosine = (np.arange(400_000) + 0.5) / 400_000
    assert mean_fresnel(ior) == pytest.approx(float((fresnel(cosine, ior) * 2.0 * cosine).mean()), rel=1e-6)


def test_mean_fresnel_of_nothing_is_nothing() -> None:
    assert mean_fresnel(1.0) == 0.0


@pytest.mark.parametrize("ior", [1.1, 1.5, 3.0])
def test_ior_and_normal_reflectance_are_inverse(ior: float) -> None:
    assert ior_of_normal_reflectance(((ior - 1.0) / (ior + 1.0)) ** 2) == pytest.approx(ior)


def test_srgb_to_linear() -> None:
    # IEC 61966-2-1: the two branches meet at 0.04045, and mid grey 0.5 is 0.21404.
    np.testing.assert_allclose(srgb_to_linear(np.array([0.0, 0.5, 1.0])), [0.0, 0.214041, 1.0], atol=1e-6)
    np.testing.assert_allclose(srgb_to_linear(np.array([0.04044999, 0.04045001])), 0.04045 / 12.92, rtol=1e-5)


def test_blackbody_of_daylight_is_white_and_of_a_candle_red() -> None:
    # The white of Rec. 709 is D65; a blackbody of 6504 K is a little greener or more purple than daylight, not more.
    assert blackbody(6504.0) == pytest.approx((1.0, 1.0, 1.0), abs=0.06)
    red, green, blue = blackbody(1900.0)
    assert red > green > blue
    assert luminance(blackbody(4000.0)) == pytest.approx(1.0, abs=0.01)


def test_blackbody_chromaticity() -> None:
    # Illuminant A is a blackbody of 2856 K: x, y = 0.44757, 0.40745 (CIE 15).
    to_xyz = np.array(
        [[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750], [0.0193339, 0.1191920, 0.9503041]]
    )
    xyz = to_xyz @ np.array(blackbody(2856.0))
    assert xyz[0] / xyz.sum() == pytest.approx(0.44757, abs=0.005)
    assert xyz[1] / xyz.sum() == pytest.approx(0.40745, abs=0.005)
    assert sqrt(xyz[1]) == pytest.approx(1.0, abs=0.01)
