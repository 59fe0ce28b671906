# SPDX-License-Identifier: GPL-3.0-or-later
"""Every constant that the engine lets a benchmark vary is one that the benchmark knows."""

import re

import numpy as np
import pytest

from tests.bench.errors import Picture
from tests.bench.renderers import ROOT
from tests.bench.tuning import HEADERS, constants, cost, number, ratio

SOURCES = ROOT / "engine" / "src"


def test_all_tunable_constants_are_found() -> None:
    macro = re.compile(r"^GLIMMER_TUNABLE_CONSTANT\(", re.MULTILINE)
    used = {path.relative_to(SOURCES).as_posix(): len(macro.findall(path.read_text())) for path in SOURCES.rglob("*.h")}
    assert {path for path, count in used.items() if count} == set(HEADERS)
    assert sum(used.values()) == len(constants())


@pytest.mark.parametrize(("text", "value"), [("3", 3), ("0.85f", 0.85), ("1e6f", 1e6), ("1u << 18", 1 << 18)])
def test_literals(text: str, value: float) -> None:
    assert number(text) == pytest.approx(value)


def test_values_stay_where_they_mean_something() -> None:
    for constant in constants().values():
        low, high = constant.values()
        assert abs(low) < abs(constant.today) < abs(high) or (constant.whole and low == constant.today == 1)
        assert not abs(constant.today) < 1 or abs(high) < 1 or constant.today == 0.5
        assert not constant.whole or (low >= 1 and low == int(low) and high == int(high))


def test_cost_is_variance_times_seconds() -> None:
    rng = np.random.default_rng(3)

    def runs(deviation: float, seconds: float) -> list[tuple[float, Picture]]:
        noise = rng.normal(size=(16, 32, 32, 3)) * deviation
        return [(seconds, np.asarray(1 + picture, np.float32)) for picture in noise]

    assert cost(runs(0.1, 3), 1) == pytest.approx(0.01 * 3, rel=0.05)
    assert cost(runs(0.1, 3), 16) == pytest.approx(0.01 * 3 / 256, rel=0.4)
    assert float(ratio(runs(0.1, 3), runs(0.2, 1), 1).split()[0]) == pytest.approx(0.75, abs=0.05)
