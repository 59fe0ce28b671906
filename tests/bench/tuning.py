# SPDX-License-Identifier: GPL-3.0-or-later
"""Varies one constant of the engine and prints what variance times CPU time becomes, against today's value.

`python3 build.py bench --tuning NAME` runs this with a build whose constants are read from the environment
(engine/src/base/tunable.h). Every value renders every scene with the same seeds, in turn, so that a machine's changing
load meets all of them. The variance is that over seeds, relative to the square of the mean; its product with the CPU
seconds is what a render of given error costs. Below 1, a value is better than today's.
"""

import argparse
import json
import os
import re
import subprocess
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from tests.bench.errors import Picture, block_means
from tests.bench.renderers import ROOT, BenchError, read_picture, set_stage
from tests.bench.scenes import SCENES

Costs = NDArray[np.float64]

HEADERS = (  # of engine/src
    "integrator/direct/tuning.h",
    "integrator/path/tuning.h",
    "integrator/roulette.h",
    "integrator/vpl/tuning.h",
)
SIZE = (96, 54)
SAMPLES = 4
BLOCK = 16
_DEFAULT_SCENES = ("moons_in_fog", "glimmervoid", "thick_fog")
_ROW = re.compile(r"GLIMMER_TUNABLE_CONSTANT\((float|double|uint32_t), (k\w+), (.+)\);")


@dataclass(frozen=True)
class Constant:
    name: str
    whole: bool  # an integer
    today: float

    def values(self) -> tuple[float, ...]:
        """Half of today's value and twice it; half way to 1 for a share that would reach it."""
        low, high = self.today / 2, self.today * 2
        if 0.5 <= abs(self.today) < 1:
            high = (self.today + np.sign(self.today)) / 2
        return (max(1, round(low)), round(high)) if self.whole else (low, high)


def number(text: str) -> float:
    """A C++ literal, or a shift of two."""
    one, *bits = text.replace("u", "").split("<<")
    return float(int(one) << int(bits[0])) if bits else float(one.rstrip("f"))


def constants() -> dict[str, Constant]:
    """All that can be varied, by name."""
    texts = [(ROOT / "engine" / "src" / header).read_text() for header in HEADERS]
    rows = [row for text in texts for row in _ROW.findall(text)]
    return {name: Constant(name, kind == "uint32_t", number(value)) for kind, name, value in rows}


def render(glimmer: Path, scene: Path, folder: Path, seed: int, variables: Mapping[str, str]) -> tuple[float, Picture]:
    """CPU seconds of the render alone, and the picture."""
    picture, report = folder / "picture.exr", folder / "report.json"
    command: list[str | Path] = [
        glimmer,
        scene,
        "-o",
        picture,
        "--report",
        report,
        "--quiet",
        "--spp",
        str(SAMPLES),
        "--seed",
        str(seed),
    ]
    done = subprocess.run(command, env={**os.environ, **variables}, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise BenchError(f"exit status {done.returncode} from {glimmer}:\n{done.stderr[-3000:]}")
    return json.loads(report.read_text())["seconds"]["cpu"], read_picture(picture)


def cost(runs: Sequence[tuple[float, Picture]], size: int) -> float:
    """Variance of the means of blocks of that many pixels, relative to their squared mean, times CPU seconds a run."""
    pictures = np.stack([block_means(picture, size) for _, picture in runs]).astype(np.float64)
    mean = pictures.mean(axis=0)
    variance = pictures.var(axis=0, ddof=1) / (mean**2 + (0.01 * mean.mean()) ** 2)
    return float(variance.mean() * np.mean([seconds for seconds, _ in runs]))


def ratio(tried: Sequence[tuple[float, Picture]], today: Sequence[tuple[float, Picture]], size: int) -> str:
    """Of the costs, with a standard error by leaving out one seed at a time."""
    whole = cost(tried, size) / cost(today, size)
    n = len(today)
    parts = [cost([*tried[:i], *tried[i + 1 :]], size) / cost([*today[:i], *today[i + 1 :]], size) for i in range(n)]
    error = np.sqrt((n - 1) / n * np.sum((np.array(parts) - np.mean(parts)) ** 2))
    return f"{whole:6.2f} ± {error:.2f}"


def main(argv: Sequence[str]) -> int:
    parser = argparse.ArgumentParser(prog="build.py bench --tuning", description=__doc__)
    parser.add_argument("name")
    parser.add_argument("--values", help="in place of half of today's and twice it: NUMBER,...")
    parser.add_argument("--scenes", default=",".join(_DEFAULT_SCENES))
    parser.add_argument("--seeds", type=int, default=8)
    parser.add_argument("--glimmer", type=Path, required=True)
    parser.add_argument("--blender", type=Path, required=True)
    parser.add_argument("--output", type=Path, required=True)
    given = parser.parse_args(argv)
    known = constants()
    if given.name not in known:
        parser.error(f"{given.name}: must be one of {', '.join(known)}")
    constant = known[given.name]
    values = [float(word) for word in given.values.split(",")] if given.values else constant.values()
    by_name = {scene.name: scene for scene in SCENES}
    for name in given.scenes.split(","):
        if name not in by_name:
            parser.error(f"scene {name}: must be of {', '.join(by_name)}")
        folder = given.output / name
        stage = set_stage(given.blender, by_name[name], SIZE, folder)
        runs: dict[float, list[tuple[float, Picture]]] = {value: [] for value in (constant.today, *values)}
        for seed in range(1, given.seeds + 1):
            for value, finished in runs.items():
                variables = {f"GLIMMER_{constant.name}": f"{value:.9g}"}
                finished.append(render(given.glimmer, stage.export, folder, seed, variables))
        for value in values:
            pixels, blocks = (ratio(runs[value], runs[constant.today], size) for size in (1, BLOCK))
            sys.stdout.write(
                f"{name}: {constant.name} {value:g} in place of {constant.today:g}: variance x CPU time"
                f" {pixels} of pixels, {blocks} of blocks\n"
            )
            sys.stdout.flush()
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except BenchError as error:
        sys.exit(str(error))
