# SPDX-License-Identifier: GPL-3.0-or-later
"""Worlds to begin with: a field to the horizon of a small planet, haze, and moons on orbits. No Blender in here.

The eye stands over the origin and looks along +y. At the preset's frame every moon stands highest on its orbit, as
seen from there.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import cos, radians, sin, sqrt
from typing import Any

Color = tuple[float, float, float]


@dataclass(frozen=True)
class PresetMoon:
    """Angles in degrees: azimuth to the right of the look, the radius as seen from the eye."""

    name: str
    color: Color
    strength: float  # radiance, W/(m^2 sr)
    azimuth: float
    elevation: float
    distance: float
    angular_radius: float
    surface: str = "EVEN"
    period: float = 250.0  # in frames
    eccentricity: float = 0.0
    is_eastward: bool = False

    def place(self, eye: Color) -> Color:
        a, e = radians(self.azimuth), radians(self.elevation)
        x, y, z = eye
        across = self.distance * cos(e)
        return x + across * sin(a), y + across * cos(a), z + self.distance * sin(e)

    def radius(self) -> float:
        return self.distance * sin(radians(self.angular_radius))


@dataclass(frozen=True)
class Preset:
    label: str
    help: str
    moons: tuple[PresetMoon, ...]
    visual_range: float
    haze_color: Color
    anisotropy: float
    frame: int = 1
    eye_height: float = 3.0  # above the ground
    pitch: float = 4.0  # degrees up from level
    exposure: float = 0.0
    planet_radius: float = 900.0  # small, so that hills stand out before few plates reach the horizon
    hill_height: float = 17.0
    land: Mapping[str, Any] = field(default_factory=dict)  # of the field, beside these

    def reach(self) -> float:
        """How far the field must go: to where the planet hides the highest hill, from an eye over the highest."""
        eye = self.eye_height + self.hill_height
        return sqrt(2.0 * self.planet_radius * eye) + sqrt(2.0 * self.planet_radius * self.hill_height)


RED, GREEN, WHITE, BLUE, VIOLET = (
    (1.0, 0.05, 0.02),
    (0.08, 1.0, 0.18),
    (1.0, 0.9, 0.76),
    (0.06, 0.2, 1.0),
    (0.45, 0.15, 1.0),
)

PRESETS: dict[str, Preset] = {
    "CONVERGENCE": Preset(
        "Convergence of the Five",
        "All five moons come together over ridged hills of three metals",
        (
            PresetMoon("Red Moon", RED, 10.0, -14.0, 5.5, 170.0, 6.0, period=420.0),
            PresetMoon("White Moon", WHITE, 60.0, 2.0, 15.0, 210.0, 2.2, period=300.0),
            PresetMoon("Blue Moon", BLUE, 30.0, 16.0, 9.5, 120.0, 3.4, period=260.0, is_eastward=True),
            PresetMoon("Green Moon", GREEN, 14.0, 5.5, 5.0, 100.0, 1.5, period=200.0, eccentricity=0.3),
            PresetMoon("Black Moon", VIOLET, 0.8, -6.5, 11.0, 90.0, 3.0, "BLACK", 340.0, 0.0, True),
        ),
        visual_range=480.0,
        haze_color=(0.82, 0.86, 0.92),
        anisotropy=0.3,
        frame=100,
        land={
            "hill_wavelength": 50.0,
            "hill_octaves": 4,
            "hill_follow": 0.55,
            "second_weight": 0.15,
            "third_weight": 0.05,
            "cracked": 0.06,
            "missing": 0.01,
            "seed": 33,
        },
    ),
    "GREEN_NOON": Preset(
        "Green Noon",
        "A great green moon high over terraces with patina",
        (
            PresetMoon("Green Moon", GREEN, 7.0, 3.0, 16.0, 190.0, 5.0, period=500.0),
            PresetMoon("White Moon", WHITE, 90.0, -17.0, 9.0, 220.0, 1.4, period=220.0, is_eastward=True),
            PresetMoon("Far Moon", (0.95, 0.75, 0.55), 0.0, 19.0, 8.0, 110.0, 3.4, "LIT", 320.0),
        ),
        visual_range=600.0,
        haze_color=(0.8, 0.92, 0.84),
        anisotropy=0.4,
        frame=60,
        pitch=5.5,
        exposure=0.5,
        land={
            "hill_wavelength": 50.0,
            "hill_follow": 0.3,
            "terrace_height": 1.6,
            "patina": 0.6,
            "seed": 56,
        },
    ),
    "BLACK_ECLIPSE": Preset(
        "Black Eclipse",
        "The black moon stands before the white one, over cracked plains",
        (
            PresetMoon("White Moon", WHITE, 110.0, 0.0, 10.0, 210.0, 4.4, period=400.0),
            PresetMoon("Black Moon", VIOLET, 0.5, 0.0, 10.0, 110.0, 4.15, "BLACK", 240.0),
            PresetMoon("Red Moon", RED, 16.0, -19.0, 4.5, 150.0, 2.0, period=300.0, is_eastward=True),
        ),
        visual_range=700.0,
        haze_color=(0.86, 0.84, 0.88),
        anisotropy=0.6,
        frame=80,
        exposure=-1.2,
        hill_height=7.0,
        land={
            "hill_kind": "BILLOWED",
            "hill_wavelength": 70.0,
            "hill_follow": 0.6,
            "cracked": 0.25,
            "sunken": 0.1,
            "crater_density": 0.35,
            "crater_radius": 14.0,
            "crater_depth": 4.5,
            "seed": 42,
        },
    ),
    "BLUE_DAWN": Preset(
        "Blue Dawn",
        "A blue moon rises over dunes, and lights a pale one",
        (
            PresetMoon("Blue Moon", BLUE, 42.0, 7.0, 4.0, 190.0, 5.0, period=450.0),
            PresetMoon("Amber Moon", (1.0, 0.55, 0.25), 90.0, -21.0, 7.0, 200.0, 1.3, period=350.0),
            PresetMoon("Pale Moon", (0.95, 0.85, 0.7), 0.0, -8.0, 13.0, 110.0, 3.6, "LIT", 280.0, 0.2, True),
        ),
        visual_range=650.0,
        haze_color=(0.8, 0.87, 0.94),
        anisotropy=0.5,
        frame=70,
        hill_height=7.0,
        land={
            "hill_kind": "DUNES",
            "hill_wavelength": 38.0,
            "hill_octaves": 2,
            "hill_follow": 0.9,
            "wind": 0.9,
            "metal_color": (0.86, 0.72, 0.55),
            "seed": 34,
        },
    ),
}
