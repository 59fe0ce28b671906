# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads node trees: follows links through groups, reroutes and muted nodes, folds what is constant and makes the rest
operations of a shader program (translate/).

Where only a constant will do, what varies is replaced by the closest constant, and a notice says which.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..native.library import load
from ..scene.description import Rgb, SkySun
from ..scene.problems import Notices
from ..scene.program import Op
from .color import blackbody, luminance, mean_fresnel, srgb_to_linear
from .translate import arithmetic, image, pattern, sky, surface, vector
from .translate import color as color_nodes
from .translate.values import Number, Triple, Value, converted, number, triple

if TYPE_CHECKING:
    import bpy

Constant = tuple[float, ...]  # (v,) or (r, g, b)


def scaled(color: Rgb, factor: float) -> Rgb:
    return (color[0] * factor, color[1] * factor, color[2] * factor)


def add_colors(a: Rgb, b: Rgb) -> Rgb:
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def lerp(a: Rgb, b: Rgb, t: float) -> Rgb:
    return (a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t, a[2] + (b[2] - a[2]) * t)


def as_color(value: tuple[float, ...]) -> Rgb:
    return (value[0], value[0], value[0]) if len(value) == 1 else (value[0], value[1], value[2])


def as_number(value: tuple[float, ...]) -> float:
    return value[0] if len(value) == 1 else luminance(as_color(value))


@dataclass(frozen=True)
class Source:
    """Where the value of an input comes from: the output of a node, within the groups that were entered."""

    node: Any
    output: Any
    groups: tuple[Any, ...]
    kinds: tuple[str, ...] = ()  # of the sockets of groups on the way, each of which converts, from the input back


@dataclass(frozen=True)
class Input:
    """An input socket within the groups that were entered."""

    socket: Any
    groups: tuple[Any, ...] = ()


class NotConstantError(Exception):
    """A value that varies over a surface or a direction."""


def unknown_mode(value: Value) -> str | None:
    """A mode of an operation that the engine does not have: a newer Blender's nodes may know more than we do."""
    if not isinstance(value, Op):
        return None
    words = load().op_rows[value.name].modes
    return next((word for word, known in zip(value.modes, words, strict=False) if word not in known), None)


class NotTranslatedError(Exception):
    """Something that no operation gives."""


def blender_version() -> tuple[int, ...]:
    import bpy

    return tuple(bpy.app.version)


def find_input(node: Any, *names: str) -> Any:
    """The first of a node's inputs of these names: a name may change between versions of Blender."""
    for name in names:
        socket = node.inputs.get(name)
        if socket is not None:
            return socket
    return None


