# SPDX-License-Identifier: GPL-3.0-or-later
"""What a farm moves, by the number of workers, and what merging costs; prints the tables of addon/docs/farm.md.

    build/venv/test/bin/python -m tests.bench.farm_cost [merge | move]

Merging is measured without a cluster, in CPU time: it does not know where ranges come from. How much faster many
workers are cannot be measured on one machine.
"""

import json
import os
import shutil
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from engine.farm import ranges
from engine.farm.cluster import local_cluster
from engine.farm.engine import ROOT
from engine.farm.farm import Farm, FarmOptions
from engine.farm.merge import RADIANCE, Sums
from engine.farm.picture import Layout
from engine.farm.ranges import Expected, Order, Range

SIZES = ((480, 270), (960, 540), (1920, 1080))
RANGES = 8
MOVED_RANGES = 16


def say(text: str) -> None:
    sys.stdout.write(text + "\n")
    sys.stdout.flush()


def merging() -> None:
    say("| pixels | a range, MB | checking it, s | adding it, s | a look at the error, s |\n|---|---|---|---|---|")
    for width, height in SIZES:
        layout = Layout(width, height, (0, 0, width, height), RADIANCE)
        sums, expected = Sums(layout, {}), Expected("scene", RADIANCE, layout.shape)
        pixels = np.random.default_rng(0).random(layout.shape, np.float32)
        data = Range(0, 0, 16, "scene", RADIANCE, pixels).encode()
        checked = added = 0.0
        for index in range(RANGES):
            item = Range(index, index, 16, "scene", RADIANCE, pixels + np.float32(index)).encode()
            begin = time.thread_time()
            found = ranges.decode(item, Order("", "", index, index, 16, ""), expected)
            middle = time.thread_time()
            sums.put(found)
            sums.add_next()
            checked, added = checked + middle - begin, added + time.thread_time() - middle
        begin = time.thread_time()
        sums.error(1)
        look = time.thread_time() - begin
        each = f"{checked / RANGES:.3f} | {added / RANGES:.3f}"
        say(f"| {width} x {height} | {len(data) / 1e6:.1f} | {each} | {look:.2f} |")


def moving() -> None:
    os.environ["PYTHONPATH"] = str(ROOT)
    """Ranges without light, since what is rendered changes nothing of it."""
    say("| workers | scene, MB | ranges, MB | checking and adding, s | the farm's process, s |\n|---|---|---|---|---|")
    example = ROOT / "engine" / "examples"
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        document = json.loads((example / "glimmervoid_small.json").read_text())
        (folder / "scene.json").write_text(json.dumps({**document, "render": {"max_depth": 0}}))
        shutil.copy(example / "plates.npy", folder)
        options = FarmOptions(
            folder / "scene.json", samples=2 * MOVED_RANGES, range_samples=2, threads=1, wait_seconds=600
        )
        for workers in (1, 2, 4, 8):
            begin = time.process_time()
            with local_cluster(workers, folder) as client:
                report = Farm(client, options, say).run().report
            whole = time.process_time() - begin
            moved, seconds = report["bytes"], report["seconds"]
            sizes = f"{moved['scene'] / 1e6:.2f} | {moved['results'] / 1e6:.1f}"
            say(f"| {workers} | {sizes} | {seconds['check'] + seconds['merge']:.2f} | {whole:.1f} |")


if __name__ == "__main__":
    for name, measure in (("merge", merging), ("move", moving)):
        if name in (sys.argv[1:] or [name]):
            measure()
