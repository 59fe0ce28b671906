# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures error against CPU time: Glimmer's integrators, Cycles and others, on scenes of blend_scenes/ and variants.

`python3 build.py bench` runs this as `python -m tests.bench` from the root of the checkout.
"""

import argparse
import os
import re
import subprocess
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from tests.bench.errors import Picture, Point, Run, agreement, block_means, noise_of, relative_errors, worst_share
from tests.bench.renderers import (
    BenchError,
    CannotRenderError,
    Cycles,
    Glimmer,
    Peer,
    Stage,
    Task,
    set_stage,
    without_set_up,
)
from tests.bench.report import Entry, SceneResult, Setting, markdown
from tests.bench.scenes import SCENES, BenchScene

ROOT = Path(__file__).resolve().parents[2]
INTEGRATORS = ("path", "baseline")
PEERS = {"mitsuba": "mitsuba", "luxcore": "pyluxcore"}  # their packages
_REFERENCE_SEED = 1_000_000
_SINGLE_SEED = 10_000


@dataclass(frozen=True)
class Plan:
    size: tuple[int, int]
    levels: Mapping[str, tuple[int, ...]]  # samples a pixel, by renderer
    repetitions: int
    reference: int  # samples a pixel of each of the reference's runs
    reference_runs: int  # a multiple of 3: a third of them for each part


_MORE, _FEWER = (4, 16, 64, 256), (2, 8, 32, 128)
# On two quiet cores half an hour; with Mitsuba and LuxCore twice that.
FULL = Plan(
    (240, 135),
    {"path": (1, 4, 16, 64), "baseline": _MORE, "Cycles": _FEWER, "mitsuba": _MORE, "luxcore": _FEWER},
    4,
    64,
    9,
)
# Four minutes; with the two peers ten.
QUICK = Plan(
    (96, 54),
    {"path": (1, 4, 16, 64), "baseline": _FEWER, "Cycles": _FEWER, "mitsuba": _MORE, "luxcore": _FEWER},
    3,
    40,
    9,
)


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
    blocks = relative_errors(block_means(run.picture), [block_means(part) for part in parts])
    return Point(run.samples, run.cpu, run.wall, float(errors.mean()), float(blocks.mean()), worst_share(errors))


@dataclass(frozen=True)
class Renderers:
    glimmer: Path
    blender: Path
    with_cycles: bool
    peers: Sequence[Peer] = ()

    def names(self) -> list[str]:
        return [*INTEGRATORS, *(["Cycles"] if self.with_cycles else []), *(peer.name for peer in self.peers)]

    def runs(self, name: str, stage: Stage, plan: Plan) -> list[list[Run]]:
        """[repetition][level]"""
        fewer = 1 if name == "path" else stage.scene.fewer
        levels = [max(samples // fewer, 1) for samples in plan.levels[name]]
        wanted = [task for repetition in range(plan.repetitions) for task in tasks(levels, repetition)]
        if name in INTEGRATORS:
            return in_rows(Glimmer(self.glimmer, name).runs(stage, wanted), len(levels))
        singles = [Task(1, _SINGLE_SEED + repetition) for repetition in range(plan.repetitions)]
        others: list[Cycles | Peer] = [Cycles(self.blender), *self.peers]
        found = next(other for other in others if other.name == name).runs(stage, singles + wanted)
        return without_set_up(in_rows(found[len(singles) :], len(levels)), found[: len(singles)])


def in_rows(runs: Sequence[Run], length: int) -> list[list[Run]]:
    return [list(runs[start : start + length]) for start in range(0, len(runs), length)]


def measure(scene: BenchScene, plan: Plan, renderers: Renderers, folder: Path) -> tuple[SceneResult, str]:
    """The result and Blender's version. Leaves the scene and the runs in `folder`, and takes up what it finds there."""
    stage = set_stage(renderers.blender, scene, plan.size, folder)
    say(f"{scene.name}: reference")
    wanted = [Task(plan.reference, _REFERENCE_SEED + index) for index in range(plan.reference_runs)]
    reference = Glimmer(renderers.glimmer, "path").runs(stage, wanted)
    parts = thirds(reference)
    entries: dict[str, Entry] = {}
    cannot: dict[str, str] = {}
    for name in renderers.names():
        say(f"{scene.name}: {name}")
        try:
            rows = renderers.runs(name, stage, plan)
        except CannotRenderError as reason:
            cannot[name] = str(reason)
            continue
        every = [run for row in rows for run in row]
        set_ups = [run.set_up for run in every if run.set_up is not None]
        entries[name] = Entry(
            [[measured_point(run, parts) for run in row] for row in rows],
            agreement(every, reference),
            float(np.median(set_ups)),
            sum(run.invalid for run in every),
            max(run.peak_bytes for run in every),
        )
    samples = plan.reference * plan.reference_runs
    return SceneResult(scene.name, entries, samples, noise_of(parts), cannot), stage.blender


