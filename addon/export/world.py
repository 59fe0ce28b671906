# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's world -> Environment and Medium."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import pi
from typing import TYPE_CHECKING, Any

import numpy as np

from ..scene.description import BLACK, Environment, Floats, Lamp, Medium, Rgb, SunLight
from ..scene.problems import ENDLESS_FOG, Notices
from ..scene.program import Op
from .color import add_colors, lerp, scaled
from .light import UNLIMITED_BOUNCES
from .nodes import Nodes
from .sockets import Input, NotConstantError, Source
from .translate.emitted import emitted, program_of
from .translate.image import MISSING, Images
from .visibility import world_rays
from .volume import world_medium

if TYPE_CHECKING:
    import bpy


def _around_z(angle: float) -> Floats:
    matrix = np.eye(4)
    matrix[:2, :2] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
    return matrix


# The centre of an equirectangular image lies along +y for the engine and along +x for Blender.
IMAGE_TURN = _around_z(-pi / 2.0)


def export_world(
    world: bpy.types.World | None, notices: Notices, images: Images | None = None, constants_only: bool = False
) -> tuple[Environment, Medium | None]:
    if world is None:
        return Environment(), None
    rays = world_rays(world)
    bounces = getattr(getattr(world, "cycles", None), "max_bounces", UNLIMITED_BOUNCES)
    if bounces < UNLIMITED_BOUNCES:
        notices.add(f"world '{world.name}'", "a limit of its light's bounces is not supported; it has none")
    if not world.use_nodes or world.node_tree is None:
        return Environment(radiance=(world.color[0], world.color[1], world.color[2]), rays=rays), None
    nodes = Nodes(world, f"world '{world.name}'", notices, images)
    nodes.is_sky = True
    nodes.constants_only = constants_only
    surface, volume = nodes.surface_of_output(), nodes.surface_of_output("Volume")
    environment = Environment()
    if surface is not None:
        environment = _sky_program(nodes, surface) or _Background(nodes, world).shader(surface)
    environment = replace(environment, rays=rays)
    return environment, None if volume is None else world_medium(nodes, volume)


def warn_of_black_sky(
    world: bpy.types.World | None,
    environment: Environment,
    lights: tuple[Lamp, ...],
    medium: Medium | None,
    notices: Notices,
    something_shines: bool = False,
) -> None:
    """Space without end in fog is opaque: nothing from outside of it arrives. Who has put lights inside knows that.

    something_shines: emissive surfaces.
    """
    if something_shines or any(not isinstance(lamp, SunLight) for lamp in lights):
        return
    if medium is None or medium.falloff is not None:
        return
    if not any(a + s > 0.0 for a, s in zip(*medium.constant_sigmas(), strict=True)):
        return
    unseen = ["its background"] if any(environment.radiance) else []
    unseen += [f"sun '{lamp.name}'" for lamp in lights if isinstance(lamp, SunLight)]
    if unseen:
        notices.add(
            f"world '{world.name}'" if world else "",
            f"{' and '.join(unseen)} {'are' if len(unseen) > 1 else 'is'} black behind its endless fog, as in Cycles:"
            " use point, spot or area lamps or emissive objects inside the fog, or remove the world's Volume shader",
            ENDLESS_FOG,
        )


def _sky_program(nodes: Nodes, surface: Input) -> Environment | None:
    """A sky that varies by more than one image; None for what the engine has without a program."""
    if nodes.constants_only or not _varies_beyond_an_image(nodes, surface):
        return None
    radiance = emitted(nodes, surface)
    if not isinstance(radiance, Op):
        return None
    program = program_of(nodes, radiance, "constants are used")
    if program is None:
        return None
    return Environment(radiance=(1.0, 1.0, 1.0), program=program, sun=nodes.sky_sun)


def _varies_beyond_an_image(nodes: Nodes, item: Input) -> bool:
    source = nodes.source(item)
    if source is None or source.node is None:
        return False
    kind = source.node.bl_idname
    if kind == "ShaderNodeMixShader":
        if not _is_constant(nodes, Input(source.node.inputs[0], source.groups)):
            return True
        return any(_varies_beyond_an_image(nodes, Input(source.node.inputs[i], source.groups)) for i in (1, 2))
    if kind == "ShaderNodeAddShader":
        return any(_varies_beyond_an_image(nodes, Input(source.node.inputs[i], source.groups)) for i in (0, 1))
    if kind not in ("ShaderNodeBackground", "ShaderNodeEmission"):
        return False
    color = Input(source.node.inputs["Color"], source.groups)
    if not _is_constant(nodes, Input(source.node.inputs["Strength"], source.groups)):
        return True
    made_by = nodes.source(color)
    if made_by is not None and made_by.node is not None and made_by.node.bl_idname == "ShaderNodeTexEnvironment":
        return not _is_plain(nodes, made_by)
    return not _is_constant(nodes, color)


