# SPDX-License-Identifier: GPL-3.0-or-later
"""What of a file is rendered in another way than Cycles does, without rendering it or reading meshes and images."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..cluster.settings import note_differences
from ..film.passes import enabled
from ..scene.problems import GlimmerError, Notice, Notices
from ..scene.program import Texture
from .camera import export_camera
from .film import export_film, full_shape, layer_samples, note_missing_passes
from .motion import read_shutter
from .scene import take_notices
from .translate.image import Images
from .world import export_world

if TYPE_CHECKING:
    import bpy


class BlankImages(Images):
    """Each image is one pixel, unless its file is missing."""

    def texture(self, image: Any) -> Texture:
        _expect_file(image)
        return Texture(image.name, np.zeros((1, 1, 4), np.float32))

    def file_of(self, image: Any, path: str) -> Texture:
        if not Path(path).is_file():
            raise ValueError(f"has no file {Path(path).name}")
        return Texture(image.name, np.zeros((1, 1, 4), np.float32))

    def light(self, image: Any) -> Any:
        _expect_file(image)
        return np.zeros((1, 1, 3), np.float32)


def _expect_file(image: Any) -> None:
    import bpy

    if image.source == "FILE" and image.packed_file is None:
        path = Path(bpy.path.abspath(image.filepath, library=image.library))
        if not path.is_file():
            raise ValueError("has no pixels")


def find_differences(depsgraph: bpy.types.Depsgraph, version: tuple[int, ...]) -> tuple[Notice, ...]:
    """In the words of a render's notices, with what would keep it from rendering."""
    notices, scene = Notices(), depsgraph.scene_eval
    images = BlankImages(scene.frame_current)
    try:
        export_film(scene, notices)
        note_missing_passes(depsgraph.view_layer_eval, notices)
        if scene.glimmer.use_cluster:
            layer = depsgraph.view_layer_eval
            note_differences(scene.glimmer, layer_samples(scene, layer), enabled(layer), notices)
        camera = scene.camera.evaluated_get(depsgraph) if scene.camera is not None else None
        export_camera(camera, full_shape(scene.render), notices)
        if depsgraph.view_layer_eval.use_motion_blur:
            read_shutter(scene, notices)
    except GlimmerError as error:
        notices.add("", str(error))
    take_notices(depsgraph, _rendered(depsgraph), version, images, notices)
    export_world(scene.world, notices, images)
    return tuple(notices.items)


def _rendered(depsgraph: bpy.types.Depsgraph) -> Iterator[bpy.types.Object]:
    """The evaluated objects that a render may show, each once, with those of instanced collections."""
    pending = list(depsgraph.view_layer.objects)
    seen: set[int] = set()
    for item in pending:  # which grows meanwhile
        pointer = item.original.as_pointer()
        if pointer in seen or item.hide_render:
            continue
        seen.add(pointer)
        if item.instance_type == "COLLECTION" and item.instance_collection is not None:
            pending.extend(item.instance_collection.all_objects)
        yield item.evaluated_get(depsgraph)
