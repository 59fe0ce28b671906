# SPDX-License-Identifier: GPL-3.0-or-later
"""The Principled BSDF as the engine's layers: that of 4.0 and later, and the one before."""

from __future__ import annotations

from dataclasses import replace
from math import ceil
from typing import Protocol

from ..scene.description import (
    BLACK,
    WHITE,
    Add,
    Burley,
    Conductor,
    Glass,
    Lambert,
    Layer,
    Light,
    Material,
    Mix,
    Null,
    Rgb,
    Sheen,
    Subsurface,
    Surface,
)
from ..scene.program import Op
from .color import ior_of_normal_reflectance
from .combine import mix
from .nodes import Nodes
from .sockets import Source, find_input
from .subsurface import Method
from .translate.values import (
    Number,
    Triple,
    clamped,
    clamped_color,
    difference,
    lerp,
    math,
    multiplied,
    product,
    scaled,
    square_root,
    squared,
    weighted,
)

# By which the hue of a colour is told from its brightness, before 4.0: of sheen, and of the specular reflection.
LUMINANCE, DISNEY_LUMINANCE = (0.2126729, 0.7151522, 0.0721750), (0.3, 0.6, 0.1)

# The angle that a coat's tint is taken at: cos^2 of 45 degrees, where a lit surface is seen in the mean.
SEEN_AT = 0.5


class Shaders(Protocol):
    """What reads the inputs of a shader node."""

    nodes: Nodes

    @property
    def masking(self) -> str: ...
    def facets(self, source: Source) -> str: ...
    def color(self, source: Source, *names: str) -> Rgb: ...
    def varying(self, source: Source, *names: str) -> Triple: ...
    def varying_number(self, source: Source, *names: str, default: float = 0.0) -> Number: ...
    def albedo(self, source: Source, *names: str) -> Triple: ...
    def number(self, source: Source, *names: str, default: float = 0.0) -> float: ...
    def along_tangent(self, source: Source, metal: Conductor, aspect: Number, rotation: str) -> Conductor: ...
    def rough_diffuse(self, albedo: Triple, roughness: float) -> Lambert: ...
    def reflects_by_surface(self, source: Source) -> bool: ...
    def glass_by_surface(
        self, source: Source, ior: float, reflected: Triple, alpha: Number, transmitted: Triple, alpha_beyond: Number
    ) -> Mix: ...
    def subsurface_method(self, source: Source, setting: str) -> Method: ...
    def subsurface_anisotropy(self, source: Source, method: Method, name: str) -> Number: ...


def principled(shaders: Shaders, source: Source) -> Material:
    is_old = find_input(source.node, "Specular IOR Level") is None
    inputs = _Inputs(shaders, source)
    result = _surface_before_4(inputs) if is_old else _surface(inputs)
    emission = inputs.emission()
    if emission != BLACK and not is_old:
        emission = multiplied(emission, _passed_by_layers(inputs))
    if emission != BLACK:
        result = replace(result, emission=emission)
    opacity = inputs.unit("Alpha", default=1.0)
    return result if opacity == 1.0 else mix(opacity, Null(), result)


