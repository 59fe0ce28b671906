# SPDX-License-Identifier: GPL-3.0-or-later
"""Mix Shader and Add Shader over the engine's materials."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from ..scene.description import BLACK, Conductor, Glass, Lambert, Light, Material, Mirror, Mix, Null, Rgb, Surface
from .nodes import lerp, scaled

Tell = Callable[[str], None]  # what was approximated


def add_colors(a: Rgb, b: Rgb) -> Rgb:
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def mixed(weight: float, a: Surface, b: Surface) -> Surface:
    """weight of a and the rest of b. The emission of both goes to the mix, where the engine wants it."""
    if weight <= 0.0:
        return b
    if weight >= 1.0:
        return a
    emission = lerp(b.emission, a.emission, weight)
    a, b = replace(a, emission=BLACK), replace(b, emission=BLACK)
    if isinstance(a, Lambert) and isinstance(b, Lambert):
        return Lambert(lerp(b.albedo, a.albedo, weight), emission)
    if isinstance(a, Mirror) and isinstance(b, Mirror):
        return Mirror(lerp(b.reflectance, a.reflectance, weight), emission)
    if a == b:
        return replace(a, emission=emission)
    return Mix(weight, a, b, emission)


def mix(factor: float, a: Material, b: Material, tell: Tell) -> Material:
    """(1 - factor) a + factor b."""
    factor = min(max(factor, 0.0), 1.0)
    if factor == 0.0 or a == b:
        return a
    if factor == 1.0:
        return b
    if isinstance(a, (Glass, Null)) or isinstance(b, (Glass, Null)):
        chosen = b if factor > 0.5 else a
        kind = {Glass: "glass", Null: "transparency"}
        parts = " and ".join(kind.get(type(item), "an opaque shader") for item in (a, b))
        tell(f"a mix of {parts} is not supported; its {'second' if chosen is b else 'first'} shader is used alone")
        return chosen
    emission = lerp(_radiance(a), _radiance(b), factor)
    if isinstance(a, Light) and isinstance(b, Light):
        return Light(emission)
    # What shines and nothing else reflects nothing: a black surface that emits.
    return replace(mixed(1.0 - factor, _reflection(a), _reflection(b)), emission=emission)


def add(a: Material, b: Material, tell: Tell) -> Material:
    """a + b, exact where at most one of the two reflects."""
    if isinstance(a, (Glass, Null)) or isinstance(b, (Glass, Null)):
        chosen, other = (a, b) if isinstance(a, (Glass, Null)) else (b, a)
        if isinstance(other, Light) and other.radiance == BLACK:
            return chosen
        if isinstance(chosen, Null) or isinstance(other, Glass):
            chosen, other = other, chosen
        tell("a sum with glass or transparency is not supported; one of the two shaders is used alone")
        return chosen
    emission = add_colors(_radiance(a), _radiance(b))
    if isinstance(a, Light) and isinstance(b, Light):
        return Light(emission)
    if isinstance(a, Light) or isinstance(b, Light):
        return replace(_reflection(b if isinstance(a, Light) else a), emission=emission)
    first, second = _reflection(a), _reflection(b)
    if isinstance(first, Lambert) and isinstance(second, Lambert):
        total = add_colors(first.albedo, second.albedo)
        if max(total) > 1.0:
            tell(f"reflects more light than it receives ({max(total):.3g}); cut to 1")
        return Lambert((min(total[0], 1.0), min(total[1], 1.0), min(total[2], 1.0)), emission)
    tell("a sum of two reflecting shaders is approximated by a mix of both at double strength, cut to 1")
    return replace(mixed(0.5, _brighter(first, 2.0), _brighter(second, 2.0)), emission=emission)


def _radiance(material: Material) -> Rgb:
    return material.radiance if isinstance(material, Light) else getattr(material, "emission", BLACK)


def _reflection(material: Material) -> Surface:
    if isinstance(material, (Light, Glass, Null)):
        return Lambert(BLACK)
    return replace(material, emission=BLACK)


def _brighter(surface: Surface, factor: float) -> Surface:
    def cut(color: Rgb) -> Rgb:
        r, g, b = scaled(color, factor)
        return (min(r, 1.0), min(g, 1.0), min(b, 1.0))

    if isinstance(surface, Lambert):
        return replace(surface, albedo=cut(surface.albedo))
    if isinstance(surface, Mirror):
        return replace(surface, reflectance=cut(surface.reflectance))
    if isinstance(surface, Conductor):
        return surface if surface.f0 is None else replace(surface, f0=cut(surface.f0), f90=cut(surface.f90))
    return replace(surface, a=_brighter(surface.a, factor), b=_brighter(surface.b, factor))