def _is_plain(nodes: Nodes, source: Source) -> bool:
    """An equirectangular image that is turned and no more."""
    node = source.node
    if node.image is None or node.projection != "EQUIRECTANGULAR" or node.interpolation != "Linear":
        return False
    vector = nodes.source(Input(node.inputs["Vector"], source.groups))
    if vector is not None and vector.node is not None and vector.node.bl_idname == "ShaderNodeMapping":
        inputs = vector.node.inputs
        place = inputs.get("Location")
        if any(inputs[name].is_linked for name in ("Rotation", "Scale")):
            return False
        if any(v != 1.0 for v in inputs["Scale"].default_value):
            return False
        if place is not None and (place.is_linked or any(place.default_value)):
            return False
        vector = nodes.source(Input(inputs["Vector"], vector.groups))
    if vector is None or vector.node is None:
        return True
    return vector.node.bl_idname == "ShaderNodeTexCoord" and (
        vector.output.identifier == "Generated" or (vector.output.identifier == "Object" and vector.node.object is None)
    )


def _is_constant(nodes: Nodes, item: Input) -> bool:
    try:
        nodes.folded(item)
    except NotConstantError:
        return False
    return True


@dataclass
class _Background:
    nodes: Nodes
    world: Any

    def shader(self, item: Input) -> Environment:
        source = self.nodes.source(item)
        if source is None or source.node is None:
            return Environment()
        kind = source.node.bl_idname
        if kind in ("ShaderNodeBackground", "ShaderNodeEmission"):
            return self._background(source)
        if kind == "ShaderNodeMixShader":
            factor = self.nodes.number(source.node, source.groups, source.node.inputs[0].name)
            first, second = (self.shader(Input(source.node.inputs[i], source.groups)) for i in (1, 2))
            return self._sum(source, _dimmed(first, 1.0 - factor), _dimmed(second, factor))
        if kind == "ShaderNodeAddShader":
            first, second = (self.shader(Input(source.node.inputs[i], source.groups)) for i in (0, 1))
            return self._sum(source, first, second)
        return self._fallback(source.node, "is not supported in a world")

    def _sum(self, source: Source, a: Environment, b: Environment) -> Environment:
        if a.image is None and b.image is None:
            return Environment(radiance=add_colors(a.radiance, b.radiance))
        for one, other in ((a, b), (b, a)):
            if one.image is not None and other.radiance == BLACK:
                return one
        self.nodes.notice(source.node, "a mix with an image is not supported; the image alone is used")
        return a if a.image is not None else b

    def _background(self, source: Source) -> Environment:
        node = source.node
        strength = max(self.nodes.number(node, source.groups, "Strength"), 0.0)
        color_input = Input(node.inputs["Color"], source.groups)
        color_source = self.nodes.source(color_input)
        if color_source is not None and color_source.node is not None:
            if color_source.node.bl_idname == "ShaderNodeTexEnvironment":
                return _dimmed(self._image(color_source), strength)
            if color_source.node.bl_idname == "ShaderNodeTexSky":
                return _dimmed(self._fallback(color_source.node, "(the sky) is not supported"), strength)
        fallback: Rgb = (self.world.color[0], self.world.color[1], self.world.color[2])
        color = self.nodes.color(node, source.groups, ("Color",), fallback)
        return Environment(radiance=scaled(color, strength))

    def _image(self, source: Source) -> Environment:
        node = source.node
        image = node.image
        try:
            if image is None:
                raise ValueError("has no image")
            pixels = self.nodes.images.light(image)
        except (ValueError, RuntimeError) as error:
            name = "" if image is None else f"image '{image.name}' "
            self.nodes.notice(node, f"{name}{error}; shown in magenta, as in Cycles")
            return Environment(radiance=MISSING)
        if node.projection != "EQUIRECTANGULAR":
            self.nodes.notice(node, "a mirror ball is not supported; the image is read as equirectangular")
        return Environment((1.0, 1.0, 1.0), pixels, self._turn(source) @ IMAGE_TURN)

    def _turn(self, source: Source) -> Floats:
        """How the image is turned by a Mapping node between the texture coordinates and the image."""
        vector = self.nodes.source(Input(source.node.inputs["Vector"], source.groups))
        if vector is None or vector.node is None:
            return np.eye(4)
        node = vector.node
        if node.bl_idname == "ShaderNodeTexCoord":
            if vector.output.name not in ("Generated", "Object"):
                self.nodes.notice(node, f"coordinates '{vector.output.name}' are not supported; Generated is used")
            return np.eye(4)
        if node.bl_idname != "ShaderNodeMapping" or node.inputs["Rotation"].is_linked:
            self.nodes.notice(node, "cannot be rendered; the image is not turned")
            return np.eye(4)
        if any(node.inputs["Location"].default_value) or any(v != 1.0 for v in node.inputs["Scale"].default_value):
            self.nodes.notice(node, "moving or scaling the image of a world is not supported; it is turned alone")
        # The mapping turns the direction that is looked up, so the picture turns the other way.
        rotation = node.inputs["Rotation"].default_value.to_matrix().to_4x4()
        turn = np.array(rotation, np.float64)
        return turn if node.vector_type == "TEXTURE" else turn.T

    def _fallback(self, node: Any, what: str) -> Environment:
        color = self.world.color
        shown = ", ".join(f"{v:.3g}" for v in color)
        self.nodes.notice(node, f"{what}; the world's viewport colour ({shown}) is used")
        return Environment(radiance=(color[0], color[1], color[2]))


def _dimmed(environment: Environment, factor: float) -> Environment:
    return replace(environment, radiance=lerp(BLACK, environment.radiance, factor))
