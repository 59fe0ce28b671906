# SPDX-License-Identifier: GPL-3.0-or-later
"""What a saved state brings along, and that a damaged one changes nothing. See test_determinism for the pixels."""

from typing import Any

import numpy as np
import pytest

from addon.native import structs
from addon.scene import description as d
from tests.engine.library import Render, Scene, functions, last_error
from tests.engine.worlds import everything
from tests.render.build import Builder, camera, grey

SETTINGS: dict[str, Any] = {"seed": 3, "threads": 2, "passes": ("depth", "albedo"), "tile_size": 32}


@pytest.fixture(scope="module")
def world() -> Scene:
    return Scene(everything(70, 40))


@pytest.fixture(scope="module")
def state(world: Scene) -> bytes:
    with Render(world, samples=5, **SETTINGS) as render:
        return render.run().save()


def test_faults_are_not_forgotten() -> None:
    """A shining mirror all around the camera, where a path leaves the range of float."""
    mirror = d.Mirror(grey(1), emission=grey(3e38))
    scene = Scene(Builder(camera((0, 0, 0), (0, 1, 0), 60), 1, 1).sphere((0, 0, 0), 1, mirror).done())
    with Render(scene, samples=1, integrator="baseline") as render:
        before, saved = render.run().report(), render.save()
    assert before["invalid_samples"]["count"] == 1 and len(before["biased_by"]) == 1
    with Render(scene, samples=1, integrator="baseline") as render:
        render.load(saved)
        after = render.run().report()
    assert after["invalid_samples"] == before["invalid_samples"] and after["biased_by"] == before["biased_by"]


def test_everything_else_is_taken_up(world: Scene, state: bytes) -> None:
    with Render(world, samples=5, **SETTINGS) as render:
        render.load(state)
        with Render(world, samples=5, **SETTINGS) as whole:
            expected = whole.run().report()
        report = render.run().report()
    for key in ("spp", "rays", "error", "invalid_samples", "biased_by"):
        assert report[key] == expected[key], key
    assert [row[2:] for row in report["curve"]] == [row[2:] for row in expected["curve"]]


def test_tiles_of_a_loaded_render_are_to_be_shown(world: Scene, state: bytes) -> None:
    with Render(world, samples=5, **SETTINGS) as render:
        assert render.next_tile() is None and render.poll().version == 0
        render.load(state)
        tiles = list(render.tiles())
        assert sum(tile.width * tile.height for tile in tiles) == 70 * 40
        assert all(tile.samples == 5 for tile in tiles) and render.poll().version > 0
        assert render.next_tile() is None


def test_a_damaged_state_changes_nothing(world: Scene, state: bytes) -> None:
    """Cut off, longer, or with any one bit of it turned: refused in one line, and the render is as if new."""
    rng = np.random.default_rng(1)
    damaged = [state[:length] for length in rng.integers(1, len(state), 20)] + [state + b"\0", state[8:]]
    for bit in rng.integers(0, 8 * len(state), 60):
        turned = bytearray(state)
        turned[bit // 8] ^= 1 << bit % 8
        damaged.append(bytes(turned))
    with Render(world, samples=2, **SETTINGS) as render:
        for data in damaged:
            result = functions().glimmer_render_load(render.handle, data, len(data))
            assert result == structs.Result.INVALID_ARGUMENT and "\n" not in last_error() and last_error()
            progress = render.poll()
            assert progress.samples == 0 and progress.version == 0 and progress.rays == 0
        assert not render.read("combined").any() and not render.read("sample_count").any()
        picture = render.run().read()
    with Render(world, samples=2, **SETTINGS) as render:
        assert (render.run().read() == picture).all()


@pytest.mark.parametrize("limit", ["max_depth", "max_scatter"])
def test_other_limits_are_another_picture(world: Scene, state: bytes, limit: str) -> None:
    with Render(world, samples=5, **SETTINGS, **{limit: 3}) as render:
        result = functions().glimmer_render_load(render.handle, state, len(state))
        assert result == structs.Result.INVALID_ARGUMENT and limit in last_error()


def test_the_report_names_the_kernel(world: Scene) -> None:
    for integrator in ("path", "baseline"):
        with Render(world, samples=1, integrator=integrator) as render:
            assert render.run().report()["kernel"].split()[0] == integrator
