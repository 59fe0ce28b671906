# SPDX-License-Identifier: GPL-3.0-or-later
"""Kernels of the path integrator that are compiled for some features alone
(engine/src/integrator/path/kernel_features.h): which one renders a scene, and that it gives the bits of the full one.
Scenes on either side of each feature; see tests/blender/test_kernels.py for those of the benchmark.
"""

from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pytest

from addon.scene import description as d
from tests.engine.bits import assert_same_bits, pictures, plain_passes
from tests.engine.library import Render, Scene
from tests.engine.worlds import everything
from tests.render.build import Builder, camera, floor, grey, hexagon, octahedron

MOONS, FIELD, HAZY_FIELD, FULL = (
    "spheres that shine, in fog or none",
    "surfaces lit by spheres, without fog and glass",
    "surfaces lit by spheres, in fog, without glass",
    "everything",
)
LEFT_OUT = {
    "fog": "no fog: no distance sampling, no transmittance",
    "surfaces": "no surface that scatters: no scattering at surfaces",
    "glass": "no glass: no search for the bodies around the camera",
    "BVH": "a few spheres alone: no BVH",
    "lights": "no lights but spheres that shine: no lamps, shining meshes, suns or sky",
}
VIEW = camera((0, -6, 3), (0, 4, 1), 60)
LENS = d.Camera(VIEW.to_world, VIEW.projection, lens_radius=0.05, focus_distance=9)
HAZE = d.Medium(grey(0.01), grey(0.05))
METAL = d.Mix(0.4, d.Lambert((0.7, 0.5, 0.3)), d.Conductor(0.2, eta=(2.6, 2.4, 2.2), k=(3.3, 3.1, 2.9)))


@dataclass(frozen=True)
class Case:
    name: str
    scene: d.SceneDescription
    needs: str  # words of LEFT_OUT
    kernel: str
    settings: dict[str, Any] = field(default_factory=dict)
    dark: bool = False  # no light reaches the camera


def moons(view: d.Camera = VIEW, count: int = 2, **parts: Any) -> Builder:
    builder = Builder(view, 48, 36, **parts)
    for i in range(count):
        builder.sphere((-2 + 1.3 * i, 5 + i, 2), 0.5, d.Light((6, 2 + i, 1)))
    return builder


def plates(material: d.Material = METAL, **parts: Any) -> Builder:
    places = np.tile(np.eye(4), (9, 1, 1))
    places[:, :2, 3] = [(2.2 * i, 2.2 * j + 4) for i in (-1, 0, 1) for j in (-1, 0, 1)]
    builder = moons(**parts).mesh(hexagon(1, 0.3), material, instances=places)
    return builder.mesh(floor(-0.5, 20), d.Lambert(grey(0.4)))


def fog(sigma_s: d.Rgb, g: float = 0) -> d.Medium:
    return d.Medium((0.01, 0.02, 0.0), sigma_s, g)


COLOURS = (0.05, 0.03, 0.06)
LAMP = d.PointLight("point", (0, 4, 3), grey(4))
BALL_LAMP = d.PointLight("ball", (0, 4, 3), grey(4), radius=0.4)
SUN = d.SunLight("sun", (0.3, 0.4, -1), grey(0.5), 0.5)
GLOW = d.Light((2, 3, 1))
SKY = d.Environment(grey(0.1))
BLUE_PASSES = d.Medium((0.01, 0.02, 0.0), (0.05, 0.03, 0.0))  # through any other fog no light from infinity comes
SHINING_BALL = ((0.5, 4, 1), 0.8, d.Lambert((0.6, 0.3, 0.5), emission=(0.5, 1, 2)))
BLACK_MOON = ((0.5, 3, 1), 0.6, d.Light(grey(0)))
NARROW_MOON = ((0, -5.5, 3), 3, d.Light((0.2, 0.3, 0.1)))  # the camera is inside
WIDE_MOON = ((0, 0, 2), 12, d.Light((0.2, 0.3, 0.1)))  # and all else too


