# SPDX-License-Identifier: GPL-3.0-or-later
"""Cases of the suite that Cycles can express, as it renders them."""

import json
import subprocess
from collections.abc import Sequence
from dataclasses import dataclass, fields, is_dataclass
from pathlib import Path
from typing import Any

import numpy as np
import OpenImageIO
from numpy.typing import NDArray
from scipy import stats

from tests.check.case import Case
from tests.check.run import run
from tests.check.suite import every_case
from tests.render.statistics import LEVEL

_SCRIPT = Path(__file__).with_name("inside_cycles.py")
SEEDS, TIMEOUT = 24, 3600.0
ROUNDING = 2e-3
"""Relative: a ball of 1280 faces for a sphere, and the arithmetic of a renderer that is not ours."""


class CyclesError(Exception):
    """Why there is no result, in words."""


@dataclass(frozen=True)
class Choice:
    case: str
    lamps: bool = False
    """Balls of light are Blender's point lamps with a radius, which cameras do not see; else meshes that shine."""
    samples: int = 64


CHOICES = (
    Choice("sphere light overhead"),
    Choice("sphere light of R/d 0.0001", lamps=True),
    Choice("sphere light of R/d 1e-06", lamps=True),
    Choice("sphere light clipped, centre above the horizon"),
    Choice("sphere light of radiance 1e-30"),
    Choice("sphere light of radiance 1e30"),
    Choice("light seen at 10000 radii"),
    Choice("point light at 1e-06"),
    Choice("glass sphere of index 1.5"),
    Choice("glass mesh of index 10"),
    Choice("white plates face to face, 0.01 of their size apart"),
    Choice("mirror corridor, 20 bounces"),
    Choice("mirror corridor, 200 bounces"),
    Choice("box of albedo 0.999 that shines", samples=16),
    Choice("integrating sphere of albedo 0.999, a light 0.3 as wide in it", samples=16),
    Choice("metal of alpha 0.001 at mu 0.5"),
    Choice("metal of alpha 0.001 at mu 0.01"),
    Choice("glass slab 1 thin at 45 degrees"),
    Choice("glass slab 0.0001 thin at 80 degrees"),
    Choice("absorption of depth 1"),
    Choice("absorption of depth 50"),
    Choice("absorption of depth 100"),
    Choice("scattered once, sigma 1e-08"),
    Choice("scattered once, g 0.99"),
    Choice("scattered once in dense fog, light of radius 0.001", lamps=True),
    Choice("furnace of white fog, 1 deep"),
    Choice("furnace of white fog, 30 deep", samples=16),
    Choice("furnace of white fog, 100 deep", samples=8),
    Choice("furnace of white fog, 1000 deep", samples=2),
    Choice("furnace of white fog, three decades of colour"),
    Choice("white bodies, scaled by 1e-06"),
    Choice("white bodies, scaled by 1e+09"),
    Choice("white bodies, moved by 1000"),
    Choice("white bodies, moved by 100000"),
    Choice("a glass slab, moved by 100000"),
    Choice("fog, moved by 1000"),
    Choice("fog, moved by 100000"),
    Choice("a lit plate of size 1 seen from 10000"),
    Choice("coincident quads"),
    Choice("needle triangles, 2e-6 by 2e-3"),
    Choice("camera on a plate"),
    Choice("rays along an edge"),
    Choice("a sealed box beside a light of 1e12"),
)


@dataclass(frozen=True)
class Side:
    """What one renderer gave, of its number that is furthest off."""

    expected: float
    measured: float | None
    half_width: float | None
    right: bool | None
    """None: the interval is too wide to tell."""


@dataclass(frozen=True)
class Row:
    choice: Choice
    ours: Side
    cycles: Side


@dataclass(frozen=True)
class Setting:
    command: str
    glimmer: str
    blender: str
    settings: dict[str, Any]


def plain(value: Any) -> Any:
    """Dataclasses as objects with their class's name, arrays as lists."""
    if is_dataclass(value):
        return {"is": type(value).__name__, **{f.name: plain(getattr(value, f.name)) for f in fields(value)}}
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    return value


def _read(path: Path) -> NDArray[np.float64]:
    """The picture's mean, (3)."""
    file = OpenImageIO.ImageInput.open(str(path))
    if file is None:
        raise CyclesError(f"{path}: {OpenImageIO.geterror()}")
    try:
        pixels = np.asarray(file.read_image(OpenImageIO.FLOAT), np.float64)
    finally:
        file.close()
    mean: NDArray[np.float64] = pixels[..., :3].mean(axis=(0, 1))
    return mean


def chosen_case(choice: Choice) -> Case:
    return next(case for case in every_case() if case.name == choice.case)


