# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's material nodes -> the engine's materials.

What the engine cannot do is replaced by the closest thing that it can, and a notice names the object, the material and
the node. Nothing turns black or vanishes for that.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from math import inf, log
from typing import TYPE_CHECKING, Any

from ..scene.description import (
    BLACK,
    WHITE,
    Add,
    Conductor,
    Glass,
    Holdout,
    Lambert,
    Layer,
    Light,
    Material,
    Medium,
    Mirror,
    Mix,
    NamedMaterial,
    Null,
    Rgb,
    Sheen,
    Subsurface,
    Surface,
    Translucent,
    Transparent,
)
from ..scene.problems import Notices, place
from ..scene.program import Op, TooLargeError, programmed
from .color import EUMELANIN, PHEOMELANIN, hair_reflectance
from .combine import add, mix
from .displacement import bump_of_displacement
from .nodes import Nodes, all_nodes
from .principled import principled
from .sockets import Input, Source
from .subsurface import DISK, Method, most_backward, most_forward, subsurface_method
from .translate.bounds import interval
from .translate.image import Images
from .translate.surface import VOLUME_DENSITY, attribute, normal_input, tangent_input
from .translate.values import Number, Triple, clamped, clamped_color, math, op, scaled, squared, triple
from .volume import volume_medium

if TYPE_CHECKING:
    import bpy

    from .grids import Grid

# Below this the engine's GGX is a mirror; its mirror keeps the colour at every angle, as Blender's does.
MIRROR_ALPHA = 1e-4

# From here on bumps mask themselves as facets do; before, a cubic softened their terminator.
BUMPS_AS_FACETS_FROM = (4, 5)

# From here on Cycles' rough diffuse surfaces keep the light that their facets send on to each other.
MULTIPLE_SCATTERING_FROM = (4, 3)

# Up to here Cycles' facets are masked towards both directions independently.
SEPARABLE_MASKING_BEFORE = (3, 5)

# From here on the angle at each facet says how much of light rough glass reflects; before, that at the surface.
FACETS_REFLECT_FROM = (4, 0)

SHADOW_RAY = "Is Shadow Ray"
REFRACTING = {"ShaderNodeBsdfGlass", "ShaderNodeBsdfRefraction", "ShaderNodeBsdfPrincipled"}

# Inputs that are left out where they are not 0.
LEFT_OUT = {
    "Thin Film Thickness": "the thin film is not supported and left out",
    "Thin Wall": "a thin wall is not supported; it is the surface of a solid body",
    "Transmission Dispersion Scale": "dispersion is not supported; all colours are refracted alike",
    "Anisotropy": "anisotropy of glass is not supported; its roughness is round",
}

# What an object without a material shows, here and in Cycles: until 3.4 at least, and from 5.0 at the latest.
OLD_DEFAULT_SURFACE = Lambert((0.8, 0.8, 0.8))
DEFAULT_SURFACE = Layer(
    1.0, Conductor(0.25, f0=(0.04,) * 3, f90=WHITE, f82=WHITE, ior=1.5, facets="multiple"), OLD_DEFAULT_SURFACE
)
HAS_GLOSSY_DEFAULT = (5, 0)


def export_material(
    material: bpy.types.Material | None,
    object_name: str,
    version: tuple[int, ...],
    notices: Notices,
    images: Images | None = None,
    constants_only: bool = False,
    aovs: tuple[Aov, ...] = (),
) -> NamedMaterial:
    """object_name: the first object that uses it, for notices. version: Blender's. constants_only: what varies
    becomes a constant. aovs: the first is the engine's number 1."""
    if material is None:
        return NamedMaterial("default", DEFAULT_SURFACE if version >= HAS_GLOSSY_DEFAULT else OLD_DEFAULT_SURFACE)
    where = place(object_name, material.name)
    if not material.use_nodes or material.node_tree is None:
        return NamedMaterial(material.name_full, viewport_surface(material), material.pass_index)
    shaders = _Shaders(material, where, version, notices, images)
    shaders.nodes.constants_only = constants_only
    asks_shadow_rays = _asks_shadow_rays(material)
    casts_shadows = not (asks_shadow_rays and _lets_shadow_rays_pass(material, version, images))
    if not casts_shadows:
        shaders.nodes.ray_flags = {SHADOW_RAY: 0.0}
    result = shaders.output()
    if casts_shadows and asks_shadow_rays and has_glass(result):
        notices.add(where, "its glass stops shadow rays; what its nodes ask of them changes nothing")
    given = shaders.aovs(aovs)
    if given and isinstance(result, Null):
        result = Transparent(WHITE)  # what is not there gives nothing
    has_normal = not isinstance(result, (Light, Null))
    volume = shaders.volume()
    try:
        (named, normal, shown), program = programmed((result, shaders.normal if has_normal else None, given))
    except TooLargeError as error:
        notices.add(where, f"its nodes cannot be rendered, since {error}; its viewport colour is used")
        return NamedMaterial(material.name_full, viewport_surface(material), material.pass_index, volume=volume)
    return NamedMaterial(
        material.name_full,
        named,
        material.pass_index,
        program,
        normal,
        volume=volume,
        aovs=shown,
        normal_key=shaders.normal_key(),
        casts_shadows=casts_shadows,
    )


