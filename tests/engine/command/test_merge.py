# SPDX-License-Identifier: GPL-3.0-or-later
"""Merged pictures: means, standard errors and counts, and what does not go together."""

from pathlib import Path

import numpy as np
import pytest
from scipy import stats

from tests.engine import scenes
from tests.engine.command.pictures import merge
from tests.engine.scenes import changed, hazy_moon, read_exr, render
from tests.engine.significance import LEVEL

pytestmark = pytest.mark.usefixtures("glimmer_command")


def test_merge_arithmetic(tmp_path: Path) -> None:
    aovs = ["--aov", "normal,depth,object_index,material_index,sample_count"]
    samples = {"a": 2, "b": 5, "c": 9}
    parts = {
        name: render(tmp_path, hazy_moon(), "--spp", spp, "--seed", seed, *aovs, name=name)
        for seed, (name, spp) in enumerate(samples.items())
    }
    assert merge(tmp_path, "a", "b", "c").returncode == 0
    merged = read_exr(tmp_path / "merged.exr")
    weights = {name: spp / 16 for name, spp in samples.items()}
    for channel in ["R", "G", "B", "normal.X", "normal.Y", "normal.Z"]:
        mean = sum(weights[name] * part.channels[channel].astype(np.float64) for name, part in parts.items())
        assert np.array_equal(merged.channels[channel], np.asarray(mean).astype(np.float32)), channel
    for channel in ["stderr.R", "stderr.G", "stderr.B"]:
        variance = sum((weights[name] * part.channels[channel].astype(np.float64)) ** 2 for name, part in parts.items())
        assert merged.channels[channel] == pytest.approx(np.sqrt(variance), rel=1e-6), channel
    depths = np.stack([part.channels["depth.Z"] for part in parts.values()]).astype(np.float64)
    hits = np.where(depths < 1e10, np.array(list(weights.values()))[:, None, None], 0)
    with np.errstate(invalid="ignore"):
        expected = np.where(hits.sum(0) > 0, (hits * depths).sum(0) / hits.sum(0), 1e10)
    assert merged.channels["depth.Z"] == pytest.approx(expected, rel=1e-6)
    assert (merged.channels["sample_count.X"] == 16).all()
    for channel in ["object_index.X", "material_index.X"]:
        assert np.array_equal(merged.channels[channel], parts["a"].channels[channel])
    attributes = merged.attributes
    assert attributes["glimmer:spp"] == 16 and attributes["glimmer:seed"] == "0, 1, 2"
    seconds = sum(part.attributes["glimmer:seconds"] for part in parts.values())
    assert attributes["glimmer:seconds"] == pytest.approx(seconds, rel=1e-5)
    assert attributes["glimmer:scene"] == parts["a"].attributes["glimmer:scene"]


def test_merged_standard_error_is_that_of_the_merged_mean(tmp_path: Path) -> None:
    """Half the squared difference of two merged pictures of disjoint seeds is an unbiased estimate of the variance of
    one; so are their own squared standard errors. Their difference, summed over pixels, has mean 0 whatever the
    pixels share: Student's t over independent pairs, whose parts have unequal numbers of samples."""
    pairs, seed = [], 0
    for _ in range(20):
        means, variances = [], []
        for _ in range(2):
            for name, samples in (("a", 4), ("b", 12)):
                render(tmp_path, hazy_moon(), "--spp", samples, "--seed", seed, "--threads", 1, name=name)
                seed += 1
            assert merge(tmp_path, "a", "b").returncode == 0
            merged = read_exr(tmp_path / "merged.exr")
            means.append(merged.rgb.astype(np.float64))
            variances.append(merged.layer("stderr").astype(np.float64) ** 2)
        pairs.append((((means[0] - means[1]) ** 2 / 2).sum(), ((variances[0] + variances[1]) / 2).sum()))
    found, claimed = np.array(pairs).T
    p = stats.ttest_1samp(found - claimed, 0).pvalue
    ratio = claimed.sum() / found.sum()
    assert p >= LEVEL, f"the claimed variance is {ratio:.3f} of the true one, p = {p:.2g}"


def test_merged_picture_can_be_merged(tmp_path: Path) -> None:
    for seed, name in enumerate("abc"):
        render(tmp_path, hazy_moon(), "--spp", 2, "--seed", seed, name=name)
    assert merge(tmp_path, "a", "b").returncode == 0
    (tmp_path / "merged.exr").rename(tmp_path / "ab.exr")
    assert merge(tmp_path, "ab", "c").returncode == 0
    assert read_exr(tmp_path / "merged.exr").attributes["glimmer:spp"] == 6
    done = merge(tmp_path, "ab", "b")
    assert done.returncode == 1 and "has the seed 1 as" in done.stderr


def test_merged_pixels_keep_their_aspect(tmp_path: Path) -> None:
    scene = changed(hazy_moon(), ("film", "pixel_aspect"), 1.5)
    for seed, name in enumerate("ab"):
        picture = render(tmp_path, scene, "--spp", 2, "--seed", seed, name=name)
        assert picture.attributes["PixelAspectRatio"] == 1.5
    assert merge(tmp_path, "a", "b").returncode == 0
    assert read_exr(tmp_path / "merged.exr").attributes["PixelAspectRatio"] == 1.5


def test_merge_into_one_of_its_parts(tmp_path: Path) -> None:
    for seed, name in enumerate(("merged", "b")):
        render(tmp_path, hazy_moon(), "--spp", 2, "--seed", seed, name=name)
    assert merge(tmp_path, "merged", "b").returncode == 0
    assert read_exr(tmp_path / "merged.exr").attributes["glimmer:spp"] == 4


def test_merge_without_a_standard_error(tmp_path: Path) -> None:
    """It is not known of one sample, and so not of the whole."""
    render(tmp_path, hazy_moon(), "--spp", 1, name="a")
    render(tmp_path, hazy_moon(), "--spp", 4, "--seed", 1, name="b")
    assert merge(tmp_path, "a", "b").returncode == 0
    assert read_exr(tmp_path / "merged.exr").channels.keys() == {"R", "G", "B"}


def test_merge_refuses(tmp_path: Path) -> None:
    cropped = scenes.changed(hazy_moon(), ("film", "crop"), [0, 0, 24, 15])
    render(tmp_path, hazy_moon(), "--spp", 2, name="a")
    render(tmp_path, hazy_moon(), "--spp", 3, name="same_seed")
    render(tmp_path, cropped, "--spp", 2, "--seed", 1, name="cropped")
    brighter = scenes.changed(hazy_moon(), ("spheres", 0, "radius"), 0.71)
    render(tmp_path, brighter, "--spp", 2, "--seed", 1, name="other_scene")
    render(tmp_path, hazy_moon(), "--spp", 2, "--seed", 1, "--aov", "depth", name="more")
    scenes.write_image(tmp_path / "foreign.exr", np.ones((16, 24, 3), np.float32))
    for name, message in {
        "same_seed": "has the seed 0 as",
        "cropped": "24 x 15 pixels at (0, 0) are not the 24 x 16 at (0, 0) of",
        "other_scene": "shows another scene than",
        "foreign": "was not written by glimmer",
    }.items():
        done = merge(tmp_path, "a", name)
        assert done.returncode == 1 and done.stderr.count("\n") == 1, done.stderr
        assert done.stderr.startswith(f"{tmp_path / name}.exr: {message}")
        assert not (tmp_path / "merged.exr").exists()
    done = merge(tmp_path, "a", "more")
    assert done.returncode == 1
    assert done.stderr.startswith(f'{tmp_path / "a"}.exr: has no channel "depth.Z", which')