class Nodes:
    """A node tree, and where to put notices about it."""

    def __init__(
        self, tree: bpy.types.NodeTree, where: str, notices: Notices, images: image.Images | None = None
    ) -> None:
        self.tree = tree
        self.where = where
        self.notices = notices
        self.images = images or image.Images()
        self.version = blender_version()
        self.frame = self.images.frame  # of the scene
        self.is_sky = False  # the tree is a world's
        self.sky_sun: SkySun | None = None  # of a Sky Texture that was met
        self.material_index = 0  # Blender's pass index
        self.constants_only = False  # nothing may vary
        self.layer_property = self.images.layer_property  # by its name, of the view layer, the scene or its world
        self.bumped_normal: Op | None = None  # by the material's displacement: what nodes know as the normal
        self.shift = "center"  # where a bump asks for its height
        self.shift_width: Number = 1.0
        self._values: dict[tuple[Any, ...], Value] = {}
        self._constants: dict[tuple[Any, ...], Constant | NotConstantError] = {}

    def notice(self, node: Any, what: str) -> None:
        label = f"node '{node.name}'"
        self.notices.add(f"{self.where}, {label}" if self.where else label, what)

    # ---- Links ----

    def surface_of_output(self, name: str = "Surface") -> Input | None:
        """An input of the active output node; None where the tree has no output."""
        output = self.tree.get_output_node("CYCLES")
        socket = None if output is None else output.inputs.get(name)
        return None if socket is None else Input(socket)

    def source(self, item: Input) -> Source | None:
        """Follows an input to the node that makes its value; None if nothing is linked."""
        socket, groups = item.socket, item.groups
        kinds: tuple[str, ...] = ()
        for _ in range(1000):  # a tree that a file holds may have cycles
            links = [link for link in socket.links if link.is_valid and not getattr(link, "is_muted", False)]
            if not links:
                return None
            node, output = links[0].from_node, links[0].from_socket
            if node.mute:
                inner = [link for link in node.internal_links if link.to_socket == output]
                if not inner:
                    return None
                socket = inner[0].from_socket
            elif node.bl_idname == "NodeReroute":
                socket = node.inputs[0]
            elif node.bl_idname == "NodeGroupInput":
                if not groups:
                    return None
                socket, groups = self._matching(groups[-1].inputs, node.outputs, output), groups[:-1]
                kinds = (*kinds, output.type)
                if not socket.is_linked:
                    return None if socket.type == "SHADER" else Source(None, socket, groups, kinds)
            elif node.bl_idname == "ShaderNodeGroup" and node.node_tree is not None:
                inside = [n for n in node.node_tree.nodes if n.bl_idname == "NodeGroupOutput" and n.is_active_output]
                if not inside:
                    return None
                socket, groups = self._matching(inside[0].inputs, node.outputs, output), (*groups, node)
                kinds = (*kinds, output.type)
                if not socket.is_linked:
                    return None if socket.type == "SHADER" else Source(None, socket, groups, kinds)
            else:
                return Source(node, output, groups, kinds)
        return None

    @staticmethod
    def _matching(sockets: Any, others: Any, wanted: Any) -> Any:
        """The socket on this side of a group that belongs to one on the other side: they have one order."""
        return sockets[[other.identifier for other in others].index(wanted.identifier)]

    # ---- Values ----

    def value(self, item: Input) -> Value:
        """Of a socket: a constant, or an operation. What has no counterpart is replaced where it stands, and told."""
        source = self.source(item)
        if source is None:
            return _default(item.socket)
        value = self._source_value(source)
        given = source.output.type
        for kind in (*reversed(source.kinds), item.socket.type):
            value, given = converted(value, given, kind), kind
        return value

    def _source_value(self, source: Source) -> Value:
        if source.node is None:
            return _default(source.output)
        width = self.shift_width if isinstance(self.shift_width, float) else id(self.shift_width)
        key = (source.output.as_pointer(), *(group.as_pointer() for group in source.groups), self.shift, width)
        if key not in self._values:
            self._values[key] = (0.0,)  # what a tree in a circle, which a file may hold, reads of itself
            self._values[key] = self._computed(source)
        return self._values[key]

    def _computed(self, source: Source) -> Value:
        try:
            return self._folded(source, means=False)
        except NotConstantError:
            pass
        translate = _OPERATIONS.get(source.node.bl_idname)
        if translate is not None:
            try:
                value = translate(self, source)
                if word := unknown_mode(value):
                    self.not_translated(source, f"its option '{word}'")
                return value
            except NotTranslatedError as error:
                return self._substitute(source, str(error))
        return self._substitute(source, "")

    def _substitute(self, source: Source, what: str) -> Value:
        """What passes through a node when it is muted, or else the middle of its range."""
        inner = [link for link in source.node.internal_links if link.to_socket == source.output]
        subject = f"{what} cannot be rendered" if what else "cannot be rendered"
        if inner:
            self.notice(source.node, f"{subject}; its {inner[0].from_socket.name} is used in its place")
            return converted(
                self.value(Input(inner[0].from_socket, source.groups)), inner[0].from_socket.type, source.output.type
            )
        self.notice(source.node, f"{subject}; 0.5 is used in its place")
        return (0.5,) if source.output.type == "VALUE" else (0.5, 0.5, 0.5)

    def not_translated(self, source: Source, what: str) -> Value:
        raise NotTranslatedError(what)

    @contextmanager
    def shifted(self, shift: str, width: Number) -> Iterator[None]:
        before = self.shift, self.shift_width
        self.shift, self.shift_width = shift, width
        try:
            yield
        finally:
            self.shift, self.shift_width = before

    def input(self, source: Source, index: int) -> Value:
        return self.value(Input(source.node.inputs[index], source.groups))

    def socket_value(self, source: Source, socket: Any) -> Value:
        return self.value(Input(socket, source.groups))

    def number_named(self, source: Source, name: str, default: float) -> Number:
        """Of an input by its name; a version of Blender may lack it or hide it."""
        return self.varying_number(source.node, source.groups, name, default=default)

    def triple_named(self, source: Source, name: str, default: Rgb) -> Triple:
        socket = find_input(source.node, name)
        return default if socket is None else triple(self.socket_value(source, socket))

    def is_free(self, source: Source, socket: Any) -> bool:
        """Whether nothing gives the socket a value."""
        return self.source(Input(socket, source.groups)) is None

    def texture_place(self, source: Source, kind: str) -> Triple:
        """A texture's vector; kind: "uv", "generated" or "direction", where nothing is linked to it."""
        socket = source.node.inputs["Vector"]
        if self.is_free(source, socket):
            if kind == "direction":
                return surface.geometry(self, "position")
            return surface.place(self, kind)
        return triple(self.socket_value(source, socket))

    def varying_color(self, node: Any, groups: tuple[Any, ...], *names: str) -> Triple:
        """A colour input by name, for what takes operations."""
        if self.constants_only:
            return self.color(node, groups, names)
        socket = find_input(node, *names)
        return (0.0, 0.0, 0.0) if socket is None else triple(self.value(Input(socket, groups)))

    def varying_number(self, node: Any, groups: tuple[Any, ...], *names: str, default: float = 0.0) -> Number:
        if self.constants_only:
            return self.number(node, groups, *names, default=default)
        socket = find_input(node, *names)
        return default if socket is None else number(self.value(Input(socket, groups)))

    # ---- Constants ----

    def constant(self, item: Input) -> Constant:
        """Raises NotConstantError. What varies in a known way is its mean, and told."""
        return self._constant(item, means=True)

    def folded(self, item: Input) -> Constant:
        """Raises NotConstantError for all that varies."""
        return self._constant(item, means=False)

    def _constant(self, item: Input, means: bool) -> Constant:
        source = self.source(item)
        if source is None:
            return _default(item.socket)
        if source.node is None:
            return _default(source.output)
        return self._folded(source, means)

    def _folded(self, source: Source, means: bool) -> Constant:
        key = (source.output.as_pointer(), *(group.as_pointer() for group in source.groups), means)
        if key not in self._constants:
            fold = _FOLDS.get(source.node.bl_idname) or (_MEANS.get(source.node.bl_idname) if means else None)
            self._constants[key] = NotConstantError(source.node)
            if fold is not None:
                try:
                    self._constants[key] = fold(_Folder(self, means), source)
                except NotConstantError as error:
                    self._constants[key] = error
        found = self._constants[key]
        if isinstance(found, NotConstantError):
            raise found
        return found

    def color(self, node: Any, groups: tuple[Any, ...], names: tuple[str, ...], fallback: Rgb | None = None) -> Rgb:
        """A colour input by name; what varies becomes the fallback, or else the socket's own value."""
        socket = find_input(node, *names)
        if socket is None:
            return fallback or (0.0, 0.0, 0.0)
        try:
            return as_color(self.constant(Input(socket, groups)))
        except NotConstantError as error:
            own = as_color(_default(socket)) if fallback is None else fallback
            shown = ", ".join(f"{v:.3g}" for v in own)
            what = "the material's viewport colour" if fallback is not None else "the socket's own value"
            self.notice(error.args[0], f"cannot be rendered; {socket.name} uses {what} ({shown}) in its place")
            return own

    def number(self, node: Any, groups: tuple[Any, ...], *names: str, default: float = 0.0) -> float:
        """A number input by name."""
        socket = find_input(node, *names)
        if socket is None:
            return default
        try:
            return as_number(self.constant(Input(socket, groups)))
        except NotConstantError as error:
            own = as_number(_default(socket))
            what = f"cannot be rendered; {socket.name} uses the socket's own value ({own:.3g}) in its place"
            self.notice(error.args[0], what)
            return own

    def is_linked(self, node: Any, *names: str) -> bool:
        socket = find_input(node, *names)
        return socket is not None and socket.is_linked

    def lamp_emission(self) -> Rgb:
        """What the nodes of a lamp multiply its light by."""
        surface = self.surface_of_output()
        source = None if surface is None else self.source(surface)
        if source is None or source.node is None:
            return (0.0, 0.0, 0.0)
        if source.node.bl_idname != "ShaderNodeEmission":
            self.notice(source.node, "cannot be rendered in a lamp; the lamp's own colour and power are used")
            return (1.0, 1.0, 1.0)
        color = self.color(source.node, source.groups, ("Color",))
        return scaled(color, self.number(source.node, source.groups, "Strength"))