def balls(count: int, lights: int = 0, **parts: Any) -> Builder:
    places = np.array([(0.9 * (i % 5) - 2, 3 + 0.8 * (i // 5), 0.5 + 0.05 * i) for i in range(count)])
    return moons(count=lights, **parts).spheres(places, np.full(count, 0.35), METAL)


CASES = (
    Case("moons", moons(medium=HAZE).done(), "fog", MOONS),
    Case("coloured fog", moons(medium=fog(COLOURS)).done(), "fog", MOONS),
    Case("fog with a direction", moons(medium=fog(COLOURS, 0.5)).done(), "fog", MOONS),
    Case("fog with a narrow peak", moons(medium=fog(COLOURS, 0.95)).done(), "fog", FULL),
    Case("fog that does not scatter", moons(medium=fog(grey(0))).done(), "fog", MOONS),
    Case("moons without fog", moons().done(), "", MOONS),
    Case("moons through a lens", moons(LENS, medium=HAZE).done(), "fog", MOONS),
    Case("one moon", moons(count=1, medium=HAZE).done(), "fog", MOONS),
    Case("moons on end", moons(medium=HAZE).done(), "fog", MOONS, {"max_scatter": 3}),
    Case("moons and direct light", moons(medium=HAZE).done(), "fog", FULL, {"max_depth": 1}),
    Case("moons by the baseline", moons(medium=HAZE).done(), "fog", FULL, {"integrator": "baseline"}),
    Case("eight moons", moons(count=8, medium=HAZE).done(), "fog", MOONS),
    Case("nine moons", moons(count=9, medium=HAZE).done(), "fog BVH", HAZY_FIELD),
    Case("a ball of metal", moons(medium=HAZE).sphere((1, 3, 1), 0.7, METAL).done(), "fog surfaces", HAZY_FIELD),
    Case(
        "a black ball", moons(medium=HAZE).sphere((1, 3, 1), 0.7, d.Lambert(grey(0))).done(), "fog surfaces", HAZY_FIELD
    ),
    Case(
        "a ball that shines and scatters", moons(medium=HAZE).sphere(*SHINING_BALL).done(), "fog surfaces", HAZY_FIELD
    ),
    Case("a ball that shines and scatters alone", moons(count=0).sphere(*SHINING_BALL).done(), "surfaces", FIELD),
    Case("a black moon", moons(medium=HAZE).sphere(*BLACK_MOON).done(), "fog", MOONS),
    Case("a black moon and no light", moons(count=0).sphere(*BLACK_MOON).done(), "", MOONS, dark=True),
    Case("inside a moon", moons(medium=HAZE).sphere(*NARROW_MOON).done(), "fog", MOONS),
    Case("inside a moon with others", moons(medium=HAZE).sphere(*WIDE_MOON).done(), "fog", MOONS),
    Case("inside a moon with a ball", balls(1, medium=HAZE).sphere(*WIDE_MOON).done(), "fog surfaces", HAZY_FIELD),
    Case("nothing", moons(count=0).done(), "", MOONS, dark=True),
    Case("fog without a light", moons(count=0, medium=HAZE).done(), "fog", FULL, dark=True),
    Case("a ball without a light", balls(1).done(), "surfaces", FIELD, dark=True),
    Case("a ball in fog without a light", balls(1, medium=HAZE).done(), "fog surfaces", FULL, dark=True),
    Case("a sky alone in fog", balls(1, medium=HAZE, environment=SKY).done(), "fog surfaces lights", FULL, dark=True),
    Case(
        "a sky alone, seen in blue", balls(1, medium=BLUE_PASSES, environment=SKY).done(), "fog surfaces lights", FULL
    ),
    Case("a sun alone, seen in blue", balls(1, medium=BLUE_PASSES).lamp(SUN).done(), "fog surfaces lights", FULL),
    Case("many balls", balls(30, lights=2).done(), "surfaces BVH", FIELD),
    Case("many balls in fog", balls(30, lights=2, medium=HAZE).done(), "fog surfaces BVH", HAZY_FIELD),
    Case("many moons", moons(count=30, medium=HAZE).done(), "fog BVH", HAZY_FIELD),
    Case("a lamp", moons(medium=HAZE).lamp(LAMP).done(), "fog lights", FULL),
    Case("a lamp with a size", moons(medium=HAZE).lamp(BALL_LAMP).done(), "fog lights", FULL),
    Case("a shining mesh", moons(medium=HAZE).mesh(octahedron((1, 4, 1), 0.4), GLOW).done(), "fog BVH lights", FULL),
    Case("a sky", moons(environment=SKY).done(), "lights", FULL),
    Case("a ball of glass", moons(medium=HAZE).sphere((0, 3, 1), 0.8, d.Glass(1.5)).done(), "fog surfaces glass", FULL),
    Case("field", plates().done(), "surfaces BVH", FIELD),
    Case("field, four bounces", plates().done(), "surfaces BVH", FIELD, {"max_depth": 4}),
    Case("balls without fog", moons().sphere((1, 3, 1), 0.7, METAL).done(), "surfaces", FIELD),
    Case("field of mirrors", plates(d.Mirror(grey(0.9))).done(), "surfaces BVH", FIELD),
    Case("field and a sun", plates().lamp(SUN).done(), "surfaces BVH lights", FULL),
    Case("field and glass", plates().sphere((0, 2, 1), 0.6, d.Glass(1.5)).done(), "surfaces BVH glass", FULL),
    Case("field that glows", plates(GLOW).done(), "surfaces BVH lights", FULL),
    Case("hazy field", plates(medium=fog(COLOURS)).done(), "fog surfaces BVH", HAZY_FIELD),
    Case("hazy field through a lens", plates(view=LENS, medium=HAZE).done(), "fog surfaces BVH", HAZY_FIELD),
    Case("hazy field of mirrors", plates(d.Mirror(grey(0.9)), medium=HAZE).done(), "fog surfaces BVH", HAZY_FIELD),
    Case("field in absorbing fog", plates(medium=fog(grey(0))).done(), "fog surfaces BVH", HAZY_FIELD),
    Case("hazy field and a lamp", plates(medium=HAZE).lamp(BALL_LAMP).done(), "fog surfaces BVH lights", FULL),
    Case("hazy field on end", plates(medium=HAZE).done(), "fog surfaces BVH", HAZY_FIELD, {"max_depth": 5}),
    Case("all there is", everything(48, 36), "fog surfaces BVH glass lights", FULL),
)


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_selected_and_full_kernel_give_the_same_bits(case: Case) -> None:
    world = Scene(case.scene)
    results = []
    for full in (0, 1):
        with Render(world, samples=8, seed=3, passes=plain_passes(), full_kernel=full, **case.settings) as render:
            results.append((pictures(render.run(), plain_passes()), render.report(), render.poll().rays))
    (selected, said, rays), (full_pictures, full_said, full_rays) = results
    assert_same_bits(selected, full_pictures)
    assert rays == full_rays
    assert not selected["combined"].any() if case.dark else np.unique(selected["combined"]).size > 10
    assert said["kernel"].endswith(f" (compiled for {case.kernel})"), said["kernel"]
    assert full_said["kernel"].endswith(f" (compiled for {FULL})")
    assert said["left_out"] == full_said["left_out"]
    left_out = {word for word, line in LEFT_OUT.items() if line in said["left_out"]}
    assert left_out == LEFT_OUT.keys() - set(case.needs.split())
