# SPDX-License-Identifier: GPL-3.0-or-later
"""The benchmark's result in words: one Markdown page."""

import os
import platform
import textwrap
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from tests.bench.errors import TESTS_PER_PAIR, Agreement, Point, TimeTo, fit, mean_points, time_to
from tests.bench.scenes import SCENES

LEVEL = 1e-3  # of one false alarm in the whole benchmark
TARGETS = (0.1, 0.01, 0.001)
BLOCK_TARGETS = (0.001, 0.0001)
YARDSTICK = "path"


@dataclass(frozen=True)
class Entry:
    """One renderer on one scene."""

    points: list[list[Point]]  # [repetition][level]
    agreement: Agreement
    set_up: float  # seconds before the first sample
    invalid: int = 0  # samples, of all runs
    peak_bytes: int = 0  # resident, of the whole process, the most of all runs


@dataclass(frozen=True)
class SceneResult:
    name: str
    entries: Mapping[str, Entry]  # by renderer
    reference_samples: int  # of all its runs together
    reference_error: float  # its own relMSE
    cannot: Mapping[str, str] = field(default_factory=dict)  # why a renderer cannot render the scene, by renderer


@dataclass(frozen=True)
class Setting:
    command: str
    glimmer: str
    revision: str
    others: str  # versions of the other renderers
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


def _ranking(results: Sequence[SceneResult], targets: Sequence[float], kind: str) -> list[str]:
    """A table of times to errors by pixel (kind "error") or by block ("block")."""
    name = "relMSE" if kind == "error" else "block relMSE"
    lines = ["| scene | renderer | " + " | ".join(f"{name} {t:g}" for t in targets) + " | error falls as |"]
    lines.append("|---|---" + "|---" * len(targets) + "|---|")
    for result in results:
        yardstick = result.entries[YARDSTICK]
        comparable = agrees(yardstick, results)
        for renderer, entry in result.entries.items():
            line = fit(mean_points(entry.points), kind)
            cells = []
            for target in targets:
                if not agrees(entry, results):
                    cells.append("not ranked: another picture")
                    continue
                base = time_to(yardstick.points, target, kind) if comparable and renderer != YARDSTICK else None
                cells.append(_time(time_to(entry.points, target, kind), base))
            power = f"t^-{line.power:.2f}" if line else "?"
            lines.append(f"| {result.name} | {renderer} | {' | '.join(cells)} | {power} |")
        for renderer, reason in result.cannot.items():
            lines.append(
                f"| {result.name} | {renderer} | {' | '.join([f'cannot render it: {reason}'] * len(targets))} | |"
            )
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
    lines = ["| scene | renderer | samples a pixel | CPU seconds | wall seconds | relMSE | worst 1 % | block relMSE |"]
    lines.append("|---" * 8 + "|")
    for result in results:
        for name, entry in result.entries.items():
            for point in mean_points(entry.points):
                times = f"{point.samples:.0f} | {point.cpu:.3f} | {point.wall:.3f}"
                errors = f"{point.error:.4g} | {point.worst:.0%} | {point.block:.3g}"
                lines.append(f"| {result.name} | {name} | {times} | {errors} |")
    return lines


def _costs(results: Sequence[SceneResult]) -> list[str]:
    lines = ["| scene | renderer | set-up, seconds | peak memory, MB |", "|---|---|---|---|"]
    for result in results:
        for name, entry in result.entries.items():
            lines.append(f"| {result.name} | {name} | {entry.set_up:.2f} | {entry.peak_bytes / 1e6:.0f} |")
    return lines


def _invalid(results: Sequence[SceneResult]) -> str:
    found = [
        f"{entry.invalid} of {name} on {result.name}"
        for result in results
        for name, entry in result.entries.items()
        if entry.invalid
    ]
    return ", ".join(found) or "none of Glimmer's; the others do not tell"


def _paragraph(text: str, indent: str = "") -> str:
    return textwrap.fill(text, 120, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False)


def _bullet(text: str) -> str:
    return _paragraph(f"- {text}", "  ")