def _default(socket: Any) -> Constant:
    value = getattr(socket, "default_value", 0.0)
    if isinstance(value, (int, float)):
        return (float(value),)
    return tuple(float(v) for v in value[:3])


# ---- Nodes whose value is known without a surface ------------------------------------------------------------------


@dataclass(frozen=True)
class _Folder:
    """Reads the inputs of a node that is folded."""

    nodes: Nodes
    means: bool

    def value(self, item: Input) -> tuple[float, ...]:
        return self.nodes.constant(item) if self.means else self.nodes.folded(item)

    def notice(self, node: Any, what: str) -> None:
        self.nodes.notice(node, what)


def _input(nodes: _Folder, source: Source, index: int) -> Constant:
    return nodes.value(Input(source.node.inputs[index], source.groups))


def _own_value(nodes: _Folder, source: Source) -> Constant:
    return _default(source.output)


def _blackbody(nodes: _Folder, source: Source) -> Constant:
    return blackbody(as_number(_input(nodes, source, 0)))


def _combine(nodes: _Folder, source: Source) -> Constant:
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


def _math(nodes: _Folder, source: Source) -> Constant:
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


def _mix(nodes: _Folder, source: Source) -> Constant:
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


def _gamma(nodes: _Folder, source: Source) -> Constant:
    exponent = as_number(_input(nodes, source, 1))
    return tuple(v**exponent if v > 0.0 else v for v in as_color(_input(nodes, source, 0)))


