# SPDX-License-Identifier: GPL-3.0-or-later
"""Mix Shader and Add Shader over the engine's materials."""

from __future__ import annotations

from dataclasses import replace

from ..scene.description import (
    BLACK,
    WHITE,
    Add,
    Color,
    Lambert,
    Light,
    Material,
    Mirror,
    Mix,
    Null,
    Surface,
    Translucent,
    Transparent,
)
from .translate.values import Number, added, clamped, difference, lerp


def mixed(weight: Number, a: Surface, b: Surface) -> Surface:
    """weight of a and the rest of b. The emission of both goes to the mix."""
    if isinstance(weight, float):
        if weight <= 0.0:
            return b
        if weight >= 1.0:
            return a
    emission = lerp(b.emission, a.emission, weight)
    a, b = replace(a, emission=BLACK), replace(b, emission=BLACK)
    if isinstance(a, Lambert) and isinstance(b, Lambert) and a.roughness == b.roughness == 0.0:
        return Lambert(lerp(b.albedo, a.albedo, weight), emission)
    if isinstance(a, Mirror) and isinstance(b, Mirror):
        return Mirror(lerp(b.reflectance, a.reflectance, weight), emission)
    if isinstance(a, Transparent) and isinstance(b, Transparent):
        return Transparent(lerp(b.transmittance, a.transmittance, weight), emission)
    if isinstance(a, Translucent) and isinstance(b, Translucent):
        return Translucent(lerp(b.albedo, a.albedo, weight), emission)
    if a == b:
        return replace(a, emission=emission)
    return Mix(weight, a, b, emission)


def mix(factor: Number, a: Material, b: Material) -> Material:
    """(1 - factor) a + factor b."""
    factor = clamped(factor)
    if factor == 0.0 or a == b:
        return a
    if factor == 1.0:
        return b
    emission = lerp(_radiance(a), _radiance(b), factor)
    if isinstance(a, Light) and isinstance(b, Light):
        return Light(emission)
    # What shines and nothing else reflects nothing: a black surface that emits.
    return replace(mixed(difference(1.0, factor), _scattering(a), _scattering(b)), emission=emission)


def add(a: Material, b: Material) -> Material:
    """a + b."""
    emission = added(_radiance(a), _radiance(b))
    if isinstance(a, Light) and isinstance(b, Light):
        return Light(emission)
    if isinstance(a, Light) or isinstance(b, Light):
        scattering = b if isinstance(a, Light) else a
        if isinstance(scattering, Null) and emission == BLACK:
            return scattering
        return replace(_scattering(scattering), emission=emission)
    return Add(_scattering(a), _scattering(b), emission)


def _radiance(material: Material) -> Color:
    return material.radiance if isinstance(material, Light) else getattr(material, "emission", BLACK)


def _scattering(material: Material) -> Surface:
    if isinstance(material, Light):
        return Lambert(BLACK)
    if isinstance(material, Null):
        return Transparent(WHITE)
    return replace(material, emission=BLACK)
