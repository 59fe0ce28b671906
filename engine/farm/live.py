# SPDX-License-Identifier: GPL-3.0-or-later
"""For a program that shows a picture while it is rendered and has neither Dask nor a reader of .exr: files in a folder.

`picture` is one line of JSON, {width, height, window, channels}, and the floats of the window, (height, width,
channels) from the top row on, as little-endian float32. `progress.json` is {pictures, workers, report}: how many
pictures there have been, and the report as far as it is known. Both are replaced in one step. While it renders, a
picture holds what is looked at, R G B A; the last one all channels.

The program ends the render by closing our standard input, and so does its own end.
"""

from __future__ import annotations

import json
import os
import threading
import time
from pathlib import Path

import numpy as np

from .farm import Outcome, Progress
from .picture import Picture

SHOWN = ("R", "G", "B", "A")
REFRESH_SECONDS = 0.5
MAX_REFRESH_SHARE = 0.05  # of the time


def write_picture(picture: Picture, path: Path) -> None:
    layout = picture.layout
    head = {
        "width": layout.width,
        "height": layout.height,
        "window": layout.window,
        "channels": layout.channels,
    }
    _replace(path, json.dumps(head).encode() + b"\n" + np.ascontiguousarray(picture.pixels, "<f4").tobytes())


def _replace(path: Path, data: bytes) -> None:
    partial = path.with_name(f".unfinished-{path.name}")
    partial.write_bytes(data)
    partial.replace(path)


class Live:
    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._ended = threading.Event()
        self._pictures = self._ranges = 0
        self._next = 0.0  # picture
        threading.Thread(target=self._wait_for_the_end, daemon=True).start()

    def _wait_for_the_end(self) -> None:
        while os.read(0, 4096):  # sys.stdin has a lock, and Python does not end while a thread holds it
            pass
        self._ended.set()

    @property
    def is_ended(self) -> bool:
        return self._ended.is_set()

    def show(self, progress: Progress) -> None:
        begin = time.monotonic()
        if progress.ranges > self._ranges and begin >= self._next:
            self._ranges = progress.ranges
            self._write(progress.picture().only(SHOWN))
            end = time.monotonic()
            self._next = end + max(REFRESH_SECONDS, (end - begin) / MAX_REFRESH_SHARE)
        self._tell(progress.workers, progress.report())

    def finish(self, outcome: Outcome) -> None:
        self._write(outcome.picture)
        self._tell(len(outcome.report["workers"]), outcome.report)

    def _write(self, picture: Picture) -> None:
        write_picture(picture, self._folder / "picture")
        self._pictures += 1

    def _tell(self, workers: int, report: dict[str, object]) -> None:
        told = {"pictures": self._pictures, "workers": workers, "report": report}
        _replace(self._folder / "progress.json", json.dumps(told).encode())
