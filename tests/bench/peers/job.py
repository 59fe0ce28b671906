# SPDX-License-Identifier: GPL-3.0-or-later
"""What every peer's process does: python -m tests.bench.peers.PEER JOB.json

JOB.json holds "scene" (a scene file), "folder", "tasks" [[samples, seed], ...] and "result". The folder gets a picture
and its record for each task (see tests/bench/store.py) as soon as it is rendered; "result" gets {}, or why the peer
cannot render the scene as {"unsupported": ...}.
"""

import json
import resource
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tests.bench.peers.scene_file import Scene, UnsupportedError, read_scene
from tests.bench.store import picture_of, write_record


def cpu_seconds() -> float:
    return time.process_time()


def peak_bytes() -> int:
    """Of the whole process, resident."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024


@dataclass(frozen=True)
class Rendered:
    samples: float  # a pixel: a peer may overshoot
    cpu: float
    wall: float


# (samples a pixel, seed, picture to write)
Render = Callable[[int, int, Path], Rendered]


def measured(render: Callable[[], Any]) -> tuple[float, float]:
    """CPU and wall seconds."""
    cpu, wall = cpu_seconds(), time.monotonic()
    render()
    return cpu_seconds() - cpu, time.monotonic() - wall


def serve(arguments: list[str], start: Callable[[Scene], Render]) -> None:
    """`start` loads a scene and renders it once, so that nothing is left that only a first render does."""
    job = json.loads(Path(arguments[0]).read_text())
    result, folder = Path(job["result"]), Path(job["folder"])
    before = cpu_seconds()
    try:
        render = start(read_scene(Path(job["scene"])))
    except UnsupportedError as reason:
        result.write_text(json.dumps({"unsupported": str(reason)}))
        return
    set_up = cpu_seconds() - before
    for samples, seed in job["tasks"]:
        done = render(samples, seed, picture_of(folder, samples, seed))
        write_record(folder, samples, seed, done.samples, done.cpu, done.wall, peak_bytes(), 0, set_up)
    result.write_text(json.dumps({}))
