# SPDX-License-Identifier: GPL-3.0-or-later
"""Every kind of picture: channels, layers, numbers and windows; a write that fails."""

import json
import re
import resource
from pathlib import Path

import numpy as np
import pytest

from tests.engine import scenes
from tests.engine.command.pictures import AOV_CHANNELS, IN_THE_MAIN_LAYER
from tests.engine.scenes import hazy_moon, read_pfm, read_pixels, render, run_glimmer, write_scene

pytestmark = pytest.mark.usefixtures("glimmer_command")


def test_exr(tmp_path: Path) -> None:
    picture = render(tmp_path, hazy_moon(), "--spp", 4, "--seed", 5)
    assert picture.channels.keys() == {"R", "G", "B", "stderr.R", "stderr.G", "stderr.B"}
    assert picture.window == (0, 0, 24, 16) and picture.size == (24, 16)
    assert all(np.isfinite(channel).all() for channel in picture.channels.values())
    attributes = picture.attributes
    assert attributes["glimmer:spp"] == 4 and attributes["glimmer:seed"] == "5"
    assert attributes["glimmer:seconds"] > 0 and attributes["glimmer:integrator"] == "path"
    assert re.fullmatch(r"\d+\.\d+\.\d+", attributes["glimmer:version"])
    assert re.fullmatch(r"xxh64:[0-9a-f]{16}", attributes["glimmer:scene"])
    assert str(read_pixels(tmp_path / "out.exr")[0].format) == "float"


def test_one_sample_has_no_standard_error(tmp_path: Path) -> None:
    picture = render(tmp_path, hazy_moon(), "--spp", 1, "--report", tmp_path / "r.json")
    assert picture.channels.keys() == {"R", "G", "B"}
    assert json.loads((tmp_path / "r.json").read_text())["error"] is None


def test_every_aov(tmp_path: Path) -> None:
    picture = render(tmp_path, hazy_moon(), "--spp", 2, "--aov", ",".join(AOV_CHANNELS))
    layers = {name: channels for name, channels in AOV_CHANNELS.items() if name not in IN_THE_MAIN_LAYER}
    expected = {f"{name}.{c}" for name, channels in layers.items() for c in channels}
    assert picture.channels.keys() == expected | {"R", "G", "B", "A"}
    assert (picture.channels["sample_count.X"] == 2).all()


def test_aovs_change_no_pixel(tmp_path: Path) -> None:
    plain = render(tmp_path, hazy_moon(), "--spp", 3, name="plain")
    more = render(tmp_path, hazy_moon(), "--spp", 3, "--aov", "depth,normal,fog", name="more")
    assert all(np.array_equal(plain.channels[name], more.channels[name]) for name in plain.channels)


def test_crop_is_a_data_window(tmp_path: Path) -> None:
    """The same bits as of the whole, in fog whose peak lets no light vertices be shared by what is in the crop."""
    peaked = scenes.changed(hazy_moon(), ("medium", "g"), 0.95)
    whole = render(tmp_path, peaked, "--spp", 3, "--aov", "depth", name="whole")
    content = scenes.changed(peaked, ("film", "crop"), [5, 2, 20, 13])
    part = render(tmp_path, content, "--spp", 3, "--aov", "depth", name="part")
    assert part.window == (5, 2, 20, 13) and part.size == (24, 16)
    assert all(np.array_equal(part.channels[name], whole.channels[name][2:13, 5:20]) for name in whole.channels)


