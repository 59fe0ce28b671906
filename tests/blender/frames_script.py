# SPDX-License-Identifier: GPL-3.0-or-later
"""Saves the files of test_frames.py: frames_script.py FOLDER."""

import sys
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).parent))

import inside

OUT = Path(inside.words()[0])
inside.enable()
scene = inside.empty_scene((0.5, 0.5, 0.5))
inside.ball("Ball", segments=8)
inside.use_format("PNG")
scene.glimmer.samples = 2
scene.frame_start, scene.frame_end = 1, 3

# With the second frame comes a camera that cannot be rendered by.
for frame, size in ((1, 1.0), (2, 0.0), (3, 1.0)):
    scene.camera.scale = (size, size, size)
    scene.camera.keyframe_insert("scale", frame=frame)
scene.frame_set(1)
bpy.ops.wm.save_as_mainfile(filepath=str(OUT / "second_fails.blend"))

scene.render.use_overwrite, scene.render.use_placeholder = False, True
bpy.ops.wm.save_as_mainfile(filepath=str(OUT / "goes_on.blend"))

scene.camera.animation_data_clear()
scene.camera.scale = (1.0, 1.0, 1.0)
scene.glimmer.samples = 1_000_000
bpy.ops.wm.save_as_mainfile(filepath=str(OUT / "endless.blend"))
