# SPDX-License-Identifier: GPL-3.0-or-later
"""What passes know objects by: the names of Cryptomatte, and light groups."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

from ..film.passes import light_groups
from ..scene.description import Lamp, Matte, SceneDescription

if TYPE_CHECKING:
    import bpy

MATTES = {"object_matte", "material_matte"}


def with_groups(scene: SceneDescription, depsgraph: bpy.types.Depsgraph) -> SceneDescription:
    """What a scene's passes ask for: where they ask for nothing, the very same scene."""
    if MATTES.intersection(scene.settings.passes):
        scene = _with_mattes(scene, _originals(depsgraph))
    names = light_groups(depsgraph.view_layer_eval)
    return _with_light_groups(scene, depsgraph, names) if names else scene


def _originals(depsgraph: bpy.types.Depsgraph) -> dict[str, bpy.types.Object]:
    """By name, all objects that are shown, instances' among them."""
    found: dict[str, bpy.types.Object] = {}
    for instance in depsgraph.object_instances:
        found.setdefault(instance.object.name, instance.object.original)
    return found


def _with_mattes(scene: SceneDescription, originals: Mapping[str, bpy.types.Object]) -> SceneDescription:
    mattes: dict[str, int] = {}

    def number(name: str) -> int:
        return mattes.setdefault(name, len(mattes) + 1)

    objects = tuple(replace(item, matte=number(item.name)) for item in scene.objects)
    spheres = tuple(replace(item, matte=number(item.name)) for item in scene.spheres)
    assets = tuple(Matte(name, asset_name(name, originals.get(name))) for name in mattes)
    return replace(scene, objects=objects, spheres=spheres, mattes=assets)


def asset_name(name: str, item: bpy.types.Object | None) -> str:
    """As in Cycles, of the object at the root of its parents."""
    while item is not None and item.parent is not None:
        item = item.parent
    return name if item is None else item.name


def _with_light_groups(scene: SceneDescription, depsgraph: bpy.types.Depsgraph, names: list[str]) -> SceneDescription:
    numbers = {name: i + 1 for i, name in enumerate(names)}
    originals = _originals(depsgraph)

    def group(name: str) -> int:
        item = originals.get(name)
        return 0 if item is None else numbers.get(item.lightgroup, 0)

    world = depsgraph.scene_eval.world
    return replace(
        scene,
        objects=tuple(replace(item, light_group=group(item.name)) for item in scene.objects),
        spheres=tuple(replace(item, light_group=group(item.name)) for item in scene.spheres),
        lights=tuple(_lamp_in_group(lamp, group(lamp.name)) for lamp in scene.lights),
        environment=replace(
            scene.environment, light_group=0 if world is None else numbers.get(world.original.lightgroup, 0)
        ),
    )


def _lamp_in_group(lamp: Lamp, group: int) -> Lamp:
    return replace(lamp, flags=replace(lamp.flags, light_group=group)) if group else lamp
