# SPDX-License-Identifier: GPL-3.0-or-later
"""Bad values for a render, in what is read of it and in the states that it loads."""

from ctypes import byref, c_float, c_void_p
from typing import Any

import numpy as np
import pytest

from addon.native import structs
from tests.engine.api.misuse import ARGUMENT, NAN, OK, changed, committed, refused
from tests.engine.library import Render, engine, functions


@pytest.mark.parametrize(
    ("changes", "word"),
    [
        ({"integrator": b"magic"}, "magic"),
        ({"seconds": -1}, "seconds"),
        ({"seconds": NAN}, "seconds"),
        ({"target_error": -1}, "target_error"),
        ({"threads": 100000}, "threads"),
        ({"tile_size": 1 << 20}, "tile_size"),
        ({"max_depth": -2}, "max_depth"),
        ({"max_scatter": -2}, "max_scatter"),
        ({"passes_above": 1 << 31}, "passes_above"),
    ],
)
def test_bad_render(changes: dict[str, Any], word: str) -> None:
    out = c_void_p()
    desc = changed(engine().init(structs.RenderDesc), changes)
    refused(functions().glimmer_render_create(committed().handle, byref(desc), byref(out)), ARGUMENT, word)
    assert not out


@pytest.mark.parametrize(
    ("which", "rectangle", "count", "word"),
    [
        (12, (0, 0, 1, 1), 3, "pass"),
        (-1, (0, 0, 1, 1), 3, "pass"),
        (2, (0, 0, 1, 1), 3, "albedo"),
        (0, (0, 0, 17, 1), 51, "16"),
        (0, (16, 8, 1, 1), 3, "16"),
        (0, (0xFFFFFFFF, 0, 2, 1), 6, "16"),
        (0, (0, 0xFFFFFFFF, 1, 2), 6, "16"),
        (0, (0, 0, 2, 2), 11, "12"),
        (0, (0, 0, 2, 2), 13, "12"),
    ],
)
def test_bad_read(which: int, rectangle: tuple[int, int, int, int], count: int, word: str) -> None:
    """Nothing is written."""
    with Render(committed(), samples=1) as render:
        render.run()
        pixels = (c_float * 64)(*[7.0] * 64)
        refused(functions().glimmer_render_read(render.handle, which, *rectangle, pixels, count), ARGUMENT, word)
        assert all(value == 7 for value in pixels)


def test_bad_states_to_load() -> None:
    """Empty, cut off at any place, of another seed, size or integrator, or not a state at all."""
    settings: dict[str, Any] = {"samples": 2, "seed": 3, "threads": 1}
    with Render(committed(), **settings) as render:
        state = render.run().save()
    library = functions()

    def try_load(data: bytes, **other: Any) -> int:
        with Render(committed(), **{**settings, **other}) as render:
            result: int = library.glimmer_render_load(render.handle, data, len(data))
            if result != OK:  # still as good as new
                refused(result, ARGUMENT)
                assert render.run().poll().samples == 2
                assert np.isfinite(render.read()).all()
            return result

    assert try_load(state) == OK
    for length in (0, 1, 8, 47, 63, 64, len(state) // 2, len(state) - 1):
        assert try_load(state[:length]) == ARGUMENT, length
    assert try_load(b"\0" * len(state)) == ARGUMENT
    assert try_load(state, seed=4) == ARGUMENT
    assert try_load(state, integrator="baseline") == ARGUMENT
    assert try_load(state, passes=("albedo",)) == ARGUMENT
    damaged = bytearray(state)
    damaged[40:48] = b"\xff" * 8  # the length of its curve
    assert try_load(bytes(damaged)) == ARGUMENT
