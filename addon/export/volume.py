# SPDX-License-Identifier: GPL-3.0-or-later
"""Volume nodes of a world or a material -> Medium, by the formulas of Cycles."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import pi, sqrt

from ..scene.description import BLACK, Medium, Rgb
from .color import add_colors, blackbody, luminance, scaled
from .nodes import Nodes
from .sockets import Input, NotConstantError, Source

# The engine's bound: a phase function of exactly 1 or -1 scatters nothing at all.
MAX_ANISOTROPY = 0.999

# Of Stefan and Boltzmann over pi, in Blender's units: what a black body of one kelvin radiates.
BLACKBODY_RADIANCE = 5.670373e-8 * 1e-6 / pi


@dataclass(frozen=True)
class Coefficients:
    sigma_a: Rgb = BLACK
    sigma_s: Rgb = BLACK
    weighted_g: float = 0.0  # g times the luminance of sigma_s, so that sums keep the mean cosine
    emission: Rgb = BLACK
    anisotropies: frozenset[float] = frozenset()  # of all that scatters

    def __add__(self, other: Coefficients) -> Coefficients:
        return Coefficients(
            add_colors(self.sigma_a, other.sigma_a),
            add_colors(self.sigma_s, other.sigma_s),
            self.weighted_g + other.weighted_g,
            add_colors(self.emission, other.emission),
            self.anisotropies | other.anisotropies,
        )

    def __mul__(self, factor: float) -> Coefficients:
        return Coefficients(
            scaled(self.sigma_a, factor),
            scaled(self.sigma_s, factor),
            self.weighted_g * factor,
            scaled(self.emission, factor),
            self.anisotropies if factor > 0.0 else frozenset(),
        )


def volume_medium(nodes: Nodes, item: Input) -> Medium | None:
    """None where there is no volume, or it does nothing. A world's does not emit: it has no end."""
    total = _shader(nodes, item)
    if not any(total.sigma_a) and not any(total.sigma_s) and not any(total.emission):
        return None
    if len(total.anisotropies) > 1:
        nodes.notices.add(nodes.where, "its volumes scatter with several anisotropies; their mean is used for all")
    scattering = luminance(total.sigma_s)
    g = total.weighted_g / scattering if scattering > 0.0 else 0.0
    return Medium(total.sigma_a, total.sigma_s, min(max(g, -MAX_ANISOTROPY), MAX_ANISOTROPY), total.emission)


def _shader(nodes: Nodes, item: Input) -> Coefficients:
    source = nodes.source(item)
    if source is None or source.node is None:
        return Coefficients()
    translate = _VOLUMES.get(source.node.bl_idname)
    if translate is None:
        nodes.notice(source.node, f"{source.node.bl_label} is not supported in a volume and left out")
        return Coefficients()
    return translate(nodes, source)


def _positive(color: Rgb) -> Rgb:
    return (max(color[0], 0.0), max(color[1], 0.0), max(color[2], 0.0))


def _complement(color: Rgb) -> Rgb:
    return _positive((1.0 - color[0], 1.0 - color[1], 1.0 - color[2]))


def _number(nodes: Nodes, source: Source, name: str) -> float:
    return nodes.number(source.node, source.groups, name)


def _density(nodes: Nodes, source: Source) -> float:
    """Of an object, one that varies in an unknown way is none: a wrong one might hide everything."""
    if not nodes.is_sky:
        try:
            nodes.constant(Input(source.node.inputs["Density"], source.groups))
        except NotConstantError as error:
            nodes.notice(error.args[0], f"density that varies is not supported; '{source.node.name}' is left out")
            return 0.0
    return max(_number(nodes, source, "Density"), 0.0)


def _color(nodes: Nodes, source: Source, name: str) -> Rgb:
    return _positive(nodes.color(source.node, source.groups, (name,)))