def revision() -> str:
    """The commit, and whether the engine or the add-on differ from it."""

    def git(*words: str) -> str:
        return subprocess.run(["git", *words], cwd=ROOT, capture_output=True, text=True, check=False).stdout.strip()

    commit = git("rev-parse", "--short=10", "HEAD")
    changed = git("status", "--porcelain", "--", "engine", "addon", "blend_scenes/*.blend")
    return f"commit {commit}{' with changes' if changed else ''}" if commit else "outside of git"


def peer_of(text: str) -> Peer:
    """NAME=PYTHON"""
    name, _, python = text.partition("=")
    if name not in PEERS or not python:
        raise argparse.ArgumentTypeError(f"{text}: must be NAME=PYTHON with one of {', '.join(PEERS)}")
    ask = f"import importlib.metadata; print(importlib.metadata.version({PEERS[name]!r}))"
    told = subprocess.run([python, "-c", ask], capture_output=True, text=True, check=False)
    if not re.fullmatch(r"[\w.+]+\n", told.stdout):
        raise argparse.ArgumentTypeError(f"{text}: no {PEERS[name]} there: {told.stderr[-500:]}")
    return Peer(name, Path(python), told.stdout.strip())


def scenes_of(text: str) -> list[BenchScene]:
    known = {scene.name: scene for scene in SCENES}
    names = text.split(",")
    unknown = [name for name in names if name not in known]
    if unknown:
        raise argparse.ArgumentTypeError(f"{', '.join(unknown)}: no such scene; there are {', '.join(known)}")
    return [known[name] for name in known if name in names]


def main(argv: Sequence[str]) -> int:
    parser = argparse.ArgumentParser(prog="python -m tests.bench", description=__doc__)
    parser.add_argument("--glimmer", type=Path, required=True)
    parser.add_argument("--blender", type=Path, required=True)
    parser.add_argument("--output", type=Path, required=True, metavar="FOLDER")
    parser.add_argument("--said", required=True, metavar="COMMAND", help="how the user started this, for the page")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--no-cycles", action="store_true")
    parser.add_argument("--scenes", type=scenes_of, default=list(SCENES))
    parser.add_argument("--peer", type=peer_of, action="append", default=[], metavar="NAME=PYTHON")
    given = parser.parse_args(argv)
    plan = QUICK if given.quick else FULL
    renderers = Renderers(given.glimmer, given.blender, not given.no_cycles, given.peer)
    before = os.getloadavg()[0]
    results, version = [], ""
    runs = ROOT / "build" / "bench" / "runs" / f"{plan.size[0]}x{plan.size[1]}"
    try:
        for scene in given.scenes:
            result, version = measure(scene, plan, renderers, runs / scene.name)
            results.append(result)
    except BenchError as error:
        sys.stderr.write(f"bench: {error}\n")
        return 1
    setting = Setting(
        given.said,
        Glimmer(given.glimmer, "path").version().removeprefix("glimmer "),
        revision(),
        ", ".join([f"Blender {version}", *(f"{peer.name} {peer.version}" for peer in given.peer)]),
        plan.size,
        plan.repetitions,
        (before, os.getloadavg()[0]),
    )
    from tests.bench.plot import write_plots  # matplotlib is not among what the tests need

    given.output.mkdir(parents=True, exist_ok=True)
    page = given.output / "README.md"
    page.write_text(markdown(results, setting))
    write_plots(results, given.output / "error_against_time")
    say(page.read_text())
    say(str(page))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
