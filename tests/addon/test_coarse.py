# SPDX-License-Identifier: GPL-3.0-or-later
"""What a final render shows before its first sample is there."""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from addon.film import coarse
from addon.film.display import Display
from addon.film.passes import COMBINED
from addon.native import library
from addon.native.render import close_all, open_render
from addon.scene import description as d

SKY = (0.25, 0.5, 2.0)
WIDTH, HEIGHT = 400, 301


@pytest.fixture(autouse=True)
def engine_library(library_dir: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.setenv("GLIMMER_LIBRARY", str(library_dir / "libglimmer.so"))
    library.load.cache_clear()
    yield
    close_all()
    library.load.cache_clear()


def sky(width: int = WIDTH, height: int = HEIGHT, samples: int = 2, **film: Any) -> d.SceneDescription:
    return d.SceneDescription(
        film=d.Film(width, height, filter="box", **film),
        camera=d.Camera(to_world=np.eye(4), projection=d.Perspective(60.0)),
        materials=(),
        environment=d.Environment(radiance=SKY),
        settings=d.RenderSettings(samples=samples, threads=1, tile_size=32),
    )


@pytest.mark.parametrize("crop", [None, (3, 5, 390, 288)])
def test_a_first_look_is_the_whole_window_of_the_film(crop: Any) -> None:
    scene = sky(crop=crop)
    found = coarse.first_look(scene, lambda: False)
    x0, y0, x1, y1 = scene.film.window
    assert found is not None and found.shape == (y1 - y0, x1 - x0, 4)
    np.testing.assert_array_equal(found, np.broadcast_to(np.array([*SKY, 1.0], np.float32), found.shape))


def test_a_first_look_is_not_waited_for() -> None:
    assert coarse.first_look(sky(100, 100), lambda: False) is None
    assert coarse.first_look(sky(4000, 4000), lambda: True) is None


class FakeBlender:
    """The picture as Blender has it, (height, width, 4), top row first, after each thing that is handed over."""

    def __init__(self, cancels_after: int = 10**9) -> None:
        self.now = np.zeros((HEIGHT, WIDTH, 4), np.float32)
        self.pictures: list[Any] = []
        self._cancels_after = cancels_after

    def begin_result(self, x: int, y: int, width: int, height: int, layer: str = "", view: str = "") -> Any:
        top = HEIGHT - y - height

        def foreach_set(_name: str, values: Any) -> None:
            self.now[top : top + height, x : x + width] = values.reshape(height, width, 4)[::-1]

        class Passes(list):  # type: ignore[type-arg]
            pass

        passes = Passes([SimpleNamespace(name=COMBINED.short_name, channels=4)])
        passes.foreach_set = foreach_set  # type: ignore[attr-defined]
        return SimpleNamespace(resolution_x=width, resolution_y=height, layers=[SimpleNamespace(passes=passes)])

    def end_result(self, _result: Any) -> None:
        self.pictures.append(self.now.copy())

    def test_break(self) -> bool:
        return len(self.pictures) >= self._cancels_after

    def update_stats(self, *_: Any) -> None: ...
    def update_progress(self, *_: Any) -> None: ...
    def update_memory_stats(self, **_: Any) -> None: ...


def show(scene: d.SceneDescription, blender: Any) -> None:
    canvas = np.full((HEIGHT, WIDTH, 4), 7.0, np.float32)
    render, _ = open_render(scene)
    with render:
        Display(blender, render, scene, (COMBINED,), "", None, coarse=canvas).run()


def is_of(pictures: Any, color: tuple[float, ...]) -> Any:
    return (np.abs(pictures - np.array(color, np.float32)) < 1e-6).all(axis=-1)


def test_tiles_take_the_place_of_the_coarse_picture() -> None:
    blender = FakeBlender()
    show(sky(), blender)
    assert (blender.pictures[0] == 7.0).all()
    for picture in blender.pictures:
        assert (is_of(picture, (7.0,) * 4) | is_of(picture, (*SKY, 1.0))).all()
    assert is_of(blender.pictures[-1], (*SKY, 1.0)).all()


def test_what_was_seen_is_kept_by_escape() -> None:
    blender = FakeBlender(cancels_after=1)
    big = replace(sky(), settings=replace(sky().settings, samples=1_000_000))
    show(big, blender)
    last = blender.pictures[-1]
    assert (is_of(last, (7.0,) * 4) | is_of(last, (*SKY, 1.0))).all()