def _asks_shadow_rays(material: bpy.types.Material) -> bool:
    nodes = (node for node in all_nodes(material.node_tree) if node.bl_idname == "ShaderNodeLightPath")
    return any(node.outputs[SHADOW_RAY].is_linked for node in nodes)


def has_glass(material: Material) -> bool:
    if isinstance(material, (Mix, Add, Layer)):
        return has_glass(material.a) or has_glass(material.b)
    return isinstance(material, Glass)


def _lets_shadow_rays_pass(material: bpy.types.Material, version: tuple[int, ...], images: Images | None) -> bool:
    """Whether nodes that ask for shadow rays make glass, which the engine's shadow rays cannot pass, clear for them
    alone: a way to have its shadows without caustics. What else they ask of rays may be so or not."""
    if not any(node.bl_idname in REFRACTING for node in all_nodes(material.node_tree)):
        return False

    def seen_by(flags: dict[str, float]) -> Material:
        shaders = _Shaders(material, "", version, Notices(), images)
        shaders.nodes.ray_flags = flags
        return shaders.output()

    others = ("Is Diffuse Ray", "Is Glossy Ray", "Is Singular Ray", "Is Reflection Ray", "Is Transmission Ray")
    cases = ({SHADOW_RAY: 1.0, "Is Camera Ray": 0.0, **dict.fromkeys(others, part)} for part in (0.0, 1.0))
    return seen_by({SHADOW_RAY: 0.0}) != Null() and all(seen_by(flags) == Null() for flags in cases)


def export_volume(
    material: bpy.types.Material | None,
    grids: dict[str, Grid],
    where: str,
    version: tuple[int, ...],
    notices: Notices,
    images: Images,
) -> Medium | None:
    """What a volume object of these grids is filled with."""
    if material is None or not material.use_nodes or material.node_tree is None:
        return None
    return _Shaders(material, where, version, notices, images).volume(grids)


def viewport_surface(material: bpy.types.Material) -> Surface:
    """The material without nodes: as in Cycles, its viewport colour alone."""
    return Lambert(_clipped(_rgb(material.diffuse_color)))


def _rgb(color: Any) -> Rgb:
    return (float(color[0]), float(color[1]), float(color[2]))


def _clipped(color: Rgb) -> Rgb:
    return (min(max(color[0], 0.0), 1.0), min(max(color[1], 0.0), 1.0), min(max(color[2], 0.0), 1.0))


@dataclass(frozen=True)
class Aov:
    """A shader AOV of a view layer."""

    name: str
    is_color: bool  # else a number


def _aov_nodes(tree: Any, groups: tuple[Any, ...]) -> Iterator[tuple[Any, tuple[Any, ...]]]:
    """The AOV outputs of a tree and of the groups in it, and the groups that each stands in."""
    for node in tree.nodes:
        if node.bl_idname == "ShaderNodeOutputAOV" and not node.mute:
            yield node, groups
        elif node.bl_idname == "ShaderNodeGroup" and node.node_tree is not None and not node.mute:
            yield from _aov_nodes(node.node_tree, (*groups, node))


def has_aovs(tree: bpy.types.NodeTree) -> bool:
    return any(True for _ in _aov_nodes(tree, ()))


