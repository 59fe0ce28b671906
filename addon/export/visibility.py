# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's Ray Visibility, holdout and indirect only -> which rays meet an object, a lamp or the world."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..scene.description import EVERY_RAY, Rays
from ..scene.problems import Notices, place

if TYPE_CHECKING:
    import bpy

OF_OBJECT = {
    "visible_camera": Rays.CAMERA,
    "visible_diffuse": Rays.DIFFUSE,
    "visible_glossy": Rays.GLOSSY,
    "visible_transmission": Rays.TRANSMISSION,
    "visible_volume_scatter": Rays.VOLUME,
    "visible_shadow": Rays.SHADOW,
}
OF_WORLD = {
    "camera": Rays.CAMERA,
    "diffuse": Rays.DIFFUSE,
    "glossy": Rays.GLOSSY,
    "transmission": Rays.TRANSMISSION,
    "scatter": Rays.VOLUME,
}


@dataclass(frozen=True)
class Visibility:
    rays: Rays = EVERY_RAY
    is_holdout: bool = False


SEEN = Visibility()


def rays_of(item: bpy.types.Object) -> Rays:
    """Of an object's own settings."""
    rays = EVERY_RAY
    for name, ray in OF_OBJECT.items():
        if not getattr(item, name):
            rays &= ~ray
    return rays


def visibility(
    item: bpy.types.Object, instancer: bpy.types.Object | None, view_layer: bpy.types.ViewLayer
) -> Visibility:
    """Of an evaluated object, by itself or as an instance of another. As in Cycles, what sees both sees an instance,
    and its instancer says whether it is a holdout or indirect only."""
    rays = rays_of(item)
    if instancer is not None:
        rays &= rays_of(instancer)
    shown = (item if instancer is None else instancer).original
    is_holdout = shown.holdout_get(view_layer=view_layer)
    if not is_holdout and shown.indirect_only_get(view_layer=view_layer):
        rays &= ~Rays.CAMERA
    return Visibility(rays, is_holdout)


def _terminator(item: bpy.types.Object, names: tuple[str, str], usual: float) -> float:
    """A setting of Blender's own, before that one of Cycles', which is not there where that is switched off."""
    settings = item if hasattr(item, names[0]) else getattr(item, "cycles", None)
    return float(getattr(settings, names[0], getattr(settings, names[1], usual)))


def shadow_terminator(item: bpy.types.Object) -> float:
    """The cosine below which lamps see a smooth surface as curved."""
    names = ("shadow_terminator_geometry_offset", "shadow_terminator_geometry_offset")
    return min(max(_terminator(item, names, 0.1), 0.0), 1.0)


def world_rays(world: bpy.types.World | None) -> Rays:
    """The settings are Cycles' own, and not there where it is switched off."""
    settings = getattr(world, "cycles_visibility", None)
    rays = EVERY_RAY
    for name, ray in OF_WORLD.items():
        if settings is not None and not getattr(settings, name):
            rays &= ~ray
    return rays


def _is_culled(item: bpy.types.Object, scene: bpy.types.Scene) -> bool:
    """Whether Cycles may leave an object out by what is in sight: settings of its own, beneath Simplify."""
    settings, own = getattr(scene, "cycles", None), getattr(item, "cycles", None)
    if settings is None or own is None or not scene.render.use_simplify:
        return False
    return any(getattr(settings, name) and getattr(own, name) for name in ("use_camera_cull", "use_distance_cull"))


def _is_diced(item: bpy.types.Object, scene: bpy.types.Scene) -> bool:
    """Whether Cycles subdivides a mesh as finely as pixels are: a switch of its last modifier, in Blender before 5.0 of
    the object, and there among what is experimental."""
    modifiers = [modifier for modifier in getattr(item, "modifiers", ()) if modifier.show_render]
    if not modifiers or modifiers[-1].type != "SUBSURF":
        return False
    if hasattr(modifiers[-1], "use_adaptive_subdivision"):
        return bool(modifiers[-1].use_adaptive_subdivision)
    own, settings = getattr(item, "cycles", None), getattr(scene, "cycles", None)
    if own is None or settings is None:
        return False
    return bool(own.use_adaptive_subdivision) and settings.feature_set == "EXPERIMENTAL"


def note_differences(item: bpy.types.Object, scene: bpy.types.Scene, notices: Notices) -> None:
    """What an object asks for that is not rendered."""
    where = place(item.name)
    if _is_culled(item, scene):
        notices.add(where, "culling by the camera or by distance is not supported; it is there in any case")
    if item.type != "LIGHT" and item.is_shadow_catcher:
        notices.add(where, "a shadow catcher is not supported; it is rendered as an ordinary object")
    if item.type != "LIGHT" and _terminator(
        item, ("shadow_terminator_shading_offset", "shadow_terminator_offset"), 0.0
    ):
        notices.add(where, "the shading offset of the shadow terminator is not supported; it is 0")
    if _is_diced(item, scene):
        notices.add(where, "adaptive subdivision is not done; it has the levels that its modifier has for renders")
    linking = getattr(item, "light_linking", None)
    if linking is None:
        return
    if linking.receiver_collection is not None:
        notices.add(where, "light linking is not supported; its light falls on all objects")
    if linking.blocker_collection is not None:
        notices.add(where, "shadow linking is not supported; all objects cast shadows in its light")
