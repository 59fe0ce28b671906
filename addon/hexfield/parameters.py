# SPDX-License-Identifier: GPL-3.0-or-later
"""What describes a hexagon field: one table, read by the layout, the plates, Blender's properties and the panel.

Lengths are in scene units, angles in radians. No bpy here.
"""

import dataclasses
import enum
import math
from collections.abc import Iterator
from typing import Any


class Part(enum.Flag):
    """What has to be made anew when a parameter changes."""

    LAYOUT = enum.auto()
    PLATES = enum.auto()


@dataclasses.dataclass(frozen=True)
class Control:
    """How a parameter is shown and limited in Blender. `choices` are (identifier, label, help)."""

    label: str
    help: str
    part: Part
    section: str = ""
    minimum: float = 0.0
    maximum: float = math.inf
    soft_maximum: float | None = None
    unit: str = "NONE"
    animatable: bool = True
    choices: tuple[tuple[str, str, str], ...] = ()


def _parameter(default: Any, label: str, help: str, part: Part, section: str, **limits: Any) -> Any:
    return dataclasses.field(default=default, metadata={"control": Control(label, help, part, section, **limits)})


_EXTENTS = (
    ("RINGS", "Rings", "So many rings of plates around the one in the middle"),
    ("RADIUS", "Radius", "All plates whose centre lies within a distance from the middle"),
)
_LAYOUT, _PLATES = Part.LAYOUT, Part.PLATES
_EXTENT, _PLATE, _HILLS, _MUTATION = SECTIONS = ("Extent", "Plates", "Hills", "Mutation")
_RIGHT_ANGLE = math.pi / 2
# 751 501 plates.
MOST_RINGS = 500


@dataclasses.dataclass(frozen=True)
class FieldParameters:
    """A field of hexagonal plates in the plane z = 0 of its object, around the origin."""

    extent: str = _parameter("RINGS", "Extent", "What bounds the field", _LAYOUT, _EXTENT, choices=_EXTENTS)
    rings: int = _parameter(
        20, "Rings", "Rings of plates around the middle", _LAYOUT, _EXTENT, maximum=MOST_RINGS, soft_maximum=150
    )
    radius: float = _parameter(
        30.0,
        "Radius",
        "Distance of the outermost plate centres",
        _LAYOUT,
        _EXTENT,
        maximum=1e6,
        soft_maximum=300,
        unit="LENGTH",
    )
    clearing: float = _parameter(
        0.0,
        "Clearing",
        "Radius of a disc in the middle that no plate reaches into",
        _LAYOUT,
        _EXTENT,
        soft_maximum=50,
        unit="LENGTH",
    )
    seed: int = _parameter(0, "Seed", "Another number, another field", _LAYOUT | _PLATES, _EXTENT, maximum=2**31 - 1)

    plate_radius: float = _parameter(
        1.0,
        "Radius",
        "From the centre of a plate to its corners",
        _LAYOUT | _PLATES,
        _PLATE,
        minimum=1e-4,
        unit="LENGTH",
    )
    gap: float = _parameter(
        0.06, "Gap", "Between the sides of neighbours", _LAYOUT, _PLATE, soft_maximum=2, unit="LENGTH"
    )
    thickness: float = _parameter(
        0.6, "Thickness", "Height of a plate", _PLATES, _PLATE, minimum=1e-4, soft_maximum=10, unit="LENGTH"
    )
    bevel_width: float = _parameter(
        0.08,
        "Bevel",
        "Radius of the rounded edges; at most 0.9 of what fits",
        _PLATES,
        _PLATE,
        soft_maximum=0.5,
        unit="LENGTH",
    )
    bevel_segments: int = _parameter(
        3,
        "Segments",
        "Facets across a rounded edge, the bevel",
        _PLATES,
        _PLATE,
        minimum=1,
        maximum=32,
        soft_maximum=8,
        animatable=False,
    )
    bevel_smooth: bool = _parameter(
        True, "Smooth", "Shade the rounded edges as if they had no facets", _PLATES, _PLATE, animatable=False
    )

    hill_height: float = _parameter(
        1.5,
        "Height",
        "The hills stay within this of the plane, up and down",
        _LAYOUT,
        _HILLS,
        soft_maximum=50,
        unit="LENGTH",
    )
    hill_wavelength: float = _parameter(
        25.0,
        "Length",
        "Distance of the largest hills",
        _LAYOUT,
        _HILLS,
        minimum=1e-3,
        soft_maximum=200,
        unit="LENGTH",
    )
    hill_octaves: int = _parameter(
        3, "Octaves", "Layers of ever smaller hills; each has half the size", _LAYOUT, _HILLS, minimum=1, maximum=12
    )
    hill_follow: float = _parameter(
        0.0, "Follow", "0: plates lie level, as steps; 1: they lean with the hill", _LAYOUT, _HILLS, maximum=1.0
    )

    mutation_height: float = _parameter(
        0.06, "Height", "Plates are raised or sunk by up to this", _LAYOUT, _MUTATION, soft_maximum=5, unit="LENGTH"
    )
    mutation_tilt: float = _parameter(
        math.radians(3),
        "Tilt",
        "Plates lean by up to this angle",
        _LAYOUT,
        _MUTATION,
        maximum=_RIGHT_ANGLE,
        unit="ROTATION",
    )
    mutation_turn: float = _parameter(
        0.0,
        "Turn",
        "Plates are turned about their axis by up to this angle",
        _LAYOUT,
        _MUTATION,
        maximum=math.pi,
        unit="ROTATION",
    )
    mutation_size: float = _parameter(
        0.0, "Size", "Plates shrink by up to this share of their size", _LAYOUT, _MUTATION, maximum=0.99
    )
    mutation_shape: float = _parameter(
        0.03,
        "Shape",
        "Corners are moved and dented by up to this share of the plate radius",
        _PLATES,
        _MUTATION,
        maximum=0.3,
    )
    mutation_bevel: float = _parameter(
        0.15,
        "Bumps",
        "Bumps on the rounded edges, as a share of the bevel width",
        _PLATES,
        _MUTATION,
        maximum=0.5,
    )
    prototypes: int = _parameter(
        8,
        "Variants",
        "Different plates that the field is made of",
        _LAYOUT | _PLATES,
        _MUTATION,
        minimum=1,
        maximum=256,
        animatable=False,
    )

    def __post_init__(self) -> None:
        for name, control in controls():
            value = getattr(self, name)
            if control.choices:
                allowed = [choice[0] for choice in control.choices]
                if value not in allowed:
                    raise ValueError(f"hexagon field: {name} is {value!r}; allowed: {', '.join(allowed)}")
            elif not isinstance(value, bool) and not (
                control.minimum <= value <= control.maximum and math.isfinite(value)
            ):
                raise ValueError(
                    f"hexagon field: {name} is {value}; allowed: {control.minimum:g} to {control.maximum:g}"
                )

    def key(self, part: Part) -> str:
        """Equal for two fields exactly when `part` of them comes out the same."""
        return ";".join(f"{name}={getattr(self, name)!r}" for name, control in controls() if control.part & part)


def controls() -> Iterator[tuple[str, Control]]:
    """(name, control) of every parameter, in the order of the table."""
    for field in dataclasses.fields(FieldParameters):
        yield field.name, field.metadata["control"]
