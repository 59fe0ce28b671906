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
    LOOK = enum.auto()  # colour and roughness of each plate, which follow the layout
    DISPLAY = enum.auto()  # what the viewport shows of it


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
    needs: tuple[str, Any] | None = None  # (another parameter, its value) without which this one does nothing


def _parameter(default: Any, label: str, help: str, part: Part, section: str, **limits: Any) -> Any:
    return dataclasses.field(default=default, metadata={"control": Control(label, help, part, section, **limits)})


_EXTENTS = (
    ("RINGS", "Rings", "So many rings of plates around the one in the middle"),
    ("RADIUS", "Radius", "All plates whose centre lies within a distance from the middle"),
)
_PATTERNS = (
    ("HEXAGONS", "Hexagons", "Plates side by side, six around each"),
    ("CIRCLES", "Circles", "Circles of plates around the middle, each turned towards it"),
    (
        "SCATTER",
        "Scatter",
        "Plates at random, none closer to another than its width: on the ground's mesh, or on a disc",
    ),
)
_HILL_KINDS = (
    ("SMOOTH", "Smooth", "Rolling hills"),
    ("RIDGED", "Ridged", "Sharp ridges between wide valleys"),
    ("BILLOWED", "Billowed", "Round domes between creases"),
    ("DUNES", "Dunes", "Long waves, gentle against the wind and steep behind"),
)
_LAYOUT, _PLATES, _LOOK = Part.LAYOUT, Part.PLATES, Part.LOOK
SECTIONS = ("Extent", "Plates", "Hills", "Landforms", "Ground", "Mutation", "Breakage", "Metals", "Patina", "Display")
_EXTENT, _PLATE, _HILLS, _LANDFORMS, _GROUND, _MUTATION, _BREAKAGE, _METALS, _PATINA, _DISPLAY = SECTIONS
_RIGHT_ANGLE = math.pi / 2
_FULL_TURN = 2.0 * math.pi
# 4 324 801 plates.
MOST_RINGS = 1200


