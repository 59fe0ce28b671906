# SPDX-License-Identifier: GPL-3.0-or-later
"""The Principled BSDF in the engine's subset: base colour, metallic, roughness, IOR, transmission and emission.

The engine has no layer of dielectric over a diffuse base. In its place stands a mix whose weight is the layer's mean
reflectance over all directions: as bright on the whole, but too bright seen from above and too dark at grazing angles.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any, Protocol

from ..scene.description import BLACK, WHITE, Conductor, Glass, Lambert, Light, Material, Null, Rgb, Surface
from .color import ior_of_normal_reflectance, mean_fresnel
from .combine import mix, mixed
from .nodes import Nodes, Source, find_input
from .translate.values import Number, Triple, clamped, clamped_color, scaled, square_root, squared

# Inputs that the engine has nothing for: their names from 4.0, those before, and what they are called in a notice.
UNSUPPORTED: tuple[tuple[tuple[str, ...], str], ...] = (
    (("Subsurface Weight", "Subsurface"), "subsurface scattering"),
    (("Coat Weight", "Clearcoat"), "the clear coat"),
    (("Sheen Weight", "Sheen"), "sheen"),
    (("Anisotropic",), "anisotropy"),
    (("Thin Film Thickness",), "the thin film"),
)


class Shaders(Protocol):
    """What reads the inputs of a shader node."""

    nodes: Nodes

    def color(self, source: Source, *names: str) -> Rgb: ...
    def varying(self, source: Source, *names: str) -> Triple: ...
    def varying_number(self, source: Source, *names: str, default: float = 0.0) -> Number: ...
    def albedo(self, source: Source, *names: str) -> Triple: ...
    def number(self, source: Source, *names: str, default: float = 0.0) -> float: ...
    def rough_diffuse(self, albedo: Triple, roughness: float) -> Lambert: ...


def normal_reflectance(node: Any, ior: float, specular: float) -> float:
    """Of the dielectric layer. `specular` scales that of the IOR from 4.0; before, it stands for 0.08 of it alone."""
    if find_input(node, "Specular IOR Level") is None:
        return 0.08 * specular
    return min(2.0 * specular * ((ior - 1.0) / (ior + 1.0)) ** 2, 1.0)


def principled(shaders: Shaders, source: Source) -> Material:
    node = source.node

    def unit(*names: str, default: float = 0.0) -> float:
        return min(max(shaders.number(source, *names, default=default), 0.0), 1.0)

    def varying_unit(*names: str, default: float = 0.0) -> Number:
        return clamped(shaders.varying_number(source, *names, default=default))

    for names, what in UNSUPPORTED:
        if unit(*names) > 0.0:
            shaders.nodes.notice(node, f"{what} is not supported and left out")
    base = shaders.albedo(source, "Base Color")
    alpha = squared(varying_unit("Roughness"))
    metallic, transmission = varying_unit("Metallic"), unit("Transmission Weight", "Transmission")
    opacity = varying_unit("Alpha", default=1.0)
    strength = shaders.varying_number(source, "Emission Strength")
    emission = scaled(shaders.varying(source, "Emission Color", "Emission"), strength)
    if isinstance(emission, tuple):
        emission = clamped_color(emission, 0.0, float("inf"))
    result: Material = Conductor(alpha=alpha, f0=base)
    if metallic != 1.0:
        below: Material = _opaque(shaders, source, base, alpha) if transmission < 1.0 else Lambert(BLACK)
        if transmission > 0.0:
            below = mix(transmission, below, _glass(shaders, source, base, alpha))
        result = mix(metallic, below, result)
    if emission != BLACK:
        assert not isinstance(result, (Light, Null))
        result = replace(result, emission=emission)
    if opacity != 1.0:
        result = mix(opacity, Null(), result)
    return result


def _opaque(shaders: Shaders, source: Source, base: Triple, alpha: Number) -> Surface:
    specular = max(shaders.number(source, "Specular IOR Level", "Specular"), 0.0)
    ior = max(shaders.number(source, "IOR", default=1.5), 1e-3)
    weight = mean_fresnel(ior_of_normal_reflectance(normal_reflectance(source.node, ior, specular)))
    diffuse = shaders.rough_diffuse(base, shaders.number(source, "Diffuse Roughness"))
    if weight <= 0.0:
        return diffuse
    shaders.nodes.notice(
        source.node, f"its dielectric layer is approximated by a mix of the same mean reflectance ({weight:.3g})"
    )
    return mixed(weight, Conductor(alpha=alpha, f0=WHITE), diffuse)


def _glass(shaders: Shaders, source: Source, base: Triple, alpha: Number) -> Glass:
    # From 4.0 on the base colour is that of light which passes two boundaries.
    at_each = find_input(source.node, "Specular IOR Level") is None
    color = base if at_each else square_root(base)
    return Glass(max(shaders.number(source, "IOR", default=1.5), 1e-3), alpha, transmission=color)
