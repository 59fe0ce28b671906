# SPDX-License-Identifier: GPL-3.0-or-later
"""The curve of the error beside the picture, as PICTURE.error.csv and .png: where the scene asks for it, with a window
or without, for a still and for every frame of an animation."""

from __future__ import annotations

import logging
from pathlib import Path

import bpy
from bpy.app.handlers import persistent

from . import reports
from .failure import written_files
from .film.png import write_png
from .native import error_curve
from .native.library import load

_log = logging.getLogger(__name__)


def stems(picture: Path, layers: list[str]) -> list[Path]:
    """Without suffix, one for each layer."""
    if len(layers) == 1:
        return [picture.with_name(f"{picture.stem}.error")]
    return [picture.with_name(f"{picture.stem}.{bpy.path.clean_name(layer)}.error") for layer in layers]


def write(picture: Path) -> list[Path]:
    """For the last render. Returns what was written."""
    written: list[Path] = []
    found = reports.layers()
    for stem, report in zip(stems(picture, list(found)), found.values(), strict=True):
        files = stem.with_name(f"{stem.name}.csv"), stem.with_name(f"{stem.name}.png")
        files[0].write_text(error_curve.table(load(), report))
        write_png(error_curve.plot(load(), report), files[1])
        written += files
    return written


@persistent  # type: ignore[untyped-decorator]
def _on_render_write(scene: bpy.types.Scene, *_: object) -> None:
    if not scene.glimmer.use_curve_files or not reports.layers():
        return
    # The still's name and the frame's: only one of them was written just now.
    pictures = [path for path in written_files(scene) if path.exists()]
    if not pictures:
        return
    newest = max(pictures, key=lambda path: path.stat().st_mtime_ns)
    try:
        write(newest)
    except OSError as error:
        _log.warning("the error curve beside %s cannot be written: %s", newest, error)


def register() -> None:
    bpy.app.handlers.render_write.append(_on_render_write)


def unregister() -> None:
    bpy.app.handlers.render_write.remove(_on_render_write)
