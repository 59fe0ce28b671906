# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of the `glimmer` command, read and written: .exr with its layers and what it says of itself."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import OpenImageIO
from numpy.typing import NDArray

from .problems import FarmError


@dataclass(frozen=True)
class Layout:
    """Of a picture whose `window` x0, y0, x1, y1 was rendered."""

    width: int
    height: int
    window: tuple[int, int, int, int]
    channels: tuple[str, ...]

    @property
    def shape(self) -> tuple[int, int, int]:
        x0, y0, x1, y1 = self.window
        return y1 - y0, x1 - x0, len(self.channels)


@dataclass(frozen=True)
class Facts:
    """The attributes glimmer:NAME."""

    samples: int
    seeds: tuple[int, ...]
    seconds: float
    version: str
    scene: str
    integrator: str
    biased_by: str


@dataclass(frozen=True)
class Picture:
    layout: Layout
    facts: Facts
    pixels: NDArray[np.float32]  # (height, width, channels) of the window, top row first

    def layer_free(self, layer: str) -> Picture:
        """Without the channels of a layer."""
        return self.only([name for name in self.layout.channels if not name.startswith(f"{layer}.")])

    def only(self, channels: Collection[str]) -> Picture:
        """With those channels of it."""
        kept = [i for i, name in enumerate(self.layout.channels) if name in channels]
        names = tuple(self.layout.channels[i] for i in kept)
        layout = Layout(self.layout.width, self.layout.height, self.layout.window, names)
        return Picture(layout, self.facts, np.ascontiguousarray(self.pixels[..., kept]))


def read(path: Path) -> Picture:
    """Raises FarmError."""
    source = OpenImageIO.ImageInput.open(str(path))
    if source is None:
        raise FarmError(f"{path.name} cannot be read: {OpenImageIO.geterror()}")
    try:
        spec = source.spec()
        pixels = source.read_image(0, 0, 0, spec.nchannels, OpenImageIO.FLOAT)
    finally:
        source.close()
    if pixels is None or not spec.get_string_attribute("glimmer:scene"):
        raise FarmError(f"{path.name} is damaged or no picture of glimmer's")
    window = (spec.x, spec.y, spec.x + spec.width, spec.y + spec.height)
    facts = Facts(
        samples=spec.get_int_attribute("glimmer:spp"),
        seeds=tuple(int(seed) for seed in spec.get_string_attribute("glimmer:seed").split(", ")),
        seconds=spec.get_float_attribute("glimmer:seconds"),
        version=spec.get_string_attribute("glimmer:version"),
        scene=spec.get_string_attribute("glimmer:scene"),
        integrator=spec.get_string_attribute("glimmer:integrator"),
        biased_by=spec.get_string_attribute("glimmer:biased_by"),
    )
    layout = Layout(spec.full_width, spec.full_height, window, tuple(spec.channelnames))
    return Picture(layout, facts, np.asarray(pixels, np.float32))


def write(picture: Picture, path: Path) -> None:
    """The file is replaced in one step. Raises FarmError."""
    layout, facts = picture.layout, picture.facts
    height, width, count = layout.shape
    spec = OpenImageIO.ImageSpec(width, height, count, OpenImageIO.FLOAT)
    spec.channelnames = layout.channels
    spec.x, spec.y = layout.window[:2]
    spec.full_x = spec.full_y = 0
    spec.full_width, spec.full_height = layout.width, layout.height
    spec.attribute("compression", "zip")
    spec.attribute("Software", f"Glimmer {facts.version}")
    spec.attribute("glimmer:spp", facts.samples)
    spec.attribute("glimmer:seconds", float(facts.seconds))
    texts = {"seed": ", ".join(map(str, facts.seeds)), "version": facts.version, "scene": facts.scene}
    for name, value in {**texts, "integrator": facts.integrator, "biased_by": facts.biased_by}.items():
        if value:
            spec.attribute(f"glimmer:{name}", value)
    partial = path.with_name(f".unfinished-{path.name}")
    target = OpenImageIO.ImageOutput.create(str(partial))
    try:
        done = target is not None and target.open(str(partial), spec) and target.write_image(picture.pixels)
        done = target is not None and target.close() and done
        if not done:
            why = target.geterror() if target is not None else OpenImageIO.geterror()
            raise FarmError(f"{path} cannot be written: {why}")
        partial.replace(path)
    except OSError as error:
        raise FarmError(f"{path} cannot be written: {error.strerror or error}") from error
    finally:
        partial.unlink(missing_ok=True)
