# SPDX-License-Identifier: GPL-3.0-or-later
"""One 3D view in rendered shading: reads the scene when it changed, the view when it was turned, and draws."""

from __future__ import annotations

import time
from dataclasses import replace
from typing import Any

import bpy
import numpy as np

from ..export.camera import export_view
from ..export.film import export_view_settings, film_exposure, filter_settings, full_shape, transparency
from ..export.instance import BulkReader
from ..export.kept import Kept
from ..export.scene import View, export_scene
from ..film.display import status
from ..reports import count_of
from ..scene.description import Film, SceneDescription
from ..scene.fingerprint import Fingerprints
from ..scene.problems import Notices, describe
from . import draw
from .border import border_crop, camera_frame
from .session import Frame, Session

# Reading the scene happens on the thread that draws the window: it gets no more than this share of it.
MAX_READ_SHARE = 0.5
SOURCES = 3  # items of a view's state that say what is seen, and not how


class RenderedView:
    def __init__(self, readers: tuple[BulkReader, ...]) -> None:
        self._readers = readers
        self.session: Session | None = None
        self.drawn: Frame | None = None
        self._picture = draw.Picture()
        self._is_dirty = True
        self._read_again_at = 0.0
        self.kept = Kept()
        self._fingerprints = Fingerprints()
        self._seen: tuple[Any, ...] = ()  # the view that the last description was made for
        self._shown: SceneDescription | None = None
        self._shown_digest = b""
        self._failure = ""
        self._differences = 0  # how many there were when the scene was last read
        self._is_held = False

    def close(self) -> None:
        if self.session is not None:
            self.session.close()
            self.session = None
        self._is_dirty, self._shown, self._shown_digest = True, None, b""
        self.kept.clear()

    def scene_changed(self, depsgraph: bpy.types.Depsgraph) -> None:
        self._is_dirty = True
        self.kept.follow(depsgraph.updates)

    def forget(self) -> None:
        """Whatever was read may be another now: undo puts data in the place of other data."""
        self._is_dirty = True
        self.kept.clear()

    def pause(self, is_rendering: bool) -> None:
        """For a final render, which gets the whole machine; or as the artist has asked for."""
        if self.session is not None:
            self.session.pause(is_rendering, self._is_held)

    def wants_draw(self) -> bool:
        if self._is_dirty:
            return time.monotonic() >= self._read_again_at
        return self.session is not None and (self.session.has_news() or not self._picture.is_complete)

    def draw(self, engine: bpy.types.RenderEngine, context: bpy.types.Context, depsgraph: bpy.types.Depsgraph) -> None:
        try:
            self._follow(context, depsgraph)
        except Exception as error:  # noqa: BLE001 - Blender would print the same at every redraw
            self._fail(describe(error))
        self._draw(engine, context, depsgraph)

    # ---- Reading ----

    def _follow(self, context: bpy.types.Context, depsgraph: bpy.types.Depsgraph) -> None:
        scene = depsgraph.scene_eval
        seen = _view_state(context, depsgraph, scene)
        self._is_held = scene.glimmer.preview_pause
        if self._seen[:SOURCES] != seen[:SOURCES]:
            self.forget()
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
                view = self._view(context, depsgraph, scene, Notices())
                self._show(replace(self._shown, film=view.film, camera=view.camera, settings=view.settings))
        if self.session is not None:
            self.session.denoise_from(scene.glimmer.viewport_denoising_start)

    def _show(self, scene: SceneDescription) -> None:
        digest = self._fingerprints.of(scene)
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

        exported = export_scene(
            depsgraph,
            lambda scene, notices: self._view(context, depsgraph, scene, notices),
            bpy.app.version,
            self._readers,
            is_shown,
            kept=self.kept,
        )
        self._differences = len(exported.notices)
        return exported.scene

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
        evaluated = None if camera is None else camera.evaluated_get(depsgraph)
        crop = border_crop(_border(context, scene, evaluated), size)
        return View(
            Film(
                width=size[0],
                height=size[1],
                crop=crop,
                exposure=film_exposure(scene),
                **filter_settings(scene.glimmer),
                **transparency(scene),
            ),
            export_view(space, context.region_data, evaluated, notices, *_picture(context, scene, evaluated)),
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
            self._picture.set(frame)
        elif self.drawn is None:
            engine.update_stats("Glimmer", "Building")
            return
        engine.update_stats("Glimmer", self._status(self.drawn, depsgraph.scene_eval))
        self._picture.draw(engine, depsgraph.scene_eval, (context.region.width, context.region.height))

    def _status(self, frame: Frame, scene: bpy.types.Scene) -> str:
        parts = ["Paused"] if self._is_held else []
        if frame.scale > 1:
            parts.append("Coarse picture")
        elif not frame.is_whole:
            parts.append("Refining the coarse picture")
        else:
            parts.append(status(frame.progress, scene.glimmer.viewport_samples))
        if frame.is_denoised:
            parts.append("Denoised, which is a bias")
        elif problem := (self.session.denoising_problem() if self.session is not None else ""):
            parts.append(f"Not denoised: {problem}")
        if self._differences:
            parts.append(f"{count_of(self._differences)}: see Render properties > Differs from Cycles")
        return " | ".join(parts)


def _border(
    context: bpy.types.Context, scene: bpy.types.Scene, camera: bpy.types.Object | None
) -> tuple[float, float, float, float] | None:
    """What of the region is rendered: min_x, min_y, max_x, max_y from the bottom left in shares of it. None: all."""
    space, region_view, render = context.space_data, context.region_data, scene.render
    if region_view.view_perspective != "CAMERA" or camera is None or camera.type != "CAMERA":
        if not space.use_render_border:
            return None
        return (
            space.render_border_min_x,
            space.render_border_min_y,
            space.render_border_max_x,
            space.render_border_max_y,
        )
    if not render.use_border:
        return None
    x0, y0, x1, y1 = _frame(region_view, scene, camera)
    return (
        x0 + (x1 - x0) * render.border_min_x,
        y0 + (y1 - y0) * render.border_min_y,
        x0 + (x1 - x0) * render.border_max_x,
        y0 + (y1 - y0) * render.border_max_y,
    )


def _frame(
    region_view: bpy.types.RegionView3D, scene: bpy.types.Scene, camera: bpy.types.Object
) -> tuple[float, float, float, float]:
    """Where a camera's picture is: min_x, min_y, max_x, max_y from the bottom left in shares of the region."""
    to_clip = region_view.perspective_matrix @ camera.matrix_world.normalized()
    clipped = [to_clip @ corner.to_4d() for corner in camera.data.view_frame(scene=scene)]
    return camera_frame([(point.x / point.w, point.y / point.w) for point in clipped])


def _picture(
    context: bpy.types.Context, scene: bpy.types.Scene, camera: bpy.types.Object | None
) -> tuple[tuple[float, float, float, float], tuple[float, float]]:
    """Where the picture of the camera that a view looks through is, and its shape (see full_shape)."""
    shape = full_shape(scene.render)
    if context.region_data.view_perspective != "CAMERA" or camera is None or camera.type != "CAMERA":
        return (0.0, 0.0, 1.0, 1.0), shape
    return _frame(context.region_data, scene, camera), shape


def _view_state(context: bpy.types.Context, depsgraph: bpy.types.Depsgraph, scene: bpy.types.Scene) -> tuple[Any, ...]:
    """What a picture of a view depends on that Blender announces by a redraw alone; what it is a picture of comes
    first."""
    region_view, space = context.region_data, context.space_data
    matrices = [
        np.array(matrix, np.float64).tobytes() for matrix in (region_view.view_matrix, region_view.window_matrix)
    ]
    camera = space.camera if space.use_local_camera else scene.camera
    return (
        scene.name_full,
        depsgraph.view_layer_eval.name,
        space.local_view is not None,
        *matrices,
        export_view_settings(scene),
        scene.glimmer.filter,
        scene.glimmer.filter_width,
        film_exposure(scene),
        tuple(transparency(scene).values()),
        context.region.width,
        context.region.height,
        region_view.view_perspective,
        space.clip_start,
        space.clip_end,
        space.use_local_camera,
        _border(context, scene, None if camera is None else camera.evaluated_get(depsgraph)),
    )
