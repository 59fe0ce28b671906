# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line: arguments, every kind of output, checkpoints, merging, interruption, exit statuses."""

import csv
import json
import os
import pty
import re
import resource
import signal
import subprocess
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import stats

from tests.engine import scenes
from tests.engine.scenes import (
    Exr,
    furnace,
    hazy_moon,
    read_exr,
    read_pfm,
    read_pixels,
    render,
    run_glimmer,
    write_scene,
)
from tests.engine.significance import LEVEL

pytestmark = pytest.mark.usefixtures("glimmer_command")


def same_bits(a: Exr, b: Exr) -> bool:
    return a.channels.keys() == b.channels.keys() and all(
        a.channels[name].tobytes() == b.channels[name].tobytes() for name in a.channels
    )


# ---- arguments -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ([], "glimmer: the scene file is missing"),
        (["scene.json"], "glimmer: -o OUT is missing; .exr, .png, .pfm and .hdr are allowed"),
        (["scene.json", "-o"], "glimmer: "),
        (["scene.json", "-o", "out.jpg"], '-o: "out.jpg" does not end in .exr, .png, .pfm or .hdr'),
        (["scene.json", "-o", "nowhere/out.exr"], '-o: "nowhere/out.exr": no such folder'),
        (["scene.json", "-o", "folder.exr"], '-o: "folder.exr" is a folder; a file is allowed'),
        (["scene.json", "-o", "out.exr", "--sppp", "4"], "glimmer: The following argument"),
        (["scene.json", "-o", "out.exr", "other.json"], "glimmer: The following argument was not expected: other.json"),
        (["scene.json", "-o", "out.exr", "--spp", "0"], '--spp: "0" is not an integer from 1 to 2147483647'),
        (["scene.json", "-o", "out.exr", "--spp=-4"], '--spp: "-4" is not an integer from 1 to 2147483647'),
        (["scene.json", "-o", "out.exr", "--spp", "4.5"], '--spp: "4.5" is not an integer from 1 to 2147483647'),
        (["scene.json", "-o", "out.exr", "--spp", "4x"], '--spp: "4x" is not an integer from 1 to 2147483647'),
        (["scene.json", "-o", "out.exr", "--spp", ""], '--spp: "" is not an integer from 1 to 2147483647'),
        (["scene.json", "-o", "out.exr", "--time", "0"], '--time: "0" is not a number above 0'),
        (["scene.json", "-o", "out.exr", "--time", "nan"], '--time: "nan" is not a number above 0'),
        (["scene.json", "-o", "out.exr", "--time", "inf"], '--time: "inf" is not a number above 0'),
        (["scene.json", "-o", "out.exr", "--error", "small"], '--error: "small" is not a number above 0'),
        (["scene.json", "-o", "out.exr", "--seed=-1"], '--seed: "-1" is not an integer from 0 to 18446744073709551615'),
        (["scene.json", "-o", "out.exr", "--threads", "0"], '--threads: "0" is not an integer from 1 to 4096'),
        (["scene.json", "-o", "out.exr", "--tile", "0"], '--tile: "0" is not an integer from 1 to 65536'),
        (
            ["scene.json", "-o", "out.exr", "--integrator", "p"],
            '--integrator: "p" is not an integrator; integrators are "path"',
        ),
        (["scene.json", "-o", "out.exr", "--aov", "depth,x"], '--aov: "x" is not an AOV; see glimmer --list-aovs'),
        (["scene.json", "-o", "out.exr", "--aov", "depth,"], '--aov: "" is not an AOV'),
        (["scene.json", "-o", "out.png", "--aov", "depth"], '--aov: "out.png" has no layers; only .exr has'),
        (["scene.json", "-o", "out.exr", "--report", "r.txt"], '--report: "r.txt" does not end in .json'),
        (["scene.json", "-o", "out.exr", "--curve", "c.pdf"], '--curve: "c.pdf" does not end in .csv or .png'),
        (["scene.json", "-o", "out.exr", "--checkpoint", "x/c"], '--checkpoint: "x/c": no such folder'),
        (
            ["scene.json", "-o", "out.exr", "--checkpoint-interval", "5"],
            "--checkpoint-interval: there is no --checkpoint FILE to save to",
        ),
        (
            ["scene.json", "-o", "out.exr", "--checkpoint", "c", "--checkpoint-interval", "0"],
            '--checkpoint-interval: "0" is not a number above 0',
        ),
        (["scene.json", "-o", "a.png", "--curve", "./a.png"], 'glimmer: "./a.png" is named twice'),
        (["scene.json", "-o", "out.exr", "--report", "scene.json"], 'glimmer: "scene.json" is named twice'),
        (["gone.json", "-o", "out.exr"], "gone.json: no such file"),
        (["merge"], "glimmer: "),
        (["merge", "a.exr", "-o", "c.exr"], 'merge: "a.exr" is one picture; two or more can be merged'),
        (["merge", "a.exr", "b.exr"], "glimmer: --output is required"),
        (["merge", "a.exr", "b.exr", "-o", "c.png"], '-o: "c.png" does not end in .exr'),
        (["merge", "a.exr", "b.exr", "-o", "c.exr"], "a.exr: no such file"),
        (["merge", "scene.json", "b.exr", "-o", "c.exr"], "scene.json: is not an .exr file"),
    ],
    ids=lambda value: " ".join(value) if isinstance(value, list) else "",
)
def test_bad_arguments(arguments: list[str], message: str, tmp_path: Path) -> None:
    write_scene(tmp_path, furnace())
    (tmp_path / "folder.exr").mkdir()
    before = sorted(tmp_path.iterdir())
    done = run_glimmer(*arguments, cwd=tmp_path)
    assert done.returncode == 1, done.stderr
    assert done.stderr.startswith(message)
    assert done.stderr.count("\n") == 1 and done.stderr.endswith("\n") and done.stdout == ""
    assert sorted(tmp_path.iterdir()) == before, "a failed run left files"


