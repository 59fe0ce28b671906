# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures error against CPU time: Glimmer's integrators and Cycles, on scenes of blend_scenes/.

`python3 build.py bench` runs this as `python -m tests.bench` from the root of the checkout.
"""

import argparse
import os
import shutil
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from tests.bench.errors import Picture, Point, Run, agreement, noise_of, relative_errors, worst_share
from tests.bench.renderers import (
    BenchError,
    FromBlender,
    Glimmer,
    Task,
    set_up_seconds,
    through_blender,
    without_set_up,
)
from tests.bench.report import Entry, SceneResult, Setting, markdown

ROOT = Path(__file__).resolve().parents[2]
SCENES = ("moons_in_fog", "glimmervoid", "clearing")
_REFERENCE_SEED = 1_000_000


@dataclass(frozen=True)
class Plan:
    size: tuple[int, int]
    levels: dict[str, tuple[int, ...]]  # samples a pixel, by renderer
    repetitions: int
    reference: int  # samples a pixel of each of the reference's runs
    reference_runs: int  # a multiple of 3: a third of them for each part


FULL = Plan((240, 135), {"path": (1, 4, 16, 64), "report": (4, 16, 64, 256), "Cycles": (4, 16, 64, 256)}, 4, 64, 9)
# About three CPU minutes.
QUICK = Plan((96, 54), {"path": (1, 4, 16, 64), "report": (4, 16, 64, 256), "Cycles": (2, 8, 32, 128)}, 3, 48, 9)


def say(text: str) -> None:
    sys.stdout.write(text + "\n")
    sys.stdout.flush()


def tasks(levels: Sequence[int], repetition: int) -> list[Task]:
    """No seed twice: a short run with the seed of a long one would be its beginning."""
    return [Task(samples, 1 + index + len(levels) * repetition) for index, samples in enumerate(levels)]


def thirds(reference: Sequence[Run]) -> list[Picture]:
    size = len(reference) // 3
    return [np.mean([run.picture for run in reference[start : start + size]], axis=0) for start in (0, size, 2 * size)]


def measured_point(run: Run, parts: Sequence[Picture]) -> Point:
    errors = relative_errors(run.picture, parts)
    return Point(run.samples, run.cpu, float(errors.mean()), worst_share(errors))


def cycles_runs(told: FromBlender, plan: Plan) -> tuple[list[list[Run]], float]:
    """[repetition][level] without set-up, and the set-up; `told.cycles` starts with the renders of one sample."""
    levels = len(plan.levels["Cycles"])
    singles, rest = told.cycles[: plan.repetitions], told.cycles[plan.repetitions :]
    rows = [rest[start : start + levels] for start in range(0, len(rest), levels)]
    set_up = set_up_seconds(singles, [max(row, key=lambda run: run.samples) for row in rows])
    return [without_set_up(row, set_up) for row in rows], set_up


def measure(
    name: str, plan: Plan, glimmer: Glimmer, blender: Path, with_cycles: bool, folder: Path
) -> tuple[SceneResult, str]:
    """The result and Blender's version. Leaves the scene, the pictures and their reports in `folder`."""
    shutil.rmtree(folder, ignore_errors=True)
    wanted: list[Task] = []
    if with_cycles:
        wanted += [Task(1, 10_000 + repetition) for repetition in range(plan.repetitions)]
        for repetition in range(plan.repetitions):
            wanted += tasks(plan.levels["Cycles"], repetition)
        say(f"{name}: Cycles")
    told = through_blender(blender, ROOT / "blend_scenes" / f"{name}.blend", plan.size, folder, wanted)
    runs: dict[str, tuple[list[list[Run]], float | None]] = {}
    for integrator in ("path", "report"):
        say(f"{name}: {integrator}")
        rows = [
            [glimmer.render(told.scene, integrator, task) for task in tasks(plan.levels[integrator], repetition)]
            for repetition in range(plan.repetitions)
        ]
        runs[integrator] = rows, None
    if with_cycles:
        runs["Cycles"] = cycles_runs(told, plan)
    say(f"{name}: reference")
    reference = [
        glimmer.render(told.scene, "path", Task(plan.reference, _REFERENCE_SEED + index))
        for index in range(plan.reference_runs)
    ]
    parts = thirds(reference)
    entries = {}
    for renderer, (rows, set_up) in runs.items():
        points = [[measured_point(run, parts) for run in row] for row in rows]
        every = [run for row in rows for run in row]
        entries[renderer] = Entry(points, agreement(every, reference), set_up, sum(run.invalid for run in every))
    return SceneResult(name, entries, plan.reference * plan.reference_runs, noise_of(parts)), told.version


def revision() -> str:
    """The commit, and whether the engine or the add-on differ from it."""

    def git(*words: str) -> str:
        return subprocess.run(["git", *words], cwd=ROOT, capture_output=True, text=True, check=False).stdout.strip()

    commit = git("rev-parse", "--short=10", "HEAD")
    changed = git("status", "--porcelain", "--", "engine", "addon", "blend_scenes/*.blend")
    return f"commit {commit}{' with changes' if changed else ''}" if commit else "outside of git"


def main(argv: Sequence[str]) -> int:
    parser = argparse.ArgumentParser(prog="python -m tests.bench", description=__doc__)
    parser.add_argument("--glimmer", type=Path, required=True)
    parser.add_argument("--blender", type=Path, required=True)
    parser.add_argument("--output", type=Path, required=True, metavar="FOLDER")
    parser.add_argument("--said", required=True, metavar="COMMAND", help="how the user started this, for the page")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--no-cycles", action="store_true")
    given = parser.parse_args(argv)
    plan = QUICK if given.quick else FULL
    glimmer = Glimmer(given.glimmer)
    before = os.getloadavg()[0]
    results, version = [], ""
    try:
        for name in SCENES:
            folder = ROOT / "build" / "bench" / name
            result, version = measure(name, plan, glimmer, given.blender, not given.no_cycles, folder)
            results.append(result)
    except BenchError as error:
        sys.stderr.write(f"bench: {error}\n")
        return 1
    setting = Setting(
        given.said,
        glimmer.version().removeprefix("glimmer "),
        revision(),
        f"Blender {version}",
        plan.size,
        plan.repetitions,
        (before, os.getloadavg()[0]),
    )
    from tests.bench.plot import write_plot  # matplotlib is not among what the tests need

    given.output.mkdir(parents=True, exist_ok=True)
    page = given.output / "README.md"
    page.write_text(markdown(results, setting))
    write_plot(results, given.output / "error_against_time.png")
    say(page.read_text())
    say(str(page))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
