# SPDX-License-Identifier: GPL-3.0-or-later
"""A picture's name holds a finished picture of this very run or nothing: for `blender -b FILE -f` and `-a`, where a
render farm takes a file for a success.

- An older picture of the frame is removed before the frame is rendered; what fails then leaves nothing to be mistaken.
- Where the scene does not overwrite (Output > Overwrite off: an animation that goes on where it was broken off skips
  what is there), Blender writes to a name beside, and the finished file is renamed: a process that is killed while it
  writes leaves nothing under the frame's name.
- A placeholder (an empty file, Output > Placeholders) stays until the picture is there and goes when the frame fails.
- A frame that was broken off ends the process with a status that tells.

With a window, and under a script, whose answer is the picture in memory, nothing of this happens.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

import bpy
from bpy.app.handlers import persistent

from . import failure

UNFINISHED = ".unfinished-"  # before a file's name: on Linux those are hidden


@dataclass(frozen=True)
class Frame:
    """The files of the frame that is being rendered."""

    scene: str
    output: str  # the scene's own render.filepath
    pictures: tuple[Path, ...]  # one for each view
    written: tuple[Path, ...]  # where Blender writes them, in the same order

    def restore(self) -> None:
        scene = bpy.data.scenes.get(self.scene)
        if scene is not None:
            scene.render.filepath = self.output

    def discard(self) -> None:
        """What a frame without a picture leaves: half a file, or its placeholder."""
        for path in self.written:
            if path not in self.pictures:
                path.unlink(missing_ok=True)
        for path in self.pictures:
            if path.is_file() and (path in self.written or path.stat().st_size == 0):
                path.unlink()


_current: dict[str, Frame] = {}


def beside(output: str) -> str:
    """A render.filepath whose files lie in the same folder under another name."""
    folder, slash, name = output.replace("\\", "/").rpartition("/")
    return f"{folder}{slash}{UNFINISHED}{name}"


def _pictures(scene: bpy.types.Scene) -> tuple[Path, ...]:
    render = scene.render
    views = [view.name for view in render.views if view.use] if render.use_multiview else [""]
    return tuple(Path(render.frame_path(frame=scene.frame_current, view=view)) for view in views)


@persistent  # type: ignore[untyped-decorator]
def _on_render_pre(scene: bpy.types.Scene, *_: object) -> None:
    _current.clear()
    render = scene.render
    if render.engine != "GLIMMER" or not failure.is_command_line() or render.is_movie_format:
        return
    output, pictures = render.filepath, _pictures(scene)
    if render.use_overwrite:
        for path in pictures:
            if path.is_file() and path.stat().st_size > 0:
                path.unlink()
        _current["frame"] = Frame(scene.name, output, pictures, pictures)
    elif PurePosixPath(output).name or output.endswith("/"):
        render.filepath = beside(output)
        _current["frame"] = Frame(scene.name, output, pictures, _pictures(scene))


@persistent  # type: ignore[untyped-decorator]
def _on_render_write(*_: object) -> None:
    frame = _current.pop("frame", None)
    if frame is None:
        return
    frame.restore()
    for written, picture in zip(frame.written, frame.pictures, strict=True):
        if written != picture and written.is_file():
            written.replace(picture)
            # Blender has told of the other name, and who collects pictures reads these lines.
            sys.stdout.write(f"Saved: '{picture}'\n")
            sys.stdout.flush()


@persistent  # type: ignore[untyped-decorator]
def _on_render_cancel(*_: object) -> None:
    """Broken off, or the picture could not be written."""
    if _current:
        discard()
        failure.end_with_status()


def discard() -> None:
    """Of a frame that has failed."""
    frame = _current.pop("frame", None)
    if frame is not None:
        frame.restore()
        frame.discard()


def register() -> None:
    bpy.app.handlers.render_pre.append(_on_render_pre)
    bpy.app.handlers.render_write.insert(0, _on_render_write)  # others want the picture's own name
    bpy.app.handlers.render_cancel.append(_on_render_cancel)
    failure.before_exit.append(discard)


def unregister() -> None:
    failure.before_exit.remove(discard)
    bpy.app.handlers.render_cancel.remove(_on_render_cancel)
    bpy.app.handlers.render_write.remove(_on_render_write)
    bpy.app.handlers.render_pre.remove(_on_render_pre)