class _Shaders:
    """The shader nodes of one material."""

    def __init__(
        self,
        material: bpy.types.Material,
        where: str,
        version: tuple[int, ...],
        notices: Notices,
        images: Images | None = None,
    ) -> None:
        self.nodes = Nodes(material, where, notices, images)
        self.nodes.material_index = material.pass_index
        self.material = material
        self.normal: Op | None = None  # of the surface, where it is not the mesh's
        self.viewport_color = _rgb(material.diffuse_color)
        self.where = where
        self.version = version
        self.notices = notices

    def output(self) -> Material:
        surface = self.nodes.surface_of_output()
        if surface is None:
            self.notices.add(self.where, "has no output node; it is black, as in Cycles")
            return Lambert(BLACK)
        self.nodes.bumped_normal = self.normal = bump_of_displacement(self.nodes, self.material)
        if self.nodes.source(surface) is None:
            volume = self.nodes.surface_of_output("Volume")
            if volume is not None and self.nodes.source(volume) is not None:
                return Null()
            self.notices.add(self.where, "has no surface shader; it is black, as in Cycles")
            return Lambert(BLACK)
        return self.shader(surface)

    def aovs(self, asked: tuple[Aov, ...]) -> tuple[tuple[int, Op], ...]:
        """What the tree's AOV outputs give, by the engine's numbers."""
        found: dict[int, Op] = {}
        for node, groups in _aov_nodes(self.nodes.tree, ()):
            name = getattr(node, "aov_name", "") or node.name
            for i, aov in enumerate(asked):
                if aov.name != name or i + 1 in found:
                    continue
                if aov.is_color:
                    value: Number | Triple = self.nodes.varying_color(node, groups, "Color")
                else:
                    value = self.nodes.varying_number(node, groups, "Value")
                shown = value if isinstance(value, tuple) else (value, 0.0, 0.0)
                found[i + 1] = value if isinstance(value, Op) else op("combine", *shown)
        return tuple(found.items())

    def normal_key(self) -> str:
        """How Cycles softens the terminator of bumps: not of those by displacement."""
        settings = getattr(self.material, "cycles", None)
        if self.normal is self.nodes.bumped_normal or not getattr(settings, "use_bump_map_correction", True):
            return "normal"
        return "bumped_normal" if self.version >= BUMPS_AS_FACETS_FROM else "bumped_normal_cubic"

    def volume(self, grids: dict[str, Grid] | None = None) -> Medium | None:
        """grids: of a volume object, which is filled with it by them."""
        nodes = Nodes(self.material, self.where, self.notices, self.nodes.images)
        nodes.material_index = self.nodes.material_index
        nodes.constants_only = self.nodes.constants_only
        nodes.in_volume = True
        item = nodes.surface_of_output("Volume")
        if grids is None:
            return None if item is None else volume_medium(nodes, item)
        nodes.grids = grids
        scale = op("separate", attribute(nodes, VOLUME_DENSITY), modes=("x",))
        return None if item is None else volume_medium(nodes, item, scale)

    def shader(self, item: Input) -> Material:
        source = self.nodes.source(item)
        if source is None or source.node is None:
            return Light(BLACK)  # an empty socket adds no light and takes all of it
        if source.output.type != "SHADER":
            return self.light(
                triple(self.nodes.value(item)), source
            )  # a value where a shader should be shines, as in Cycles
        translate = _SHADERS.get(source.node.bl_idname)
        if translate is None:
            return self._unknown(source)
        self._bend_normal(source)
        self._note_left_out(source)
        return translate(self, source)

    def _bend_normal(self, source: Source) -> None:
        """A surface has one normal: that of the first of its shaders that has one of its own."""
        socket = source.node.inputs.get("Normal")
        if socket is None or self.nodes.is_free(source, socket):
            return
        if self.nodes.constants_only:
            self.nodes.notice(source.node, "bump and normal maps are left out; the surface is smooth")
            return
        normal = triple(self.nodes.socket_value(source, socket))
        if isinstance(normal, Op) and normal.name == "geometry" and normal.modes[0] == "normal":
            return  # the surface's own
        if self.normal is self.nodes.bumped_normal:
            self.normal = normal if isinstance(normal, Op) else op("combine", *normal)
        elif normal is not self.normal:
            self.nodes.notice(source.node, "shaders of one material cannot have several normals; the first is used")

    def _note_left_out(self, source: Source) -> None:
        """Inputs of later Blenders that no shader here knows."""
        for name, words in LEFT_OUT.items():
            socket = source.node.inputs.get(name)
            if socket is None or (name == "Anisotropy" and source.node.bl_idname != "ShaderNodeBsdfGlass"):
                continue
            if not self.nodes.is_free(source, socket) or socket.default_value:
                self.nodes.notice(source.node, words)

    def _unknown(self, source: Source) -> Material:
        node = source.node
        color: Triple = _clipped(self.viewport_color)
        words = "the material's viewport colour"
        if node.inputs.get("Color") is not None:
            color, words = self.albedo(source), "a diffuse surface of its colour"
        shown = "" if isinstance(color, Op) else f" ({', '.join(f'{v:.3g}' for v in color)})"
        self.nodes.notice(node, f"shader {node.bl_label} is not supported; {words}{shown} is used in its place")
        return Lambert(color)

    # ---- Inputs ----

    def color(self, source: Source, *names: str) -> Rgb:
        """A constant."""
        return self.nodes.color(source.node, source.groups, names, self.viewport_color)

    def varying(self, source: Source, *names: str) -> Triple:
        return self.nodes.varying_color(source.node, source.groups, *names)

    def albedo(self, source: Source, *names: str) -> Triple:
        color = self.varying(source, *(names or ("Color",)))
        most = interval(color)[1]
        if 1.0 < most < inf:
            may = "may reflect" if isinstance(color, Op) else "reflects"
            self.nodes.notice(
                source.node,
                f"{may} more light than it receives ({most:.3g}), so that it grows with every bounce; cut to 1",
            )
        return clamped_color(color) if isinstance(color, tuple) else color

    def number(self, source: Source, *names: str, default: float = 0.0) -> float:
        """A constant."""
        return self.nodes.number(source.node, source.groups, *names, default=default)

    def varying_number(self, source: Source, *names: str, default: float = 0.0) -> Number:
        return self.nodes.varying_number(source.node, source.groups, *names, default=default)

    # ---- Shaders ----

    def emission(self, source: Source) -> Material:
        return self.light(scaled(self.varying(source, "Color"), self.varying_number(source, "Strength")), source)

    def light(self, radiance: Triple, source: Source) -> Material:
        if isinstance(radiance, Op):
            return Light(radiance)
        if min(radiance) < 0.0:
            self.nodes.notice(source.node, "negative light is not supported; it is cut to 0")
        return Light((max(radiance[0], 0.0), max(radiance[1], 0.0), max(radiance[2], 0.0)))

    def diffuse(self, source: Source) -> Material:
        return self.rough_diffuse(self.albedo(source), self.number(source, "Roughness"))

    def rough_diffuse(self, albedo: Triple, roughness: float) -> Lambert:
        roughness = min(max(roughness, 0.0), 1.0)
        if roughness == 0.0:
            return Lambert(albedo)
        return Lambert(
            albedo, roughness=roughness, facets="tinted" if self.version >= MULTIPLE_SCATTERING_FROM else "single"
        )

    def glossy(self, source: Source) -> Material:
        color, alpha = self.albedo(source), self._alpha(source)
        if isinstance(alpha, float) and alpha < MIRROR_ALPHA:
            return Mirror(color)
        # Cycles' Glossy has no Fresnel: its colour is the reflectance at every angle.
        metal = Conductor(alpha=alpha, f0=color, f90=color, masking=self.masking, facets=self.facets(source))
        return self.brushed(source, metal)

    def metallic(self, source: Source) -> Material:
        alpha = self._alpha(source)
        if source.node.fresnel_type == "PHYSICAL_CONDUCTOR":
            eta, k = self.color(source, "IOR"), self.color(source, "Extinction")
            index = (max(eta[0], 1e-3), max(eta[1], 1e-3), max(eta[2], 1e-3))
            return self.brushed(source, Conductor(alpha=alpha, eta=index, k=k, facets=self.facets(source)))
        f0, f82 = self.albedo(source, "Base Color"), self.albedo(source, "Edge Tint")
        return self.brushed(source, Conductor(alpha=alpha, f0=f0, f82=f82, facets=self.facets(source)))

    def brushed(self, source: Source, metal: Conductor) -> Conductor:
        """With the node's anisotropy, whose sign says which way the facets lean further."""
        anisotropy = clamped(self.varying_number(source, "Anisotropy"), -0.99, 0.99)
        if isinstance(anisotropy, Op):
            below, above = math("add", 1.0, math("minimum", anisotropy, 0.0)), math("maximum", anisotropy, 0.0)
            aspect: Number = math("divide", below, math("subtract", 1.0, above))
        else:
            aspect = 1.0 + anisotropy if anisotropy < 0.0 else 1.0 / (1.0 - anisotropy)
        return self.along_tangent(source, metal, aspect, "Rotation")

    def along_tangent(self, source: Source, metal: Conductor, aspect: Number, rotation: str) -> Conductor:
        if aspect == 1.0:
            return metal
        if self.nodes.constants_only:
            self.nodes.notice(source.node, "anisotropy is left out; the reflection is round")
            return metal
        turns = self.varying_number(source, rotation)
        turns = math("fraction", turns) if isinstance(turns, Op) else turns % 1.0
        tangent = tangent_input(self.nodes, source)
        return replace(metal, aspect=aspect, rotation=turns, tangent=tangent)

    @property
    def masking(self) -> str:
        return "smith_separable" if self.version < SEPARABLE_MASKING_BEFORE else "smith"

    def facets(self, source: Source) -> str:
        """Beckmann's facets, which GGX stands for, lose less light than those of GGX that scatter once."""
        distribution = getattr(source.node, "distribution", "GGX")
        if source.node.bl_idname == "ShaderNodeBsdfRefraction":
            return "single"
        return "multiple" if distribution in ("MULTI_GGX", "BECKMANN") else "single"

    def _alpha(self, source: Source) -> Number:
        node = source.node
        if getattr(node, "distribution", "GGX") == "SHARP":
            return 0.0
        alpha = squared(clamped(self.varying_number(source, "Roughness")))
        if node.distribution in ("BECKMANN", "ASHIKHMIN_SHIRLEY") and (isinstance(alpha, Op) or alpha >= MIRROR_ALPHA):
            self.nodes.notice(node, f"the distribution {node.distribution.title()} is not supported; it is GGX")
        return alpha

    def glass(self, source: Source) -> Material:
        node = source.node
        color, alpha = self.albedo(source), self._alpha(source)
        is_rough = isinstance(alpha, Op) or alpha >= MIRROR_ALPHA
        if node.bl_idname == "ShaderNodeBsdfGlass" and is_rough and self.reflects_by_surface(source):
            return self.glass_by_surface(source, max(self.number(source, "IOR"), 1e-3), color, alpha, color, alpha)
        return Glass(
            max(self.number(source, "IOR"), 1e-3),
            0.0 if isinstance(alpha, float) and alpha < MIRROR_ALPHA else alpha,
            color,
            color,
            lobes="refraction" if node.bl_idname == "ShaderNodeBsdfRefraction" else "both",
            facets=self.facets(source),
        )

    def reflects_by_surface(self, source: Source) -> bool:
        """Whether the angle at the surface says how much of light rough glass reflects, not that at each facet."""
        if self.version >= FACETS_REFLECT_FROM:
            return False
        if source.node.distribution == "MULTI_GGX":
            self.nodes.notice(source.node, "light that facets of rough glass send on to each other is approximated")
            return False
        return True

    def glass_by_surface(
        self, source: Source, ior: float, reflected: Triple, alpha: Number, transmitted: Triple, alpha_beyond: Number
    ) -> Mix:
        if self.nodes.constants_only:
            self.nodes.notice(source.node, "its rough glass reflects as it is seen from the front, from everywhere")
            weight: Number = ((ior - 1.0) / (ior + 1.0)) ** 2
        else:
            weight = op("fresnel", ior, normal_input(self.nodes, source))
        gloss = Conductor(alpha, f0=reflected, f90=reflected, masking=self.masking)
        beyond = Glass(ior, alpha_beyond, transmission=transmitted, lobes="refraction", masking=self.masking)
        return Mix(weight, gloss, beyond)

    def transparent(self, source: Source) -> Material:
        transmittance = self.albedo(source)
        return Null() if transmittance == WHITE else Transparent(transmittance)

    def translucent(self, source: Source) -> Material:
        return Translucent(self.albedo(source))

    def sheen(self, source: Source) -> Material:
        model = "velvet" if getattr(source.node, "distribution", "MICROFIBER") == "ASHIKHMIN" else "fibers"
        return Sheen(self.albedo(source), clamped(self.varying_number(source, "Roughness")), model)

    def velvet(self, source: Source) -> Material:
        return Sheen(self.albedo(source), clamped(self.varying_number(source, "Sigma")), "velvet")

    def subsurface(self, source: Source) -> Material:
        method = self.subsurface_method(source, "falloff")
        radius = scaled(self.varying(source, "Radius"), self.varying_number(source, "Scale", default=1.0))
        return Subsurface(
            self.albedo(source),
            clamped_color(radius, 0.0, float("inf")),
            method.model,
            method.entry,
            self.varying_number(source, "IOR", default=1.4),
            clamped(self.varying_number(source, "Roughness", default=1.0)),
            self.subsurface_anisotropy(source, method, "Anisotropy"),
        )

    def subsurface_method(self, source: Source, setting: str) -> Method:
        method = subsurface_method(source.node, setting, self.version)
        if method.is_disk:
            self.nodes.notice(source.node, DISK)
        return method

    def subsurface_anisotropy(self, source: Source, method: Method, name: str) -> Number:
        return clamped(self.varying_number(source, name), most_backward(method), most_forward(method))

    def portal(self, source: Source) -> Material:
        """Where nothing is linked light goes on as if there were no surface."""
        if any(not self.nodes.is_free(source, source.node.inputs[name]) for name in ("Position", "Direction")):
            self.nodes.notice(source.node, "portals are not supported; light goes straight through")
        return self.transparent(source)

    def hair(self, source: Source) -> Material:
        color = self._hair_color(source)
        shown = ", ".join(f"{v:.3g}" for v in color)
        what = f"shader {source.node.bl_label} is not supported; a diffuse surface of its colour ({shown}) is used"
        self.nodes.notice(source.node, f"{what} in its place")
        return Lambert(_clipped(color))

    def _hair_color(self, source: Source) -> Rgb:
        kind = source.node.parametrization
        if kind == "COLOR":
            return self.color(source, "Color")
        if kind == "ABSORPTION":
            return hair_reflectance(self.color(source, "Absorption Coefficient"))
        redness = self.number(source, "Melanin Redness")
        melanin = -log(max(1.0 - self.number(source, "Melanin"), 1e-4))
        r, g, b = (melanin * (eu + (pheo - eu) * redness) for eu, pheo in zip(EUMELANIN, PHEOMELANIN, strict=True))
        own, tint = hair_reflectance((r, g, b)), self.color(source, "Tint")
        return (own[0] * tint[0], own[1] * tint[1], own[2] * tint[2])

    def principled(self, source: Source) -> Material:
        return principled(self, source)

    def holdout(self, source: Source) -> Material:
        return Holdout()

    def mix(self, source: Source) -> Material:
        inputs = source.node.inputs
        factor = self.varying_number(source, inputs[0].name)
        first, second = (Input(inputs[i], source.groups) for i in (1, 2))
        if isinstance(factor, float):
            if factor <= 0.0:
                return self.shader(first)
            if factor >= 1.0:
                return self.shader(second)
        return mix(factor, self.shader(first), self.shader(second))

    def add(self, source: Source) -> Material:
        first, second = (self.shader(Input(source.node.inputs[i], source.groups)) for i in (0, 1))
        return add(first, second)


