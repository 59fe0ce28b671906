# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's side of a render: `update` reads the scene, `render` hands pixels over, `view_draw` shows a 3D view. None
does more than that.

Blender calls the first two once for every view layer, on one instance. An exception out of either crashes Blender
where no result was begun, so nothing escapes from here.
"""

from typing import Any

import bpy

from . import failure, jobs
from .film import passes
from .scene.problems import describe
from .viewport import redraw
from .viewport.view import RenderedView


class GlimmerRenderEngine(bpy.types.RenderEngine):
    bl_idname = "GLIMMER"
    bl_label = "Glimmer"
    bl_use_preview = True
    bl_use_postprocess = True
    bl_use_shading_nodes_custom = False  # Cycles' nodes are ours, and stay editable
    bl_use_eevee_viewport = True

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self._job: jobs.Job | None = None
        self._failure = ""
        self._view: RenderedView | None = None

    def update(self, data: bpy.types.BlendData, depsgraph: bpy.types.Depsgraph) -> None:
        """Reads everything: only here is the scene safe from the user's hands."""
        self._job, self._failure = None, ""
        try:
            self._job = jobs.prepare(self, depsgraph)
        except Exception as error:  # noqa: BLE001 - see above
            self._failure = describe(error)

    def render(self, depsgraph: bpy.types.Depsgraph) -> None:
        if self._job is not None:
            try:
                self._job.run(self)
            except Exception as error:  # noqa: BLE001 - see above
                self._failure = describe(error)
            self._job = None
        if self._failure:
            jobs.begin_and_end_result(self)
            failure.fail(self, self._failure)

    def view_update(self, context: bpy.types.Context, depsgraph: bpy.types.Depsgraph) -> None:
        if self._view is not None:
            self._view.scene_changed(depsgraph)

    def view_draw(self, context: bpy.types.Context, depsgraph: bpy.types.Depsgraph) -> None:
        if self._view is None:
            self._view = RenderedView(jobs.BULK_READERS)
        redraw.watch(self, self._view)
        self._view.draw(self, context, depsgraph)

    def update_render_passes(
        self, scene: bpy.types.Scene | None = None, renderlayer: bpy.types.ViewLayer | None = None
    ) -> None:
        is_denoised = scene is not None and scene.glimmer.use_denoising
        for item in passes.enabled(renderlayer, is_denoised):
            name = item.name(bpy.app.version)
            self.register_pass(scene, renderlayer, name, len(item.channels), item.channels, item.kind)


def register() -> None:
    bpy.utils.register_class(GlimmerRenderEngine)


def unregister() -> None:
    bpy.utils.unregister_class(GlimmerRenderEngine)