def test_information() -> None:
    version = run_glimmer("--version")
    assert version.returncode == 0 and re.fullmatch(r"glimmer \d+\.\d+\.\d+\n", version.stdout)
    usage = run_glimmer("--help")
    options = "--spp --time --error --integrator --seed --threads --tile --aov --checkpoint --checkpoint-interval"
    options += " --report --curve --quiet"
    assert usage.returncode == 0 and all(option in usage.stdout for option in options.split())
    assert "PICTURE A.exr B.exr ..." in run_glimmer("merge", "--help").stdout
    integrators = run_glimmer("--list-integrators").stdout.splitlines()
    assert [line.split()[0] for line in integrators] == ["path", "report"]
    aovs = run_glimmer("--list-aovs").stdout.splitlines()
    assert [line.split()[0] for line in aovs] == list(AOV_CHANNELS)


# ---- pictures ------------------------------------------------------------------------------------------------------

AOV_CHANNELS = {
    "combined": "RGB",
    "stderr": "RGB",
    "albedo": "RGB",
    "normal": "XYZ",
    "depth": "Z",
    "emission": "RGB",
    "direct": "RGB",
    "indirect": "RGB",
    "fog": "RGB",
    "object_index": "X",
    "material_index": "X",
    "sample_count": "X",
}


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
    expected = {f"{name}.{c}" for name, channels in AOV_CHANNELS.items() if name != "combined" for c in channels}
    assert picture.channels.keys() == expected | {"R", "G", "B"}
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


# ---- determinism ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("integrator", ["path", "report"])
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
    report = render(tmp_path, hazy_moon(), "--spp", 2, "--integrator", "report", name="report")
    assert report.attributes["glimmer:integrator"] == "report" and not np.array_equal(path.rgb, report.rgb)


# ---- limits --------------------------------------------------------------------------------------------------------


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


# ---- report and curve ----------------------------------------------------------------------------------------------


def test_report(tmp_path: Path) -> None:
    content = hazy_moon()
    content["meshes"]["spare"] = scenes.QUAD
    picture = render(tmp_path, content, "--spp", 16, "--report", tmp_path / "r.json")
    report: dict[str, Any] = json.loads((tmp_path / "r.json").read_text())
    assert report["spp"] == 16
    seconds = report["seconds"]
    assert all(seconds[key] > 0 for key in ("load", "build", "render", "cpu"))
    assert report["rays"] > 16 * 24 * 16 and report["peak_bytes"] > 0
    assert report["invalid_samples"] == {"count": 0, "first": None}
    error = report["error"]
    assert 0 <= error["low"] <= error["relmse"] <= error["high"] and 0 < error["confidence"] < 1
    assert [row[2] for row in report["curve"]] == sorted({row[2] for row in report["curve"]})
    assert all(len(row) == 6 for row in report["curve"]) and report["curve"][-1][2] == 16
    assert report["biased_by"] == [] and isinstance(report["kernel"], str)
    assert 'mesh "spare": no object uses it' in report["left_out"] and isinstance(report["warnings"], list)
    assert picture.attributes["glimmer:seconds"] == pytest.approx(seconds["render"], rel=0.05, abs=0.01)


