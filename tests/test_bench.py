# SPDX-License-Identifier: GPL-3.0-or-later
"""The benchmark's arithmetic: errors, the check of means, times, and that it refuses to rank different pictures."""

import math
import os
from pathlib import Path

import numpy as np
import pytest
from scipy import stats

import build
from tests.bench import errors
from tests.bench.__main__ import FULL, QUICK, Plan, cycles_runs, measure, tasks
from tests.bench.errors import Agreement, Picture, Point, Run
from tests.bench.renderers import FromBlender, Glimmer
from tests.bench.report import LEVEL, Entry, SceneResult, Setting, agrees, markdown

RNG = np.random.default_rng(20261122)
SHAPE = (24, 36, 3)
TRUTH = 1 + RNG.random(SHAPE)
SETTING = Setting("python3 build.py bench", "1", "commit 1", "Blender 1", (36, 24), 3, (0.0, 0.0))


def noisy(samples: int, deviation: float = 0.5, scale: float = 1.0) -> Picture:
    noise = RNG.normal(size=SHAPE) * deviation / math.sqrt(samples)
    return np.asarray(scale * TRUTH + noise, np.float32)


def runs(count: int, scale: float = 1.0) -> list[Run]:
    return [Run(samples, 1.0, noisy(samples, scale=scale)) for samples in (1, 4, 16) for _ in range(count)]


def test_the_noise_of_the_reference_cancels() -> None:
    """Thirds ten times noisier than the picture: by chance it fails once in ten thousand seeds."""
    small, large, trials = 0.02, 0.2, 300

    def reciprocals() -> float:
        c = noisy(1, large)
        return float(np.mean(1 / (c.astype(np.float64) ** 2 + (0.01 * c.mean()) ** 2)))

    found = np.array(
        [errors.relative_errors(noisy(1, small), [noisy(1, large) for _ in range(3)]).mean() for _ in range(trials)]
    )
    expected = small**2 * np.array([reciprocals() for _ in range(trials)])
    error = math.sqrt((found.var(ddof=1) + expected.var(ddof=1)) / trials)
    assert abs(found.mean() - expected.mean()) < stats.norm.isf(0.5e-4) * error
    assert 0 < error < 0.2 * expected.mean(), "too blunt to show anything"


def test_relmse_of_a_known_difference() -> None:
    flat = np.full(SHAPE, 2.0, np.float32)
    found = errors.relative_errors(1.1 * flat, [flat] * 3)
    assert found.mean() == pytest.approx(0.01 / 1.0001, rel=1e-5)
    assert errors.worst_share(found) == pytest.approx(0.01, abs=1 / found.size)
    found[0, 0, 0] = found.sum()
    assert errors.worst_share(found) == pytest.approx(0.5, abs=0.01)


def test_the_references_own_noise() -> None:
    """By chance, it fails once in ten thousand seeds."""
    found = [errors.noise_of([noisy(1, 0.05) for _ in range(3)]) for _ in range(100)]
    expected = np.mean(0.05**2 / 3 / (TRUTH**2 + (0.01 * TRUTH.mean()) ** 2))
    # Second order: the noise of mu in the denominator, 3 var / mu^2 at most.
    assert np.mean(found) == pytest.approx(expected, rel=0.05**2 + 3.9 * np.std(found) / 10 / expected)


def test_means_that_agree_are_found_to_agree_as_often_as_promised() -> None:
    """400 checks at a level of 5 %; Bonferroni's bound is nearly reached as the tests are nearly independent."""
    level, trials = 0.05, 400
    alarms = sum(errors.agreement(runs(3), runs(3)).p < level / errors.TESTS_PER_PAIR for _ in range(trials))
    assert alarms <= stats.binom.ppf(1 - 1e-4, trials, level)


def test_a_mean_that_differs_is_noticed() -> None:
    found = errors.agreement(runs(4, scale=1.05), runs(4))
    assert found.p < LEVEL / (errors.TESTS_PER_PAIR * 9)
    assert found.ratio == pytest.approx(1.05, abs=5 * found.error)
    one_block = runs(4)
    for run in one_block:
        run.picture[:12, :12, 2] *= 1.2
    assert errors.agreement(one_block, runs(4)).p < LEVEL / (errors.TESTS_PER_PAIR * 9)


