# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders one frame of a .blend with Glimmer and writes STEM.png (display-referred) and STEM.exr (linear, float32).

Runs inside Blender (`blender -b --python blend_scenes/render_blend.py -- ...`) or on the bpy module. The add-on must be
findable as `glimmer`. Ends with a non-zero status when there is no picture.
"""

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

import bpy


class RenderError(Exception):
    """Why there is no picture."""


def parse(argv: Sequence[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="render_blend.py", description=__doc__)
    parser.add_argument("--scene", type=Path, required=True)
    parser.add_argument("--output", type=Path, required=True, metavar="STEM")
    parser.add_argument("--samples", type=int)
    parser.add_argument("--seconds", type=float, help="of rendering, beside the samples: whichever limit comes first")
    parser.add_argument("--resolution", type=int, metavar="PERCENT")
    parser.add_argument("--frame", type=int)
    return parser.parse_args(argv)


def save(scene: "bpy.types.Scene", path: Path, file_format: str, depth: str) -> None:
    settings = scene.render.image_settings
    if hasattr(settings, "media_type"):  # 5.0 on
        settings.media_type = "IMAGE"
    settings.file_format = file_format
    settings.color_mode = "RGB"
    settings.color_depth = depth
    bpy.data.images["Render Result"].save_render(str(path), scene=scene)


def print_status(status: str | None, *_: object) -> None:
    """As Blender prints it up to 4.x. Later ones keep silent, and hand it to this handler instead."""
    if isinstance(status, str):
        sys.stdout.write(f"Fra:{bpy.context.scene.frame_current} {status}\n")
        sys.stdout.flush()


def main(argv: Sequence[str]) -> None:
    import addon_utils  # the bpy module brings it with itself: not there before

    given = parse(argv)
    if addon_utils.enable("glimmer", default_set=False) is None:
        raise RenderError("the add-on `glimmer` did not start; the reason stands above")
    bpy.ops.wm.open_mainfile(filepath=str(given.scene))
    scene = bpy.context.scene
    scene.render.engine = "GLIMMER"
    if given.samples is not None:
        scene.glimmer.samples = given.samples
    if given.seconds is not None:
        scene.glimmer.use_seconds, scene.glimmer.seconds = True, given.seconds
    if given.resolution is not None:
        scene.render.resolution_percentage = given.resolution
    if given.frame is not None:
        scene.frame_set(given.frame)
    bpy.app.handlers.render_stats.append(print_status)
    bpy.ops.render.render()
    save(scene, given.output.with_name(given.output.name + ".png"), "PNG", "8")
    save(scene, given.output.with_name(given.output.name + ".exr"), "OPEN_EXR", "32")


if __name__ == "__main__":
    try:
        main(sys.argv[sys.argv.index("--") + 1 :])
    except (RenderError, RuntimeError) as error:  # bpy raises RuntimeError with what an operator reported
        sys.stderr.write(f"render: {error}\n")
        sys.exit(1)
