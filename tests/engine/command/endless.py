# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders that do not end by themselves, to be interrupted."""

import os
import signal
import subprocess
import time
from pathlib import Path
from typing import Any

from tests.engine.scenes import hazy_moon, write_scene


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
