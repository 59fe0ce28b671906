# SPDX-License-Identifier: GPL-3.0-or-later
"""What happens when no picture can be made: one message, no file, and an exit status that a script can see.

Blender has no such notion for add-ons: `error_set` shows the message and then writes the black picture and exits 0, and
`report({'ERROR'})` raises in a calling script after writing it. So the file is removed again, and:

- `blender -b FILE -f 1`, where no script waits for an answer: the process ends here, with status 1;
- `blender -b --python SCRIPT`: the operator raises RuntimeError in the script, and Blender exits with 1 in the end;
- the bpy module: the operator raises RuntimeError, and the program decides;
- with a window: the message is shown.
"""

import atexit
import os
import shutil
import sys
from collections.abc import Callable
from pathlib import Path
from types import FrameType

import bpy
from bpy.app.handlers import persistent

EXIT_STATUS = 1

# The render that failed and still may write a file.
_pending = {"failed": False}
_process = {"failed": False}

# Called before a failed render ends the process.
before_exit: list[Callable[[], None]] = []


def is_module() -> bool:
    """Whether Blender runs as a module of a Python program, whose exit status is not ours."""
    return bool(getattr(bpy.app, "module", not bpy.app.binary_path))


def _is_called_from_script(frame: FrameType | None) -> bool:
    """Whether Python code outside of this package stands below us on the stack: it gets the exception."""
    package = str(Path(__file__).parent)  # unresolved, as in the code objects
    while frame is not None:
        if not frame.f_code.co_filename.startswith(package):
            return True
        frame = frame.f_back
    return False


def is_command_line() -> bool:
    """Whether the render was asked for by Blender's own arguments, -f or -a: nobody but the files' reader learns of
    it."""
    return bpy.app.background and not is_module() and not _is_called_from_script(sys._getframe())


def end_with_status() -> None:
    """The process goes on, and its status will tell that a render of it has failed."""
    _process["failed"] = True


def fail(engine: bpy.types.RenderEngine, message: str) -> None:
    """Ends a render that has begun and ended a result already."""
    if engine.is_preview:
        engine.error_set(message)
        return
    if is_command_line():
        _exit_now(message)
    _pending["failed"] = True
    _process["failed"] = bpy.app.background
    engine.report({"ERROR"}, f"Glimmer: {message}")
    if not bpy.app.background:
        engine.error_set(message)  # later versions report it too: where nobody reads the picture, once is enough


def _exit_now(message: str) -> None:
    for action in before_exit:
        action()
    sys.stderr.write(f"Error: Glimmer: {message}\n")
    shutil.rmtree(bpy.app.tempdir, ignore_errors=True)
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(EXIT_STATUS)


def _exit_with_status() -> None:
    if _process["failed"] and not is_module():
        shutil.rmtree(bpy.app.tempdir, ignore_errors=True)
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(EXIT_STATUS)


def written_files(scene: bpy.types.Scene) -> list[Path]:
    """Where Blender may have written the picture of the current frame, as a still or as a frame of an animation."""
    render = scene.render
    still = bpy.path.abspath(render.filepath)
    if render.use_file_extension and not still.endswith(render.file_extension):
        still += render.file_extension
    return [Path(still), Path(render.frame_path(frame=scene.frame_current))]


@persistent  # type: ignore[untyped-decorator]
def _on_render_write(scene: bpy.types.Scene, *_: object) -> None:
    if _pending["failed"]:
        for path in written_files(scene):
            path.unlink(missing_ok=True)


@persistent  # type: ignore[untyped-decorator]
def _on_render_pre(scene: bpy.types.Scene, *_: object) -> None:
    _pending["failed"] = False


def register() -> None:
    bpy.app.handlers.render_pre.append(_on_render_pre)
    bpy.app.handlers.render_write.append(_on_render_write)
    if not is_module():
        atexit.register(_exit_with_status)


def unregister() -> None:
    atexit.unregister(_exit_with_status)
    bpy.app.handlers.render_write.remove(_on_render_write)
    bpy.app.handlers.render_pre.remove(_on_render_pre)
