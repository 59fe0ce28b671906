# SPDX-License-Identifier: GPL-3.0-or-later
"""Volume nodes of a world -> Medium, by the formulas of Cycles."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import sqrt

from ..scene.description import BLACK, Medium, Rgb
from .color import luminance
from .nodes import Input, Nodes, Source, add_colors, scaled

# The engine's bound: a phase function of exactly 1 or -1 scatters nothing at all.
MAX_ANISOTROPY = 0.999


@dataclass(frozen=True)
class Coefficients:
    sigma_a: Rgb = BLACK
    sigma_s: Rgb = BLACK
    weighted_g: float = 0.0  # g times the luminance of sigma_s, so that sums keep the mean cosine

    def __add__(self, other: Coefficients) -> Coefficients:
        return Coefficients(
            add_colors(self.sigma_a, other.sigma_a),
            add_colors(self.sigma_s, other.sigma_s),
            self.weighted_g + other.weighted_g,
        )

    def __mul__(self, factor: float) -> Coefficients:
        return Coefficients(scaled(self.sigma_a, factor), scaled(self.sigma_s, factor), self.weighted_g * factor)


def volume_medium(nodes: Nodes, item: Input) -> Medium | None:
    """None where there is no volume, or it neither absorbs nor scatters."""
    total = _shader(nodes, item)
    if not any(total.sigma_a) and not any(total.sigma_s):
        return None
    scattering = luminance(total.sigma_s)
    g = total.weighted_g / scattering if scattering > 0.0 else 0.0
    return Medium(total.sigma_a, total.sigma_s, min(max(g, -MAX_ANISOTROPY), MAX_ANISOTROPY))


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


def _color(nodes: Nodes, source: Source, name: str) -> Rgb:
    return _positive(nodes.color(source.node, source.groups, (name,)))


def _scattering(nodes: Nodes, source: Source, sigma_s: Rgb, sigma_a: Rgb) -> Coefficients:
    phase = getattr(source.node, "phase", "HENYEY_GREENSTEIN")
    if phase != "HENYEY_GREENSTEIN":
        name = phase.replace("_", " ").title()
        nodes.notice(source.node, f"the phase function {name} is not supported; Henyey-Greenstein is used")
    return Coefficients(sigma_a, sigma_s, _number(nodes, source, "Anisotropy") * luminance(sigma_s))


def _scatter(nodes: Nodes, source: Source) -> Coefficients:
    density = max(_number(nodes, source, "Density"), 0.0)
    return _scattering(nodes, source, scaled(_color(nodes, source, "Color"), density), BLACK)


def _absorption(nodes: Nodes, source: Source) -> Coefficients:
    density = max(_number(nodes, source, "Density"), 0.0)
    return Coefficients(sigma_a=scaled(_complement(_color(nodes, source, "Color")), density))


def _principled(nodes: Nodes, source: Source) -> Coefficients:
    density = max(_number(nodes, source, "Density"), 0.0)
    color, tint = _color(nodes, source, "Color"), _color(nodes, source, "Absorption Color")
    lost = _complement(color)
    kept = _complement((sqrt(tint[0]), sqrt(tint[1]), sqrt(tint[2])))
    absorbed = (lost[0] * kept[0], lost[1] * kept[1], lost[2] * kept[2])
    if _number(nodes, source, "Emission Strength") > 0.0 or _number(nodes, source, "Blackbody Intensity") > 0.0:
        nodes.notice(source.node, "fog that emits is not supported; it does not emit")
    return _scattering(nodes, source, scaled(color, density), scaled(absorbed, density))


def _coefficients(nodes: Nodes, source: Source) -> Coefficients:
    if any(_color(nodes, source, "Emission Coefficients")):
        nodes.notice(source.node, "fog that emits is not supported; it does not emit")
    sigma_s, sigma_a = _color(nodes, source, "Scatter Coefficients"), _color(nodes, source, "Absorption Coefficients")
    return _scattering(nodes, source, sigma_s, sigma_a)


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
    "ShaderNodeAddShader": _add,
    "ShaderNodeMixShader": _mix,
}
