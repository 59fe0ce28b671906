# SPDX-License-Identifier: GPL-3.0-or-later
"""What a render says of its own error, against its true error: in furnaces, where every pixel must be 1, and on metal,
where the mean of all the other renders says what it must be."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import pytest
from scipy import stats

from addon.scene import description as d
from tests.engine.library import Render, Scene
from tests.render.build import BLACK, WHITE, Builder, camera, floor, grey, hexagon, sky
from tests.render.statistics import INTEGRATORS, Array, check_mean, pool, repeat

PIXELS = 24
SMALL = 24
LEVEL, CONFIDENCE = 1e-3, 0.95


def furnace() -> Scene:
    """White fog and a white ball within a shining one."""
    scene = Builder(camera((0.4, -1, 0.3), (0, 1, 0), 80), PIXELS, PIXELS, medium=d.Medium(BLACK, grey(0.3), 0.2))
    return Scene(scene.sphere((0, 0, 0), 2, d.Light(WHITE)).sphere((0, 0.5, 0), 0.5, d.Lambert(WHITE)).done())


def measure(scene: Scene, integrator: str, samples: int, seed: int) -> tuple[Array, Array, tuple[float, float, float]]:
    """Squared true errors and squared standard errors (height, width), and relMSE with its interval."""
    with Render(scene, integrator=integrator, samples=samples, seed=seed, threads=1, passes=("stderr",)) as render:
        progress = render.run().poll()
        picture, stderr = (render.read(name).astype(np.float64)[..., 0] for name in ("combined", "stderr"))
        return (picture - 1) ** 2, stderr**2, (progress.relmse, progress.relmse_low, progress.relmse_high)


@pytest.mark.parametrize("samples", [2, 5, 8, 24])
@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_standard_errors(integrator: str, samples: int) -> None:
    """In the mean their squares are the squared errors: also where replicates hold unequal numbers of samples."""
    scene = furnace()

    def ratio_parts(seed: int) -> tuple[float, float]:
        true, claimed, _ = measure(scene, integrator, samples, seed)
        return float(true.mean()), float(claimed.mean())

    scale = repeat(ratio_parts, 16, 1 << 50).mean()

    def one_plus_difference(seed: int) -> float:
        true, claimed = ratio_parts(seed)
        return 1 + (claimed - true) / float(scale)

    check_mean(one_plus_difference, 1, within=0.1, what=f"{integrator} at {samples} samples")


def hazy_furnace() -> d.SceneDescription:
    scene = Builder(camera((0.4, -1, 0.3), (0, 1, 0), 80), SMALL, SMALL, medium=d.Medium(BLACK, grey(0.3), 0.2))
    return scene.sphere((0, 0, 0), 2, d.Light(WHITE)).sphere((0, 0.5, 0), 0.5, d.Lambert(WHITE)).done()


def specular_furnace() -> d.SceneDescription:
    """White plates, a mirror and a glass ball under a white sky."""
    scene = Builder(camera((0, -4, 1.5), (0, 0, 0.3), 60), SMALL, SMALL, environment=sky())
    scene.mesh(floor(0, 3), d.Lambert(WHITE)).sphere((-0.8, 0, 0.7), 0.6, d.Mirror(WHITE))
    return scene.sphere((0.8, 0, 0.7), 0.6, d.Glass(1.5)).done()


def metal(alpha: float, fog: bool) -> d.SceneDescription:
    """Plates under two moons. Where they are smooth, their mirror images of the moons are met by chance alone. No rim
    of a moon reaches less than a fortieth into a pixel that is black but for it: what 63 of 64 pictures have not met
    is in none of their intervals."""
    medium = d.Medium(grey(0.002), grey(0.05)) if fog else None
    scene = Builder(camera((0, -4, 2), (0, 2, 0.2), 60), SMALL, SMALL, medium=medium)
    places = np.tile(np.eye(4), (9, 1, 1))
    places[:, :3, 3] = [(2 * i, 2 * j + 2, 0.15 * i * j) for i in (-1, 0, 1) for j in (-1, 0, 1)]
    scene.mesh(hexagon(1, 0.6), d.Conductor(alpha, f0=(0.9, 0.8, 0.7)), instances=places)
    scene.mesh(floor(-0.6, 8), d.Lambert(grey(0.4)))
    return scene.sphere((-2, 6, 3), 0.5, d.Light((9, 3, 1))).sphere((2, 1, 2.55), 0.2, d.Light((3, 9, 30))).done()


def filtered(scene: d.SceneDescription) -> d.SceneDescription:
    """On a film whose samples count for several pixels, so that the errors of neighbours are correlated."""
    return replace(scene, film=d.Film(SMALL, SMALL, None, "blackman_harris", 3))


@dataclass(frozen=True)
class World:
    scene: Callable[[], d.SceneDescription]
    truth: float | None  # of every pixel; None: the mean of the other renders
    tails: str  # "light": every render is certified; "mixed": some are; "heavy": none should be


WORLDS = {
    "fog": World(hazy_furnace, 1, "light"),
    "mirror and glass": World(specular_furnace, 1, "light"),
    "rough metal": World(lambda: metal(0.3, False), None, "mixed"),
    "rough metal in fog": World(lambda: metal(0.3, True), None, "mixed"),
    "smooth metal": World(lambda: metal(0.02, False), None, "heavy"),
    "fog, filtered": World(lambda: filtered(hazy_furnace()), 1, "light"),
    "rough metal in fog, filtered": World(lambda: filtered(metal(0.3, True)), None, "mixed"),
}
CLAIMS = [
    pytest.param(integrator, name, marks=[pytest.mark.full] * (name == "rough metal in fog, filtered"))
    for integrator in INTEGRATORS
    for name in WORLDS
    if integrator == "path" or not name.endswith("filtered")
]


@dataclass(frozen=True)
class Claim:
    low: float
    high: float
    certified: bool
    picture: Array


def claim(scene: Scene, integrator: str, seed: int, **limits: float) -> Claim:
    with Render(scene, integrator=integrator, seed=seed, threads=1, **limits) as render:
        progress = render.run().poll()
        return Claim(
            progress.relmse_low, progress.relmse_high, not progress.heavy_tails, render.read().astype(np.float64)
        )


def true_errors(claims: list[Claim], truth: float | None) -> Array:
    """The relMSE that became of each."""
    pictures = np.stack([c.picture for c in claims])
    n = len(pictures)
    others = (pictures.sum(axis=0) - pictures) / (n - 1) if truth is None else np.full_like(pictures, truth)
    # The others' mean has an error of its own, 1/(n - 1) of what is measured.
    scale = (n - 1) / n if truth is None else 1
    mean = pictures.mean(axis=0) if truth is None else others[0]
    errors: Array = ((pictures - others) ** 2 * scale / (mean**2 + 1e-4 * mean.mean() ** 2)).mean(axis=(1, 2, 3))
    return errors


@pytest.mark.parametrize("runs", [60, pytest.param(400, marks=[pytest.mark.full, pytest.mark.timeout(1800)])])
@pytest.mark.parametrize(("integrator", "name"), CLAIMS)
def test_the_interval_holds_the_error(integrator: str, name: str, runs: int) -> None:
    """Of all renders, and of those that are certified, 95 % hold in their interval, within the binomial error of so
    many renders: where tails are light the expected error, which is what the interval promises, and it is narrow enough
    to mean something; elsewhere the error that the render has made. Where tails are heavy, those that are certified
    have met no bright sample and cannot know of any: they are at most 5 %."""
    world = WORLDS[name]
    scene = Scene(world.scene())
    claims = list(pool.map(lambda seed: claim(scene, integrator, 5000 + seed, samples=64), range(runs)))
    errors = true_errors(claims, world.truth)
    if world.tails == "light":
        assert stats.sem(errors) < 0.05 * errors.mean(), "no evidence"
        errors = np.full(runs, errors.mean())
    held = np.array([c.low <= error <= c.high for c, error in zip(claims, errors, strict=True)])
    certified = np.array([c.certified for c in claims])
    for which in (held, held[certified]) if world.tails != "heavy" else (held, ~certified):
        assert stats.binom.cdf(which.sum(), len(which), CONFIDENCE) > LEVEL, f"{which.sum()} of {len(which)}"
    assert world.tails == "heavy" or (certified.all() if world.tails == "light" else certified.any()), certified.sum()
    if world.tails == "light":
        assert np.median([c.high / c.low for c in claims]) < 4, "so wide an interval says nothing"


@pytest.mark.parametrize("runs", [40, pytest.param(300, marks=[pytest.mark.full, pytest.mark.timeout(1800)])])
@pytest.mark.parametrize(("integrator", "name"), [(i, n) for i in INTEGRATORS for n in ("fog", "mirror and glass")])
def test_stopping_meets_its_target(integrator: str, name: str, runs: int) -> None:
    """Of the renders that stop by a target of the error, 95 % have met it, and the mean of their pictures is right."""
    world = WORLDS[name]
    scene = Scene(world.scene())
    target = float(np.median([claim(scene, integrator, seed, samples=32).high for seed in range(5)]))
    claims = list(pool.map(lambda seed: claim(scene, integrator, 7000 + seed, target_error=target), range(runs)))
    assert all(c.high <= target and c.certified for c in claims)
    met = int((true_errors(claims, world.truth) <= target).sum())
    assert stats.binom.cdf(met, runs, CONFIDENCE) > LEVEL, f"{met} of {runs} met {target:.2g}"
    means = np.array([c.picture.mean() for c in claims])
    z = (means.mean() - 1) / np.hypot(stats.sem(means), 1e-6)
    assert abs(z) < stats.norm.isf(LEVEL / 2), f"the mean is {means.mean():.5f}, z = {z:.1f}"


def test_heavy_tails_do_not_stop_a_render() -> None:
    """However large the target. A fog's tails are light: that one stops at the first look that may stop it."""
    scene = Scene(metal(0.02, False))
    went_on = 0
    for seed in range(12):
        with Render(scene, integrator="baseline", seed=seed, samples=32, target_error=1e9, threads=1) as render:
            progress = render.run().poll()
            tails = render.report()["error"]["tails"]
        assert progress.samples == 32 or not progress.heavy_tails
        assert tails["certifiable"] == (not progress.heavy_tails) == (tails["largest_share"] <= tails["allowed"])
        assert tails["largest_share"] == pytest.approx(progress.largest_share)
        assert 0 <= tails["x"] < SMALL and 0 <= tails["y"] < SMALL
        went_on += progress.heavy_tails
    assert went_on >= 6
    with Render(Scene(hazy_furnace()), samples=32, target_error=1e6, threads=1) as render:
        progress = render.run().poll()
        assert not progress.heavy_tails and progress.samples == 16
        assert render.report()["error"]["tails"]["certifiable"]
