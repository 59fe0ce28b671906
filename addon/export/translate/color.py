# SPDX-License-Identifier: GPL-3.0-or-later
"""Colours: Mix, Color Ramp, curves, Hue/Saturation, Brightness/Contrast, Gamma, Invert."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ...scene.program import Op, Table
from .. import observer
from ..color import BLACKBODY_RANGE, TO_RGB
from ..color import blackbody as blackbody_color
from .arithmetic import mix_inputs
from .values import (
    Number,
    Triple,
    Value,
    clamped,
    clamped_color,
    math,
    number,
    op,
    product,
    scaled,
    triple,
    value_of,
    vector_math,
)

if TYPE_CHECKING:
    from ..nodes import Nodes
    from ..sockets import Source

RAMP_ROWS = 256
BLACKBODY_ROWS = 1121
BRIGHTEST_WAVELENGTH = 2.52  # what Blender divides colours by, so that none exceeds 1


def mix(nodes: Nodes, source: Source) -> Value:
    """Of either node, for any kind of data."""
    node = source.node
    if node.bl_idname != "ShaderNodeMix":
        factor, a, b = (nodes.input(source, i) for i in range(3))
        t = clamped(number(factor))
        return op("blend", t, triple(a), triple(b), modes=(node.blend_type.lower(), _clamp(node.use_clamp)))
    if node.data_type == "FLOAT":
        factor, a, b = mix_inputs(nodes, source, "Float")
        return op("mix_number", _factor(node, factor), number(a), number(b))
    if node.data_type == "RGBA":
        factor, a, b = mix_inputs(nodes, source, "Color")
        modes = (node.blend_type.lower(), _clamp(node.clamp_result))
        return op("blend", _factor(node, factor), triple(a), triple(b), modes=modes)
    if node.factor_mode == "UNIFORM":
        factor, a, b = mix_inputs(nodes, source, "Vector")
        return op("blend", _factor(node, factor), triple(a), triple(b), modes=("mix", "free"))
    factor, a, b = mix_inputs(nodes, source, "Vector", uniform=False)
    factors = triple(factor)
    if node.clamp_factor:
        factors = vector_math("minimum", vector_math("maximum", factors, (0.0,) * 3), (1.0,) * 3)
    return op("mix_vector", factors, triple(a), triple(b))


def _factor(node: Any, factor: Value) -> Number:
    return clamped(number(factor)) if node.clamp_factor else number(factor)


def _clamp(is_clamped: bool) -> str:
    return "clamped" if is_clamped else "free"


def ramp(nodes: Nodes, source: Source) -> Value:
    node = source.node
    factor = number(nodes.input(source, 0))
    colors = node.color_ramp
    wants_alpha = source.output.identifier == "Alpha"
    rows = np.array([colors.evaluate(i / (RAMP_ROWS - 1)) for i in range(RAMP_ROWS)], np.float32)
    kind = "constant" if colors.interpolation == "CONSTANT" else "linear"
    return op("ramp_alpha" if wants_alpha else "ramp", factor, modes=(kind,), resource=Table(rows))


def rgb_curves(nodes: Nodes, source: Source) -> Value:
    """Of colours, and of vectors."""
    mapping = source.node.mapping
    mapping.initialize()
    curves = list(mapping.curves)
    low, high = _interval(curves)
    steps = low + (high - low) * np.arange(RAMP_ROWS) / (RAMP_ROWS - 1)
    rows = np.ones((RAMP_ROWS, 4), np.float32)
    for i, x in enumerate(steps):
        inner = mapping.evaluate(curves[3], float(x)) if len(curves) > 3 else float(x)
        rows[i, :3] = [mapping.evaluate(curve, inner) for curve in curves[:3]]
    factor, color = number(nodes.input(source, 0)), triple(nodes.input(source, 1))
    return op("curves", factor, color, modes=(_beyond(mapping),), resource=Table(rows, low, high))


def float_curve(nodes: Nodes, source: Source) -> Value:
    mapping = source.node.mapping
    mapping.initialize()
    curve = mapping.curves[0]
    low, high = _interval([curve])
    steps = low + (high - low) * np.arange(RAMP_ROWS) / (RAMP_ROWS - 1)
    rows = np.zeros((RAMP_ROWS, 4), np.float32)
    rows[:, 0] = [mapping.evaluate(curve, float(x)) for x in steps]
    factor, value = number(nodes.input(source, 0)), number(nodes.input(source, 1))
    return op("curve", factor, value, modes=(_beyond(mapping),), resource=Table(rows, low, high))


def _interval(curves: list[Any]) -> tuple[float, float]:
    """From the first to the last point of all curves."""
    places = [point.location[0] for curve in curves for point in curve.points]
    return min(places), max(places)


def _beyond(mapping: Any) -> str:
    return "extrapolate" if mapping.extend == "EXTRAPOLATED" else "hold"


def hue_saturation(nodes: Nodes, source: Source) -> Value:
    hue = nodes.number_named(source, "Hue", 0.5)
    parts = [nodes.number_named(source, name, 1.0) for name in ("Saturation", "Value")]
    factor = nodes.number_named(source, "Fac" if source.node.inputs.get("Fac") else "Factor", 1.0)
    return op("hue_saturation", hue, *parts, factor, nodes.triple_named(source, "Color", (0.0, 0.0, 0.0)))


def bright_contrast(nodes: Nodes, source: Source) -> Value:
    color, bright, contrast = (nodes.input(source, i) for i in range(3))
    return op("bright_contrast", triple(color), number(bright), number(contrast))


def gamma(nodes: Nodes, source: Source) -> Value:
    return op("gamma", triple(nodes.input(source, 0)), number(nodes.input(source, 1)))


def invert(nodes: Nodes, source: Source) -> Value:
    return op("invert", number(nodes.input(source, 0)), triple(nodes.input(source, 1)))


def to_gray(nodes: Nodes, source: Source) -> Value:
    value = nodes.input(source, 0)
    return op("luminance", triple(value))


def wavelength(nodes: Nodes, source: Source) -> Value:
    rows = np.ones((len(observer.XYZ), 4), np.float32)
    rows[:, :3] = observer.XYZ @ TO_RGB.T / BRIGHTEST_WAVELENGTH
    nm, last = number(nodes.input(source, 0)), observer.FIRST + observer.STEP * (len(rows) - 1)
    color = op("ramp", nm, modes=("linear",), resource=Table(rows, observer.FIRST, last))
    seen = product(math("less_than", nm, last), math("greater_than", nm, observer.FIRST - observer.STEP))
    return scaled(clamped_color(color, 0.0, 1e6), seen)


def blackbody(nodes: Nodes, source: Source) -> Value:
    kelvin = number(nodes.input(source, 0))
    return value_of(blackbody_of(kelvin))


def blackbody_of(kelvin: Number) -> Triple:
    """The colour of a black body, of luminance 1."""
    if not isinstance(kelvin, Op):
        return blackbody_color(kelvin)
    rows = np.ones((BLACKBODY_ROWS, 4), np.float32)
    kelvins = np.linspace(*BLACKBODY_RANGE, BLACKBODY_ROWS)
    rows[:, :3] = [blackbody_color(float(kelvin)) for kelvin in kelvins]
    return op("ramp", kelvin, modes=("linear",), resource=Table(rows, *BLACKBODY_RANGE))