def _invert(nodes: _Folder, source: Source) -> Constant:
    factor = as_number(_input(nodes, source, 0))
    return tuple(v + factor * (1.0 - 2.0 * v) for v in as_color(_input(nodes, source, 1)))


def _ramp(nodes: _Folder, source: Source) -> Constant:
    color = source.node.color_ramp.evaluate(as_number(_input(nodes, source, 0)))
    return (color[3],) if source.output.identifier == "Alpha" else tuple(color[:3])


def _to_gray(nodes: _Folder, source: Source) -> Constant:
    return (luminance(as_color(_input(nodes, source, 0))),)


def _fresnel(nodes: _Folder, source: Source) -> Constant:
    mean = mean_fresnel(max(as_number(_input(nodes, source, 0)), 1e-3))
    nodes.notice(source.node, f"varies with the angle; its mean over all directions ({mean:.3g}) is used")
    return (mean,)


def _layer_weight(nodes: _Folder, source: Source) -> Constant:
    blend = min(max(as_number(_input(nodes, source, 0)), 0.0), 1.0 - 1e-5)
    if source.output.identifier == "Fresnel":
        mean = mean_fresnel(1.0 / (1.0 - blend))
    else:  # 1 - cos^p, its mean over the cosine-weighted hemisphere
        power = 2.0 * blend if blend < 0.5 else 0.5 / (1.0 - blend)
        mean = 1.0 - 2.0 / (power + 2.0)
    nodes.notice(source.node, f"varies with the angle; its mean over all directions ({mean:.3g}) is used")
    return (mean,)


def read_image(image: bpy.types.Image) -> NDArray[np.float32]:
    """(height, width, channels) float32, linear, bottom row first."""
    width, height = image.size
    channels = image.channels
    if not width or not height or not channels:
        raise ValueError("has no pixels")
    pixels = np.empty(width * height * channels, np.float32)
    image.pixels.foreach_get(pixels)
    pixels = pixels.reshape(height, width, channels)
    if not image.is_float and image.colorspace_settings.name.startswith("sRGB"):
        pixels[..., :3] = srgb_to_linear(pixels[..., :3])
    if channels < 3:
        pixels = np.repeat(pixels[..., :1], 3, axis=2)
    return pixels


