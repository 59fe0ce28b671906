# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads node trees: follows links through groups, reroutes and muted nodes, folds what is constant and makes the rest
operations of a shader program (translate/).

Where only a constant will do, what varies is replaced by the closest constant, and a notice says which.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from ..native.library import load
from ..scene.description import Rgb, SkySun
from ..scene.problems import Notices
from ..scene.program import Op
from .fold import FOLDS, MEANS, Folder
from .sockets import Constant, Input, NotConstantError, Source, as_color, as_number, default_value, find_input
from .translate import arithmetic, ies, image, pattern, sky, surface, vector
from .translate import color as color_nodes
from .translate.values import Number, Triple, Value, converted, number, triple

if TYPE_CHECKING:
    import bpy

    from .grids import Grid


# The Cycles of 3.4 makes 0 of an input that a muted node passes on with nothing linked to it; that of 5.0 leaves what
# the muted node is linked to by itself.
MUTED_IS_BLACK_BEFORE = (5, 0)


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


PLAIN = ("NodeReroute", "NodeFrame", "NodeGroupInput", "NodeGroupOutput")


def all_nodes(tree: bpy.types.NodeTree) -> Iterator[bpy.types.Node]:
    """Those of its groups too."""
    seen, pending = set(), [tree]
    while pending:
        each = pending.pop()
        if each.as_pointer() in seen:
            continue
        seen.add(each.as_pointer())
        for node in each.nodes:
            yield node
            if getattr(node, "node_tree", None) is not None:
                pending.append(node.node_tree)


def has_zones(tree: bpy.types.NodeTree) -> bool:
    """Whether it has nodes that Blender can write in plain shader nodes: zones, closures, bundles, switches."""
    return any(not node.bl_idname.startswith("ShaderNode") and node.bl_idname not in PLAIN for node in all_nodes(tree))


class Nodes:
    """The node tree of a material, world or lamp, and where to put notices about it."""

    def __init__(self, owner: Any, where: str, notices: Notices, images: image.Images | None = None) -> None:
        self.tree: bpy.types.NodeTree = owner.node_tree
        self._inlined: Any = None  # Blender's plain copy of the tree, which lives as long as this does
        if hasattr(owner, "inline_shader_nodes") and has_zones(self.tree):  # from 5.0 on
            try:
                self._inlined = owner.inline_shader_nodes()
                self.tree = self._inlined.node_tree
            except RuntimeError as error:
                notices.add(where, f"its zones cannot be rendered: {error}")
        self.where = where
        self.notices = notices
        self.images = images or image.Images()
        self.version = blender_version()
        self.frame = self.images.frame  # of the scene
        self.is_sky = False  # the tree is a world's
        self.lamp = ""  # the tree is a lamp's: of this type
        self.in_volume = False  # it is asked about points within a body
        self.grids: dict[str, Grid] = {}  # of that body, a volume object
        self.sky_sun: SkySun | None = None  # of a Sky Texture that was met
        self.material_index = 0  # Blender's pass index
        self.constants_only = False  # nothing may vary
        self.ray_flags: dict[str, float] = {}  # by the outputs of a Light Path node: what is known of the rays
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
                if not socket.is_linked:
                    is_black = socket.type != "SHADER" and self.version < MUTED_IS_BLACK_BEFORE
                    return Source(None, socket, groups, kinds, is_muted=True) if is_black else None
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
            return default_value(item.socket)
        value = self._source_value(source)
        given = source.output.type
        for kind in (*reversed(source.kinds), item.socket.type):
            value, given = converted(value, given, kind), kind
        return value

    def _source_value(self, source: Source) -> Value:
        if source.node is None:
            return source.own_value()
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
        if inner and inner[0].from_socket.name == "Normal" and self.is_free(source, inner[0].from_socket):
            self.notice(source.node, f"{subject}; the surface's own normal is used in its place")
            return surface.geometry(self, "normal")
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
            return default_value(item.socket)
        if source.node is None:
            return source.own_value()
        return self._folded(source, means)

    def _folded(self, source: Source, means: bool) -> Constant:
        key = (source.output.as_pointer(), *(group.as_pointer() for group in source.groups), means)
        if key not in self._constants:
            fold = FOLDS.get(source.node.bl_idname) or (MEANS.get(source.node.bl_idname) if means else None)
            self._constants[key] = NotConstantError(source.node)
            if fold is not None:
                try:
                    self._constants[key] = fold(Folder(self, means), source)
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
            own = as_color(default_value(socket)) if fallback is None else fallback
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
            own = as_number(default_value(socket))
            what = f"cannot be rendered; {socket.name} uses the socket's own value ({own:.3g}) in its place"
            self.notice(error.args[0], what)
            return own

    def is_linked(self, node: Any, *names: str) -> bool:
        socket = find_input(node, *names)
        return socket is not None and socket.is_linked


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
    "ShaderNodeTexIES": ies.ies_texture,
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
    "ShaderNodeLightFalloff": surface.light_falloff,
    "ShaderNodeFresnel": surface.fresnel,
    "ShaderNodeLayerWeight": surface.layer_weight,
    "ShaderNodeBump": surface.bump,
    "ShaderNodeWireframe": surface.wireframe,
    "ShaderNodeParticleInfo": surface.particle_info,
    "ShaderNodeHairInfo": surface.strand_info,
    "ShaderNodeVolumeInfo": surface.volume_info,
    "ShaderNodeWavelength": color_nodes.wavelength,
    "ShaderNodeNormalMap": surface.normal_map,
}
