# SPDX-License-Identifier: GPL-3.0-or-later
"""One view layer's way from the depsgraph to the render result."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

import bpy

from . import reports
from .cluster.render import ClusterRender
from .cluster.settings import Cluster, cluster_of, note_differences
from .export.camera import export_camera
from .export.film import export_film, export_settings, full_shape, layer_samples, note_missing_passes
from .export.instance import BulkReader
from .export.scene import Exported, View, export_scene
from .export.stereo import active_views, eye_of
from .film import passes
from .film.coarse import first_look
from .film.display import Display
from .hexfield.export import export_instances
from .native.render import NativeRender, open_render
from .scene.description import SceneDescription
from .scene.problems import Notices
from .scene.writer import write_scene

BULK_READERS: tuple[BulkReader, ...] = (export_instances,)


class Job(Protocol):
    def run(self, engine: bpy.types.RenderEngine) -> None: ...


@dataclass(frozen=True)
class RenderJob:
    views: tuple[tuple[str, Exported], ...]  # by name; of no name where there is but one
    passes: tuple[passes.RenderPass, ...]
    layer: str
    cluster: Cluster | None = None  # None: this machine renders

    def run(self, engine: bpy.types.RenderEngine) -> None:
        for item in self.passes[1:]:
            engine.add_pass(item.name(bpy.app.version), len(item.channels), item.channels, layer=self.layer)
        for view, exported in self.views:
            if engine.test_break() and view != self.views[0][0]:
                break
            self._render(engine, exported, view)

    def _render(self, engine: bpy.types.RenderEngine, exported: Exported, view: str) -> None:
        engine.update_stats("", f"Building {view}".rstrip())
        is_final = not engine.is_preview
        coarse = None
        if is_final and not bpy.app.background:
            coarse = first_look(exported.scene, engine.test_break)
        with self._open(exported.scene) as render:

            def watch(report: dict[str, Any]) -> None:
                reports.update(reports.collect(report, exported), self.layer)

            told = watch if is_final else None
            display = Display(engine, render, exported.scene, self.passes, self.layer, told, view, coarse)
            display.run()
            report = reports.collect(render.report(), exported)
            metadata = display.metadata()
            reports.note_denoising(report, display.denoised, display.problem)
        if is_final:
            reports.stamp(engine, metadata)
            reports.publish(engine, report, self.layer)

    def _open(self, scene: SceneDescription) -> NativeRender | ClusterRender:
        if self.cluster is not None:
            return ClusterRender(scene, self.cluster, Path(bpy.app.tempdir))
        return open_render(scene)[0]


@dataclass(frozen=True)
class ExportJob:
    """Writes the scene file in place of rendering; see operators/export_scene.py."""

    exported: Exported
    path: Path

    def run(self, engine: bpy.types.RenderEngine) -> None:
        write_scene(self.exported.scene, self.path)
        begin_and_end_result(engine)
        reports.publish(engine, reports.collect({}, self.exported), "")


# The scene file that the next render is to write, set by the export operator.
export_request: dict[str, Path] = {}


def prepare(engine: bpy.types.RenderEngine, depsgraph: bpy.types.Depsgraph) -> Job:
    is_denoised = depsgraph.scene_eval.glimmer.use_denoising
    enabled = (passes.COMBINED,) if engine.is_preview else passes.enabled(depsgraph.view_layer_eval, is_denoised)
    engine.update_stats("", "Reading the scene")
    # A preview's depsgraph is not the scene's.
    set_frame = None if engine.is_preview else engine.frame_set
    path = export_request.pop("path", None) if not engine.is_preview else None
    cluster = None if engine.is_preview or path is not None else cluster_of(depsgraph.scene_eval)
    names = ("",) if engine.is_preview else active_views(depsgraph.scene_eval.render)
    views = []
    for name in names:
        if name:
            engine.active_view_set(name)
        view = _camera_view(engine, depsgraph, enabled, name, cluster is not None)
        exported = export_scene(depsgraph, view, bpy.app.version, BULK_READERS, set_frame=set_frame)
        if path is not None:
            return ExportJob(exported, path)
        views.append((name, exported))
    return RenderJob(tuple(views), enabled, depsgraph.view_layer_eval.name, cluster)


def _camera_view(
    engine: bpy.types.RenderEngine,
    depsgraph: bpy.types.Depsgraph,
    enabled: tuple[passes.RenderPass, ...],
    view_name: str,
    on_cluster: bool,
) -> Callable[[bpy.types.Scene, Notices], View]:
    """view_name: of a stereoscopic render, "" else."""

    def camera_view(scene: bpy.types.Scene, notices: Notices) -> View:
        film = export_film(scene, notices)
        if not engine.is_preview:
            note_missing_passes(depsgraph.view_layer_eval, notices)
        if on_cluster:
            samples = layer_samples(scene, depsgraph.view_layer_eval)
            note_differences(scene.glimmer, samples, enabled, notices)
        camera = engine.camera_override or scene.camera
        evaluated = None if camera is None else camera.evaluated_get(depsgraph)
        is_eye = view_name and evaluated is not None and evaluated.type == "CAMERA"
        return View(
            film,
            export_camera(
                evaluated,
                full_shape(scene.render),
                notices,
                eye_of(engine, evaluated, view_name) if is_eye and evaluated is not None else None,
            ),
            export_settings(scene, depsgraph.view_layer_eval, enabled, engine.is_preview),
        )

    return camera_view


def begin_and_end_result(engine: bpy.types.RenderEngine) -> Any:
    """A result without pixels: Blender needs one from every render."""
    result = engine.begin_result(0, 0, engine.resolution_x, engine.resolution_y)
    engine.end_result(result, cancel=True)
