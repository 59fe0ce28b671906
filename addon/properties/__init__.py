# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings that Glimmer adds to Blender's datablocks, as `glimmer` groups."""

import bpy

from . import object, scene, view_layer

_GROUPS = (
    (bpy.types.Scene, scene.GlimmerSceneSettings),
    (bpy.types.ViewLayer, view_layer.GlimmerViewLayerSettings),
    (bpy.types.Object, object.GlimmerObjectSettings),
)


def register() -> None:
    for owner, group in _GROUPS:
        bpy.utils.register_class(group)
        owner.glimmer = bpy.props.PointerProperty(name="Glimmer", type=group)


def unregister() -> None:
    for owner, group in reversed(_GROUPS):
        del owner.glimmer
        bpy.utils.unregister_class(group)