def test_curve_table(tmp_path: Path) -> None:
    render(tmp_path, hazy_moon(), "--spp", 32, "--report", tmp_path / "r.json", "--curve", tmp_path / "c.csv")
    rows = list(csv.reader((tmp_path / "c.csv").read_text().splitlines()))
    assert rows[0] == ["seconds", "cpu_seconds", "spp", "relmse", "low", "high"]
    curve = [row for row in json.loads((tmp_path / "r.json").read_text())["curve"] if row[3] is not None]
    assert len(curve) >= 3
    assert [[float(cell) if cell else None for cell in row] for row in rows[1:]] == curve


def plot_colours(path: Path) -> NDArray[np.uint8]:
    pixels: NDArray[np.uint8] = read_pixels(path, "uint8")[1]
    assert pixels.shape == (600, 960, 3)
    return np.unique(pixels.reshape(-1, 3), axis=0)


def test_curve_plot(tmp_path: Path) -> None:
    """The colours of line, band and guide are all there; a picture without an estimate gets a plot that says so."""
    render(tmp_path, hazy_moon(), "--spp", 32, "--curve", tmp_path / "c.png")
    drawn = plot_colours(tmp_path / "c.png")
    for colour in ([33, 84, 173], [204, 222, 245], [217, 115, 51]):
        assert (np.abs(drawn.astype(int) - colour).max(axis=1) <= 1).any(), colour
    render(tmp_path, hazy_moon(), "--spp", 1, "--curve", tmp_path / "none.png")
    assert not (np.abs(plot_colours(tmp_path / "none.png").astype(int) - [33, 84, 173]).max(axis=1) <= 1).any()


def test_black_picture_has_no_relative_error(tmp_path: Path) -> None:
    render(tmp_path, scenes.scene(), "--spp", 8, "--report", tmp_path / "r.json", "--curve", tmp_path / "c.csv")
    assert json.loads((tmp_path / "r.json").read_text())["error"] is None
    assert (tmp_path / "c.csv").read_text() == "seconds,cpu_seconds,spp,relmse,low,high\n"


# ---- progress ------------------------------------------------------------------------------------------------------


def test_summary_and_quiet(tmp_path: Path) -> None:
    path = write_scene(tmp_path, hazy_moon())
    loud = run_glimmer(path, "-o", tmp_path / "out.exr", "--spp", 4)
    assert re.search(
        r"out\.exr: 4 spp in \d+\.\d\d s, relMSE [0-9.e-]+ \([0-9.e-]+ to [0-9.e-]+\)(, not .*)?\n$", loud.stderr
    )
    assert loud.stdout == ""
    quiet = run_glimmer(path, "-o", tmp_path / "out.exr", "--spp", 4, "--quiet")
    assert quiet.stderr == "" and quiet.stdout == ""


def test_progress_on_a_terminal(tmp_path: Path) -> None:
    path = write_scene(tmp_path, hazy_moon())
    ours, theirs = pty.openpty()
    command = [os.environ["GLIMMER_BIN"], str(path), "-o", str(tmp_path / "out.exr"), "--time", "1.5"]
    process = subprocess.Popen(command, stderr=theirs)
    os.close(theirs)
    shown = b""
    try:
        while chunk := os.read(ours, 65536):
            shown += chunk
    except OSError:  # how Linux says that the other end is closed
        pass
    os.close(ours)
    assert process.wait(60) == 0
    updates = shown.decode().split("\r")
    assert sum("spp" in update and "left" in update for update in updates) >= 3
    assert "relMSE" in shown.decode() and shown.decode().count("\n") == 1


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


# ---- checkpoints ---------------------------------------------------------------------------------------------------


def test_resumed_render_has_the_same_bits(tmp_path: Path) -> None:
    common = ["--aov", "depth,albedo,material_index"]
    whole = render(tmp_path, hazy_moon(), "--spp", 21, *common)
    state = tmp_path / "state"
    for samples in (1, 6, 13, 21):
        part = render(tmp_path, hazy_moon(), "--spp", samples, *common, "--checkpoint", state, name="part")
        assert part.attributes["glimmer:spp"] == samples
    assert same_bits(whole, part)
    assert list(tmp_path.glob("state*")) == [state]


