# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders whose every bit is compared, and renders that are broken off."""

import time
from typing import Any

import numpy as np

from addon.native.structs import State
from tests.engine.library import Image, Render, Scene, pass_table


def plain_passes() -> tuple[str, ...]:
    """Those that need no kernel of their own: the table's up to the first that does."""
    names = tuple(pass_table())
    return names[: names.index("alpha")]


def all_passes() -> tuple[str, ...]:
    return tuple(pass_table())


def pictures(render: Render, names: tuple[str, ...] = ()) -> dict[str, Image]:
    """Of all passes, or of some."""
    return {name: render.read(name) for name in names or all_passes()}


def assert_same_bits(a: dict[str, Image], b: dict[str, Image]) -> None:
    for name in a:
        same = a[name].view(np.uint32) == b[name].view(np.uint32)
        assert same.all(), f"{name}: {(~same).sum()} of {same.size} values differ, first at {np.argwhere(~same)[0]}"


def broken_off_within_batches(scene: Scene, settings: dict[str, Any], state: bytes = b"") -> bytes:
    """The state of a render that went on from `state`, was paused with some tiles ahead of others, saved, destroyed and
    taken up elsewhere; that several times over."""
    uneven = 0
    for _ in range(40):
        with Render(scene, **settings) as render:
            if state:
                render.load(state)
            samples = {(tile.x, tile.y): tile.samples for tile in render.tiles()}
            render.start()
            while (tile := render.next_tile()) is None and render.state == State.RUNNING:
                time.sleep(1e-4)
            render.pause()
            for after in (tile, *render.tiles()):
                if after is not None:
                    samples[after.x, after.y] = after.samples
            if render.state != State.PAUSED:
                break
            uneven += len(set(samples.values())) > 1
            state = render.save()
    assert uneven > 0, "never paused within a batch: nothing was tested"
    return state
