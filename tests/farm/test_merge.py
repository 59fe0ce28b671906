# SPDX-License-Identifier: GPL-3.0-or-later
"""The sums of ranges: no order changes a bit, nothing counts twice, and each layer is merged by its rule."""

import random

import numpy as np
import pytest

from engine.farm.engine import Engine
from engine.farm.merge import NO_DEPTH, Rule, Sums
from engine.farm.picture import Facts, Layout
from engine.farm.ranges import Range

CHANNELS = ("R", "G", "B", "depth.Z", "object_index.X", "sample_count.X", "albedo.R")
RULES = {"depth": 2, "object_index": 3, "sample_count": 4, "albedo": 0}
LAYOUT = Layout(5, 3, (0, 0, 5, 3), CHANNELS)
FACTS = Facts(0, (), 0.0, "", "", "", "")


def rendered(index: int) -> Range:
    pixels = np.random.default_rng(index).gamma(0.2, size=LAYOUT.shape).astype(np.float32)
    pixels[0, 0, 3] = NO_DEPTH if index % 2 else 4.0
    pixels[0, 1, 3] = NO_DEPTH
    pixels[..., 4], pixels[..., 5] = index + 7, 4
    return Range(index, index, 4, "scene", CHANNELS, pixels)


def merged(order: list[int]) -> Sums:
    sums = Sums(LAYOUT, RULES)
    for index in order:
        sums.put(rendered(index))
        while sums.add_next():
            pass
    return sums


def test_neither_order_nor_repetition_changes_a_bit() -> None:
    expected = merged(list(range(21))).picture(FACTS).pixels.tobytes()
    for seed in range(3):
        order = [*range(21), 3, 20, 0]
        random.Random(seed).shuffle(order)
        assert merged(order).picture(FACTS).pixels.tobytes() == expected


def test_what_comes_early_waits() -> None:
    sums = merged([0, 2, 3, 5])
    assert (sums.count, sums.samples, sums.waiting) == (1, 4, 3)
    assert sums.has(2) and not sums.has(1)


def test_each_layer_has_its_rule() -> None:
    picture = merged(list(range(6))).picture(FACTS)
    layers = dict(zip(picture.layout.channels, np.moveaxis(picture.pixels, 2, 0), strict=True))
    parts = np.array([rendered(i).pixels for i in range(6)], np.float64)
    assert layers["R"] == pytest.approx(parts[..., 0].mean(0), rel=1e-6)
    assert layers["stderr.G"] == pytest.approx(parts[..., 1].std(0, ddof=1) / np.sqrt(6), rel=1e-5)
    assert layers["albedo.R"] == pytest.approx(parts[..., 6].mean(0), rel=1e-6)
    assert layers["depth.Z"][0, :2].tolist() == [4.0, NO_DEPTH]
    assert layers["depth.Z"][1] == pytest.approx(parts[:, 1, :, 3].mean(0), rel=1e-6)
    assert (layers["object_index.X"] == 7).all() and (layers["sample_count.X"] == 24).all()


def test_the_rules_are_the_engines(library_dir: object) -> None:
    rules = Engine.here().pass_rules
    assert rules["depth"] == Rule.MEAN_OF_HITS and rules["stderr"] == Rule.STANDARD_ERROR
    assert rules["object_matte"] == Rule.MATTE and rules["albedo"] == Rule.MEAN
    assert rules["object_index"] == Rule.FIRST and rules["sample_count"] == Rule.COUNT
