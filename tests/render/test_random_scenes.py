# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes that nobody chose, of random haze, bodies, materials and lights at three scales: all samples are numbers."""

from typing import Any

import numpy as np
import pytest

from addon.scene import description as d
from tests.engine.library import Render, Scene
from tests.render.build import WHITE, Builder, box, camera, floor, grey, look_at, quad

INTEGRATORS = ("path", "path-no-light-vertices", "baseline")
SEEDS = 4


class Random:
    """Draws the parts of a scene; all lengths are in units of `scale`."""

    def __init__(self, seed: int) -> None:
        self._rng = np.random.default_rng(seed)
        self.scale = float(self.pick(1.0, 1e-3, 1e3))

    def pick(self, *choices: Any) -> Any:
        return choices[self._rng.integers(len(choices))]

    def often(self, probability: float) -> bool:
        return bool(self._rng.random() < probability)

    def within(self, low: float, high: float) -> float:
        return float(self._rng.uniform(low, high))

    def magnitude(self, low: float, high: float) -> float:
        return float(10 ** self._rng.uniform(np.log10(low), np.log10(high)))

    def color(self, low: float = 0.0, high: float = 1.0) -> d.Rgb:
        r, g, b = self._rng.uniform(low, high, 3).tolist()
        return r, g, b

    def scaled(self, color: d.Rgb, factor: float) -> d.Rgb:
        r, g, b = (factor * c for c in color)
        return r, g, b

    def place(self, reach: float, height: float) -> tuple[float, float, float]:
        x, y, z = self.within(-reach, reach), self.within(-reach, reach), self.within(0.2, height)
        return x * self.scale, y * self.scale, z * self.scale

    def medium(self) -> d.Medium:
        sigma, albedo = self.magnitude(1e-4, 30) / self.scale, self.pick(0.0, 0.5, 0.9, 0.99, 1.0)
        tint = self.color(0.3, 1) if self.often(0.5) else WHITE
        absorbed, scattered = self.scaled(tint, sigma * (1 - albedo)), self.scaled(tint, sigma * albedo)
        return d.Medium(absorbed, scattered, self.pick(0.0, 0.3, -0.4, 0.8))

    def surface(self, depth: int = 0) -> Any:
        alpha = self.pick(1e-4, 0.01, 0.1, 0.3, 1.0)
        simple = (
            d.Lambert(self.color()),
            d.Lambert(
                self.color(0.8, 1), roughness=self.within(0, 1), facets=self.pick("single", "multiple", "tinted")
            ),
            d.Mirror(self.color(0.5, 1)),
            d.Conductor(alpha, f0=self.color(0.3, 1), facets=self.pick("single", "multiple")),
            d.Conductor(alpha, eta=self.color(0.1, 2), k=self.color(1, 5), aspect=self.pick(1.0, 0.5, 2.0)),
            d.Glass(self.pick(1.0, 1.1, 1.33, 2.4), self.pick(0.0, 0.1, 0.5), transmission=self.color(0.5, 1)),
            d.Transparent(self.color()),
            d.Translucent(self.color()),
            d.Burley(self.color(), self.within(0, 1)),
            d.Sheen(self.color(), self.within(0, 1), model=self.pick("fibers", "schlick", "velvet")),
        )
        if depth < 2 and self.often(0.2):
            return self.pick(d.Mix, d.Layer)(self.within(0, 1), self.surface(depth + 1), self.surface(depth + 1))
        return self.pick(*simple)

    def add_body(self, scene: Builder) -> None:
        surface, interior = self.surface(), self.medium() if self.often(0.4) else None
        if interior is not None and self.often(0.6):
            surface = d.Null()
        elif not isinstance(surface, d.Glass):
            interior = None
        center, radius = np.array(self.place(3, 3)), self.within(0.1, 1) * self.scale
        if self.often(0.5):
            scene.sphere(center, radius, surface, interior=interior)
        else:
            far = center + radius * self.pick(1.0, 0.2, 1e-3)
            scene.mesh(box(tuple(center - radius), tuple(far)), surface, interior=interior)

    def add_light(self, scene: Builder, name: str) -> None:
        place, unit = self.place(*self.pick((5, 6), (50, 60))), self.scale
        radiance = self.scaled(self.color(), self.magnitude(1, 100))
        intensity, radius = self.scaled(radiance, unit * unit), self.pick(0.0, 0.1, 1.0) * unit
        sides = (self.within(0.1, 3) * unit, self.within(0.1, 3) * unit)
        kind = self.pick("point", "spot", "sun", "area", "sphere", "mesh")
        if kind == "point":
            scene.lamp(d.PointLight(name, place, intensity, radius, is_disk=self.often(0.5)))
        elif kind == "spot":
            x, y, z = place
            scene.lamp(
                d.SpotLight(name, place, (-x, -y, -z), intensity, self.within(5, 120), self.within(0, 1), radius)
            )
        elif kind == "sun":
            down = (self.within(-1, 1), self.within(-1, 1), -1.0)
            scene.lamp(d.SunLight(name, down, self.color(), self.pick(0.0, 0.5, 20.0)))
        elif kind == "area":
            to_world = look_at(place, (0, 0, 0))
            scene.lamp(d.AreaLight(name, to_world, sides, radiance, self.often(0.5), self.pick(180.0, 90.0, 10.0)))
        elif kind == "sphere":
            scene.sphere(place, max(radius, 0.05 * unit), d.Light(radiance))
        else:
            scene.mesh(quad(place, (sides[0], 0, 0), (0, sides[1], 0)), d.Light(radiance))


def random_scene(seed: int) -> d.SceneDescription:
    draw = Random(seed)
    parts: dict[str, Any] = {}
    if draw.often(0.55):
        parts["medium"] = draw.medium()
    if draw.often(0.3):
        parts["environment"] = d.Environment(draw.color(0, 0.5))
    unit = draw.scale
    scene = Builder(camera((0, -6 * unit, 2 * unit), (0, 0, unit), draw.within(20, 90)), 16, 12, **parts)
    if draw.often(0.8):
        scene.mesh(floor(0, draw.pick(10, 50, 1000) * unit), draw.pick(d.Lambert(grey(0.5)), draw.surface()))
    for _ in range(draw.pick(0, 1, 2, 3)):
        draw.add_body(scene)
    for number in range(draw.pick(1, 2, 3)):
        draw.add_light(scene, f"light {number}")
    return scene.done()


@pytest.mark.parametrize("first", [0, *(pytest.param(n, marks=pytest.mark.full) for n in range(20, 400, 20))])
def test_samples_are_numbers(first: int) -> None:
    """Depth is limited: light wanders long in white haze, and no other path is rarer."""
    for number in range(first, first + 20):
        scene = Scene(random_scene(number))
        for integrator in INTEGRATORS:
            for seed in range(SEEDS):
                with Render(scene, integrator=integrator, samples=2, seed=seed, threads=1, max_depth=10) as render:
                    invalid = render.run().poll().invalid_samples
                    assert invalid == 0, f"scene {number}, {integrator}: {render.report()['invalid_samples']}"
                    picture = render.read()
                assert np.isfinite(picture).all()
