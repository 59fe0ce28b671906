# SPDX-License-Identifier: GPL-3.0-or-later
"""The results as a table, as Markdown and as JSON."""

import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass

from tests.check.run import Result


@dataclass(frozen=True)
class Setting:
    """How the results came about."""

    command: str
    version: str
    level: float
    """Probability that a correct engine is rejected anywhere."""
    comparisons: int
    seconds: float


def _number(x: float | None) -> str:
    return "" if x is None else f"{x:.6g}"


def _interval(result: Result) -> str:
    if result.half_width is None:
        return ""
    if result.expected == 0:
        return "exact"
    return f"{result.half_width / abs(result.expected):.2%}"


def _seconds(result: Result) -> str:
    if result.seconds_to_one_percent is None:
        return "no noise" if result.measured is not None else ""
    return f"{result.seconds_to_one_percent:.2g}"


COLUMNS = ("case", "integrator", "expected", "measured", "+-", "verdict", "CPU s to 1 %")


def row(result: Result) -> tuple[str, ...]:
    return (
        result.case,
        result.integrator,
        _number(result.expected),
        _number(result.measured),
        _interval(result),
        result.verdict,
        _seconds(result),
    )


def line(result: Result) -> str:
    """Of the table on a terminal."""
    cells = row(result)
    widths = (-66, -6, 12, 12, 7, -11, 8)
    text = "  ".join(f"{c:<{-w}}" if w < 0 else f"{c:>{w}}" for c, w in zip(cells, widths, strict=True))
    text += f"  {result.seconds:6.1f} s"
    return text + ("" if result.good else f"\n    {result.text}")


def summary(results: Sequence[Result]) -> str:
    counts: dict[str, int] = {}
    for result in results:
        counts[result.verdict] = counts.get(result.verdict, 0) + 1
    return ", ".join(f"{number} {verdict}" for verdict, number in sorted(counts.items(), key=lambda x: -x[1]))


def markdown(results: Sequence[Result], setting: Setting) -> str:
    lines = [
        "# Stiff and extreme scenes",
        "",
        f"`{setting.command}`, {setting.version}: {summary(results)}, in {setting.seconds:.0f} s.",
        "",
        "Each number is the mean over independent seeds of few samples each. Student's t decides, at a level of"
        f" {setting.level:g} for the whole table, shared by {setting.comparisons} comparisons; a rejection is repeated"
        " once with fresh seeds. `+-` is the half-width of that interval, relative to what is expected; a case whose"
        " interval is wider than it allows is `no evidence`. Of several numbers that a case compares, the one furthest"
        " off stands here. Seconds are the engine's, to a standard error of 1 % of the case's noisiest number.",
        "",
        "| " + " | ".join(COLUMNS) + " |",
        "|" + "|".join("---" for _ in COLUMNS) + "|",
        *("| " + " | ".join(cell.replace("|", "\\|") for cell in row(result)) + " |" for result in results),
    ]
    bad = [result for result in results if not result.good]
    if bad:
        lines += ["", "## What does not pass", ""]
        lines += [f"- {result.case} ({result.integrator}): {result.text}" for result in bad]
    return "\n".join(lines) + "\n"


def as_json(results: Sequence[Result], setting: Setting) -> str:
    return json.dumps({**asdict(setting), "results": [asdict(result) for result in results]}, indent=1) + "\n"