def wait_until_caught(process: "subprocess.Popen[str]") -> None:
    """Until it catches signals: loading libraries takes its time."""
    status = Path(f"/proc/{process.pid}/status")
    for _ in range(30_000):
        caught = next(line for line in status.read_text().splitlines() if line.startswith("SigCgt"))
        if int(caught.split()[1], 16) >> (signal.SIGTERM - 1) & 1:
            return
        time.sleep(0.001)
    raise AssertionError("it never caught signals")


def start_endless(folder: Path, *options: Any) -> "subprocess.Popen[str]":
    """A render that would take days, some way in."""
    path = write_scene(folder, hazy_moon())
    command = [os.environ["GLIMMER_BIN"], path, "-o", folder / "out.exr", "--spp", 1_000_000_000, *options]
    process = subprocess.Popen(list(map(str, command)), stderr=subprocess.PIPE, text=True)
    wait_until_caught(process)
    time.sleep(1)
    assert process.poll() is None
    return process


@pytest.mark.parametrize("signal_number", [signal.SIGINT, signal.SIGTERM])
def test_interruption_writes_what_is_there(signal_number: int, tmp_path: Path) -> None:
    process = start_endless(tmp_path, "--report", tmp_path / "r.json", "--curve", tmp_path / "c.csv")
    process.send_signal(signal_number)
    _, said = process.communicate(timeout=30)
    assert process.returncode == 130, said
    assert said.rstrip().endswith("(interrupted)")
    picture = read_exr(tmp_path / "out.exr")
    samples = picture.attributes["glimmer:spp"]
    assert samples >= 1 and json.loads((tmp_path / "r.json").read_text())["spp"] == samples
    assert same_bits(picture, render(tmp_path, hazy_moon(), "--spp", samples, name="again"))


def test_signals_that_arrive_together_are_one(tmp_path: Path) -> None:
    """`timeout` sends to the process, then to its group: one in three such renders used to leave nothing."""
    for _ in range(3):
        process = start_endless(tmp_path)
        for _ in range(50):
            process.send_signal(signal.SIGTERM)
            process.send_signal(signal.SIGTERM)
            process.send_signal(signal.SIGCONT)
        _, said = process.communicate(timeout=30)
        assert process.returncode == 130, said
        assert read_exr(tmp_path / "out.exr").attributes["glimmer:spp"] >= 1
        (tmp_path / "out.exr").unlink()


def test_a_second_signal_that_is_meant_ends_at_once(tmp_path: Path) -> None:
    """The process is held after the first one, lest it end by itself; it may still be faster than that."""
    for _ in range(20):
        process = start_endless(tmp_path)
        process.send_signal(signal.SIGTERM)
        time.sleep(0.005)
        process.send_signal(signal.SIGSTOP)
        time.sleep(1.2)
        process.send_signal(signal.SIGTERM)
        process.send_signal(signal.SIGCONT)
        process.communicate(timeout=30)
        if process.returncode == -signal.SIGTERM:
            return
        assert process.returncode == 130
    raise AssertionError("a second signal after more than a second was ignored 20 times")


def test_a_picture_that_is_not_written_is_told_of_in_any_case(tmp_path: Path) -> None:
    content = scenes.changed(hazy_moon(), ("film",), {"width": 1000, "height": 1000})
    words = [write_scene(tmp_path, content), "-o", tmp_path / "out.exr", "--threads", 1, "--quiet"]
    command = list(map(str, [os.environ["GLIMMER_BIN"], *words]))
    process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
    wait_until_caught(process)
    process.send_signal(signal.SIGTERM)
    _, said = process.communicate(timeout=60)
    assert process.returncode == 130
    assert said == f"{tmp_path / 'out.exr'}: not written: interrupted before the first sample was finished\n"
    assert not (tmp_path / "out.exr").exists()


def test_resumed_after_interruption(tmp_path: Path) -> None:
    process = start_endless(tmp_path, "--checkpoint", tmp_path / "state")
    process.send_signal(signal.SIGINT)
    process.communicate(timeout=30)
    assert process.returncode == 130
    samples = read_exr(tmp_path / "out.exr").attributes["glimmer:spp"] + 3
    resumed = render(tmp_path, hazy_moon(), "--spp", samples, "--checkpoint", tmp_path / "state", name="resumed")
    assert resumed.attributes["glimmer:spp"] == samples
    assert same_bits(resumed, render(tmp_path, hazy_moon(), "--spp", samples, name="whole"))


