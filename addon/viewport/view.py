# SPDX-License-Identifier: GPL-3.0-or-later
"""One 3D view in rendered shading: reads the scene when it changed, the view when it was turned, and draws."""

from __future__ import annotations

import time
from dataclasses import replace
from typing import Any

import bpy
import numpy as np

from ..export.camera import export_view
from ..export.film import export_view_settings, film_exposure, filter_settings
from ..export.instance import BulkReader
from ..export.scene import View, export_scene
from ..film.display import status
from ..scene.description import Film, SceneDescription
from ..scene.fingerprint import fingerprint
from ..scene.problems import Notices, describe
from . import draw
from .session import Frame, Session

# Reading the scene happens on the thread that draws the window: it gets no more than this share of it.
MAX_READ_SHARE = 0.5


class RenderedView:
    def __init__(self, readers: tuple[BulkReader, ...]) -> None:
        self._readers = readers
        self.session: Session | None = None
        self.drawn: Frame | None = None
        self._picture = draw.Picture()
        self._is_dirty = True
        self._read_again_at = 0.0
        self._seen: tuple[Any, ...] = ()  # the view that the last description was made for
        self._shown: SceneDescription | None = None
        self._shown_digest = b""
        self._failure = ""

    def close(self) -> None:
        if self.session is not None:
            self.session.close()
            self.session = None
        self._is_dirty, self._shown, self._shown_digest = True, None, b""

    def scene_changed(self) -> None:
        self._is_dirty = True

    def wants_draw(self) -> bool:
        if self._is_dirty:
            return time.monotonic() >= self._read_again_at
        return self.session is not None and self.session.has_news()

    def draw(self, engine: bpy.types.RenderEngine, context: bpy.types.Context, depsgraph: bpy.types.Depsgraph) -> None:
        try:
            self._follow(context, depsgraph)
        except Exception as error:  # noqa: BLE001 - Blender would print the same at every redraw
            self._fail(describe(error))
        self._draw(engine, context, depsgraph)

    # ---- Reading ----

    def _follow(self, context: bpy.types.Context, depsgraph: bpy.types.Depsgraph) -> None:
        seen = _view_state(context, depsgraph.scene_eval)
        if self._is_dirty and time.monotonic() >= self._read_again_at:
            start = time.monotonic()
            self._is_dirty, self._seen = False, seen
            try:
                self._show(self._read(context, depsgraph))
            finally:
                end = time.monotonic()
                self._read_again_at = end + (end - start) * (1.0 / MAX_READ_SHARE - 1.0)
        elif seen != self._seen:
            self._seen = seen
            if self._shown is None:
                self._is_dirty = True  # what was wrong may have been the view
            else:
                view = self._view(context, depsgraph, depsgraph.scene_eval, Notices())
                self._show(replace(self._shown, film=view.film, camera=view.camera, settings=view.settings))

    def _show(self, scene: SceneDescription) -> None:
        digest = fingerprint(scene)
        self._failure = ""
        if digest == self._shown_digest:
            return  # Blender tells of many a change that none can see, a selection for one
        if self.session is None:
            self.session = Session()
        self._shown, self._shown_digest = scene, digest
        self.session.show(scene)

    def _fail(self, message: str) -> None:
        self._failure = message
        self._shown, self._shown_digest = None, b""
        if self.session is not None:
            self.session.show(None)

    def _read(self, context: bpy.types.Context, depsgraph: bpy.types.Depsgraph) -> SceneDescription:
        space = context.space_data
        in_local_view = space.local_view is not None

        def is_shown(item: bpy.types.Object) -> bool:
            return not in_local_view or item.original.local_view_get(space)

        return export_scene(
            depsgraph,
            lambda scene, notices: self._view(context, depsgraph, scene, notices),
            bpy.app.version,
            self._readers,
            is_shown,
        ).scene

    def _view(
        self,
        context: bpy.types.Context,
        depsgraph: bpy.types.Depsgraph,
        scene: bpy.types.Scene,
        notices: Notices,
    ) -> View:
        space, region = context.space_data, context.region
        size = (max(region.width, 1), max(region.height, 1))
        camera = space.camera if space.use_local_camera else scene.camera
        return View(
            Film(*size, exposure=film_exposure(scene), **filter_settings(scene.glimmer)),
            export_view(
                space, context.region_data, None if camera is None else camera.evaluated_get(depsgraph), notices
            ),
            export_view_settings(scene),
        )

    # ---- Drawing ----

    def _draw(self, engine: bpy.types.RenderEngine, context: bpy.types.Context, depsgraph: bpy.types.Depsgraph) -> None:
        session = self.session
        failure = self._failure or (session.failure() if session is not None else "")
        if failure or session is None:
            self.drawn = None
            engine.update_stats("Glimmer", "No picture")
            draw.message(f"Glimmer: {failure}")
            return
        frame = session.frame() if self.drawn is None or session.has_news() else None
        if frame is not None:
            self.drawn = frame
            self._picture.set(frame.pixels)
            line = status(frame.progress, depsgraph.scene_eval.glimmer.viewport_samples)
            engine.update_stats("Glimmer", line if frame.scale == 1 else "Coarse")
        elif self.drawn is None:
            engine.update_stats("Glimmer", "Building")
            return
        self._picture.draw(engine, depsgraph.scene_eval, (context.region.width, context.region.height))


def _view_state(context: bpy.types.Context, scene: bpy.types.Scene) -> tuple[Any, ...]:
    """What a picture of a view depends on that Blender announces by a redraw alone."""
    region_view, space = context.region_data, context.space_data
    matrices = [
        np.array(matrix, np.float64).tobytes() for matrix in (region_view.view_matrix, region_view.window_matrix)
    ]
    return (
        *matrices,
        export_view_settings(scene),
        scene.glimmer.filter,
        scene.glimmer.filter_width,
        film_exposure(scene),
        context.region.width,
        context.region.height,
        region_view.view_perspective,
        space.clip_start,
        space.clip_end,
        space.use_local_camera,
        space.local_view is not None,
    )
