# SPDX-License-Identifier: GPL-3.0-or-later
"""The job files of addon/docs/farm.md make the commands that test_frames.py runs."""

import json
import shlex
import subprocess
from pathlib import Path
from typing import Any

import pytest
import quickjs

import build

JOBS = Path(__file__).resolve().parents[2] / "addon" / "docs" / "farm"

# As Flamenco's manager gives it to the scripts of job types.
MANAGER = """
const tasks = [];
function frameChunker(frames, size) { return frames === "1-3" && size === 2 ? ["1-2", "3"] : []; }
const author = {
    Task: (name, type) => ({ name, type, commands: [], addCommand(command) { this.commands.push(command); } }),
    Command: (name, parameters) => ({ name, parameters }),
};
"""


def compiled(settings: dict[str, Any]) -> list[dict[str, Any]]:
    context = quickjs.Context()
    for text in (MANAGER, (JOBS / "glimmer_frames.js").read_text()):
        context.eval(text)
    defaults = "Object.fromEntries(JOB_TYPE.settings.filter(s => 'default' in s).map(s => [s.key, s.default]))"
    job = f"({{ settings: Object.assign({defaults}, {json.dumps(settings)}), addTask: t => tasks.push(t) }})"
    context.eval(f"compileJob({job})")
    tasks: list[dict[str, Any]] = json.loads(context.eval("JSON.stringify(tasks)"))
    return tasks


def test_flamenco_compiles_a_task_for_each_chunk() -> None:
    output = "/out/######"
    settings = {"frames": "1-3", "chunk_size": 2, "blendfile": "/a b.blend", "format": "PNG"}
    tasks = compiled({**settings, "render_output_path": output})
    assert [(task["name"], task["type"]) for task in tasks] == [("render-1-2", "blender"), ("render-3", "blender")]
    parts = tasks[0]["commands"][0]["parameters"]
    assert [*parts["argsBefore"], parts["blendfile"], *parts["args"]] == [
        *("--addons", "glimmer", "/a b.blend", "--engine", "GLIMMER"),
        *("--render-output", output, "--render-format", "PNG", "--render-frame", "1..2"),
    ]


def test_flamenco_refuses_films() -> None:
    with pytest.raises(Exception, match="renders pictures; FFMPEG is a film"):
        compiled({"frames": "1-3", "chunk_size": 2, "format": "FFMPEG"})


@pytest.mark.full
def test_opencue_makes_a_frame_of_each_command() -> None:
    python = build.virtual_environment("opencue")
    words = [
        str(python),
        str(JOBS / "opencue_job.py"),
        "/a b.blend",
        "/out/frame_####",
        "1-3",
        "--format",
        "PNG",
        "--print",
    ]
    text = subprocess.run(words, capture_output=True, text=True, check=True).stdout
    command = text.split("<cmd>")[1].split("</cmd>")[0]
    assert shlex.split(command) == [
        *("blender", "-b", "--addons", "glimmer", "/a b.blend", "-E", "GLIMMER"),
        *("-o", "/out/frame_####", "-F", "PNG", "-f", "#IFRAME#"),
    ]
    assert "<range>1-3</range><chunk>1</chunk>" in text
