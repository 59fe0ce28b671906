# SPDX-License-Identifier: GPL-3.0-or-later
"""The benchmark's result in words: one Markdown page."""

import os
import platform
import textwrap
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from tests.bench.errors import TESTS_PER_PAIR, Agreement, Point, TimeTo, fit, mean_points, time_to

LEVEL = 1e-3  # of one false alarm in the whole benchmark
TARGETS = (0.1, 0.01)
YARDSTICK = "path"


@dataclass(frozen=True)
class Entry:
    """One renderer on one scene."""

    points: list[list[Point]]  # [repetition][level]
    agreement: Agreement
    set_up: float | None  # CPU seconds before the first sample, where they had to be subtracted
    invalid: int = 0  # samples, of all runs


@dataclass(frozen=True)
class SceneResult:
    name: str
    entries: Mapping[str, Entry]  # by renderer
    reference_samples: int  # of all its runs together
    reference_error: float  # its own relMSE


@dataclass(frozen=True)
class Setting:
    command: str
    glimmer: str
    revision: str
    blender: str
    size: tuple[int, int]
    repetitions: int
    load: tuple[float, float]  # averages over a minute, before and after


def pairs(results: Sequence[SceneResult]) -> int:
    return sum(len(result.entries) for result in results)


def agrees(entry: Entry, results: Sequence[SceneResult]) -> bool:
    return entry.agreement.p >= LEVEL / (TESTS_PER_PAIR * pairs(results))


def processor() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        lines = []
    names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.processor() or platform.machine()


def _time(time: TimeTo | None, base: TimeTo | None) -> str:
    if time is None:
        return "no line fits"
    text = f"{'≤ ' if time.at_most else ''}{time.seconds:.3g} s{'*' if time.extrapolated else ''}"
    if time.factor > 1:
        text += f" (×/÷ {time.factor:.2f})"
    if base is not None:
        bound = {(True, False): "≤ ", (False, True): "≥ "}.get((time.at_most, base.at_most), "")
        text += f", {bound}**{time.seconds / base.seconds:.3g} ×**"
    return text


def _ranking(results: Sequence[SceneResult]) -> list[str]:
    lines = ["| scene | renderer | " + " | ".join(f"relMSE {t:g}" for t in TARGETS) + " | error falls as |"]
    lines.append("|---|---" + "|---" * len(TARGETS) + "|---|")
    for result in results:
        yardstick = result.entries[YARDSTICK]
        comparable = agrees(yardstick, results)
        for name, entry in result.entries.items():
            line = fit(mean_points(entry.points))
            cells = []
            for target in TARGETS:
                if not agrees(entry, results):
                    cells.append("not ranked: another picture")
                    continue
                base = time_to(yardstick.points, target) if comparable and name != YARDSTICK else None
                cells.append(_time(time_to(entry.points, target), base))
            power = f"t^-{line.power:.2f}" if line else "?"
            lines.append(f"| {result.name} | {name} | {' | '.join(cells)} | {power} |")
    return lines


def _checks(results: Sequence[SceneResult]) -> list[str]:
    lines = ["| scene | renderer | mean / reference | least p | same picture? |", "|---|---|---|---|---|"]
    for result in results:
        for name, entry in result.entries.items():
            found = entry.agreement
            verdict = "yes" if agrees(entry, results) else "**no**"
            lines.append(
                f"| {result.name} | {name} | {found.ratio:.4f} ± {found.error:.4f} | {found.p:.2g} | {verdict} |"
            )
    return lines


def _points(results: Sequence[SceneResult]) -> list[str]:
    lines = ["| scene | renderer | samples a pixel | CPU seconds | relMSE | worst 1 % |", "|---|---|---|---|---|---|"]
    for result in results:
        for name, entry in result.entries.items():
            for point in mean_points(entry.points):
                measured = f"{point.samples} | {point.cpu:.3f} | {point.error:.4g} | {point.worst:.0%}"
                lines.append(f"| {result.name} | {name} | {measured} |")
    return lines


def _set_up(results: Sequence[SceneResult]) -> list[str]:
    return [
        f"{name} on {result.name}: {entry.set_up:.2f} s"
        for result in results
        for name, entry in result.entries.items()
        if entry.set_up is not None
    ]


