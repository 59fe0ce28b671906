# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the renderers on one scene and reads their pictures. Runs that are on disk already are not rendered again."""

import dataclasses
import json
import os
import shutil
import subprocess
import tempfile
import threading
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import OpenImageIO

from tests.bench.errors import Picture, Run
from tests.bench.scenes import BenchScene
from tests.bench.store import digest, picture_of, read_record, write_record

ROOT = Path(__file__).resolve().parents[2]
_HERE = Path(__file__).parent
_SCRIPT = _HERE / "inside_blender.py"
_SETTINGS = ROOT / "tests" / "blender" / "exact_cycles.py"
_TIMEOUT = 4 * 3600.0


class BenchError(Exception):
    """Why there is no result, in words."""


class CannotRenderError(Exception):
    """What of a scene cannot be said to a renderer, in words."""


@dataclass(frozen=True)
class Task:
    samples: int
    seed: int


def read_picture(path: Path, layer: str = "") -> Picture:
    """layer: as "stderr."; else the picture itself."""
    file = OpenImageIO.ImageInput.open(str(path))
    if file is None:
        raise BenchError(f"{path}: {OpenImageIO.geterror()}")
    try:
        channels = [file.spec().channelnames.index(layer + name) for name in "RGB"]
        pixels = np.asarray(file.read_image(OpenImageIO.FLOAT), np.float32)
    finally:
        file.close()
    return pixels[..., channels]


def _run(command: Sequence[str | Path], env: Mapping[str, str] | None = None) -> tuple[str, int]:
    """What it printed, and the most memory it had resident, in bytes."""
    words = [str(word) for word in command]
    with tempfile.TemporaryFile("w+") as output:
        process = subprocess.Popen(words, stdout=output, stderr=subprocess.STDOUT, cwd=ROOT, env=env)
        timer = threading.Timer(_TIMEOUT, process.kill)
        timer.start()
        try:
            _, status, usage = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
        finally:
            timer.cancel()
        output.seek(0)
        said = output.read()
    if process.returncode != 0:
        raise BenchError(f"exit status {process.returncode} from {words[0]}:\n{said[-3000:]}")
    return said, usage.ru_maxrss * 1024


# ---- The scene ---------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Stage:
    """A scene at one size, and where its runs are kept."""

    scene: BenchScene
    size: tuple[int, int]
    folder: Path
    export: Path  # as Glimmer's command line and the peers read it
    content: str  # digest of the export and all its files
    blender: str  # version

    def room(self, renderer: str, words: Sequence[str], files: Sequence[Path]) -> Path:
        """The folder for a renderer's runs of this very scene; those of another scene, build or setting are removed."""
        room = self.folder / f"{renderer}-{digest((self.content, *words), files)}"
        for other in self.folder.glob(f"{renderer}-*"):
            if other != room:
                shutil.rmtree(other)
        room.mkdir(parents=True, exist_ok=True)
        return room


def _job(scene: BenchScene, size: tuple[int, int], folder: Path, rest: Mapping[str, Any]) -> tuple[Path, Path]:
    job, result = folder / "job.json", folder / "result.json"
    result.unlink(missing_ok=True)
    description = {
        "scene": str(ROOT / "blend_scenes" / f"{scene.blend}.blend"),
        "haze": scene.haze and dataclasses.asdict(scene.haze),
        "roughness": scene.roughness,
        "width": size[0],
        "height": size[1],
        "result": str(result),
    }
    job.write_text(json.dumps({**description, **rest}))
    return job, result


def _in_blender(blender: Path, job: Path) -> None:
    _run([blender, "-b", "--factory-startup", "--python-exit-code", "1", "--python", _SCRIPT, "--", job])


def set_stage(blender: Path, scene: BenchScene, size: tuple[int, int], folder: Path) -> Stage:
    """Exports the scene, always: what the add-on writes today decides which runs still hold."""
    home = folder / "scene"
    shutil.rmtree(home, ignore_errors=True)
    home.mkdir(parents=True)
    export = home / "scene.json"
    job, result = _job(scene, size, folder, {"export": str(export)})
    _in_blender(blender, job)
    content = digest((), sorted(path for path in home.rglob("*") if path.is_file()))
    return Stage(scene, size, folder, export, content, json.loads(result.read_text())["version"])


# ---- Renderers ---------------------------------------------------------------------------------------------------


def _missing(room: Path, tasks: Sequence[Task]) -> list[Task]:
    return [task for task in tasks if read_record(room, task.samples, task.seed) is None]


def _finished(room: Path, tasks: Sequence[Task]) -> list[Run]:
    runs = []
    for task in tasks:
        told = read_record(room, task.samples, task.seed)
        if told is None:
            raise BenchError(f"{room}: no run of {task.samples} samples with seed {task.seed}")
        runs.append(Run(picture=read_picture(picture_of(room, task.samples, task.seed)), **told))
    return runs


