# SPDX-License-Identifier: GPL-3.0-or-later
"""What settings do to a picture: threads and tiles nothing; seeds, integrators and limits what they say."""

import json
from pathlib import Path

import numpy as np
import pytest

from tests.engine.command.pictures import merge, same_bits
from tests.engine.scenes import furnace, hazy_moon, read_exr, render, run_glimmer, write_scene

pytestmark = pytest.mark.usefixtures("glimmer_command")


@pytest.mark.parametrize("integrator", ["path", "baseline"])
def test_threads_and_tiles_change_no_bit(integrator: str, tmp_path: Path) -> None:
    aovs = "albedo,normal,depth,fog,direct,indirect,emission,material_index"
    common = ["--spp", 5, "--aov", aovs, "--integrator", integrator]
    reference = render(tmp_path, hazy_moon(), *common, "--threads", 1)
    for threads, tile in [(1, 7), (2, 16), (3, 1), (5, 1000)]:
        other = render(tmp_path, hazy_moon(), *common, "--threads", threads, "--tile", tile, name="other")
        assert same_bits(reference, other), f"{threads} threads, tiles of {tile}"


def test_seeds_give_other_pictures(tmp_path: Path) -> None:
    pictures = [render(tmp_path, hazy_moon(), "--spp", 2, "--seed", seed).rgb for seed in (0, 1, 2**64 - 1)]
    assert not np.array_equal(pictures[0], pictures[1]) and not np.array_equal(pictures[1], pictures[2])


def test_integrators_are_named(tmp_path: Path) -> None:
    path = render(tmp_path, hazy_moon(), "--spp", 2, "--integrator", "path", name="path")
    assert same_bits(path, render(tmp_path, hazy_moon(), "--spp", 2)), "path is the default"
    baseline = render(tmp_path, hazy_moon(), "--spp", 2, "--integrator", "baseline", name="baseline")
    assert baseline.attributes["glimmer:integrator"] == "baseline" and not np.array_equal(path.rgb, baseline.rgb)


FORMER_NAMES = {
    "report": "baseline",
    "path-no-light-rays": "path-no-emitter-rays",
    "path-no-lines": "path-no-equiangular",
    "path-no-deep-lines": "path-no-deep-equiangular",
    "path-no-pixel-points": "path-no-pixel-ris",
}


@pytest.mark.parametrize("former", FORMER_NAMES)
def test_former_names_of_integrators_work_and_say_so_once(former: str, tmp_path: Path) -> None:
    present = FORMER_NAMES[former]
    expected = render(tmp_path, hazy_moon(), "--spp", 1, "--integrator", present, name="present")
    scene, output, report = tmp_path / "present.json", tmp_path / "former.exr", tmp_path / "r.json"
    done = run_glimmer(scene, "-o", output, "--spp", 1, "--integrator", former, "--report", report)
    assert done.returncode == 0 and done.stderr.count("is now called") == 1
    assert f'--integrator: warning: "{former}" is now called "{present}"\n' in done.stderr
    picture, told = read_exr(output), json.loads(report.read_text())
    assert same_bits(expected, picture) and picture.attributes["glimmer:integrator"] == present
    assert told["integrator"] == present
    assert told["warnings"] == [f'integrator "{former}" is now called "{present}"']
    assert told["warning_codes"] == ["renamed_integrator"]


def test_present_names_of_integrators_need_no_word(tmp_path: Path) -> None:
    scene = write_scene(tmp_path, hazy_moon())
    report = tmp_path / "r.json"
    done = run_glimmer(scene, "-o", tmp_path / "o.exr", "--spp", 1, "--integrator", "baseline", "--report", report)
    assert done.returncode == 0 and "now called" not in done.stderr and json.loads(report.read_text())["warnings"] == []


def test_default_is_64_samples(tmp_path: Path) -> None:
    assert render(tmp_path, furnace()).attributes["glimmer:spp"] == 64


def test_time_limit(tmp_path: Path) -> None:
    picture = render(tmp_path, hazy_moon(), "--time", 0.5, "--report", tmp_path / "r.json")
    report = json.loads((tmp_path / "r.json").read_text())
    assert picture.attributes["glimmer:spp"] == report["spp"] >= 1
    assert report["seconds"]["render"] >= 0.5


def test_error_limit(tmp_path: Path) -> None:
    render(tmp_path, hazy_moon(), "--error", 0.05, "--time", 60, "--report", tmp_path / "r.json")
    report = json.loads((tmp_path / "r.json").read_text())
    assert report["error"]["high"] <= 0.05 and report["seconds"]["render"] < 60


def test_depth_limits_are_biases_by_name(tmp_path: Path) -> None:
    free = render(tmp_path, hazy_moon(), "--spp", 16, "--report", tmp_path / "r.json")
    assert json.loads((tmp_path / "r.json").read_text())["biased_by"] == []
    content = {**hazy_moon(), "render": {"max_depth": 1, "max_scatter": 0}}
    limited = render(tmp_path, content, "--spp", 16, "--report", tmp_path / "r.json")
    biases = json.loads((tmp_path / "r.json").read_text())["biased_by"]
    assert any("max_depth" in bias for bias in biases) and any("max_scatter" in bias for bias in biases)
    assert limited.attributes["glimmer:biased_by"] == ", ".join(biases)
    assert limited.rgb.mean() < free.rgb.mean()


def test_adaptive(tmp_path: Path) -> None:
    """Told of at the end and in the report; with a checkpoint the very bits; merged as any other."""
    common = ["--adaptive", "--aov", "sample_count", "--report", tmp_path / "r.json"]
    whole = render(tmp_path, hazy_moon(), "--spp", 30, *common, name="whole")
    counts = whole.channels["sample_count.X"]
    told = json.loads((tmp_path / "r.json").read_text())["adaptive"]
    assert told == {"fewest": counts.min(), "most": counts.max()} and counts.min() < 30 < counts.max()
    for samples in (13, 21, 30):
        part = render(tmp_path, hazy_moon(), "--spp", samples, *common, "--checkpoint", tmp_path / "c", name="part")
    assert same_bits(whole, part)
    other = render(tmp_path, hazy_moon(), "--spp", 20, "--seed", 1, *common, name="other")
    assert merge(tmp_path, "whole", "other").returncode == 0
    merged = read_exr(tmp_path / "merged.exr")
    assert np.array_equal(merged.channels["sample_count.X"], counts + other.channels["sample_count.X"])
    mean = 0.6 * whole.rgb.astype(np.float64) + 0.4 * other.rgb.astype(np.float64)
    assert merged.rgb == pytest.approx(mean, rel=1e-6, abs=1e-9)
    path = write_scene(tmp_path, hazy_moon())
    for options, words in ((common[:1], "adaptive sampling: pixels took"), ([], None)):
        done = run_glimmer(path, "-o", tmp_path / "out.exr", "--spp", 18, *options)
        assert (words in done.stderr) if words else ("adaptive sampling" not in done.stderr)
    refused = run_glimmer(path, "-o", tmp_path / "out.exr", "--spp", 40, "--checkpoint", tmp_path / "c")
    assert refused.returncode == 1 and "with adaptive sampling, and this one is without" in refused.stderr
