# SPDX-License-Identifier: GPL-3.0-or-later
"""Procedural textures, as each version of Blender has them: a node shows by its properties which one it is of."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from .values import Number, Triple, Value, op, scaled

if TYPE_CHECKING:
    from ..nodes import Nodes
    from ..sockets import Source

FRACTALS = {
    "FBM": "fbm",
    "MULTIFRACTAL": "multifractal",
    "HYBRID_MULTIFRACTAL": "hybrid",
    "RIDGED_MULTIFRACTAL": "ridged",
    "HETERO_TERRAIN": "hetero",
}


class _Inputs:
    """The inputs of a texture node by name."""

    def __init__(self, nodes: Nodes, source: Source) -> None:
        self._nodes = nodes
        self._source = source

    def number(self, name: str, default: float) -> Number:
        return self._nodes.number_named(self._source, name, default)

    def color(self, name: str) -> Triple:
        return self._nodes.triple_named(self._source, name, (0.0, 0.0, 0.0))

    def place(self) -> Triple:
        return self._nodes.texture_place(self._source, "generated")


def noise(nodes: Nodes, source: Source) -> Value:
    node = source.node
    inputs = _Inputs(nodes, source)
    scale = inputs.number("Scale", 5.0)
    is_new = hasattr(node, "normalize")  # 4.0
    kind = FRACTALS[getattr(node, "noise_type", "FBM")]
    w = inputs.number("W", 0.0)
    values = [
        inputs.number(name, default)
        for name, default in (
            ("Detail", 2.0),
            ("Roughness", 0.5),
            ("Lacunarity", 2.0),
            ("Offset", 0.0),
            ("Gain", 1.0),
            ("Distortion", 0.0),
        )
    ]
    modes = (
        node.noise_dimensions.lower(),
        kind,
        "normalized" if getattr(node, "normalize", True) else "raw",
        "from_4" if is_new else "before_4",
    )
    name = "noise" if source.output.type == "VALUE" else "noise_color"
    place = inputs.place() if node.noise_dimensions != "1D" else (0.0,) * 3
    w = op("math", w, scale, 0.0, modes=("multiply", "free"))
    return op(name, scaled(place, scale), w, *values, modes=modes)


def musgrave(nodes: Nodes, source: Source) -> Value:
    node = source.node
    inputs = _Inputs(nodes, source)
    scale = inputs.number("Scale", 5.0)
    place = inputs.place() if node.musgrave_dimensions != "1D" else (0.0,) * 3
    w = op("math", inputs.number("W", 0.0), scale, 0.0, modes=("multiply", "free"))
    values = [inputs.number(name, 1.0) for name in ("Detail", "Dimension", "Lacunarity", "Offset", "Gain")]
    modes = (node.musgrave_dimensions.lower(), FRACTALS[node.musgrave_type])
    return op("musgrave", scaled(place, scale), w, *values, modes=modes)


VORONOI_FEATURES = {
    "F1": "f1",
    "F2": "f2",
    "SMOOTH_F1": "smooth_f1",
    "DISTANCE_TO_EDGE": "distance_to_edge",
    "N_SPHERE_RADIUS": "sphere_radius",
}


def voronoi(nodes: Nodes, source: Source) -> Value:
    node = source.node
    inputs = _Inputs(nodes, source)
    place = inputs.place() if node.voronoi_dimensions != "1D" else (0.0,) * 3
    is_new = hasattr(node, "normalize")  # 4.0: the others have no octaves
    names = ("Scale", "Detail", "Roughness", "Lacunarity", "Smoothness", "Exponent", "Randomness")
    defaults = (5.0, 0.0, 0.5, 2.0, 1.0, 0.5, 1.0)
    values = [inputs.number(name, default) for name, default in zip(names, defaults, strict=True)]
    modes = (
        node.voronoi_dimensions.lower(),
        VORONOI_FEATURES[node.feature],
        node.distance.lower(),
        "normalized" if is_new and node.normalize else "raw",
        "pcg" if nodes.version >= (4, 3) else "lookup3",
    )
    arguments = (place, inputs.number("W", 0.0), *values)
    identifier = source.output.identifier
    if identifier in ("Color", "Position"):
        return op("voronoi_color", *arguments, modes=(*modes, identifier.lower()))
    return op("voronoi_w" if identifier == "W" else "voronoi", *arguments, modes=modes)


def white_noise(nodes: Nodes, source: Source) -> Value:
    node = source.node
    dimensions = node.noise_dimensions
    vector = nodes.triple_named(source, "Vector", (0.0, 0.0, 0.0)) if dimensions != "1D" else (0.0,) * 3
    w = nodes.number_named(source, "W", 0.0)
    name = "white_noise" if source.output.type == "VALUE" else "white_noise_color"
    return op(name, vector, w, modes=(dimensions.lower(),))


def wave(nodes: Nodes, source: Source) -> Value:
    node = source.node
    inputs = _Inputs(nodes, source)
    names = ("Distortion", "Detail", "Detail Scale", "Detail Roughness", "Phase Offset")
    defaults = (0.0, 2.0, 1.0, 0.5, 0.0)
    values = [inputs.number(name, default) for name, default in zip(names, defaults, strict=True)]
    axis = node.bands_direction if node.wave_type == "BANDS" else node.rings_direction
    modes = (
        node.wave_type.lower(),
        {"SPHERICAL": "diagonal"}.get(axis, axis.lower()),
        {"SIN": "sine", "SAW": "saw", "TRI": "triangle"}[node.wave_profile],
        "from_4" if nodes.version >= (4, 0) else "before_4",
    )
    return op("wave", scaled(inputs.place(), inputs.number("Scale", 5.0)), *values, modes=modes)


def checker(nodes: Nodes, source: Source) -> Value:
    inputs = _Inputs(nodes, source)
    factor = op("checker", scaled(inputs.place(), inputs.number("Scale", 5.0)))
    if source.output.type == "VALUE":
        return factor
    return op("blend", factor, inputs.color("Color2"), inputs.color("Color1"), modes=("mix", "free"))


def gradient(nodes: Nodes, source: Source) -> Value:
    kind = source.node.gradient_type.lower()
    factor = op("gradient", _Inputs(nodes, source).place(), modes=(kind,))
    return factor if source.output.type == "VALUE" else op("splat", factor)


def magic(nodes: Nodes, source: Source) -> Value:
    inputs = _Inputs(nodes, source)
    color = op(
        "magic",
        inputs.place(),
        inputs.number("Scale", 5.0),
        inputs.number("Distortion", 1.0),
        modes=(str(source.node.turbulence_depth),),
    )
    return op("average", color) if source.output.type == "VALUE" else color


def gabor(nodes: Nodes, source: Source) -> Value:
    inputs = _Inputs(nodes, source)
    numbers = [
        inputs.number(name, default) for name, default in (("Scale", 5.0), ("Frequency", 2.0), ("Anisotropy", 1.0))
    ]
    dimensions = source.node.gabor_type.lower()
    if dimensions == "2d":
        orientation: Triple = op("combine", inputs.number("Orientation 2D", 0.0), 0.0, 0.0)
    else:
        orientation = nodes.triple_named(source, "Orientation 3D", (1.0, 0.0, 0.0))
    return op("gabor", inputs.place(), *numbers, orientation, modes=(dimensions, source.output.identifier.lower()))


def brick(nodes: Nodes, source: Source) -> Value:
    node: Any = source.node
    inputs = _Inputs(nodes, source)
    names = ("Mortar Size", "Mortar Smooth", "Bias", "Brick Width", "Row Height")
    numbers = [inputs.number(name, 0.0) for name in names]
    found = op(
        "brick",
        scaled(inputs.place(), inputs.number("Scale", 5.0)),
        *numbers,
        (float(node.offset), float(node.offset_frequency), 0.0),
        (float(node.squash), float(node.squash_frequency), 0.0),
    )
    mortar = op("separate", found, modes=("y",))
    if source.output.type == "VALUE":
        return mortar
    tint = op("separate", found, modes=("x",))
    own = op("blend", tint, inputs.color("Color1"), inputs.color("Color2"), modes=("mix", "free"))
    return op("blend", mortar, own, inputs.color("Mortar"), modes=("mix", "free"))
