# SPDX-License-Identifier: GPL-3.0-or-later
"""The error of a picture in an artist's words: its noise, in percent of what a pixel should show.

That is the root of the engine's relMSE: so much do pixels differ from the finished picture, in the root of the mean of
squares.
"""

from __future__ import annotations

from math import inf, isnan, sqrt

# Up to so much noise, in percent, a picture is called this.
WORDS = ((1.0, "clean"), (3.0, "clean to the eye"), (10.0, "some grain"), (30.0, "grainy"), (inf, "very grainy"))
FIREFLIES = "Fireflies"


def percent(relmse: float) -> float:
    return 100.0 * sqrt(max(relmse, 0.0))


def relmse_of(percent: float) -> float:
    return (percent / 100.0) ** 2


def digits(percent: float) -> str:
    return f"{percent:.0f}" if percent >= 10.0 else f"{percent:.2g}"


def noise_text(relmse: float, low: float | None = None, high: float | None = None) -> str:
    """With its interval, if that is known."""
    text = f"{digits(percent(relmse))} %"
    if low is None or high is None or isnan(low) or isnan(high):
        return text
    return f"{text} ({digits(percent(low))} to {digits(percent(high))} %)"


def word_for(relmse: float) -> str:
    return next(word for most, word in WORDS if percent(relmse) <= most)


def seconds_to_half_the_noise(seconds: float, to_half_relmse: float) -> float:
    """Half the noise is a quarter of the relMSE. seconds: rendered so far; to_half_relmse: until that has halved."""
    if seconds <= 0.0:
        return 2.0 * to_half_relmse
    return seconds * ((1.0 + to_half_relmse / seconds) ** 2 - 1.0)  # errors fall as a power of the time
