# SPDX-License-Identifier: GPL-3.0-or-later
"""Checkpoints: the bits of a render that nobody disturbed, whatever happened to it."""

import os
import signal
import subprocess
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.engine import scenes
from tests.engine.command.endless import start_endless
from tests.engine.command.pictures import same_bits
from tests.engine.scenes import furnace, hazy_moon, read_exr, render, run_glimmer, write_scene

pytestmark = pytest.mark.usefixtures("glimmer_command")


def test_resumed_render_has_the_same_bits(tmp_path: Path) -> None:
    common = ["--aov", "depth,albedo,material_index"]
    whole = render(tmp_path, hazy_moon(), "--spp", 21, *common)
    state = tmp_path / "state"
    for samples in (1, 6, 13, 21):
        part = render(tmp_path, hazy_moon(), "--spp", samples, *common, "--checkpoint", state, name="part")
        assert part.attributes["glimmer:spp"] == samples
    assert same_bits(whole, part)
    assert list(tmp_path.glob("state*")) == [state]


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
    assert "integrator" in refused(path, good, "--integrator", "baseline")
