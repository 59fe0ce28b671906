# SPDX-License-Identifier: GPL-3.0-or-later
"""The table of passes, and the arrays that Blender is handed."""

import ctypes
from pathlib import Path
from types import SimpleNamespace

import numpy as np

from addon.film.passes import COMBINED, OPTIONAL, Pixels, RenderPass, enabled, hand_over, to_blender
from addon.native.library import Library


def test_the_engine_has_every_pass_of_the_table(library_dir: Path) -> None:
    known = Library(library_dir / "libglimmer.so").passes()
    for item in (COMBINED, *OPTIONAL):
        assert len(known[item.engine_name][1]) == min(len(item.channels), 3)
    assert set(known) == {item.engine_name for item in (COMBINED, *OPTIONAL)}


def test_switches_choose_the_passes() -> None:
    ours = SimpleNamespace(**{item.switch: False for item in OPTIONAL if not item.builtin})
    layer = SimpleNamespace(glimmer=ours, **{item.builtin: False for item in OPTIONAL if item.builtin})
    assert enabled(layer) == (COMBINED,)
    layer.use_pass_z = ours.use_fog = True
    assert [item.engine_name for item in enabled(layer)] == ["combined", "depth", "fog"]


def test_rows_are_flipped_and_opaque() -> None:
    pixels = np.arange(2 * 3 * 3, dtype=np.float32).reshape(2, 3, 3)
    flat = to_blender(COMBINED, pixels).reshape(2, 3, 4)
    np.testing.assert_array_equal(flat[0, :, :3], pixels[1])
    np.testing.assert_array_equal(flat[1, :, :3], pixels[0])
    assert (flat[..., 3] == 1.0).all()


def test_material_numbers_become_blenders_indices() -> None:
    item = next(item for item in OPTIONAL if item.engine_name == "material_index")
    table = np.array([0.0, 70.0, 80.0], np.float32)
    flat = to_blender(item, np.array([[[0.0], [2.0], [1.0]]], np.float32), table)
    np.testing.assert_array_equal(flat, [0.0, 80.0, 70.0])


def test_passes_follow_the_order_of_blenders_layer() -> None:
    def read(item: RenderPass) -> Pixels:
        return np.full((1, 2, len(item.channels)), 7.0, np.float32)

    combined = np.full((1, 2, 3), 3.0, np.float32)
    names, channels = ["Depth", "Mist", "Combined"], [1, 1, 4]
    flat = hand_over(names, (1, 2), read, combined, channels=channels)
    np.testing.assert_array_equal(flat, [7, 7, 0, 0, 3, 3, 3, 1, 3, 3, 3, 1])
    # While rendering only the picture is read; the rest waits as zeros of the right size.
    early = hand_over(names, (1, 2), None, combined, channels=channels)
    np.testing.assert_array_equal(early, [0, 0, 0, 0, 3, 3, 3, 1, 3, 3, 3, 1])
    assert ctypes.sizeof(ctypes.c_float) * len(flat) == flat.nbytes
