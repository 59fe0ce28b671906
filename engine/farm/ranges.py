# SPDX-License-Identifier: GPL-3.0-or-later
"""A range of a frame's samples: what a worker is asked for, and what it sends back.

Range i is the picture of `glimmer SCENE --seed FIRST+i --spp SAMPLES`. Both ways are bytes that are read here, not
pickled objects, and what comes back is held against what was asked for.
"""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .problems import FarmError, one_line

MAX_HEAD_BYTES = 1 << 16


@dataclass(frozen=True)
class Order:
    job: str
    scene: str  # digest of the packed scene
    index: int
    seed: int
    samples: int
    program: str  # digest of the command
    threads: int = 0  # 0: the worker's own number
    integrator: str = ""  # "": the default
    aovs: tuple[str, ...] = ()
    adaptive: bool = False
    independent_pixels: bool = False

    def encode(self) -> bytes:
        return json.dumps(asdict(self)).encode()

    @staticmethod
    def decode(data: bytes) -> Order:
        values = json.loads(data)
        return Order(**{**values, "aovs": tuple(values["aovs"])})


@dataclass(frozen=True)
class Work:
    """What a range took."""

    seconds: float = 0.0
    cpu_seconds: float = 0.0
    load_seconds: float = 0.0  # reading and building the scene
    rays: int = 0
    invalid_samples: int = 0

    def __add__(self, other: Work) -> Work:
        return Work(*(getattr(self, name) + getattr(other, name) for name in self.__dataclass_fields__))


@dataclass(frozen=True)
class Range:
    """A rendered range. scene: glimmer:scene of its picture."""

    index: int
    seed: int
    samples: int
    scene: str
    channels: tuple[str, ...]
    pixels: NDArray[np.float32]  # (height, width, channels)
    work: Work = field(default_factory=Work)

    def encode(self) -> bytes:
        head = {name: value for name, value in asdict(self).items() if name != "pixels"}
        head["shape"] = self.pixels.shape
        return json.dumps(head).encode() + b"\n" + np.ascontiguousarray(self.pixels, "<f4").tobytes()


@dataclass(frozen=True)
class Expected:
    scene: str
    channels: tuple[str, ...]
    shape: tuple[int, int, int]


def failure(words: str) -> bytes:
    return json.dumps({"failure": one_line(words)}).encode() + b"\n"


def _head(data: bytes) -> tuple[dict[str, Any], int]:
    end = data.find(b"\n", 0, MAX_HEAD_BYTES)
    try:
        head = json.loads(data[: max(end, 0)])
    except ValueError:
        head = None
    if not isinstance(head, dict):
        raise FarmError("sent something that is no range")
    return head, end + 1


def refuse_failure(data: bytes) -> None:
    """Raises FarmError: anything but b"" is a failure where no pixels are asked for."""
    if data:
        head, _ = _head(data)
        raise FarmError(one_line(str(head.get("failure", "sent something that was not asked for"))))


def decode(data: bytes, order: Order, expected: Expected) -> Range:
    """Raises FarmError with the worker's own words for a failure, and where it sent something else than was asked."""
    head, begin = _head(data)
    if "failure" in head:
        raise FarmError(one_line(str(head["failure"])))
    asked = {
        "index": order.index,
        "seed": order.seed,
        "samples": order.samples,
        "scene": expected.scene,
        "channels": list(expected.channels),
        "shape": list(expected.shape),
    }
    for name, value in asked.items():
        if head.get(name) != value:
            raise FarmError(f"sent {name} {one_line(str(head.get(name)))[:80]}, asked for {value}")
    count = int(np.prod(expected.shape))
    if len(data) - begin != 4 * count:
        raise FarmError(f"sent {len(data) - begin} bytes of pixels, asked for {4 * count}")
    pixels = np.frombuffer(data, "<f4", count, begin).reshape(expected.shape)
    if not np.isfinite(pixels).all():
        raise FarmError("sent pixels that are no finite numbers")
    return Range(
        order.index, order.seed, order.samples, expected.scene, expected.channels, pixels, _work(head.get("work"))
    )


def _work(values: Any) -> Work:
    """Statistics alone: what is missing or no number is 0."""
    given = values if isinstance(values, dict) else {}

    def number(name: str) -> float:
        value = given.get(name)
        return float(value) if isinstance(value, int | float) and 0 <= value < 1e18 else 0.0

    return Work(
        number("seconds"),
        number("cpu_seconds"),
        number("load_seconds"),
        int(number("rays")),
        int(number("invalid_samples")),
    )
