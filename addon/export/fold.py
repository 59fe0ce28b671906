# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes whose value is known without a surface: what is constant, and the means of what varies in a known way."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .color import blackbody, luminance, mean_fresnel
from .color_space import to_linear
from .sockets import Constant, Input, NotConstantError, Source, as_color, as_number, default_value

if TYPE_CHECKING:
    import bpy

    from .nodes import Nodes


@dataclass(frozen=True)
class Folder:
    """Reads the inputs of a node that is folded."""

    nodes: Nodes
    means: bool

    def value(self, item: Input) -> tuple[float, ...]:
        return self.nodes.constant(item) if self.means else self.nodes.folded(item)

    def notice(self, node: Any, what: str) -> None:
        self.nodes.notice(node, what)


def _input(nodes: Folder, source: Source, index: int) -> Constant:
    return nodes.value(Input(source.node.inputs[index], source.groups))


def _own_value(nodes: Folder, source: Source) -> Constant:
    return default_value(source.output)


def _blackbody(nodes: Folder, source: Source) -> Constant:
    return blackbody(as_number(_input(nodes, source, 0)))


def _combine(nodes: Folder, source: Source) -> Constant:
    if getattr(source.node, "mode", "RGB") != "RGB":
        raise NotConstantError(source.node)
    return tuple(as_number(_input(nodes, source, i)) for i in range(3))


_BINARY: dict[str, Callable[[float, float], float]] = {
    "ADD": lambda a, b: a + b,
    "SUBTRACT": lambda a, b: a - b,
    "MULTIPLY": lambda a, b: a * b,
    "DIVIDE": lambda a, b: a / b if b else 0.0,
    "POWER": lambda a, b: a**b if a > 0.0 else 0.0,
    "MINIMUM": min,
    "MAXIMUM": max,
}
_UNARY: dict[str, Callable[[float], float]] = {
    "SQRT": lambda a: math.sqrt(max(a, 0.0)),
    "ABSOLUTE": abs,
    "RADIANS": math.radians,
    "DEGREES": math.degrees,
}


def _math(nodes: Folder, source: Source) -> Constant:
    operation = source.node.operation
    a = as_number(_input(nodes, source, 0))
    if operation in _BINARY:
        result = _BINARY[operation](a, as_number(_input(nodes, source, 1)))
    elif operation in _UNARY:
        result = _UNARY[operation](a)
    else:
        raise NotConstantError(source.node)
    return (min(max(result, 0.0), 1.0) if source.node.use_clamp else result,)


_BLENDS: dict[str, Callable[[float, float], float]] = {
    "MIX": lambda a, b: b,
    "MULTIPLY": lambda a, b: a * b,
    "ADD": lambda a, b: a + b,
    "SUBTRACT": lambda a, b: a - b,
    "DARKEN": min,
    "LIGHTEN": max,
    "SCREEN": lambda a, b: 1.0 - (1.0 - a) * (1.0 - b),
}


def _mix(nodes: Folder, source: Source) -> Constant:
    node = source.node
    if node.bl_idname == "ShaderNodeMix":
        suffix = {"FLOAT": "Float", "VECTOR": "Vector", "RGBA": "Color"}.get(node.data_type)
        if suffix is None or (node.data_type == "VECTOR" and node.factor_mode != "UNIFORM"):
            raise NotConstantError(node)
        wanted = ("Factor_Float", f"A_{suffix}", f"B_{suffix}")
        by_identifier = {socket.identifier: socket for socket in node.inputs}
        factor, a, b = (nodes.value(Input(by_identifier[name], source.groups)) for name in wanted)
        blend = node.blend_type if node.data_type == "RGBA" else "MIX"
        clamp_factor, clamp_result = node.clamp_factor, node.clamp_result and node.data_type == "RGBA"
    else:
        factor, a, b = (_input(nodes, source, i) for i in range(3))
        blend, clamp_factor, clamp_result = node.blend_type, True, node.use_clamp
    if blend not in _BLENDS:
        raise NotConstantError(node)
    t = as_number(factor)
    t = min(max(t, 0.0), 1.0) if clamp_factor else t
    if len(a) != len(b):
        a, b = as_color(a), as_color(b)
    result = tuple(x + t * (_BLENDS[blend](x, y) - x) for x, y in zip(a, b, strict=True))
    return tuple(min(max(v, 0.0), 1.0) for v in result) if clamp_result else result


def _gamma(nodes: Folder, source: Source) -> Constant:
    exponent = as_number(_input(nodes, source, 1))
    return tuple(v**exponent if v > 0.0 else v for v in as_color(_input(nodes, source, 0)))