def _about_peers(results: Sequence[SceneResult]) -> list[str]:
    names = {name for result in results for name in (*result.entries, *result.cannot)}
    about = {
        "mitsuba": "Mitsuba (llvm_ad_rgb): `path`, or `volpath` in fog, no limit on depth, its own roulette. Its "
        "GGX masks separably (Glimmer's height-correlated). It gets the plates as one mesh, as it compiles code for "
        "each instance; its set-up reads that, builds and compiles.",
        "luxcore": "LuxCore: PATHCPU with Sobol samples, 1024 bounces of each kind. Spheres are meshes of 2048 quads "
        "scaled to the sphere's area. Its metal has another masking, and a Fresnel factor that falls towards grazing "
        "(fresnelcolor): plates come out darker, by a tenth at grazing. Metals of reflectance 1 and 0 mixed with black "
        "would have a constant one, and agree without fog at an alpha of 0.02; but in fog LuxCore draws the distance "
        "and the part of a mixture by one random number, and the same plates are up to 16 % too bright.",
    }
    return [_bullet(text) for name, text in about.items() if name in names]


def markdown(results: Sequence[SceneResult], setting: Setting) -> str:
    width, height = setting.size
    references = "; ".join(
        f"{r.name} {r.reference_samples} samples a pixel (own relMSE {r.reference_error:.2g})" for r in results
    )
    measured = (
        _bullet(
            f"{width} x {height} pixels, box filter, no limit on depth (Cycles: 1024 bounces of each kind), no clamp, "
            "no denoiser, no adaptive sampling. Cycles reads the .blend, all others what the add-on exports from it."
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
        _bullet(
            "Plates have facets instead of smooth normals. Where a reflection off a smooth normal goes below the true "
            "surface, Glimmer drops it and Cycles bends the normal until it does not: with them, Cycles' picture of "
            "smooth_metal is 0.3 % brighter as a whole and 1 to 4 % in one sixth of it; with facets it is not."
        ),
        *(_bullet(f"{scene.name}: {scene.what}.") for scene in SCENES if scene.name in {r.name for r in results}),
        _bullet(f"{setting.repetitions} repetitions of every number of samples, each with a seed of its own."),
        _bullet(
            "CPU seconds: user + system of the render on all cores, without loading and building. For Glimmer as its "
            "`--report` tells, for the others from the resource usage of their process around each render: set-up "
            "is there what renders of 1 sample take, less that sample; the longest render less set-up, shared out over "
            "its samples, gives the time of fewer samples."
        ),
        _bullet(
            "Cycles gets spheres as the meshes of the .blend, scaled to the sphere's area, and draws distances in fog "
            "by multiple importance sampling. In Blender before 3.5 it has no light tree, and it samples closed lights "
            "on their inner sides too; a newer one may do better."
        ),
        *_about_peers(results),
        _bullet(f"Samples that were not finite or were broken off: {_invalid(results)}."),
    )
    page = [
        "# Error against run time",
        "",
        f"Made by `{setting.command}`.",
        "",
        "![Error against CPU seconds](error_against_time.png)",
        "",
        "([The same as SVG](error_against_time.svg).)",
        "",
        "## CPU seconds to an error, and as a multiple of `path`",
        "",
        *_ranking(results, TARGETS, "error"),
        "",
        _paragraph(
            "From a line through the measured points on logarithmic axes. ×/÷: the 95 % interval, by a jackknife over "
            f"the {setting.repetitions} repetitions; it knows nothing of what the line itself gets wrong. *: "
            "extrapolated, the target lies outside the errors that were measured. ≤: a single sample a pixel has a "
            "smaller error already."
        ),
        "",
        "## The same for what the eye sees from afar",
        "",
        *_ranking(results, BLOCK_TARGETS, "block"),
        "",
        _paragraph(
            "relMSE of the means of blocks of 32 x 32 pixels. `path` shares light paths among pixels, so their errors "
            "are not independent, and averaging them gains less than it does with the others."
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
        "## Before the first sample, and memory",
        "",
        *_costs(results),
        "",
        _paragraph(
            "Set-up: loading and building, and compiling where that is done; wall seconds for Glimmer, CPU seconds for "
            "the others. Memory: the most that the whole process had resident, in Cycles' case with all of Blender."
        ),
        "",
        "## How it was measured",
        "",
        *measured,
        "",
        _paragraph(
            f"Glimmer {setting.glimmer}, {setting.revision}; {setting.others}; {processor()}, {os.cpu_count()} cores; "
            f"{platform.system()} {platform.machine()}. Load average {setting.load[0]:.1f} before and "
            f"{setting.load[1]:.1f} after: trust ratios, not seconds."
        ),
        "",
        "## Measured points",
        "",
        _paragraph(
            "Means over the repetitions, medians of the seconds. Worst 1 %: the share of the relMSE that is the worst "
            "hundredth's of pixels and channels: where it is large, rare bright samples (fireflies) make the error, "
            "the line is uncertain and most of the picture is better than the relMSE says."
        ),
        "",
        *_points(results),
        "",
    ]
    return "\n".join(page)
