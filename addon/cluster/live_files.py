# SPDX-License-Identifier: GPL-3.0-or-later
"""The files by which `glimmer farm --live FOLDER` shows its picture; engine/farm/live.py of a checkout writes them."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..scene.problems import GlimmerError

MAX_HEAD_BYTES = 1 << 16


@dataclass(frozen=True)
class Told:
    pictures: int = 0  # that there have been
    workers: int = 0
    report: dict[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class Picture:
    channels: tuple[str, ...]
    pixels: NDArray[np.float32]  # (height, width, channels), top row first


def read_told(folder: Path) -> Told | None:
    """None where nothing is told yet."""
    try:
        found = json.loads((folder / "progress.json").read_bytes())
    except FileNotFoundError:
        return None
    return Told(int(found["pictures"]), int(found["workers"]), found["report"])


def read_picture(folder: Path, window: tuple[int, int, int, int]) -> Picture:
    """Raises GlimmerError where it is not of that window."""
    with (folder / "picture").open("rb") as file:
        head = json.loads(file.readline(MAX_HEAD_BYTES))
        data = file.read()
    channels = tuple(str(name) for name in head["channels"])
    x0, y0, x1, y1 = window
    shape = (y1 - y0, x1 - x0, len(channels))
    if tuple(head["window"]) != window or len(data) != 4 * shape[0] * shape[1] * shape[2]:
        raise GlimmerError(
            f"The cluster's picture has the window {head['window']}, asked for {list(window)}: the command of the"
            " checkout is of another version than this add-on"
        )
    return Picture(channels, np.frombuffer(data, "<f4").reshape(shape))