_SHADERS: dict[str, Callable[[_Shaders, Source], Material]] = {
    "ShaderNodeEmission": _Shaders.emission,
    "ShaderNodeBackground": _Shaders.emission,
    "ShaderNodeBsdfDiffuse": _Shaders.diffuse,
    "ShaderNodeBsdfGlossy": _Shaders.glossy,
    "ShaderNodeBsdfAnisotropic": _Shaders.glossy,
    "ShaderNodeBsdfMetallic": _Shaders.metallic,
    "ShaderNodeBsdfGlass": _Shaders.glass,
    "ShaderNodeBsdfRefraction": _Shaders.glass,
    "ShaderNodeBsdfTransparent": _Shaders.transparent,
    "ShaderNodeBsdfTranslucent": _Shaders.translucent,
    "ShaderNodeBsdfRayPortal": _Shaders.portal,
    "ShaderNodeHoldout": _Shaders.holdout,
    "ShaderNodeBsdfHairPrincipled": _Shaders.hair,
    "ShaderNodeBsdfSheen": _Shaders.sheen,
    "ShaderNodeBsdfVelvet": _Shaders.velvet,
    "ShaderNodeSubsurfaceScattering": _Shaders.subsurface,
    "ShaderNodeBsdfPrincipled": _Shaders.principled,
    "ShaderNodeMixShader": _Shaders.mix,
    "ShaderNodeAddShader": _Shaders.add,
}
