# SPDX-License-Identifier: GPL-3.0-or-later
"""The table of passes, and the arrays that Blender is handed."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np

from addon.film.passes import (
    ALPHA,
    COMBINED,
    MOST_AOVS,
    MOST_LIGHT_GROUPS,
    OPTIONAL,
    Pixels,
    Reader,
    enabled,
    engine_names,
    flat,
    hand_over,
    missing,
    with_alpha,
    without_color,
)
from addon.native.library import Library


def test_the_engine_has_every_pass_of_the_table(library_dir: Path) -> None:
    known = Library(library_dir / "libglimmer.so").passes()
    for item in (COMBINED, *OPTIONAL):
        assert len(known[item.engine_name][1]) == min(len(item.channels), 3)
    assert set(known) == {ALPHA, *engine_names((COMBINED, *OPTIONAL, *enabled(_full_layer())))}


def _full_layer() -> Any:
    layer = _layer(use_pass_cryptomatte_object=True, use_pass_cryptomatte_material=True)
    layer.pass_cryptomatte_depth = 6
    layer.aovs = [SimpleNamespace(name=f"aov {i}", type="COLOR") for i in range(MOST_AOVS)]
    layer.lightgroups = [SimpleNamespace(name=f"group {i}") for i in range(MOST_LIGHT_GROUPS)]
    return layer


def _layer(**on: bool) -> Any:
    ours = SimpleNamespace(**{item.switch: False for item in OPTIONAL if item.is_ours})
    cycles = SimpleNamespace(**{item.switch: False for item in OPTIONAL if item.cycles})
    builtin = {item.switch: False for item in OPTIONAL if item.builtin}
    return SimpleNamespace(glimmer=ours, cycles=cycles, aovs=[], **(builtin | on))


def test_switches_choose_the_passes() -> None:
    layer = _layer()
    assert enabled(layer) == (COMBINED,)
    layer.use_pass_z = layer.glimmer.use_fog = layer.cycles.use_pass_volume_direct = True
    assert [item.engine_name for item in enabled(layer)] == ["combined", "depth", "volume_direct", "fog"]
    del layer.cycles  # where Cycles is switched off
    assert [item.engine_name for item in enabled(layer)] == ["combined", "depth", "fog"]


def test_light_brings_its_color_along() -> None:
    asked = enabled(_layer(use_pass_diffuse_direct=True, use_pass_diffuse_indirect=True))
    assert engine_names(asked) == ("combined", "diffuse_direct", "diffuse_color", "diffuse_indirect")


def test_passes_that_are_not_there_are_named() -> None:
    layer = _layer(use_pass_vector=True)
    layer.cycles.use_pass_shadow_catcher = True
    layer.aovs.extend(SimpleNamespace(name=f"Rust {i}", type="COLOR") for i in range(9))
    assert missing(_layer()) == []
    assert missing(layer) == ["Vector", "Shadow Catcher", "shader AOV 'Rust 8' (of 8 at most)"]


def test_names_are_blenders_of_the_version() -> None:
    item = next(item for item in OPTIONAL if item.engine_name == "diffuse_direct")
    assert item.name((3, 4, 1)) == "DiffDir"
    assert item.name((5, 0, 0)) == "Diffuse Direct"
    for version in ((3, 4, 1), (5, 0, 0)):
        names = [item.name(version) for item in (COMBINED, *OPTIONAL)]
        assert len(set(names)) == len(names)


def test_rows_are_flipped_and_opaque() -> None:
    pixels = np.arange(2 * 3 * 3, dtype=np.float32).reshape(2, 3, 3)
    result = flat(with_alpha(pixels, None)).reshape(2, 3, 4)
    np.testing.assert_array_equal(result[0, :, :3], pixels[1])
    np.testing.assert_array_equal(result[1, :, :3], pixels[0])
    assert (result[..., 3] == 1.0).all()


def test_alpha_is_the_engines_within_its_range() -> None:
    alpha = np.array([[[0.25], [1.5]]], np.float32)
    result = with_alpha(np.full((1, 2, 3), 0.2, np.float32), alpha)
    np.testing.assert_array_equal(result[..., 3], [[0.25, 1.0]])


def test_light_is_divided_by_color_and_gives_it_back() -> None:
    light = np.array([[[2.0, 3.0, 0.0], [0.0, 0.0, 0.0], [1.0, 0.0, 0.0]]], np.float32)
    color = np.array([[[0.5, 0.5, 0.0], [0.0, 0.0, 0.0], [0.5, 0.0, 0.5]]], np.float32)
    shown = without_color(light, color)
    np.testing.assert_array_equal(shown * color, light)
    np.testing.assert_array_equal(shown[0], [[4.0, 6.0, 5.0], [0.0, 0.0, 0.0], [2.0, 1.0, 0.0]])


def test_material_numbers_become_blenders_indices() -> None:
    item = next(item for item in OPTIONAL if item.engine_name == "material_index")
    table = np.array([0.0, 70.0, 80.0], np.float32)
    reader = Reader(lambda _: np.array([[[0.0], [2.0], [1.0]]], np.float32), material_indices=table)
    np.testing.assert_array_equal(flat(reader.pixels(item)), [0.0, 80.0, 70.0])


def test_passes_follow_the_order_of_blenders_layer() -> None:
    values = {"combined": (3.0, 3), "depth": (7.0, 1), ALPHA: (0.5, 1)}

    def read(name: str) -> Pixels:
        value, channels = values[name]
        return np.full((1, 2, channels), value, np.float32)

    layers = [("Depth", 1), ("Unknown", 1), ("Combined", 4)]
    asked = enabled(_layer(use_pass_z=True))
    np.testing.assert_array_equal(
        hand_over(layers, asked, (1, 2), Reader(read, has_alpha=True), True), [7, 7, 0, 0, 3, 3, 3, 0.5, 3, 3, 3, 0.5]
    )
    # While rendering only the picture is read; the rest waits as zeros of the right size.
    early = hand_over(layers, asked, (1, 2), Reader(read), False)
    np.testing.assert_array_equal(early, [0, 0, 0, 0, 3, 3, 3, 1, 3, 3, 3, 1])