def _invalid(results: Sequence[SceneResult]) -> str:
    found = [
        f"{entry.invalid} of {name} on {result.name}"
        for result in results
        for name, entry in result.entries.items()
        if entry.invalid
    ]
    return ", ".join(found) or "none of Glimmer's; Cycles does not tell"


def _paragraph(text: str, indent: str = "") -> str:
    return textwrap.fill(text, 120, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False)


def _bullet(text: str) -> str:
    return _paragraph(f"- {text}", "  ")


def markdown(results: Sequence[SceneResult], setting: Setting) -> str:
    width, height = setting.size
    references = "; ".join(
        f"{r.name} {r.reference_samples} samples a pixel (own relMSE {r.reference_error:.2g})" for r in results
    )
    measured = (
        _bullet(
            f"{width} x {height} pixels, box filter, no limit on depth (Cycles: 1024 bounces of each kind), no clamp, "
            "no denoiser, no adaptive sampling. All read the same .blend; Glimmer's command line renders what the "
            "add-on exports from it."
        ),
        _bullet(
            "relMSE: the mean over pixels and channels of squared error / (mu^2 + (0.01 of the picture's mean)^2). "
            "Squared errors are products of the differences to two independent parts of a reference, mu is a third "
            "part: so the reference's own noise cancels."
        ),
        _bullet(
            f"Reference: Glimmer `path` with other seeds: {references}. Tests against closed forms check `path` "
            "itself; here the means of the others do."
        ),
        _bullet(f"{setting.repetitions} repetitions of every number of samples, each with a seed of its own."),
        _bullet(
            "CPU seconds: user + system of the render on all cores, without loading and building. For Glimmer as its "
            "`--report` tells. For Cycles from the resource usage of its process around each render: set-up is what "
            "renders of 1 sample take, less that sample; the longest render less set-up, shared out over its samples, "
            f"gives the time of fewer samples. Set-up: {'; '.join(_set_up(results)) or 'none'}."
        ),
        _bullet(
            "Cycles gets spheres as the meshes of the .blend, scaled to the sphere's area, and draws distances in fog "
            "by multiple importance sampling. In Blender before 3.5 it has no light tree, and it samples closed lights "
            "on their inner sides too; a newer one may do better."
        ),
        _bullet(f"Samples that were not finite or were broken off: {_invalid(results)}."),
    )
    page = [
        "# Error against run time",
        "",
        f"Made by `{setting.command}`.",
        "",
        "![Error against CPU seconds](error_against_time.png)",
        "",
        "## CPU seconds to an error, and as a multiple of `path`",
        "",
        *_ranking(results),
        "",
        _paragraph(
            "From a line through the measured points on logarithmic axes. ×/÷: the 95 % interval, by a jackknife over "
            f"the {setting.repetitions} repetitions; it knows nothing of what the line itself gets wrong. *: "
            "extrapolated, the target lies outside the errors that were measured. ≤: a single sample a pixel has a "
            "smaller error already."
        ),
        "",
        "## Do they show the same picture?",
        "",
        *_checks(results),
        "",
        _paragraph(
            "Means of 6 blocks and of the whole picture, by channel, against the reference, by Welch's t-test; whoever "
            f"falls below p = {LEVEL:g} / {TESTS_PER_PAIR * pairs(results)} (tests) is not ranked. The ± is one "
            "standard error of the whole: how small a difference could be seen."
        ),
        "",
        "## How it was measured",
        "",
        *measured,
        "",
        _paragraph(
            f"Glimmer {setting.glimmer}, {setting.revision}; {setting.blender}; {processor()}, {os.cpu_count()} cores; "
            f"{platform.system()} {platform.machine()}. Load average {setting.load[0]:.1f} before and "
            f"{setting.load[1]:.1f} after: trust ratios, not seconds."
        ),
        "",
        "## Measured points",
        "",
        _paragraph(
            "Means over the repetitions. The last column is the share of the relMSE that is the worst hundredth's of "
            "pixels and channels: where it is large, rare bright samples (fireflies) make the error, the line is "
            "uncertain and most of the picture is better than the relMSE says."
        ),
        "",
        *_points(results),
        "",
    ]
    return "\n".join(page)
