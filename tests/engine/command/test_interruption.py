# SPDX-License-Identifier: GPL-3.0-or-later
"""Signals: what was rendered so far is written, also where they come in flocks."""

import json
import os
import signal
import subprocess
import time
from pathlib import Path

import pytest

from tests.engine import scenes
from tests.engine.command.endless import start_endless, wait_until_caught
from tests.engine.command.pictures import same_bits
from tests.engine.scenes import hazy_moon, read_exr, render, write_scene

pytestmark = pytest.mark.usefixtures("glimmer_command")


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
