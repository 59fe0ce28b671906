# SPDX-License-Identifier: GPL-3.0-or-later
"""Volume nodes of a world or a material -> Medium, by the formulas of Cycles."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import pi

from ..scene.description import BLACK, Medium
from ..scene.problems import Notices
from ..scene.program import Op, TooLargeError, programmed
from .haze import height_haze
from .nodes import Nodes
from .sockets import Input, Source
from .translate import color as color_nodes
from .translate.surface import geometry
from .translate.values import (
    Number,
    Triple,
    added,
    clamped,
    clamped_color,
    math,
    multiplied,
    op,
    product,
    scaled,
    square_root,
    vector_math,
    weighted,
)

# The engine's bound: a phase function of exactly 1 or -1 scatters nothing at all.
MAX_ANISOTROPY = 0.999

# Of Stefan and Boltzmann over pi, in Blender's units: what a black body of one kelvin radiates.
BLACKBODY_RADIANCE = 5.670373e-8 * 1e-6 / pi

LUMINANCE = (0.2126729, 0.7151522, 0.0721750)
WHITE = (1.0, 1.0, 1.0)


@dataclass(frozen=True)
class Coefficients:
    """Constants, or what varies from place to place."""

    sigma_a: Triple = BLACK
    sigma_s: Triple = BLACK
    weighted_g: Number = 0.0  # g times the luminance of sigma_s, so that sums keep the mean cosine
    emission: Triple = BLACK
    anisotropies: tuple[Number, ...] = ()  # of all that scatters, each once

    def __add__(self, other: Coefficients) -> Coefficients:
        return Coefficients(
            added(self.sigma_a, other.sigma_a),
            added(self.sigma_s, other.sigma_s),
            _sum(self.weighted_g, other.weighted_g),
            added(self.emission, other.emission),
            (*self.anisotropies, *(g for g in other.anisotropies if g not in self.anisotropies)),
        )

    def __mul__(self, factor: Number) -> Coefficients:
        return Coefficients(
            _times(self.sigma_a, factor),
            _times(self.sigma_s, factor),
            product(self.weighted_g, factor),
            _times(self.emission, factor),
            self.anisotropies if isinstance(factor, Op) or factor > 0.0 else (),
        )


def volume_medium(nodes: Nodes, item: Input, scale: Number = 1.0) -> Medium | None:
    """None where there is no volume, or it does nothing. A world's does not emit: it has no end. scale: a factor of all
    coefficients."""
    total = _shader(nodes, item) * scale
    if not any(_is_there(value) for value in (total.sigma_a, total.sigma_s, total.emission)):
        return None
    if len(total.anisotropies) > 1:
        nodes.notices.add(nodes.where, "its volumes scatter with several anisotropies; their mean is used for all")
    medium = Medium(total.sigma_a, total.sigma_s, _mean_anisotropy(total), total.emission)  # type: ignore[arg-type]
    try:
        found, program = programmed(medium)
    except TooLargeError as error:
        nodes.notices.add(nodes.where, f"its volume cannot be rendered, since {error}; it is left out")
        return None
    return replace(found, program=program) if program is not None else medium


def world_medium(nodes: Nodes, item: Input) -> Medium | None:
    """One that is the same everywhere, or haze that thins out with height; else constants are used, and told."""
    notices, nodes.notices = nodes.notices, Notices()  # of a trial
    nodes.constants_only = False
    total = _shader(nodes, item)
    nodes.notices = notices
    haze = None
    if (isinstance(total.sigma_a, Op) or isinstance(total.sigma_s, Op)) and len(total.anisotropies) < 2:
        haze = height_haze(total.sigma_a, total.sigma_s)
    g = _mean_anisotropy(total)
    if haze is None or isinstance(g, Op):
        nodes.constants_only = True
        return volume_medium(nodes, item)
    _shader(nodes, item)  # for its notices
    return Medium(haze.sigma_a, haze.sigma_s, g, falloff=haze.falloff)


def _times(color: Triple, factor: Number) -> Triple:
    """What is 0 stays so, and need not be computed."""
    return scaled(color, factor) if _is_there(color) and factor != 0.0 else BLACK


def _is_there(value: Triple) -> bool:
    return isinstance(value, Op) or any(value)


def _mean_anisotropy(total: Coefficients) -> Number:
    if len(total.anisotropies) == 1:
        return clamped(total.anisotropies[0], -MAX_ANISOTROPY, MAX_ANISOTROPY)
    scattering = weighted(total.sigma_s, LUMINANCE)
    if isinstance(scattering, Op) or isinstance(total.weighted_g, Op):
        return math("divide", total.weighted_g, scattering)
    g = total.weighted_g / scattering if scattering > 0.0 else 0.0
    return clamped(g, -MAX_ANISOTROPY, MAX_ANISOTROPY)


def _sum(a: Number, b: Number) -> Number:
    if isinstance(a, Op) or isinstance(b, Op):
        return b if a == 0.0 else a if b == 0.0 else math("add", a, b)
    return a + b


def _shader(nodes: Nodes, item: Input) -> Coefficients:
    source = nodes.source(item)
    if source is None or source.node is None:
        return Coefficients()
    translate = _VOLUMES.get(source.node.bl_idname)
    if translate is None:
        nodes.notice(source.node, f"{source.node.bl_label} is not supported in a volume and left out")
        return Coefficients()
    return translate(nodes, source)


def _positive(color: Triple) -> Triple:
    return clamped_color(color, 0.0, 1e30)


def _complement(color: Triple) -> Triple:
    if isinstance(color, Op):
        return _positive(vector_math("subtract", WHITE, color))
    return _positive((1.0 - color[0], 1.0 - color[1], 1.0 - color[2]))


def _number(nodes: Nodes, source: Source, name: str) -> Number:
    return nodes.varying_number(source.node, source.groups, name)


def _density(nodes: Nodes, source: Source) -> Number:
    return clamped(_number(nodes, source, "Density"), 0.0, 1e30)


def _color(nodes: Nodes, source: Source, name: str) -> Triple:
    return _positive(nodes.varying_color(source.node, source.groups, name))


def _scattering(nodes: Nodes, source: Source, sigma_s: Triple, sigma_a: Triple) -> Coefficients:
    phase = getattr(source.node, "phase", "HENYEY_GREENSTEIN")
    if phase != "HENYEY_GREENSTEIN":
        name = phase.replace("_", " ").title()
        nodes.notice(source.node, f"the phase function {name} is not supported; Henyey-Greenstein is used")
    if not _is_there(sigma_s):
        return Coefficients(sigma_a, sigma_s)
    g = _number(nodes, source, "Anisotropy")
    return Coefficients(sigma_a, sigma_s, product(g, weighted(sigma_s, LUMINANCE)), anisotropies=(g,))


def _emitting(nodes: Nodes, source: Source, emission: Triple) -> Coefficients:
    if nodes.is_sky and _is_there(emission):
        nodes.notice(source.node, "fog that emits is not supported in a world; it does not emit")
        return Coefficients()
    return Coefficients(emission=emission)


def _emission(nodes: Nodes, source: Source) -> Coefficients:
    strength = clamped(_number(nodes, source, "Strength"), 0.0, 1e30)
    return _emitting(nodes, source, _times(_color(nodes, source, "Color"), strength))


def _scatter(nodes: Nodes, source: Source) -> Coefficients:
    density = _density(nodes, source)
    return _scattering(nodes, source, _times(_color(nodes, source, "Color"), density), BLACK)


def _absorption(nodes: Nodes, source: Source) -> Coefficients:
    density = _density(nodes, source)
    return Coefficients(sigma_a=_times(_complement(_color(nodes, source, "Color")), density))


def _principled(nodes: Nodes, source: Source) -> Coefficients:
    density = _density(nodes, source)
    color, tint = _color(nodes, source, "Color"), _color(nodes, source, "Absorption Color")
    if (grid := _grid(nodes, source, "Density Attribute")) is not None:
        density = product(density, clamped(op("average", grid), 0.0, 1e30))
    if (grid := _grid(nodes, source, "Color Attribute")) is not None:
        color = multiplied(color, _positive(grid))
    absorbed = multiplied(_complement(color), _complement(square_root(tint)))
    strength = clamped(_number(nodes, source, "Emission Strength"), 0.0, 1e30)
    emission = BLACK if strength == 0.0 else _times(_color(nodes, source, "Emission Color"), strength)
    shining = _emitting(nodes, source, added(emission, _heat(nodes, source)))
    return _scattering(nodes, source, _times(color, density), _times(absorbed, density)) + shining


def _grid(nodes: Nodes, source: Source, name: str) -> Op | None:
    """Of a volume object, what its attribute input names; None where there is none, which changes nothing."""
    socket = source.node.inputs.get(name)
    grid = None if socket is None else nodes.grids.get(getattr(socket, "default_value", ""))
    return None if grid is None else grid.lookup(geometry(nodes, "object_position"))


def _heat(nodes: Nodes, source: Source) -> Triple:
    """What a Principled Volume radiates as a black body."""
    intensity = clamped(_number(nodes, source, "Blackbody Intensity"))
    if intensity == 0.0:
        return BLACK
    kelvin = clamped(_number(nodes, source, "Temperature"), 0.0, 1e6)
    if (grid := _grid(nodes, source, "Temperature Attribute")) is not None:
        kelvin = product(kelvin, clamped(op("average", grid), 0.0, 1e6))
    fourth = math("power", kelvin, 4.0) if isinstance(kelvin, Op) else kelvin**4
    power = product(_sum(1.0, product(_sum(fourth, -1.0), intensity)), BLACKBODY_RADIANCE)
    hue = color_nodes.blackbody_of(kelvin)
    return scaled(multiplied(_color(nodes, source, "Blackbody Tint"), hue), power)


def _coefficients(nodes: Nodes, source: Source) -> Coefficients:
    shining = _emitting(nodes, source, _color(nodes, source, "Emission Coefficients"))
    sigma_s, sigma_a = _color(nodes, source, "Scatter Coefficients"), _color(nodes, source, "Absorption Coefficients")
    return _scattering(nodes, source, sigma_s, sigma_a) + shining


def _add(nodes: Nodes, source: Source) -> Coefficients:
    first, second = (_shader(nodes, Input(source.node.inputs[i], source.groups)) for i in (0, 1))
    return first + second


def _mix(nodes: Nodes, source: Source) -> Coefficients:
    factor = clamped(_number(nodes, source, source.node.inputs[0].name))
    first, second = (_shader(nodes, Input(source.node.inputs[i], source.groups)) for i in (1, 2))
    rest = math("subtract", 1.0, factor) if isinstance(factor, Op) else 1.0 - factor
    return first * rest + second * factor


_VOLUMES: dict[str, Callable[[Nodes, Source], Coefficients]] = {
    "ShaderNodeVolumeScatter": _scatter,
    "ShaderNodeVolumeAbsorption": _absorption,
    "ShaderNodeVolumePrincipled": _principled,
    "ShaderNodeVolumeCoefficients": _coefficients,
    "ShaderNodeEmission": _emission,
    "ShaderNodeAddShader": _add,
    "ShaderNodeMixShader": _mix,
}