@dataclasses.dataclass(frozen=True)
class FieldParameters:
    """A field of hexagonal plates in the plane z = 0 of its object, around the origin."""

    pattern: str = _parameter("HEXAGONS", "Pattern", "How plates lie", _LAYOUT, _EXTENT, choices=_PATTERNS)
    extent: str = _parameter("RINGS", "Extent", "What bounds the field", _LAYOUT, _EXTENT, choices=_EXTENTS)
    rings: int = _parameter(
        20,
        "Rings",
        "Rings of plates around the middle",
        _LAYOUT,
        _EXTENT,
        maximum=MOST_RINGS,
        soft_maximum=150,
        needs=("extent", "RINGS"),
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
        needs=("extent", "RADIUS"),
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
    sector: float = _parameter(
        _FULL_TURN,
        "Sector",
        "Only plates within this angle, as seen from the middle",
        _LAYOUT,
        _EXTENT,
        maximum=_FULL_TURN,
        unit="ROTATION",
    )
    sector_direction: float = _parameter(
        0.0,
        "Direction",
        "Where the middle of the sector lies, counter-clockwise from the y axis",
        _LAYOUT,
        _EXTENT,
        minimum=-_FULL_TURN,
        maximum=_FULL_TURN,
        unit="ROTATION",
    )
    planet_radius: float = _parameter(
        0.0,
        "Planet Radius",
        "Plates lie on a sphere of this radius, whose top is the origin, and a horizon hides what lies beyond;"
        " 0: on a plane",
        _LAYOUT,
        _EXTENT,
        maximum=1e9,
        soft_maximum=1e5,
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

    hill_kind: str = _parameter("SMOOTH", "Kind", "Shape of the hills", _LAYOUT, _HILLS, choices=_HILL_KINDS)
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
    wind: float = _parameter(
        0.0,
        "Wind",
        "Where the wind of dunes blows to, counter-clockwise from the y axis",
        _LAYOUT,
        _HILLS,
        minimum=-_FULL_TURN,
        maximum=_FULL_TURN,
        unit="ROTATION",
        needs=("hill_kind", "DUNES"),
    )

    terrace_height: float = _parameter(
        0.0,
        "Terraces",
        "Height of the steps that hills rise in; 0: none",
        _LAYOUT,
        _LANDFORMS,
        soft_maximum=10,
        unit="LENGTH",
    )
    terrace_flatness: float = _parameter(
        0.8, "Flatness", "0: terraces are as steep as the hill; 1: level, with cliffs", _LAYOUT, _LANDFORMS, maximum=1.0
    )
    crater_density: float = _parameter(
        0.0, "Craters", "Share of the ground that has a crater", _LAYOUT, _LANDFORMS, maximum=1.0
    )
    crater_radius: float = _parameter(
        8.0,
        "Crater Radius",
        "Of the largest; the smallest have a third of it",
        _LAYOUT,
        _LANDFORMS,
        minimum=1e-3,
        soft_maximum=100,
        unit="LENGTH",
    )
    crater_depth: float = _parameter(
        2.0,
        "Crater Depth",
        "Of the largest, below the ground around it",
        _LAYOUT,
        _LANDFORMS,
        soft_maximum=50,
        unit="LENGTH",
    )
    path_width: float = _parameter(
        0.0,
        "Path",
        "Width of a path that winds along the y axis through the hills; 0: none",
        _LAYOUT,
        _LANDFORMS,
        soft_maximum=50,
        unit="LENGTH",
    )
    path_depth: float = _parameter(
        0.5,
        "Path Depth",
        "How far the path lies below the plane that hills stand on",
        _LAYOUT,
        _LANDFORMS,
        minimum=-1e6,
        soft_maximum=20,
        unit="LENGTH",
    )
    path_bend: float = _parameter(
        8.0, "Bends", "How far the path winds to both sides", _LAYOUT, _LANDFORMS, soft_maximum=100, unit="LENGTH"
    )
    path_length: float = _parameter(
        60.0,
        "Bend Length",
        "From bend to bend on the same side",
        _LAYOUT,
        _LANDFORMS,
        minimum=1e-3,
        soft_maximum=500,
        unit="LENGTH",
    )

    image_size: float = _parameter(
        100.0,
        "Image Size",
        "Width of the square that the height image covers, around the origin",
        _LAYOUT,
        _GROUND,
        minimum=1e-3,
        soft_maximum=1000,
        unit="LENGTH",
    )
    image_height: float = _parameter(
        10.0,
        "Image Height",
        "Height of what is white in the height image; black lies at 0",
        _LAYOUT,
        _GROUND,
        minimum=-1e6,
        soft_maximum=100,
        unit="LENGTH",
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

    missing: float = _parameter(0.0, "Missing", "Share of plates that are not there", _LAYOUT, _BREAKAGE, maximum=1.0)
    sunken: float = _parameter(0.0, "Sunken", "Share of plates that have sunk", _LAYOUT, _BREAKAGE, maximum=1.0)
    sunken_depth: float = _parameter(
        0.6, "Depth", "How far plates sink at most", _LAYOUT, _BREAKAGE, soft_maximum=10, unit="LENGTH"
    )
    cracked: float = _parameter(
        0.0, "Cracked", "Share of plates that are broken in two or three", _LAYOUT | _PLATES, _BREAKAGE, maximum=1.0
    )
    crack_width: float = _parameter(
        0.04, "Crack Width", "Between the pieces of a broken plate", _PLATES, _BREAKAGE, soft_maximum=0.5, unit="LENGTH"
    )

    metal_color: tuple[float, float, float] = _parameter(
        (0.56, 0.57, 0.6), "First", "Colour of the first metal", _LOOK, _METALS
    )
    metal_roughness: float = _parameter(0.35, "Roughness", "Of the first metal", _LOOK, _METALS, maximum=1.0)
    second_weight: float = _parameter(
        0.0, "Second Share", "So many plates of the second metal for one of the first", _LOOK, _METALS, soft_maximum=1.0
    )
    second_color: tuple[float, float, float] = _parameter(
        (0.95, 0.64, 0.54), "Second", "Colour of the second metal", _LOOK, _METALS
    )
    second_roughness: float = _parameter(0.25, "Roughness", "Of the second metal", _LOOK, _METALS, maximum=1.0)
    third_weight: float = _parameter(
        0.0, "Third Share", "So many plates of the third metal for one of the first", _LOOK, _METALS, soft_maximum=1.0
    )
    third_color: tuple[float, float, float] = _parameter(
        (1.0, 0.77, 0.34), "Third", "Colour of the third metal", _LOOK, _METALS
    )
    third_roughness: float = _parameter(0.2, "Roughness", "Of the third metal", _LOOK, _METALS, maximum=1.0)
    roughness_spread: float = _parameter(
        0.1, "Spread", "Roughness differs by up to this from plate to plate, both ways", _LOOK, _METALS, maximum=1.0
    )

    patina: float = _parameter(
        0.0,
        "Amount",
        "0: bare metal; 1: patina wherever height, slope and noise together allow it",
        _LOOK,
        _PATINA,
        maximum=1.0,
    )
    patina_color: tuple[float, float, float] = _parameter(
        (0.16, 0.42, 0.36), "Color", "Colour of the patina", _LOOK, _PATINA
    )
    patina_roughness: float = _parameter(0.75, "Roughness", "Of the patina", _LOOK, _PATINA, maximum=1.0)
    patina_height: float = _parameter(
        -0.5, "Height", "Above 0: on hills; below: in valleys", _LOOK, _PATINA, minimum=-1.0, maximum=1.0
    )
    patina_slope: float = _parameter(
        0.0, "Slope", "Above 0: on slopes; below: where it is level", _LOOK, _PATINA, minimum=-1.0, maximum=1.0
    )
    patina_noise: float = _parameter(0.5, "Noise", "In patches", _LOOK, _PATINA, maximum=1.0)
    patina_length: float = _parameter(
        12.0, "Patches", "Distance of the patches", _LOOK, _PATINA, minimum=1e-3, soft_maximum=200, unit="LENGTH"
    )

    simplify: bool = _parameter(
        False,
        "Simplify Far Plates",
        "Plates that the scene's camera sees small have one facet across their edges and neither bumps nor cracks",
        _LAYOUT | _PLATES,
        _DISPLAY,
        animatable=False,
    )
    simplify_pixels: float = _parameter(
        12.0,
        "Below",
        "Plates whose width covers fewer pixels of the picture are simplified",
        _LAYOUT,
        _DISPLAY,
        soft_maximum=100,
        unit="PIXEL",
        animatable=False,
        needs=("simplify", True),
    )
    viewport_share: float = _parameter(
        1.0,
        "Viewport Share",
        "Share of the plates that the 3D view shows; a render has them all",
        Part.DISPLAY,
        _DISPLAY,
        maximum=1.0,
        animatable=False,
    )

    def __post_init__(self) -> None:
        for name, control in controls():
            value = getattr(self, name)
            if control.choices:
                allowed = [choice[0] for choice in control.choices]
                if value not in allowed:
                    raise ValueError(f"hexagon field: {name} is {value!r}; allowed: {', '.join(allowed)}")
            elif isinstance(value, tuple):
                if len(value) != 3 or not all(0.0 <= part < math.inf for part in value):
                    raise ValueError(f"hexagon field: {name} is {value}; allowed: three numbers from 0 up")
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
