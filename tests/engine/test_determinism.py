# SPDX-License-Identifier: GPL-3.0-or-later
"""The same bits whatever the threads, the tiles and the interruptions."""

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest

from addon.scene import description as d
from tests.engine.bits import all_passes, assert_same_bits, broken_off_within_batches, pictures
from tests.engine.library import Image, Render, Scene
from tests.engine.worlds import everything

SAMPLES = 3  # three batches
WIDTH, HEIGHT = 70, 66  # nine tiles at the least, since a tile is made of whole blocks of 32 pixels
INTEGRATORS = ("path", "baseline")


@cache
def scene(fog: bool = True, glass: bool = True) -> Scene:
    return Scene(everything(WIDTH, HEIGHT, fog, glass))


@cache
def filtered(fog: bool = True, crop: tuple[int, int, int, int] | None = None) -> Scene:
    """On a film whose samples count for pixels of other cells and tiles."""
    description = everything(WIDTH, HEIGHT, fog)
    return Scene(replace(description, film=d.Film(WIDTH, HEIGHT, crop, "blackman_harris", 3)))


def passes() -> tuple[str, ...]:
    return all_passes()


def rendered(which: Scene, **settings: Any) -> dict[str, Image]:
    settings = {"samples": SAMPLES, "seed": 5, "threads": 2, "passes": passes(), **settings}
    with Render(which, **settings) as render:
        return pictures(render.run())


@cache
def reference(integrator: str, fog: bool = True) -> dict[str, Image]:
    return rendered(scene(fog), integrator=integrator, threads=1, tile_size=64)


def test_the_reference_is_no_blank_picture() -> None:
    for integrator in INTEGRATORS:
        picture = reference(integrator)["combined"]
        assert np.isfinite(picture).all() and np.unique(picture).size > picture.size / 2


@pytest.mark.parametrize("threads", [2, 3, 7])
@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_threads(integrator: str, threads: int) -> None:
    """Small tiles, so that every thread has some."""
    assert_same_bits(reference(integrator), rendered(scene(), integrator=integrator, threads=threads, tile_size=8))


@pytest.mark.parametrize("tile_size", [1, 8, 17, 64, 1000])
@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_tile_size(integrator: str, tile_size: int) -> None:
    assert_same_bits(reference(integrator), rendered(scene(), integrator=integrator, tile_size=tile_size))


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_without_fog(integrator: str) -> None:
    assert_same_bits(
        reference(integrator, fog=False), rendered(scene(fog=False), integrator=integrator, threads=3, tile_size=9)
    )


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_scene_built_anew(integrator: str) -> None:
    assert_same_bits(reference(integrator), rendered(Scene(everything(WIDTH, HEIGHT)), integrator=integrator))


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_seeds_differ(integrator: str) -> None:
    """In most pixels; seeds that differ in their high half too."""
    pictures = [rendered(scene(), integrator=integrator, seed=seed)["combined"] for seed in (5, 6, 5 + (1 << 32))]
    for i in range(3):
        for j in range(i):
            assert (pictures[i] != pictures[j]).mean() > 0.9


def test_integrators_differ() -> None:
    assert (reference("path")["combined"] != reference("baseline")["combined"]).mean() > 0.9


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_passes_change_no_pixel(integrator: str) -> None:
    with Render(scene(), integrator=integrator, samples=SAMPLES, seed=5, threads=2) as render:
        alone = render.run().read()
    assert (alone == reference(integrator)["combined"]).all()


@pytest.mark.parametrize("at", [1, 2])
@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_resume_after_some_samples(integrator: str, at: int) -> None:
    """A render of fewer samples, saved and taken up."""
    settings: dict[str, Any] = {"integrator": integrator, "seed": 5, "threads": 2, "passes": passes(), "tile_size": 64}
    with Render(scene(), samples=at, **settings) as render:
        state = render.run().save()
    with Render(scene(), samples=SAMPLES, **settings) as render:
        render.load(state)
        assert_same_bits(reference(integrator), pictures(render.run()))


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_resume_from_the_middle_of_a_batch(integrator: str) -> None:
    settings: dict[str, Any] = {
        "integrator": integrator,
        "seed": 5,
        "samples": SAMPLES,
        "passes": passes(),
        "tile_size": 8,
        "threads": 2,
    }
    state = broken_off_within_batches(scene(), settings)
    with Render(scene(), **settings) as render:
        render.load(state)
        assert_same_bits(reference(integrator), pictures(render.run()))


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_pause_and_resume_in_one_session(integrator: str) -> None:
    settings: dict[str, Any] = {"integrator": integrator, "seed": 5, "samples": SAMPLES, "tile_size": 8, "threads": 3}
    with Render(scene(), passes=passes(), **settings) as render:
        render.start()
        for _ in range(20):
            render.pause()
            render.resume()
        render.wait()
        assert_same_bits(reference(integrator), pictures(render))


def test_a_crop_is_cut_from_the_picture() -> None:
    """Where nothing is shared between pixels: the same bits as in the whole picture."""
    description = everything(WIDTH, HEIGHT, fog=False)
    crop = (7, 5, 50, 45)
    part = Scene(replace(description, film=replace(description.film, crop=crop)))
    x0, y0, x1, y1 = crop
    for integrator in INTEGRATORS:
        cut = {name: image[y0:y1, x0:x1] for name, image in reference(integrator, fog=False).items()}
        cut = {name: np.ascontiguousarray(image) for name, image in cut.items()}
        assert_same_bits(cut, rendered(part, integrator=integrator))


@pytest.mark.parametrize(("threads", "tile_size"), [(3, 32), (2, 64), (1, 1000)])
def test_samples_that_count_for_several_pixels(threads: int, tile_size: int) -> None:
    reference = rendered(filtered(), threads=2, tile_size=96)
    assert np.unique(reference["combined"]).size > reference["combined"].size / 2
    assert_same_bits(reference, rendered(filtered(), threads=threads, tile_size=tile_size))


def test_samples_that_count_for_several_pixels_resume() -> None:
    settings: dict[str, Any] = {"seed": 5, "samples": SAMPLES, "passes": passes(), "tile_size": 32, "threads": 2}
    state = broken_off_within_batches(filtered(), settings)
    with Render(filtered(), **settings) as render:
        render.load(state)
        assert_same_bits(rendered(filtered()), pictures(render.run()))


@pytest.mark.parametrize("crop", [(7, 5, 50, 45), (32, 1, 33, 64), (31, 33, 70, 66)])
def test_a_crop_of_samples_that_count_for_several_pixels(crop: tuple[int, int, int, int]) -> None:
    """Also where it begins or ends at the edge of a cell, or next to it."""
    x0, y0, x1, y1 = crop
    whole = rendered(filtered(fog=False))
    cut = {name: np.ascontiguousarray(image[y0:y1, x0:x1]) for name, image in whole.items()}
    assert_same_bits(cut, rendered(filtered(fog=False, crop=crop), tile_size=32, threads=3))