class _Inputs:
    """The node's inputs within their ranges."""

    def __init__(self, shaders: Shaders, source: Source) -> None:
        self.shaders, self.source, self.node = shaders, source, source.node
        self.base = self.own_base = shaders.albedo(source, "Base Color")
        self.alpha = squared(self.unit("Roughness"))
        self.metallic = self.unit("Metallic")
        self.transmission = self.unit("Transmission Weight", "Transmission")
        self.ior = max(shaders.number(source, "IOR", default=1.5), 1e-3)
        self.facets = shaders.facets(source)
        self.under: Triple = WHITE  # what a coat's tint makes of white beneath it
        self.subsurface = self.unit("Subsurface Weight", "Subsurface")

    def notice(self, what: str) -> None:
        self.shaders.nodes.notice(self.node, what)

    def unit(self, *names: str, default: float = 0.0) -> Number:
        return clamped(self.shaders.varying_number(self.source, *names, default=default))

    def color(self, *names: str) -> Triple:
        return clamped_color(self.shaders.varying(self.source, *names))

    def beneath(self, albedo: Triple, scale: Number, ior: Number, color: Triple, boundary: str) -> Subsurface:
        """What of the surface light wanders in. scale: of the radius. ior: of the surface."""
        shaders, source = self.shaders, self.source
        method = shaders.subsurface_method(source, "subsurface_method")
        radius = scaled(shaders.varying(source, "Subsurface Radius"), scale)
        own = shaders.varying_number(source, "Subsurface IOR", default=1.4)
        return Subsurface(
            albedo,
            clamped_color(radius, 0.0, float("inf")),
            method.model,
            method.entry,
            own if method.model == "skin" else ior,
            self.alpha,
            shaders.subsurface_anisotropy(source, method, "Subsurface Anisotropy"),
            color,
            boundary,
        )

    def brushed(self, metal: Conductor) -> Conductor:
        squared_aspect = difference(1.0, product(self.unit("Anisotropic"), 0.9))
        aspect = math("sqrt", squared_aspect) if isinstance(squared_aspect, Op) else squared_aspect**0.5
        return self.shaders.along_tangent(self.source, metal, aspect, "Anisotropic Rotation")

    def emission(self) -> Triple:
        strength = self.shaders.varying_number(self.source, "Emission Strength", default=1.0)
        emission = scaled(self.shaders.varying(self.source, "Emission Color", "Emission"), strength)
        return emission if isinstance(emission, Op) else clamped_color(emission, 0.0, float("inf"))


def normal_reflectance(ior: float) -> float:
    return ((ior - 1.0) / (ior + 1.0)) ** 2


def _ior_of_normal_reflectance(f0: Number) -> Number:
    if isinstance(f0, Op):
        root = math("sqrt", math("minimum", f0, 0.98))
        return math("divide", math("add", 1.0, root), math("subtract", 1.0, root))
    return ior_of_normal_reflectance(f0)


# ---- From 4.0 on: layers that leave to those beneath what they do not reflect ----


def _surface(inputs: _Inputs) -> Surface:
    coat_weight, coat_ior = inputs.unit("Coat Weight"), max(inputs.shaders.number(inputs.source, "Coat IOR"), 1.0)
    if coat_weight != 0.0:
        inputs.under = _coat_tint(inputs, coat_weight, coat_ior)
        inputs.base = multiplied(inputs.base, inputs.under)
    tint, white = inputs.color("Specular Tint"), inputs.under
    metal = Conductor(inputs.alpha, f0=inputs.base, f90=white, f82=tint, facets=inputs.facets)
    result: Material = inputs.brushed(metal)
    if inputs.metallic != 1.0:
        below: Material = Lambert(BLACK)
        if inputs.transmission != 1.0:
            below = _opaque(inputs, tint)
        if inputs.transmission != 0.0:
            # The base colour is that of light which passes two boundaries.
            color = square_root(multiplied(inputs.base, white))
            glass = Glass(inputs.ior, inputs.alpha, reflection=white, transmission=color, facets=inputs.facets)
            below = mix(inputs.transmission, below, glass)
        result = mix(inputs.metallic, below, result)
    assert not isinstance(result, (Light, Null))
    if coat_weight != 0.0 and coat_ior != 1.0:
        f0 = (normal_reflectance(coat_ior),) * 3
        result = Layer(coat_weight, Conductor(squared(inputs.unit("Coat Roughness")), f0=f0, ior=coat_ior), result)
        _note_coat_normal(inputs, "Coat Normal")
    sheen = inputs.unit("Sheen Weight")
    if sheen != 0.0:
        result = Layer(sheen, Sheen(inputs.color("Sheen Tint"), inputs.unit("Sheen Roughness")), result)
    return result