@dataclass(frozen=True)
class Glimmer:
    command: Path
    integrator: str

    def version(self) -> str:
        return _run([self.command, "--version"])[0].strip()

    def room(self, stage: Stage) -> Path:
        library = self.command.parent.parent / "lib" / "libglimmer.so"
        return stage.room(self.integrator, (), [self.command, *([library] if library.exists() else [])])

    def runs(self, stage: Stage, tasks: Sequence[Task]) -> list[Run]:
        room = self.room(stage)
        for task in _missing(room, tasks):
            self._render(stage.export, room, task)
        return _finished(room, tasks)

    def _render(self, scene: Path, room: Path, task: Task) -> None:
        picture = picture_of(room, task.samples, task.seed)
        report = picture.with_suffix(".report.json")
        limits = ["--integrator", self.integrator, "--spp", str(task.samples), "--seed", str(task.seed)]
        _, peak_bytes = _run([self.command, scene, "-o", picture, "--report", report, "--quiet", *limits])
        told: dict[str, Any] = json.loads(report.read_text())
        if told["spp"] != task.samples or told["biased_by"]:
            raise BenchError(f"{report}: {told['spp']} samples, biased by {told['biased_by']}")
        seconds, invalid = told["seconds"], told["invalid_samples"]["count"]
        times = seconds["cpu"], seconds["render"]
        set_up = seconds["load"] + seconds["build"]
        write_record(room, task.samples, task.seed, task.samples, *times, peak_bytes, invalid, set_up)


@dataclass(frozen=True)
class Cycles:
    """Like the peers': what a render does before its first sample is in the seconds of its runs: see without_set_up."""

    blender: Path
    name: str = "Cycles"

    def runs(self, stage: Stage, tasks: Sequence[Task]) -> list[Run]:
        blend = ROOT / "blend_scenes" / f"{stage.scene.blend}.blend"
        room = stage.room("Cycles", (stage.blender,), [_SCRIPT, _SETTINGS, blend])
        missing = [[task.samples, task.seed] for task in _missing(room, tasks)]
        if missing:
            job, _ = _job(stage.scene, stage.size, room, {"folder": str(room), "cycles": missing})
            _in_blender(self.blender, job)
        return _finished(room, tasks)


@dataclass(frozen=True)
class Peer:
    """A renderer with a Python of its own: see peers/job.py."""

    name: str
    python: Path
    version: str

    def runs(self, stage: Stage, tasks: Sequence[Task]) -> list[Run]:
        peers = _HERE / "peers"
        sources = [peers / f"{self.name}.py", peers / "scene_file.py", peers / "job.py"]
        room = stage.room(self.name, (self.version,), sources)
        missing = [[task.samples, task.seed] for task in _missing(room, tasks)]
        if missing:
            job, result = room / "job.json", room / "result.json"
            result.unlink(missing_ok=True)
            description = {"scene": str(stage.export), "folder": str(room), "tasks": missing, "result": str(result)}
            job.write_text(json.dumps(description))
            _run([self.python, "-m", f"tests.bench.peers.{self.name}", job])
            reason = json.loads(result.read_text()).get("unsupported")
            if reason is not None:
                raise CannotRenderError(reason)
        return _finished(room, tasks)


def set_up_seconds(singles: Sequence[Run], longest: Sequence[Run], clock: str) -> float:
    """What a render costs before its first sample: renders of one sample, less that sample by the slope to the longest.
    Medians of seconds of a clock, "cpu" or "wall".
    """
    one, most = (float(np.median([getattr(run, clock) for run in runs])) for runs in (singles, longest))
    count, samples = (float(np.median([run.samples for run in runs])) for runs in (singles, longest))
    return max(one - (most - one) / (samples - count) * count, 0.0)


def without_set_up(rows: Sequence[Sequence[Run]], singles: Sequence[Run]) -> list[list[Run]]:
    """[repetition][level]: each with the seconds of its samples alone, those of the repetition's longest run less the
    set-up, shared out by samples; the set-up is added to what the runs tell of theirs.
    """
    ends = [max(row, key=lambda run: run.samples) for row in rows]
    before = {clock: set_up_seconds(singles, ends, clock) for clock in ("cpu", "wall")}
    result = []
    for row, end in zip(rows, ends, strict=True):
        each = {clock: (getattr(end, clock) - before[clock]) / end.samples for clock in before}
        if min(each.values()) <= 0:
            raise BenchError("the set-up took as long as the longest render: more samples are needed")
        result.append(
            [
                dataclasses.replace(
                    run,
                    cpu=each["cpu"] * run.samples,
                    wall=each["wall"] * run.samples,
                    set_up=(run.set_up or 0.0) + before["cpu"],
                )
                for run in row
            ]
        )
    return result
