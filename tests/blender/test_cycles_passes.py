# SPDX-License-Identifier: GPL-3.0-or-later
"""Shader AOVs, holdout shaders and ambient occlusion, held against Cycles' pictures."""

from pathlib import Path

import numpy as np
import pytest
from hosts import Host
from test_render import Pixels, channels

SCRIPT = Path(__file__).with_name("passes_script.py")
SAMPLES = 64


@pytest.fixture(scope="module")
def folder(host: Host, tmp_path_factory: pytest.TempPathFactory) -> Path:
    result = tmp_path_factory.mktemp("passes")
    host.run_script(SCRIPT, str(result))
    return result


def both(folder: Path, ending: str) -> tuple[Pixels, Pixels]:
    """A channel of Cycles' and of ours."""
    found = []
    for engine in ("CYCLES", "GLIMMER"):
        matching = [pixels for name, pixels in channels(folder / f"{engine}.exr").items() if name.endswith(ending)]
        assert len(matching) == 1, (engine, ending)
        found.append(matching[0])
    return found[0], found[1]


@pytest.mark.parametrize(
    "channel", ["Places.R", "Places.G", "Places.B", "Places.A", "Number.X", "Nobody.R", "Combined.A"]
)
def test_what_is_no_light_is_the_same(folder: Path, channel: str) -> None:
    cycles, ours = both(folder, channel)
    # Samples lie within a hundredth of a pixel: edges may part them.
    apart = np.abs(ours - cycles) > 5e-3 * (1 + np.abs(cycles))
    assert apart.mean() < 1e-2, (channel, int(apart.sum()), float(np.abs(ours - cycles).max()))
    assert channel.startswith("Nobody") or cycles.std() > 0.05


def test_occlusion_is_the_same(folder: Path) -> None:
    names = ("AO.R", "Ambient Occlusion.R")
    have = channels(folder / "CYCLES.exr")
    ending = next(name for name in names if any(key.endswith(name) for key in have))
    cycles, ours = both(folder, ending)
    assert 0.3 < cycles.mean() < 0.95 and cycles.std() > 0.1
    # Each pixel is the mean of yes and no, twice.
    error = np.sqrt(2 * 0.25 / SAMPLES)
    assert np.abs(ours - cycles).max() < 5 * error
    np.testing.assert_allclose(ours.mean(), cycles.mean(), atol=4 * error / np.sqrt(cycles.size))