def _scattering(nodes: Nodes, source: Source, sigma_s: Rgb, sigma_a: Rgb) -> Coefficients:
    phase = getattr(source.node, "phase", "HENYEY_GREENSTEIN")
    if phase != "HENYEY_GREENSTEIN":
        name = phase.replace("_", " ").title()
        nodes.notice(source.node, f"the phase function {name} is not supported; Henyey-Greenstein is used")
    g = _number(nodes, source, "Anisotropy")
    return Coefficients(sigma_a, sigma_s, g * luminance(sigma_s), anisotropies=frozenset({g} if any(sigma_s) else ()))


def _emitting(nodes: Nodes, source: Source, emission: Rgb) -> Coefficients:
    if nodes.is_sky and any(emission):
        nodes.notice(source.node, "fog that emits is not supported in a world; it does not emit")
        return Coefficients()
    return Coefficients(emission=emission)


def _emission(nodes: Nodes, source: Source) -> Coefficients:
    strength = max(_number(nodes, source, "Strength"), 0.0)
    return _emitting(nodes, source, scaled(_color(nodes, source, "Color"), strength))


def _scatter(nodes: Nodes, source: Source) -> Coefficients:
    density = _density(nodes, source)
    return _scattering(nodes, source, scaled(_color(nodes, source, "Color"), density), BLACK)


def _absorption(nodes: Nodes, source: Source) -> Coefficients:
    density = _density(nodes, source)
    return Coefficients(sigma_a=scaled(_complement(_color(nodes, source, "Color")), density))


def _principled(nodes: Nodes, source: Source) -> Coefficients:
    density = _density(nodes, source)
    color, tint = _color(nodes, source, "Color"), _color(nodes, source, "Absorption Color")
    lost = _complement(color)
    kept = _complement((sqrt(tint[0]), sqrt(tint[1]), sqrt(tint[2])))
    absorbed = (lost[0] * kept[0], lost[1] * kept[1], lost[2] * kept[2])
    emission = scaled(_color(nodes, source, "Emission Color"), max(_number(nodes, source, "Emission Strength"), 0.0))
    shining = _emitting(nodes, source, add_colors(emission, _heat(nodes, source)))
    return _scattering(nodes, source, scaled(color, density), scaled(absorbed, density)) + shining


def _heat(nodes: Nodes, source: Source) -> Rgb:
    """What a Principled Volume radiates as a black body."""
    intensity = _number(nodes, source, "Blackbody Intensity")
    if intensity <= 0.0:
        return BLACK
    kelvin = max(_number(nodes, source, "Temperature"), 0.0)
    power = BLACKBODY_RADIANCE * (1.0 + (kelvin**4 - 1.0) * min(intensity, 1.0))
    tint = _color(nodes, source, "Blackbody Tint")
    hue = blackbody(kelvin)
    return (tint[0] * hue[0] * power, tint[1] * hue[1] * power, tint[2] * hue[2] * power)


def _coefficients(nodes: Nodes, source: Source) -> Coefficients:
    shining = _emitting(nodes, source, _color(nodes, source, "Emission Coefficients"))
    sigma_s, sigma_a = _color(nodes, source, "Scatter Coefficients"), _color(nodes, source, "Absorption Coefficients")
    return _scattering(nodes, source, sigma_s, sigma_a) + shining


def _add(nodes: Nodes, source: Source) -> Coefficients:
    first, second = (_shader(nodes, Input(source.node.inputs[i], source.groups)) for i in (0, 1))
    return first + second


def _mix(nodes: Nodes, source: Source) -> Coefficients:
    factor = min(max(_number(nodes, source, source.node.inputs[0].name), 0.0), 1.0)
    first, second = (_shader(nodes, Input(source.node.inputs[i], source.groups)) for i in (1, 2))
    return first * (1.0 - factor) + second * factor


_VOLUMES: dict[str, Callable[[Nodes, Source], Coefficients]] = {
    "ShaderNodeVolumeScatter": _scatter,
    "ShaderNodeVolumeAbsorption": _absorption,
    "ShaderNodeVolumePrincipled": _principled,
    "ShaderNodeVolumeCoefficients": _coefficients,
    "ShaderNodeEmission": _emission,
    "ShaderNodeAddShader": _add,
    "ShaderNodeMixShader": _mix,
}