def render(blender: Path, choices: Sequence[Choice], folder: Path) -> tuple[list[NDArray[np.float64]], dict[str, Any]]:
    """(seeds, 3) means of pictures for each choice, and what Blender told."""
    folder.mkdir(parents=True, exist_ok=True)
    job, result = folder / "job.json", folder / "result.json"
    result.unlink(missing_ok=True)
    scenes = []
    for choice in choices:
        case = chosen_case(choice)
        assert case.scene is not None
        scenes.append(
            {
                "name": choice.case,
                "scene": plain(case.scene()),
                "lamps": choice.lamps,
                "samples": choice.samples,
                "max_scatter": case.max_scatter,
            }
        )
    job.write_text(json.dumps({"scenes": scenes, "seeds": SEEDS, "folder": str(folder), "result": str(result)}))
    words = [blender, "-b", "--factory-startup", "--python-exit-code", "1", "--python", _SCRIPT, "--", job]
    done = subprocess.run(list(map(str, words)), capture_output=True, text=True, check=False, timeout=TIMEOUT)
    if done.returncode != 0 or not result.exists():
        raise CyclesError(f"exit status {done.returncode} from {blender}:\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    told: dict[str, Any] = json.loads(result.read_text())
    means = [np.array([_read(folder / f"{n}_{seed}.exr") for seed in range(SEEDS)]) for n in range(len(choices))]
    return means, told


def judge(case: Case, means: NDArray[np.float64], level: float) -> Side:
    """means: (seeds, 3)."""
    expected = np.broadcast_to(np.asarray(case.expected, np.float64), 3)
    if not np.isfinite(means).all():
        return Side(float(expected[0]), None, None, False)
    mean, error = means.mean(axis=0), means.std(axis=0, ddof=1) / np.sqrt(len(means))
    half = stats.t.isf(level / 2, len(means) - 1) * error
    off, slack = np.abs(mean - expected), half + max(case.rounding, ROUNDING) * np.abs(expected)
    worst = int(np.argmax(off / np.maximum(slack, 1e-300)))
    right: bool | None = bool((off <= slack).all())
    # As in the suite: what would not see an error of 10 % shows nothing.
    if right and (half > max(case.within, 0.1) * np.abs(expected)).any():
        right = None
    return Side(float(expected[worst]), float(mean[worst]), float(half[worst]), right)


def compare(blender: Path, choices: Sequence[Choice], folder: Path) -> tuple[list[Row], dict[str, Any]]:
    """Both renderers on each choice."""
    level = LEVEL / (3 * len(choices))
    means, told = render(blender, choices, folder)
    rows = []
    for choice, pictures in zip(choices, means, strict=True):
        case = chosen_case(choice)
        result = run(case, "path", 3 * len(choices))
        right = {"passes": True, "no evidence": None}.get(result.verdict, False)
        ours = Side(result.expected, result.measured, result.half_width, right)
        rows.append(Row(choice, ours, judge(case, pictures, level)))
    return rows, told


# ---- The page ------------------------------------------------------------------------------------------------------


def _share(side: Side) -> str:
    """Measured over expected."""
    if side.measured is None or side.half_width is None:
        return "**not finite**"
    if side.expected == 0:
        text = f"{side.measured:.3g}"
    else:
        text = f"{side.measured / side.expected:.4g}"
        half = side.half_width / abs(side.expected)
        text += f" ± {half:.1g}" if half > 5e-7 else ""
    return {True: text, False: f"**{text}**", None: f"{text} ?"}[side.right]


def table(rows: Sequence[Row]) -> list[str]:
    lines = ["| case | expected | Glimmer | Cycles |", "|---|---|---|---|"]
    for row in rows:
        what = "0" if row.cycles.expected == 0 else f"{row.cycles.expected:.4g}"
        lines.append(f"| {row.choice.case} | {what} | {_share(row.ours)} | {_share(row.cycles)} |")
    return lines


def markdown(rows: Sequence[Row], setting: Setting) -> str:
    def count(side: str, right: bool | None) -> int:
        return sum(getattr(row, side).right is right for row in rows)

    settings = ", ".join(f"{name} {value}" for name, value in setting.settings.items() if name != "samples")
    lamps = ", ".join(row.choice.case for row in rows if row.choice.lamps)
    lines = [
        "# Stiff and extreme scenes, in Glimmer and in Cycles",
        "",
        f"Made by `{setting.command}`, with {setting.glimmer} (`path`) and Cycles of Blender {setting.blender}. Of"
        f" {len(rows)} scenes Glimmer is right on {count('ours', True)} and Cycles on {count('cycles', True)}"
        f" ({count('cycles', None)} more it leaves too noisy to tell).",
        "",
        "What was measured over what is expected (where 0 is expected: what was measured), of the colour channel that"
        " is furthest off, with the half-width of its interval; bold: wrong beyond it, ?: too noisy to tell. Both"
        " render the suite's own scenes, whose answers come from formulas (`tests/check`). The expected number is of"
        " Cycles' channel.",
        "",
        *table(rows),
        "",
        f"Cycles: means over {SEEDS} seeds of 2 to 64 samples a pixel; {settings}; where single scattering alone is"
        " asked for, volume_bounces 0. It takes no more bounces than that. Spheres are closed meshes of 1280 faces and"
        f" of the sphere's area, for which and for other arithmetic {ROUNDING:g} is allowed; balls of light are point"
        f" lamps of that radius in: {lamps}. The camera clips at 1e-6, the least that Blender takes. Intervals by"
        f" Student's t at a level of {LEVEL:g} for the whole table.",
        "",
        "Blender holds coordinates in float32: of the moved scenes there are only those that survive that, and where"
        " Cycles is off in one of them its own meshes may be what was rounded.",
    ]
    return "\n".join(lines) + "\n"
