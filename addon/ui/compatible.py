# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's own panels that say something to Glimmer, shown when it is the engine."""

from collections.abc import Iterator

import bpy

ENGINE = "GLIMMER"

# Panels of Blender's common set that would lie: nothing here reads them.
HIDDEN = {
    "DATA_PT_area",
    "DATA_PT_camera_stereoscopy",
    "DATA_PT_distance",
    "DATA_PT_falloff_curve",
    "DATA_PT_light",
    "DATA_PT_spot",
    "RENDER_PT_freestyle",
    "RENDER_PT_simplify",
    "RENDER_PT_simplify_greasepencil",
    "RENDER_PT_simplify_render",
    "RENDER_PT_simplify_viewport",
    "RENDER_PT_grease_pencil_render",
    "RENDER_PT_gpencil",
    "RENDER_PT_stereoscopy",
    "RENDER_PT_output_views",
    "VIEWLAYER_PT_filter",
    "VIEWLAYER_PT_layer_passes",
}

# Panels that Blender files under one engine of its own and that apply to every engine.
BORROWED = {
    "EEVEE_MATERIAL_PT_context_material",
    "EEVEE_MATERIAL_PT_viewport_settings",
    "MATERIAL_PT_preview",
    "MATERIAL_PT_viewport",
}


def _panels() -> Iterator[type[bpy.types.Panel]]:
    for panel in bpy.types.Panel.__subclasses__():
        name = panel.__name__
        engines = getattr(panel, "COMPAT_ENGINES", None)
        # The node editor's twin of a panel (NODE_...) shares its set of engines.
        if not isinstance(engines, set) or name.removeprefix("NODE_") in HIDDEN or "freestyle" in name:
            continue
        if name in BORROWED or "BLENDER_RENDER" in engines:
            yield panel


def register() -> None:
    for panel in _panels():
        panel.COMPAT_ENGINES.add(ENGINE)


def unregister() -> None:
    for panel in _panels():
        panel.COMPAT_ENGINES.discard(ENGINE)
