# SPDX-License-Identifier: GPL-3.0-or-later
"""What runs on the workers: they keep scenes, and render ranges by the `glimmer` command of their machine.

Every function takes and returns plain bytes and numbers and raises nothing: a failure goes back as words. The scene and
the order come from whoever reaches the scheduler, so paths and sizes are checked.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import tempfile
import threading
from collections.abc import Callable
from pathlib import Path

from distributed import get_worker

from . import command, picture, ranges, scene_files
from .engine import Engine
from .problems import FarmError
from .ranges import Order, Range, Work

THREADS_VARIABLE = "GLIMMER_FARM_THREADS"
MISSING_SCENE = "the scene is not here"

_lock = threading.Lock()
_running: dict[str, list[subprocess.Popen[str]]] = {}
_ended: set[str] = set()


def _folder() -> Path:
    return Path(get_worker().local_directory)


def _scene_folder(digest: str) -> Path:
    if not re.fullmatch("[0-9a-f]{64}", digest):
        raise FarmError("that is no digest of a scene")
    return _folder() / f"scene-{digest}"


def _in_words(task: Callable[[], bytes]) -> bytes:
    try:
        return task()
    except (FarmError, OSError, ValueError, KeyError, TypeError) as error:
        return ranges.failure(str(error) or type(error).__name__)


def put_chunk(digest: str, number: int, chunks: int, data: bytes) -> bytes:
    """Chunk `number` of a packed scene, in order; b"" or a failure. With the last one the scene is unpacked."""

    def task() -> bytes:
        folder = _scene_folder(digest)
        if folder.is_dir():
            return b""
        stream = folder.with_suffix(".part")
        with stream.open("wb" if number == 0 else "ab") as target:
            if target.tell() != number * scene_files.CHUNK_BYTES or len(data) > scene_files.CHUNK_BYTES:
                raise FarmError(f"part {number} of the scene does not follow what is there")
            target.write(data)
        if number + 1 == chunks:
            _unpack(stream, folder, digest)
        return b""

    return _in_words(task)


def _unpack(stream: Path, folder: Path, digest: str) -> None:
    unpacked = Path(tempfile.mkdtemp(dir=folder.parent))
    try:
        if scene_files.digest_of(stream) != digest:
            raise FarmError("the scene was damaged on its way")
        scene = scene_files.unpack(stream, unpacked / "files")
        (unpacked / "scene").write_text(scene.name)
        unpacked.rename(folder)
    finally:
        stream.unlink(missing_ok=True)
        shutil.rmtree(unpacked, ignore_errors=True)


def end_job(job: str) -> None:
    """Ends what is still being rendered for a job."""
    with _lock:
        _ended.add(job)
        for process in _running.get(job, []):
            process.kill()


def render_range(order: bytes) -> bytes:
    return _in_words(lambda: _render(Order.decode(order)).encode())


def _render(order: Order) -> Range:
    engine = Engine.here()
    if engine.identity.program != order.program:
        raise FarmError("the command of this machine has changed since the worker was started; start it anew")
    folder = _scene_folder(order.scene)
    if not folder.is_dir():
        raise FarmError(MISSING_SCENE)
    scene = folder / "files" / (folder / "scene").read_text()
    threads = order.threads or int(os.environ.get(THREADS_VARIABLE, "0"))
    with tempfile.TemporaryDirectory(dir=_folder()) as name:
        out, report = Path(name, "range.exr"), Path(name, "report.json")
        _run(command.words_of(engine, order, scene, out, report, threads), order.job, scene)
        rendered = picture.read(out).layer_free("stderr")
        told = json.loads(report.read_text())
    seconds = told["seconds"]
    work = Work(
        seconds["render"],
        seconds["cpu"],
        seconds["load"] + seconds["build"],
        told["rays"],
        told["invalid_samples"]["count"],
    )
    facts, layout = rendered.facts, rendered.layout
    return Range(order.index, order.seed, facts.samples, facts.scene, layout.channels, rendered.pixels, work)


def _run(words: list[str], job: str, scene: Path) -> None:
    with _lock:
        if job in _ended:
            raise FarmError("the job has ended")
        process = command.start(words)
        _running.setdefault(job, []).append(process)
    try:
        command.finish(process, lambda line: line.replace(str(scene), scene.name))
    finally:
        with _lock:
            _running[job].remove(process)