def _image_texture(nodes: _Folder, source: Source) -> Constant:
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


_FOLDS: dict[str, Callable[[_Folder, Source], Constant]] = {
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
}
# What varies, but whose mean is known.
_MEANS: dict[str, Callable[[_Folder, Source], Constant]] = {
    "ShaderNodeFresnel": _fresnel,
    "ShaderNodeLayerWeight": _layer_weight,
    "ShaderNodeTexImage": _image_texture,
}


_OPERATIONS: dict[str, Callable[[Nodes, Source], Value]] = {
    "ShaderNodeMath": arithmetic.math_node,
    "ShaderNodeMapRange": arithmetic.map_range,
    "ShaderNodeClamp": arithmetic.clamp,
    "ShaderNodeCombineColor": arithmetic.combine,
    "ShaderNodeCombineRGB": arithmetic.combine,
    "ShaderNodeCombineXYZ": arithmetic.combine,
    "ShaderNodeCombineHSV": arithmetic.combine,
    "ShaderNodeSeparateColor": arithmetic.separate,
    "ShaderNodeSeparateRGB": arithmetic.separate,
    "ShaderNodeSeparateXYZ": arithmetic.separate,
    "ShaderNodeSeparateHSV": arithmetic.separate,
    "ShaderNodeMix": color_nodes.mix,
    "ShaderNodeMixRGB": color_nodes.mix,
    "ShaderNodeValToRGB": color_nodes.ramp,
    "ShaderNodeRGBCurve": color_nodes.rgb_curves,
    "ShaderNodeVectorCurve": color_nodes.rgb_curves,
    "ShaderNodeFloatCurve": color_nodes.float_curve,
    "ShaderNodeHueSaturation": color_nodes.hue_saturation,
    "ShaderNodeBrightContrast": color_nodes.bright_contrast,
    "ShaderNodeGamma": color_nodes.gamma,
    "ShaderNodeInvert": color_nodes.invert,
    "ShaderNodeRGBToBW": color_nodes.to_gray,
    "ShaderNodeBlackbody": color_nodes.blackbody,
    "ShaderNodeVectorMath": vector.vector_math_node,
    "ShaderNodeMapping": vector.mapping,
    "ShaderNodeVectorRotate": vector.vector_rotate,
    "ShaderNodeVectorTransform": vector.vector_transform,
    "ShaderNodeNormal": vector.normal_node,
    "ShaderNodeTexNoise": pattern.noise,
    "ShaderNodeTexMusgrave": pattern.musgrave,
    "ShaderNodeTexVoronoi": pattern.voronoi,
    "ShaderNodeTexWhiteNoise": pattern.white_noise,
    "ShaderNodeTexWave": pattern.wave,
    "ShaderNodeTexChecker": pattern.checker,
    "ShaderNodeTexGradient": pattern.gradient,
    "ShaderNodeTexMagic": pattern.magic,
    "ShaderNodeTexBrick": pattern.brick,
    "ShaderNodeTexGabor": pattern.gabor,
    "ShaderNodeTexImage": image.image_texture,
    "ShaderNodeTexEnvironment": image.image_texture,
    "ShaderNodeTexSky": sky.sky_texture,
    "ShaderNodeTexCoord": surface.texture_coordinate,
    "ShaderNodeUVMap": surface.uv_map,
    "ShaderNodeAttribute": surface.attribute_node,
    "ShaderNodeVertexColor": surface.color_attribute,
    "ShaderNodeNewGeometry": surface.geometry_node,
    "ShaderNodeTangent": surface.tangent_node,
    "ShaderNodeObjectInfo": surface.object_info,
    "ShaderNodeCameraData": surface.camera_data,
    "ShaderNodeLightPath": surface.light_path,
    "ShaderNodeFresnel": surface.fresnel,
    "ShaderNodeLayerWeight": surface.layer_weight,
    "ShaderNodeBump": surface.bump,
    "ShaderNodeWireframe": surface.wireframe,
    "ShaderNodeParticleInfo": surface.particle_info,
    "ShaderNodeWavelength": color_nodes.wavelength,
    "ShaderNodeNormalMap": surface.normal_map,
}