@pytest.mark.parametrize("fog", ["forward", "even"])
def test_checkpoint_survives_kills(fog: str, tmp_path: Path) -> None:
    """Killed at random moments, also while it saves, and taken up again and again: the bits of a render that nobody
    disturbed. Even fog shares light vertices between pixels."""
    content = scenes.changed(hazy_moon(), ("medium", "g"), 0.3 if fog == "forward" else 0)
    samples = 1500 if fog == "forward" else 600
    whole = render(tmp_path, content, "--spp", samples, name="whole")
    scene, state, output = tmp_path / "whole.json", tmp_path / "state", tmp_path / "out.exr"
    options = ["--spp", samples, "--tile", 8, "--checkpoint", state, "--checkpoint-interval", 0.01, "--quiet"]
    command = [os.environ["GLIMMER_BIN"], *map(str, [scene, "-o", output, *options])]
    rng = np.random.default_rng(11)
    kills = 0
    for _ in range(6):
        before = state.read_bytes() if state.exists() else b""
        process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
        while process.poll() is None and not (state.exists() and state.read_bytes() != before):
            time.sleep(0.005)
        time.sleep(rng.uniform(0, 0.1))
        process.kill()
        if process.wait(30) == 0:
            break
        kills += 1
        assert not output.exists(), "a picture before the end"
    assert kills >= 3, "it ended too soon: nothing was tested"
    done = run_glimmer(*command[1:])
    assert done.returncode == 0, done.stderr
    assert same_bits(read_exr(output), whole)


def test_checkpoint_interval(tmp_path: Path) -> None:
    """Saved again and again in the middle of the render, without a word from anyone; and never too early."""
    state = tmp_path / "state"
    for interval, saves in ((0.1, True), (1000, False)):
        process = start_endless(tmp_path, "--checkpoint", state, "--checkpoint-interval", interval)
        if saves:
            seen = set()
            for _ in range(40):
                time.sleep(0.05)
                seen.add(state.stat().st_mtime_ns)
            assert len(seen) >= 3
        assert state.exists() == saves
        process.kill()
        process.communicate(timeout=30)
        state.unlink(missing_ok=True)


def test_finished_checkpoint_is_the_picture(tmp_path: Path) -> None:
    state = tmp_path / "state"
    first = render(tmp_path, hazy_moon(), "--spp", 9, "--checkpoint", state)
    assert same_bits(first, render(tmp_path, hazy_moon(), "--spp", 9, "--checkpoint", state, name="again"))
    less = render(tmp_path, hazy_moon(), "--spp", 4, "--checkpoint", state, name="less")
    assert less.attributes["glimmer:spp"] == 9 and same_bits(first, less)


def test_bad_checkpoints(tmp_path: Path) -> None:
    state = tmp_path / "state"
    path = write_scene(tmp_path, hazy_moon())
    assert run_glimmer(path, "-o", tmp_path / "out.exr", "--spp", 2, "--checkpoint", state).returncode == 0
    good = state.read_bytes()

    def refused(scene: Path, data: bytes, *options: Any) -> str:
        state.write_bytes(data)
        done = run_glimmer(scene, "-o", tmp_path / "no.exr", "--spp", 4, "--checkpoint", state, *options)
        assert done.returncode == 1 and done.stderr.startswith(f"{state}: ") and done.stderr.count("\n") == 1
        assert state.read_bytes() == data and not (tmp_path / "no.exr").exists()
        return done.stderr[len(f"{state}: ") :]

    assert refused(path, b"").startswith("is not a checkpoint of glimmer")
    assert refused(path, b"anything\n" + good).startswith("is not a checkpoint of glimmer")
    assert refused(path, good[:-1]).startswith("is damaged")
    assert refused(path, good[:-9] + bytes([good[-9] ^ 1]) + good[-8:]).startswith("is damaged")
    assert refused(write_scene(tmp_path, furnace(), "b.json"), good).startswith("is a checkpoint of another scene")
    assert "seed" in refused(path, good, "--seed", 1)
    assert "integrator" in refused(path, good, "--integrator", "report")


# ---- failing -------------------------------------------------------------------------------------------------------


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


# ---- merging -------------------------------------------------------------------------------------------------------


def merge(folder: Path, *names: str) -> "subprocess.CompletedProcess[str]":
    return run_glimmer("merge", *(folder / f"{name}.exr" for name in names), "-o", folder / "merged.exr")


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
    for _ in range(8):
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
