# SPDX-License-Identifier: GPL-3.0-or-later
"""Running the `glimmer` command for a range."""

from __future__ import annotations

import ctypes
import signal
import subprocess
from collections.abc import Callable
from pathlib import Path

from .engine import Engine
from .problems import FarmError
from .ranges import Order

_libc = ctypes.CDLL(None)
_PR_SET_PDEATHSIG = 1


def words_of(engine: Engine, order: Order, scene: Path, out: Path, report: Path, threads: int) -> list[str]:
    """threads: 0 is all cores."""
    command = [str(engine.command), str(scene), "-o", str(out), "--report", str(report), "--quiet"]
    command += ["--seed", str(int(order.seed)), "--spp", str(int(order.samples))]
    command += ["--threads", str(threads)] if threads else []
    command += ["--integrator", order.integrator] if order.integrator else []
    command += ["--aov", ",".join(order.aovs)] if order.aovs else []
    command += ["--adaptive"] if order.adaptive else []
    return [*command, "--independent-pixels"] if order.independent_pixels else command


def _die_with_the_parent() -> None:
    """A killed worker leaves no command behind that renders for nobody."""
    _libc.prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)


def start(words: list[str]) -> subprocess.Popen[str]:
    return subprocess.Popen(
        words,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        errors="replace",
        preexec_fn=_die_with_the_parent,  # noqa: PLW1509 - one call of the C library, loaded before
    )


def finish(process: subprocess.Popen[str], tell: Callable[[str], str] = str) -> None:
    """Waits for the end. Raises FarmError with the last line of a command that failed, as `tell` has it."""
    _, said = process.communicate()
    if process.returncode != 0:
        last = (said.strip().splitlines() or [f"glimmer ended with status {process.returncode}"])[-1]
        raise FarmError(tell(last))