def _invert(nodes: Folder, source: Source) -> Constant:
    factor = as_number(_input(nodes, source, 0))
    return tuple(v + factor * (1.0 - 2.0 * v) for v in as_color(_input(nodes, source, 1)))


def _ramp(nodes: Folder, source: Source) -> Constant:
    color = source.node.color_ramp.evaluate(as_number(_input(nodes, source, 0)))
    return (color[3],) if source.output.identifier == "Alpha" else tuple(color[:3])


def _to_gray(nodes: Folder, source: Source) -> Constant:
    return (luminance(as_color(_input(nodes, source, 0))),)


def _fresnel(nodes: Folder, source: Source) -> Constant:
    mean = mean_fresnel(max(as_number(_input(nodes, source, 0)), 1e-3))
    nodes.notice(source.node, f"varies with the angle; its mean over all directions ({mean:.3g}) is used")
    return (mean,)


def _layer_weight(nodes: Folder, source: Source) -> Constant:
    blend = min(max(as_number(_input(nodes, source, 0)), 0.0), 1.0 - 1e-5)
    if source.output.identifier == "Fresnel":
        mean = mean_fresnel(1.0 / (1.0 - blend))
    else:  # 1 - cos^p, its mean over the cosine-weighted hemisphere
        power = 2.0 * blend if blend < 0.5 else 0.5 / (1.0 - blend)
        mean = 1.0 - 2.0 / (power + 2.0)
    nodes.notice(source.node, f"varies with the angle; its mean over all directions ({mean:.3g}) is used")
    return (mean,)


def _light_path(nodes: Folder, source: Source) -> Constant:
    flags = nodes.nodes.ray_flags
    if source.output.identifier not in flags:
        raise NotConstantError(source.node)
    return (flags[source.output.identifier],)


def stored_pixels(image: bpy.types.Image) -> NDArray[np.float32]:
    """(height, width, channels) as Blender has them, bottom row first. Raises ValueError where there are none."""
    width, height = image.size
    channels = image.channels
    if not width or not height or not channels:
        raise ValueError("has no pixels")
    pixels = np.empty(width * height * channels, np.float32)
    image.pixels.foreach_get(pixels)
    return pixels.reshape(height, width, channels)


def read_image(image: bpy.types.Image) -> NDArray[np.float32]:
    """(height, width, channels), linear, bottom row first. Raises as `stored_pixels`."""
    pixels = stored_pixels(image)
    if image.channels < 3:
        pixels = np.repeat(pixels[..., :1], 3, axis=2)
    if not image.is_float:
        pixels[..., :3] = to_linear(pixels[..., :3], image.colorspace_settings.name)
    return pixels


def _image_texture(nodes: Folder, source: Source) -> Constant:
    image = source.node.image
    if image is None:
        raise NotConstantError(source.node)
    try:
        pixels = read_image(image)
    except (ValueError, RuntimeError):
        raise NotConstantError(source.node) from None
    if source.output.identifier == "Alpha":
        mean: Constant = (float(pixels[..., 3].mean()) if pixels.shape[2] > 3 else 1.0,)
    else:
        mean = tuple(float(v) for v in pixels[..., :3].mean(axis=(0, 1)))
    shown = ", ".join(f"{v:.3g}" for v in mean)
    nodes.notice(source.node, f"textures are not supported; the mean of image '{image.name}' ({shown}) is used")
    return mean


FOLDS: dict[str, Callable[[Folder, Source], Constant]] = {
    "ShaderNodeRGB": _own_value,
    "ShaderNodeValue": _own_value,
    "ShaderNodeBlackbody": _blackbody,
    "ShaderNodeCombineColor": _combine,
    "ShaderNodeCombineRGB": _combine,
    "ShaderNodeCombineXYZ": _combine,
    "ShaderNodeMath": _math,
    "ShaderNodeMix": _mix,
    "ShaderNodeMixRGB": _mix,
    "ShaderNodeGamma": _gamma,
    "ShaderNodeInvert": _invert,
    "ShaderNodeValToRGB": _ramp,
    "ShaderNodeRGBToBW": _to_gray,
    "ShaderNodeLightPath": _light_path,
}
# What varies, but whose mean is known.
MEANS: dict[str, Callable[[Folder, Source], Constant]] = {
    "ShaderNodeFresnel": _fresnel,
    "ShaderNodeLayerWeight": _layer_weight,
    "ShaderNodeTexImage": _image_texture,
}