def _opaque(inputs: _Inputs, tint: Triple) -> Surface:
    """A dielectric over a diffuse base."""
    shaders, source = inputs.shaders, inputs.source
    level = shaders.varying_number(source, "Specular IOR Level")
    f0 = clamped(product(level, 2.0 * normal_reflectance(inputs.ior)))
    ior = _ior_of_normal_reflectance(f0)
    if inputs.ior < 1.0:
        ior = math("divide", 1.0, ior) if isinstance(ior, Op) else 1.0 / ior
    diffuse: Material = shaders.rough_diffuse(inputs.base, shaders.number(source, "Diffuse Roughness"))
    if inputs.subsurface != 0.0:
        scale = shaders.varying_number(source, "Subsurface Scale", default=1.0)
        beneath = inputs.beneath(inputs.own_base, scale, ior, inputs.under, "lambert")
        diffuse = mix(inputs.subsurface, diffuse, beneath)
    assert not isinstance(diffuse, (Light, Null))
    if f0 == 0.0:
        return diffuse
    f0_color, white = multiplied(scaled(tint, f0), inputs.under), inputs.under
    gloss = Conductor(inputs.alpha, f0=f0_color, f90=white, ior=ior, facets=inputs.facets)
    return Layer(1.0, inputs.brushed(gloss), diffuse)


def _coat_tint(inputs: _Inputs, weight: Number, ior: float) -> Triple:
    """What a tinted coat leaves of the colour beneath it, by the way through it at one angle."""
    tint = inputs.shaders.color(inputs.source, "Coat Tint")
    if tint == WHITE:
        return WHITE
    inputs.notice("the coat's tint is taken as it is seen at 45 degrees, and colours what lies beneath it")
    way = (1.0 - SEEN_AT / ior**2) ** -0.5
    return lerp(WHITE, (max(tint[0], 0.0) ** way, max(tint[1], 0.0) ** way, max(tint[2], 0.0) ** way), weight)


def _passed_by_layers(inputs: _Inputs) -> Triple:
    """Of what shines beneath the coat, seen from the front, where sheen keeps next to nothing."""
    weight = inputs.unit("Coat Weight")
    if weight == 0.0:
        return WHITE
    shaders, source = inputs.shaders, inputs.source
    f0 = normal_reflectance(max(shaders.number(source, "Coat IOR"), 1.0))
    tint = shaders.color(source, "Coat Tint")
    passed = lerp(WHITE, (max(tint[0], 0.0), max(tint[1], 0.0), max(tint[2], 0.0)), weight)
    inputs.notice("what shines beneath the coat is dimmed as it is seen from the front, from everywhere")
    return scaled(passed, difference(1.0, product(weight, f0)))


def _note_coat_normal(inputs: _Inputs, name: str) -> None:
    socket = inputs.node.inputs.get(name)
    if socket is not None and not inputs.shaders.nodes.is_free(inputs.source, socket):
        inputs.notice("a coat with a normal of its own is not supported; it has the normal of what lies beneath it")


# ---- Before 4.0: lobes on top of each other, each at full strength ----


def _surface_before_4(inputs: _Inputs) -> Surface:
    opaque, clear = difference(1.0, inputs.metallic), inputs.transmission
    through = product(clear, opaque)
    # A mix with the glass beneath; of what is not glass, the part that is neither metal.
    diffuse_share = product(opaque, difference(1.0, clear))
    if through != 0.0 and through != 1.0:
        rest = difference(1.0, through)
        both_fixed = not isinstance(diffuse_share, Op) and not isinstance(rest, Op)
        diffuse_share = diffuse_share / rest if both_fixed else math("divide", diffuse_share, rest)  # type: ignore[operator]
    result: Material = Lambert(BLACK)
    if through != 1.0:
        result = _lobes_before_4(inputs, diffuse_share)
    if through != 0.0:
        result = mix(through, result, _glass_before_4(inputs))
    assert not isinstance(result, (Light, Null))
    coat = inputs.unit("Clearcoat")
    if coat != 0.0:
        inputs.notice("the clear coat's highlight has the tails of GGX, which are shorter than its own")
        part = product(coat, 0.25)
        f0, f90 = scaled(WHITE, product(part, 0.04)), scaled(WHITE, part)
        alpha = squared(inputs.unit("Clearcoat Roughness"))
        result = Add(Conductor(alpha, f0=f0, f90=f90, ior=1.5, masking=inputs.shaders.masking), result)
        _note_coat_normal(inputs, "Clearcoat Normal")
    return result


