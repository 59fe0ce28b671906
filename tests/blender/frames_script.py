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

# What Blender cannot render comes with the second frame.
camera = scene.camera.data
for frame, kind in ((1, "PERSP"), (2, "PANO"), (3, "PERSP")):
    camera.type = kind
    camera.keyframe_insert("type", frame=frame)
scene.frame_set(1)
bpy.ops.wm.save_as_mainfile(filepath=str(OUT / "second_fails.blend"))

scene.render.use_overwrite, scene.render.use_placeholder = False, True
bpy.ops.wm.save_as_mainfile(filepath=str(OUT / "goes_on.blend"))

camera.animation_data_clear()
camera.type = "PERSP"
scene.glimmer.samples = 1_000_000
bpy.ops.wm.save_as_mainfile(filepath=str(OUT / "endless.blend"))