def test_a_transparent_picture_has_alpha(tmp_path: Path) -> None:
    """Premultiplied in an .exr, straight in a .png; merged like colours."""
    content = scenes.changed(scenes.furnace(), ("film", "transparent"), True)
    picture = render(tmp_path, content, "--spp", 8)
    alpha = picture.channels["A"]
    assert alpha.min() == 0 and alpha.max() == 1 and ((alpha > 0) & (alpha < 1)).any()
    assert not picture.rgb[alpha == 0].any()
    path = tmp_path / "out.png"
    assert run_glimmer(tmp_path / "out.json", "-o", path, "--spp", 8).returncode == 0
    spec, pixels = read_pixels(path, "uint8")
    assert spec.nchannels == 4
    np.testing.assert_array_equal(pixels[..., 3], np.rint(255 * alpha))
    linear = np.where(alpha > 0, picture.channels["G"] / np.where(alpha > 0, alpha, 1), 0).astype(np.float64)
    encoded = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * np.maximum(linear, 1e-9) ** (1 / 2.4) - 0.055)
    assert np.abs(pixels[..., 1] - 255 * np.clip(encoded, 0, 1)).max() <= 0.51
    other = render(tmp_path, content, "--spp", 8, "--seed", 1, name="other")
    files = (tmp_path / "out.exr", tmp_path / "other.exr")
    assert run_glimmer("merge", *files, "-o", tmp_path / "both.exr").returncode == 0
    both = scenes.read_exr(tmp_path / "both.exr").channels["A"]
    np.testing.assert_allclose(both, (alpha + other.channels["A"]) / 2, atol=1e-6)


def test_pfm(tmp_path: Path) -> None:
    """The very floats of the .exr; rows from the bottom up, little-endian."""
    reference = render(tmp_path, hazy_moon(), "--spp", 2).rgb
    path = tmp_path / "out.pfm"
    assert run_glimmer(tmp_path / "out.json", "-o", path, "--spp", 2).returncode == 0
    assert path.read_bytes().startswith(b"PF\n24 16\n-1.0\n")
    assert np.array_equal(read_pfm(path), reference)


def test_png_tone_map(tmp_path: Path) -> None:
    """sRGB's curve, clipped, no exposure: within the rounding of one level of the formula in float64."""
    content = scenes.removed(hazy_moon(), ("medium",))
    content["environment"] = {"radiance": [0.0, 0.001, 5.0]}  # black, the straight part of the curve, and beyond white
    reference = render(tmp_path, content, "--spp", 2).rgb.astype(np.float64)
    path = tmp_path / "out.png"
    assert run_glimmer(tmp_path / "out.json", "-o", path, "--spp", 2).returncode == 0
    spec, pixels = read_pixels(path, "uint8")
    assert str(spec.format) == "uint8" and pixels.shape == (16, 24, 3)
    linear = np.clip(reference, 0, 1)
    encoded = 255 * np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    assert np.abs(pixels - encoded).max() <= 0.5 + 1e-3
    assert pixels.min() == 0 and pixels.max() == 255


def test_hdr(tmp_path: Path) -> None:
    """RGBE keeps 8 bits below the largest channel's power of two."""
    reference = np.maximum(render(tmp_path, hazy_moon(), "--spp", 2).rgb, 0)
    path = tmp_path / "out.hdr"
    assert run_glimmer(tmp_path / "out.json", "-o", path, "--spp", 2).returncode == 0
    pixels = read_pixels(path)[1]
    assert (np.abs(pixels - reference) <= reference.max(axis=2, keepdims=True) / 128).all()
    assert reference.max() > 0


def test_crop_of_png(tmp_path: Path) -> None:
    path = write_scene(tmp_path, scenes.changed(hazy_moon(), ("film", "crop"), [5, 2, 20, 13]))
    assert run_glimmer(path, "-o", tmp_path / "out.png", "--spp", 1).returncode == 0
    assert read_pixels(tmp_path / "out.png")[1].shape == (11, 15, 3)


def small_files() -> None:
    resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))


@pytest.mark.parametrize("name", ["out.exr", "out.png", "out.pfm", "out.hdr"])
def test_failed_write_leaves_nothing(name: str, tmp_path: Path) -> None:
    """As on a full disk: exit status 2, one line, and the picture that was there before is still there."""
    content = scenes.changed(hazy_moon(), ("film",), {"width": 64, "height": 48})
    path = write_scene(tmp_path, content)
    (tmp_path / name).write_bytes(b"before")
    done = run_glimmer(path, "-o", tmp_path / name, "--spp", 1, "--quiet", preexec_fn=small_files)
    assert done.returncode == 2, done.stderr
    assert done.stderr.startswith(f"{tmp_path / name}: cannot be written: ") and done.stderr.count("\n") == 1
    assert (tmp_path / name).read_bytes() == b"before"
    assert sorted(file.name for file in tmp_path.iterdir()) == [name, "scene.json"]
