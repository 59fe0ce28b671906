# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the renderers on one scene and reads their pictures."""

import json
import subprocess
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import OpenImageIO

from tests.bench.errors import Picture, Run

_SCRIPT = Path(__file__).with_name("inside_blender.py")
_TIMEOUT = 3600.0


class BenchError(Exception):
    """Why there is no result, in words."""


@dataclass(frozen=True)
class Task:
    samples: int
    seed: int


def read_picture(path: Path) -> Picture:
    file = OpenImageIO.ImageInput.open(str(path))
    if file is None:
        raise BenchError(f"{path}: {OpenImageIO.geterror()}")
    try:
        channels = [file.spec().channelnames.index(name) for name in "RGB"]
        pixels = np.asarray(file.read_image(OpenImageIO.FLOAT), np.float32)
    finally:
        file.close()
    return pixels[..., channels]


def _run(command: Sequence[str | Path]) -> str:
    words = [str(word) for word in command]
    result = subprocess.run(words, capture_output=True, text=True, check=False, timeout=_TIMEOUT)
    if result.returncode != 0:
        raise BenchError(
            f"exit status {result.returncode} from {words[0]}:\n{result.stdout[-2000:]}{result.stderr[-2000:]}"
        )
    return result.stdout


@dataclass(frozen=True)
class Glimmer:
    command: Path

    def version(self) -> str:
        return _run([self.command, "--version"]).strip()

    def render(self, scene: Path, integrator: str, task: Task) -> Run:
        out = scene.with_name(f"{integrator}_{task.samples}_{task.seed}")
        picture, report = out.with_suffix(".exr"), out.with_suffix(".json")
        limits: list[str | Path] = ["--integrator", integrator, "--spp", str(task.samples), "--seed", str(task.seed)]
        _run([self.command, scene, "-o", picture, "--report", report, "--quiet", *limits])
        told: dict[str, Any] = json.loads(report.read_text())
        if told["spp"] != task.samples or told["biased_by"]:
            raise BenchError(f"{report}: {told['spp']} samples, biased by {told['biased_by']}")
        return Run(task.samples, told["seconds"]["cpu"], read_picture(picture), told["invalid_samples"]["count"])


@dataclass(frozen=True)
class FromBlender:
    scene: Path  # as Glimmer's command line reads it
    version: str
    cycles: list[Run]  # in the order of the tasks; CPU seconds as measured, set-up included


def through_blender(
    blender: Path, blend: Path, size: tuple[int, int], folder: Path, cycles: Sequence[Task]
) -> FromBlender:
    """Exports the scene and renders it in Cycles."""
    folder.mkdir(parents=True, exist_ok=True)
    export, result, job = folder / "scene.json", folder / "blender.json", folder / "job.json"
    result.unlink(missing_ok=True)
    description = {
        "scene": str(blend),
        "width": size[0],
        "height": size[1],
        "export": str(export),
        "folder": str(folder),
        "cycles": [[task.samples, task.seed] for task in cycles],
        "result": str(result),
    }
    job.write_text(json.dumps(description))
    options: list[str | Path] = ["-b", "--factory-startup", "--python-exit-code", "1", "--python", _SCRIPT, "--", job]
    _run([blender, *options])
    told = json.loads(result.read_text())
    runs = [Run(item["samples"], item["cpu"], read_picture(Path(item["picture"]))) for item in told["renders"]]
    return FromBlender(export, told["version"], runs)


def without_set_up(repetition: Sequence[Run], set_up: float) -> list[Run]:
    """The runs of Cycles with the CPU seconds of their samples alone: the longest run less the set-up, shared out."""
    longest = max(repetition, key=lambda run: run.samples)
    each = (longest.cpu - set_up) / longest.samples
    if each <= 0:
        raise BenchError("Cycles' set-up took as long as its longest render: more samples are needed")
    return [Run(run.samples, each * run.samples, run.picture) for run in repetition]


def set_up_seconds(singles: Sequence[Run], longest: Sequence[Run]) -> float:
    """What a render costs before its first sample: renders of one sample, less that sample by the slope to the longest.
    Medians of CPU seconds.
    """
    one = float(np.median([run.cpu for run in singles]))
    most = float(np.median([run.cpu for run in longest]))
    return one - (most - one) / (longest[0].samples - 1)
