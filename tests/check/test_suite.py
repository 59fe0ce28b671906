# SPDX-License-Identifier: GPL-3.0-or-later
"""The short tier of the suite, and that its verdicts can be bad ones."""

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from tests.check import __main__ as command
from tests.check import cycles
from tests.check.case import Case, Estimate, Limit
from tests.check.report import Setting, as_json, markdown
from tests.check.run import LIMIT, STALE, Result, numbers, run
from tests.check.suite import chosen
from tests.render.statistics import INTEGRATORS, Clock

QUICK = chosen(quick=True)


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("case", [pytest.param(case, id=case.name) for case in QUICK])
def test_case(case: Case, integrator: str) -> None:
    if integrator in case.integrators:
        result = run(case, integrator, 2 * numbers(QUICK))
        assert result.good, f"{result.verdict}: {result.text}"


def judged(truth: float, noise: float, expected: float = 1, limit: Limit | None = None) -> Result:
    def measure(integrator: str, clock: Clock) -> Estimate:
        def estimate(seed: int) -> float:
            clock.add(0.5)
            return truth + noise * float(np.random.default_rng(seed).normal())

        return estimate

    return run(Case("made up", expected, measure, within=0.02, limit=limit), "path", 100)


@pytest.mark.parametrize(
    ("result", "verdict"),
    [
        (lambda: judged(1, 0.01), "passes"),
        (lambda: judged(1, 0), "passes"),
        (lambda: judged(1.03, 0.05), "fails"),
        (lambda: judged(1.0001, 0), "fails"),
        (lambda: judged(1e-30, 0, 0), "fails"),
        (lambda: judged(0, 0, 0), "passes"),
        (lambda: judged(1, 2), "no evidence"),
        (lambda: judged(1, 2, limit=Limit("", 0.1)), "no evidence"),
        (lambda: judged(1.03, 0.01, limit=Limit("", 0.1)), LIMIT),
        (lambda: judged(1.3, 0.01, limit=Limit("", 0.1)), "fails"),
        (lambda: judged(1.3, 0.01, limit=Limit("", 1, ("baseline",))), "fails"),
        (lambda: judged(1, 0.01, limit=Limit("", 0.1)), STALE),
        (lambda: judged(1, 2, limit=Limit("", np.inf)), LIMIT),
        (lambda: judged(1, 0.01, limit=Limit("", np.inf)), "passes"),
        (lambda: judged(float("nan"), 0), "fails"),
    ],
)
def test_verdict(result: Callable[[], Result], verdict: str) -> None:
    assert result().verdict == verdict


def test_seconds() -> None:
    """Half a second a seed, of 10 % noise: a hundred seeds to 1 %."""
    seconds = judged(1, 0.1).seconds_to_one_percent
    assert seconds is not None
    assert seconds == pytest.approx(50, rel=0.2)  # known from a thousand seeds: 4 standard errors


def test_report() -> None:
    results = [judged(1, 0.01), judged(1.03, 0.05)]
    setting = Setting("python3 build.py check", "glimmer 0", 1e-3, 100, 12)
    page = markdown(results, setting)
    assert "1 passes, 1 fails" in page and page.count("| made up | path |") == 2
    assert "## What does not pass" in page and results[1].text in page
    told = json.loads(as_json(results, setting))
    assert [item["verdict"] for item in told["results"]] == ["passes", "fails"]
    assert told["results"][0]["expected"] == 1


def test_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    only = "camera within a light"
    assert command.main(["--only", only, "--report", str(tmp_path)]) == 0
    assert only in capsys.readouterr().out
    assert only in (tmp_path / "check.md").read_text()
    assert json.loads((tmp_path / "check.json").read_text())["results"][0]["case"] == only


# ---- beside Cycles -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("means", "right"),
    [
        (np.array([[1, 0.5, 0.999]] * 8), True),
        (np.array([[1, 0.5, 0.99]] * 8), False),
        (np.array([[1, 0.5, np.inf]] * 8), False),
        (np.outer([0.1, 1.9] * 4, [1, 0.5, 1]), None),
        (np.outer([0.1, 0.12] * 4, [1, 0.5, 1]), False),
    ],
)
def test_verdict_on_cycles(means: NDArray[np.float64], right: bool | None) -> None:
    case = Case("made up", (1, 0.5, 1), lambda integrator, clock: lambda seed: 0)
    assert cycles.judge(case, means, 1e-4).right is right


def test_choices_for_cycles() -> None:
    """Each is one scene of the suite."""
    assert all(cycles.chosen_case(choice).scene is not None for choice in cycles.CHOICES)


def test_beside_cycles(blender: Path, tmp_path: Path) -> None:
    """A lamp on a plate, and fog before a ball of light: both renderers know them."""
    for only in ("R/d 0.0001", "absorption of depth 1"):
        command.main(["--cycles", str(blender), "--only", only, "--report", str(tmp_path)])
        page = (tmp_path / "extremes.md").read_text()
        shares = [[float(cell.split()[0].strip("*")) for cell in row.split("|")[3:5]] for row in rows_of(page)]
        assert shares[0] == pytest.approx([1, 1], abs=3e-3)


def rows_of(page: str) -> list[str]:
    """Of its table, the head left out."""
    return [row for row in page.splitlines() if row.startswith("| ")][1:]