def _glass_before_4(inputs: _Inputs) -> Surface:
    shaders, source = inputs.shaders, inputs.source
    own = inputs.unit("Transmission Roughness")
    if not shaders.reflects_by_surface(source):
        if own != 0.0:
            inputs.notice("a roughness of its own for what is transmitted is not supported; it has that of the surface")
        return Glass(inputs.ior, inputs.alpha, transmission=inputs.base, facets=inputs.facets)
    smoothness = product(difference(1.0, inputs.unit("Roughness")), difference(1.0, own))
    beyond = squared(difference(1.0, smoothness))
    if inputs.alpha == 0.0 and beyond == 0.0:
        return Glass(inputs.ior, transmission=inputs.base)
    color = lerp(WHITE, inputs.base, inputs.unit("Specular Tint"))
    return shaders.glass_by_surface(source, inputs.ior, color, inputs.alpha, inputs.base, beyond)


def _lobes_before_4(inputs: _Inputs, diffuse_share: Number) -> Surface:
    parts: list[Surface] = []
    subsurface = inputs.subsurface
    if diffuse_share != 0.0:
        albedo = lerp(inputs.base, inputs.color("Subsurface Color"), subsurface)
        diffuse, roughness = scaled(albedo, diffuse_share), inputs.unit("Roughness")
        if subsurface == 0.0:
            parts.append(Burley(diffuse, roughness))
        else:
            color = clamped_color(scaled(WHITE, diffuse_share))
            parts.append(inputs.beneath(albedo, subsurface, inputs.ior, color, "burley"))
            parts.append(Burley(diffuse, roughness, part="retro"))
        sheen = product(inputs.unit("Sheen"), diffuse_share)
        if sheen != 0.0:
            parts += _velvets(inputs, scaled(_tinted(inputs, "Sheen Tint", LUMINANCE), sheen))
    specular = clamped(inputs.shaders.varying_number(inputs.source, "Specular"), 0.0, 10.0)
    if specular != 0.0 or inputs.metallic != 0.0:
        f0 = product(specular, 0.08)
        color = lerp(scaled(_tinted(inputs, "Specular Tint", DISNEY_LUMINANCE), f0), inputs.base, inputs.metallic)
        ior = _ior_of_normal_reflectance(f0)
        masking = inputs.shaders.masking
        gloss = Conductor(inputs.alpha, clamped_color(color), ior=ior, masking=masking, facets=inputs.facets)
        parts.append(inputs.brushed(gloss))
    if not parts:
        return Lambert(BLACK)
    result = parts[0]
    for part in parts[1:]:
        result = Add(result, part)
    return result


MOST_SHEENS = 4


def _velvets(inputs: _Inputs, color: Triple) -> list[Surface]:
    """The hue of a dark colour may be more than 1, which no single lobe can be: several share it."""
    brightest = 2.0 if isinstance(color, Op) else max(color)
    if brightest > MOST_SHEENS:
        inputs.notice(f"its sheen is brighter ({brightest:.3g}) than can be rendered; cut to {MOST_SHEENS}")
    count = min(max(ceil(brightest), 1), MOST_SHEENS)
    return [Sheen(clamped_color(scaled(color, 1.0 / count)), model="schlick")] * count


def _tinted(inputs: _Inputs, name: str, weights: Rgb) -> Triple:
    """White, or the hue of the base colour where the sum by these weights is 1."""
    tint = inputs.unit(name)
    if tint == 0.0:
        return WHITE
    light = weighted(inputs.base, weights)
    if isinstance(light, Op):
        hue: Triple = scaled(inputs.base, math("divide", 1.0, light))
    else:
        hue = scaled(inputs.base, 1.0 / light) if light > 0.0 else WHITE
    return lerp(WHITE, hue, tint)
