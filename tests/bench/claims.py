# SPDX-License-Identifier: GPL-3.0-or-later
"""What renders say of their error against the error that they made: the figures of engine/cli/SCENE_FORMAT.md.

`python3 build.py claims` runs this. Many short renders of a scene, each against the mean of all others; finished ones
are kept, as the benchmark's are.
"""

import argparse
import json
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from tests.bench.renderers import ROOT, Glimmer, Task, read_picture, set_stage
from tests.bench.scenes import SCENES
from tests.bench.store import picture_of

Array = NDArray[np.float64]

SIZE = (64, 36)
NAMES = ("moons_in_fog", "glimmervoid", "clearing")
LOOKS = (16, 32, 64)  # samples a pixel at which a render may stop
_FIRST_SEED = 1
_QUANTILE = float(stats.t.isf(0.025, 7))  # of eight replicates


@dataclass(frozen=True)
class Claim:
    relmse: float
    low: float
    high: float | None
    certified: bool
    picture: Array  # (height, width, 3)
    stderr: Array


def read_claim(room: Path, task: Task) -> Claim:
    picture = picture_of(room, task.samples, task.seed)
    parts = [read_picture(picture, layer).astype(np.float64) for layer in ("", "stderr.")]
    report = picture.with_suffix(".report.json")
    error: dict[str, Any] = json.loads(report.read_text())["error"]
    return Claim(error["relmse"], error["low"], error["high"], error["tails"]["certifiable"], *parts)


def errors_made(claims: Sequence[Claim], last: Sequence[Claim], samples: int) -> Array:
    """relMSE of each picture, against the mean of all other seeds' at the last look; its noise is subtracted."""
    finals = np.stack([c.picture for c in last])
    mean = finals.mean(axis=0)
    scale = mean**2 + 1e-4 * mean.mean() ** 2
    count = len(finals)
    noise = 1 / (1 + samples / LOOKS[-1] / (count - 1))
    others = [(finals.sum(axis=0) - final) / (count - 1) for final in finals]
    return np.array([noise * ((c.picture - o) ** 2 / scale).mean() for c, o in zip(claims, others, strict=True)])


def held(claims: Sequence[Claim], errors: Array) -> list[bool]:
    return [c.low <= error <= (np.inf if c.high is None else c.high) for c, error in zip(claims, errors, strict=True)]


def pixels(last: Sequence[Claim]) -> tuple[float, float, float]:
    """Squared standard errors over squared errors, the share of values whose interval holds the truth, and the share of
    the others that are too dark.
    """
    total = np.sum([c.picture for c in last], axis=0)
    count = len(last)
    claimed = made = inside = below = 0.0
    for c in last:
        wrong = c.picture - (total - c.picture) / (count - 1)
        missed = np.abs(wrong) > _QUANTILE * c.stderr
        made += (wrong**2).mean() * (count - 1) / count / count
        claimed += (c.stderr**2).mean() / count
        inside += (1 - missed.mean()) / count
        below += (missed & (wrong < 0)).sum() / max(missed.sum(), 1) / count
    return claimed / made, inside, below


def main(argv: Sequence[str]) -> int:
    parser = argparse.ArgumentParser(prog="build.py claims", description=__doc__)
    parser.add_argument("--glimmer", type=Path, required=True)
    parser.add_argument("--blender", type=Path, required=True)
    parser.add_argument("--seeds", type=int, required=True)
    given = parser.parse_args(argv)
    if given.seeds < 2:
        parser.error(f"--seeds {given.seeds}: at least 2, since each render is compared with the mean of the others")
    sys.stdout.write("| scene, integrator | error made | relmse | interval | certified | held | held, certified |\n")
    for scene in (scene for scene in SCENES if scene.name in NAMES):
        stage = set_stage(given.blender, scene, SIZE, ROOT / "build" / "bench" / "claims" / scene.name)
        for integrator in ("path", "baseline"):
            glimmer = Glimmer(given.glimmer, integrator)
            tasks = {n: [Task(n, _FIRST_SEED + seed) for seed in range(given.seeds)] for n in LOOKS}
            for wanted in tasks.values():
                glimmer.runs(stage, wanted)
            looks = {n: [read_claim(glimmer.room(stage), task) for task in wanted] for n, wanted in tasks.items()}
            last = looks[LOOKS[-1]]
            for samples, claims in looks.items():
                errors = errors_made(claims, last, samples)
                good = held(claims, errors)
                sure = [ok for ok, c in zip(good, claims, strict=True) if c.certified]
                middle = [
                    float(np.median([np.inf if v is None else v for v in column]))
                    for column in zip(*((c.relmse, c.low, c.high) for c in claims), strict=True)
                ]
                sys.stdout.write(
                    f"| {scene.name}, {integrator}, {samples} | {np.median(errors):.2g} | {middle[0]:.2g} "
                    f"| {middle[1]:.2g} to {middle[2]:.2g} | {len(sure)} of {len(good)} | {sum(good)} "
                    f"| {sum(sure)} of {len(sure)} | mean error {errors.mean():.2g}, mean relmse "
                    f"{np.mean([c.relmse for c in claims]):.2g} |\n"
                )
            ratio, inside, below = pixels(last)
            sys.stdout.write(
                f"  stderr^2 {ratio:.3f} of the squared errors; {inside:.1%} inside; {below:.0%} of misses too dark\n"
            )
            sys.stdout.flush()
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
