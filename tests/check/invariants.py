# SPDX-License-Identifier: GPL-3.0-or-later
"""What must not change a picture, to the last bit or in the mean."""

import ctypes
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from itertools import permutations
from typing import Any

import numpy as np
from numpy.typing import NDArray

from addon.scene import description as d
from tests.check import fog
from tests.check.case import Case, Estimate, picture
from tests.engine.library import Render, Scene
from tests.engine.worlds import everything
from tests.render import closed_forms as exact
from tests.render.build import BLACK, grey
from tests.render.statistics import Clock

Picture = NDArray[Any]


SEEDS = 8


def world() -> d.SceneDescription:
    return everything(12, 8)


def clear_world() -> d.SceneDescription:
    """Without fog: there some guides have floors that do not scale, which moves an ulp of noise, not the mean."""
    return everything(12, 8, fog=False)


def brighter(scene: d.SceneDescription, factor: float) -> d.SceneDescription:
    """All light times a factor."""

    def times(color: d.Rgb) -> d.Rgb:
        return (color[0] * factor, color[1] * factor, color[2] * factor)

    def lamp(light: d.Lamp) -> d.Lamp:
        if isinstance(light, d.SunLight):
            return replace(light, irradiance=times(light.irradiance))
        if isinstance(light, d.AreaLight):
            return replace(light, radiance=times(light.radiance))
        return replace(light, intensity=times(light.intensity))

    materials = tuple(
        replace(m, material=d.Light(times(m.material.radiance))) if isinstance(m.material, d.Light) else m
        for m in scene.materials
    )
    environment = replace(scene.environment, radiance=times(scene.environment.radiance))
    return replace(scene, materials=materials, lights=tuple(map(lamp, scene.lights)), environment=environment)


def rendered(scene: Scene, integrator: str, seed: int, clock: Clock, **settings: int) -> Picture:
    with Render(scene, integrator=integrator, samples=2, seed=seed, **{"threads": 1, **settings}) as render:
        progress = render.run().poll()
        assert progress.invalid_samples == 0
        clock.add(progress.cpu_seconds)
        return render.read()


def same_bits(
    name: str,
    other: Callable[[Scene, str, int, Clock], Picture],
    quick: bool = False,
    scene: Callable[[], d.SceneDescription] = world,
) -> Case:
    """How many numbers of the picture differ from those of a plain render: none."""

    def measure(integrator: str, clock: Clock) -> Estimate:
        committed = Scene(scene())

        def differing(seed: int) -> int:
            plain = rendered(committed, integrator, seed, clock)
            assert plain.any(), "a black picture"
            return int((plain != other(committed, integrator, seed, clock)).sum())

        return differing

    return Case(name, 0, measure, within=0, quick=quick, most_seeds=SEEDS)


def below_zero(scene: Callable[[], d.SceneDescription]) -> Callable[[str, Clock], Estimate]:
    """How many numbers of a picture are."""

    def measure(integrator: str, clock: Clock) -> Estimate:
        committed = Scene(scene())

        def count(seed: int) -> int:
            plain = rendered(committed, integrator, seed, clock)
            assert plain.any(), "a black picture"
            return int((plain < 0).sum())

        return count

    return measure


def scaled_back(power: int) -> Callable[[Scene, str, int, Clock], Picture]:
    bright = Scene(brighter(clear_world(), 2.0**power))
    return lambda _, integrator, seed, clock: rendered(bright, integrator, seed, clock) / np.float32(2.0**power)


@contextmanager
def flushed_to_zero() -> Iterator[None]:
    """Arithmetic of this thread, and of threads that it starts, flushes subnormals to zero, as in Blender's."""
    library = ctypes.CDLL("libm.so.6")
    before, flushing = (ctypes.c_uint32 * 8)(), (ctypes.c_uint32 * 8)()  # fenv_t of x86-64: MXCSR is its last word
    assert library.fegetenv(before) == 0 and library.fegetenv(flushing) == 0
    flushing[7] |= 0x8040  # FTZ and DAZ
    assert library.fesetenv(flushing) == 0
    try:
        yield
    finally:
        library.fesetenv(before)


def in_flushing_host(integrator: str, clock: Clock) -> Estimate:
    description = fog.light_through(d.Medium(grey(10), BLACK))

    def estimate(seed: int) -> float:
        with flushed_to_zero():
            scene = Scene(description)
            with Render(scene, integrator=integrator, samples=2, seed=seed, threads=1) as render:
                clock.add(render.run().poll().cpu_seconds)
                picture = render.read()
        return float(picture.mean(dtype=np.float64))

    return estimate


def cases() -> list[Case]:
    result = [
        Case(
            "absorption of depth 100, in a host that flushes subnormals to zero",
            np.exp(-100),
            in_flushing_host,
            within=0,
            rounding=0.5 * fog.LEAST / np.exp(-100) + 1e-4,
            quick=True,
            most_seeds=SEEDS,
        ),
        same_bits("the same seed, the same bits", rendered, quick=True),
        same_bits(
            "three threads, the same bits", lambda s, i, seed, clock: rendered(s, i, seed, clock, threads=3), True
        ),
        same_bits("tiles of 5, the same bits", lambda s, i, seed, clock: rendered(s, i, seed, clock, tile_size=5)),
        # In fog `path` takes what is hidden off again by one ray for many connections: alone there are such numbers.
        Case("no number below 0, without fog", 0, below_zero(clear_world), within=0, quick=True),
        Case("no number below 0, in fog", 0, below_zero(world), within=0, integrators=("baseline",)),
        *(
            same_bits(f"light times 2^{power}, the same bits", scaled_back(power), power == 20, clear_world)
            for power in (20, -30, 90)
        ),
    ]
    sigma_a, sigma_s, radiance = np.array([0.0, 0.3, 0.02]), np.array([0.1, 0.02, 1.0]), np.array([1.0, 5.0, 30.0])
    airlight = np.array(
        [
            emitted * exact.sphere_airlight(a + s, s, 0.3, 0.3, (0.5, 1.5, 0), fog.ALONG, np.inf)
            for a, s, emitted in zip(sigma_a, sigma_s, radiance, strict=True)
        ]
    )
    for order in permutations(range(3)):
        p = list(order)

        def scene(p: list[int] = p) -> d.SceneDescription:
            medium = d.Medium(tuple(sigma_a[p]), tuple(sigma_s[p]), 0.3)
            plain = fog.beside_ray(medium, (0.3, 1))
            light = d.NamedMaterial("light", d.Light(tuple(radiance[p])))
            return replace(plain, materials=(light,))

        result.append(
            picture(
                f"channels in the order {''.join('RGB'[k] for k in p)}",
                scene,
                airlight[p],
                max_scatter=1,
                within=0.04,
                rounding=1e-5,
            )
        )
    return result