def line(scale: float, seconds: float = 1.0) -> list[list[Point]]:
    return [[Point(n, n * seconds, scale / n * noise, 0.01) for n in (1, 4, 16)] for noise in (0.99, 1.0, 1.01)]


def test_time_to_an_error() -> None:
    inside, beyond = errors.time_to(line(1.0), 0.1), errors.time_to(line(1.0), 0.01)
    assert inside is not None and beyond is not None
    assert inside.seconds == pytest.approx(10) and beyond.seconds == pytest.approx(100)
    assert (inside.extrapolated, beyond.extrapolated) == (False, True)
    # The mean of three that scatter by 1 %, by Student's t.
    assert inside.factor == pytest.approx(1 + 4.3027 * 0.01 / math.sqrt(3), rel=1e-3)
    first = errors.time_to(line(0.05, seconds=0.2), 0.1)
    assert first is not None and first.at_most and first.seconds == pytest.approx(0.2)


def test_no_time_where_no_line_falls() -> None:
    assert errors.time_to([[Point(1, 1, 0.1, 0.01), Point(4, 4, 0.1, 0.01)]] * 2, 0.01) is None
    assert errors.time_to([[Point(1, 1, 0.1, 0.01), Point(4, 4, -0.1, 0.01)]] * 2, 0.01) is None


def test_another_picture_is_not_ranked() -> None:
    same, other = Agreement(0.5, 1.0, 0.001), Agreement(1e-9, 1.1, 0.001)
    entries = {"path": Entry(line(1.0), same, None), "Cycles": Entry(line(2.0), other, 0.1)}
    page = markdown([SceneResult("somewhere", entries, 64, 1e-4)], SETTING)
    row = next(text for text in page.splitlines() if text.startswith("| somewhere | Cycles |"))
    assert row.count("not ranked") == 2 and "×**" not in page
    entries["Cycles"] = Entry(line(2.0), same, 0.1)
    page = markdown([SceneResult("somewhere", entries, 64, 1e-4)], SETTING)
    assert "20 s* (×/÷ 1.03), **2 ×** | 200 s* (×/÷ 1.03), **2 ×** | t^-1.00 |" in page


@pytest.mark.parametrize("plan", [FULL, QUICK])
def test_no_seed_twice(plan: Plan) -> None:
    for levels in plan.levels.values():
        seeds = [task.seed for repetition in range(plan.repetitions) for task in tasks(levels, repetition)]
        assert len(seeds) == len(set(seeds))
    assert plan.reference_runs % 3 == 0


def test_set_up_is_subtracted() -> None:
    def run(samples: int) -> Run:
        return Run(samples, 3.0 + 0.25 * samples, TRUTH.astype(np.float32))

    levels = QUICK.levels["Cycles"]
    every = [run(1)] * QUICK.repetitions + [run(samples) for samples in levels] * QUICK.repetitions
    rows, set_up = cycles_runs(FromBlender(Path("scene.json"), "1", every), QUICK)
    assert set_up == pytest.approx(3.0)
    assert [[item.cpu for item in row] for row in rows] == [pytest.approx([0.25 * n for n in levels])] * len(rows)


@pytest.mark.parametrize("with_cycles", [True, False])
def test_a_scene_is_measured(
    with_cycles: bool, glimmer_command: Path, blender: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Small, from the .blend to the page. The seeds are fixed; of all seeds, one in a thousand would fail."""
    for name, value in build.host_environment(tmp_path / "profile", blender).items():
        if os.environ.get(name) != value:
            monkeypatch.setenv(name, value)
    plan = Plan((32, 18), {"path": (1, 4), "report": (1, 4), "Cycles": (2, 64)}, 4, 16, 6)
    folder = tmp_path / "pictures"
    result, version = measure("moons_in_fog", plan, Glimmer(glimmer_command), blender, with_cycles, folder)
    assert list(result.entries) == ["path", "report", *(["Cycles"] if with_cycles else [])]
    assert version[0].isdigit()
    for name, entry in result.entries.items():
        assert [[point.samples for point in row] for row in entry.points] == [list(plan.levels[name])] * 4
        assert all(point.cpu > 0 for row in entry.points for point in row), name
        assert agrees(entry, [result]), (name, entry.agreement)
    assert "| moons_in_fog | path |" in markdown([result], SETTING)
