# SPDX-License-Identifier: GPL-3.0-or-later
"""Adaptive sampling: whom a plan may ask, what it may ask for, and the same bits whatever the threads, the tiles and
the interruptions. See tests/render/test_adaptive for what becomes of the picture."""

from functools import cache
from typing import Any

import numpy as np
import pytest

from addon.native import structs
from tests.engine.bits import all_passes, assert_same_bits, broken_off_within_batches, pictures
from tests.engine.library import Image, Render, Scene, functions, last_error
from tests.engine.probe.film import sample_allocation
from tests.engine.worlds import everything

LOWEST, HIGHEST = 0.25, 4.0
PLANNED_AT = 16
SAMPLES = 27  # ends in the middle of a round of the replicates
WIDTH, HEIGHT = 40, 35  # four blocks of the integrator


def noise(seed: int, width: int = 40, height: int = 30) -> Image:
    """Sums of eight replicates, noisier to the right."""
    rng = np.random.default_rng(seed)
    spread = np.geomspace(0.01, 1, width)[None, :, None, None]
    return (2 * np.exp(spread * rng.standard_normal((height, width, 8, 3)))).astype(np.float32)


@pytest.mark.parametrize("replicate", range(8))
def test_a_replicate_is_planned_by_three_others_alone(replicate: int) -> None:
    """Not by its own samples, and not by those that it plans: that is what keeps every mean unbiased, and any two
    uncorrelated."""
    sums = noise(1)
    plan = sample_allocation(sums)
    asked = {(replicate + d) % 8 for d in (1, 2, 3)}
    for other in range(8):
        changed = sums.copy()
        changed[..., other, :] = noise(2)[..., other, :] ** 3
        differs = (sample_allocation(changed)[..., replicate] != plan[..., replicate]).any()
        assert differs == (other in asked), f"replicate {replicate} and replicate {other}"


def test_rates_keep_their_bounds_and_their_mean() -> None:
    """The mean within half a unit of 1/4096, to which rates are rounded."""
    plan = sample_allocation(noise(3))
    assert plan.min() >= LOWEST and plan.max() <= HIGHEST
    assert np.abs(plan.mean(axis=(0, 1)) - 1).max() < 0.5 / 4096 + 1e-6
    left, right = plan[:, :10].mean(), plan[:, -10:].mean()
    assert right > 3 * left, "the noisy side gets more"


def test_what_has_no_noise_is_planned_all_the_same() -> None:
    assert (sample_allocation(np.full((9, 7, 8, 3), 2.0)) == 1).all()
    assert (sample_allocation(np.zeros((9, 7, 8, 3))) == 1).all()
    one = np.full((30, 30, 8, 3), 2.0)
    one[15, 15, 4] = 9
    plan = sample_allocation(one)
    for replicate in range(8):
        highest = HIGHEST if replicate in (1, 2, 3) else 1
        assert plan[15, 15, replicate] == highest
        assert plan[0, 0, replicate] == (LOWEST if highest > 1 else 1)


def test_sums_out_of_range_are_planned_all_the_same() -> None:
    """Infinite in one pixel; so large that their squares are infinite as float; infinite in all."""
    sums = noise(4)
    sums[3, 5, 2] = np.inf
    for values in (sums, noise(4) * np.float32(1e36), np.full((9, 7, 8, 3), np.inf)):
        plan = sample_allocation(values)
        assert ((plan >= LOWEST) & (plan <= HIGHEST)).all()
    assert np.allclose(sample_allocation(noise(4) * np.float32(1e36)), sample_allocation(noise(4)), atol=2 / 4096)


@cache
def scene() -> Scene:
    return Scene(everything(WIDTH, HEIGHT))


SETTINGS: dict[str, Any] = {"seed": 5, "threads": 2, "adaptive": 1, "tile_size": 64}


def rendered(**settings: Any) -> dict[str, Image]:
    with Render(scene(), passes=all_passes(), **{**SETTINGS, "samples": SAMPLES, **settings}) as render:
        return pictures(render.run())


@cache
def reference() -> dict[str, Image]:
    return rendered(threads=1)


def test_counts() -> None:
    """Of every pixel between what the bounds of the rates allow, in the mean one a pass, within what rounding at
    random of 8 numbers a pixel does to it; the report has the extremes."""
    with Render(scene(), **SETTINGS, samples=SAMPLES) as render:
        counts, report = render.run().read("sample_count"), render.report()
    assert report["spp"] == SAMPLES
    assert report["adaptive"] == {"fewest": counts.min(), "most": counts.max()}
    passes = [(SAMPLES + 7 - r) // 8 - 2 for r in range(8)]
    assert counts.min() >= PLANNED_AT + sum(int(LOWEST * n) for n in passes)
    assert counts.max() <= PLANNED_AT + sum(int(np.ceil(HIGHEST * n)) for n in passes)
    assert np.unique(counts).size > 10
    error = np.sqrt(8 / 4 / counts.size)  # a number rounded at random has a variance of 1/4 at most
    assert abs(counts.mean() - SAMPLES) < 4 * error
    with Render(scene(), **{**SETTINGS, "adaptive": 0}, samples=SAMPLES) as render:
        assert (render.run().read("sample_count") == SAMPLES).all() and render.report()["adaptive"] is None


def test_until_the_plan_it_is_any_other_render() -> None:
    plain, adaptive = rendered(samples=PLANNED_AT, adaptive=0), rendered(samples=PLANNED_AT)
    assert_same_bits(plain, adaptive)
    assert (rendered(adaptive=0)["combined"] != reference()["combined"]).mean() > 0.9


@pytest.mark.parametrize("settings", [{"threads": 3, "tile_size": 32}, {"threads": 2, "tile_size": 1000}])
def test_threads_and_tiles(settings: dict[str, int]) -> None:
    assert_same_bits(reference(), rendered(**settings))


@pytest.mark.parametrize("at", [9, PLANNED_AT, 21])
def test_resume(at: int) -> None:
    """Before the plan, when it is to be made, and after it."""
    with Render(scene(), samples=at, passes=all_passes(), **SETTINGS) as render:
        state = render.run().save()
    with Render(scene(), samples=SAMPLES, passes=all_passes(), **SETTINGS) as render:
        render.load(state)
        assert_same_bits(reference(), pictures(render.run()))


def test_resume_from_the_middle_of_a_batch() -> None:
    settings: dict[str, Any] = {**SETTINGS, "tile_size": 8, "passes": all_passes()}
    with Render(scene(), samples=PLANNED_AT + 1, **settings) as render:
        planned = render.run().save()
    settings["samples"] = SAMPLES
    state = broken_off_within_batches(scene(), settings, planned)
    with Render(scene(), **settings) as render:
        render.load(state)
        assert_same_bits(reference(), pictures(render.run()))


def test_a_state_of_the_other_kind_is_refused() -> None:
    for adaptive, words in ((1, "with adaptive sampling, and this one is without"), (0, "without adaptive sampling")):
        with Render(scene(), samples=1, **{**SETTINGS, "adaptive": adaptive}) as render:
            state = render.run().save()
        with Render(scene(), samples=2, **{**SETTINGS, "adaptive": 1 - adaptive}) as render:
            result = functions().glimmer_render_load(render.handle, state, len(state))
            assert result == structs.Result.INVALID_ARGUMENT and words in last_error()
            assert render.poll().samples == 0
