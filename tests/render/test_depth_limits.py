# SPDX-License-Identifier: GPL-3.0-or-later
"""Limits on the depth mean the same with light vertices, which count their own depth, and without them."""

from collections.abc import Callable

import numpy as np
import pytest

from addon.scene import description as d
from tests.engine.library import Scene, rendering
from tests.render.build import WHITE, Array, Builder, camera, floor, grey
from tests.render.statistics import Measurement, Pictures, check_same
from tests.render.test_integrators_agree import field

pytestmark = pytest.mark.timeout(900)  # some of its scenes take minutes on a busy machine

SHARED = "light vertices"


def moons_in_fog() -> Builder:
    """Fog alone, thick enough that each depth up to five has a share of the picture."""
    scene = Builder(camera((0, -4, 4), (0, 8, 1.5), 60), 32, 24, medium=d.Medium(grey(0.01), grey(0.19)))
    scene.sphere((-3, 11, 4), 1.2, d.Light((3, 0.5, 0.3))).sphere((0, 3, 2), 0.5, d.Light((1, 1, 3)))
    return scene.sphere((4, 9, 3), 0.8, d.Light((0.3, 3, 0.5)))


def field_in_fog() -> Builder:
    return field(d.Medium(grey(0.01), (0.15, 0.1, 0.2), 0.3))


def glass_in_fog() -> Builder:
    """Glass and a mirror between light and fog, before the camera and behind what it sees."""
    scene = Builder(camera((0, -4, 2), (0, 4, 1), 60), 32, 24, medium=d.Medium(grey(0.01), grey(0.15)))
    scene.mesh(floor(0, 8, (0, 4)), d.Lambert(grey(0.7))).sphere((-0.5, 3, 1.4), 0.8, d.Glass(1.5))
    scene.sphere((1.6, 4, 1), 0.7, d.Mirror(grey(0.9))).sphere((0.3, -1.5, 1.7), 0.4, d.Glass(1.3))
    return scene.sphere((-1, 5, 3), 0.6, d.Light((6, 5, 4)))


SCENES: dict[str, Callable[[], Builder]] = {
    "fog": moons_in_fog,
    "field in fog": field_in_fog,
    "glass in fog": glass_in_fog,
}
# In fog alone what compensation rays bring of a depth too many, 1.4 % of the picture, is seen.
WITHIN = {"fog": 0.012, "field in fog": 0.03, "glass in fog": 0.04}
LIMITS = [(1, -1), (2, -1), (3, -1), (5, -1), (65, -1), (-1, 1), (-1, 2), (4, 2)]  # max_depth, max_scatter
FEWER = [(2, -1), (5, -1), (65, -1), (-1, 1), (-1, 2)]
CASES = [
    *(("fog", *limits) for limits in LIMITS),
    *((name, *limits) for name in ("field in fog", "glass in fog") for limits in FEWER),
]


def quadrants(picture: Array) -> Array:
    """(4,) means of the quarters of the picture."""
    h, w, _ = picture.shape
    return np.asarray(picture.reshape(2, h // 2, 2, w // 2, 3).mean(axis=(1, 3, 4)).ravel())


@pytest.mark.parametrize(("name", "depth", "scatter"), CASES)
def test_limits_mean_the_same_with_light_vertices(name: str, depth: int, scatter: int) -> None:
    scene = SCENES[name]().done()
    shared, alone = (
        Pictures(Measurement(scene, integrator, samples=4, max_depth=depth, max_scatter=scatter))
        for integrator in ("path", "path-no-light-vertices")
    )
    check_same(
        lambda seed: quadrants(shared(seed)),
        lambda seed: quadrants(alone(seed)),
        within=WITHIN[name] * (3 if depth == 65 else 1),  # long paths alone are noisy
        what=f"{name}, max_depth {depth}, max_scatter {scatter}",
    )


@pytest.mark.parametrize(
    ("limits", "serve"),
    [({"max_depth": 1}, False), ({"max_depth": 2}, True), ({"max_scatter": 0}, False), ({"max_scatter": 1}, True)],
)
def test_light_vertices_serve_where_limits_leave_them_room(limits: dict[str, int], serve: bool) -> None:
    with rendering(Scene(moons_in_fog().done()), samples=1, **limits) as render:
        render.wait()
        report = render.report()
    assert (SHARED in report["kernel"]) == serve
    assert any(SHARED in line and "max_depth" in line for line in report["left_out"]) != serve


@pytest.mark.parametrize(
    ("scene", "reason"),
    [
        (moons_in_fog().sphere((0, -4, 4), 1, d.Glass(1.5)), "inside glass"),
        (Builder(camera((0, -4, 4), (0, 8, 1), 60), 32, 24, medium=d.Medium(grey(0.1), grey(0.1), 0.95)), "anisotropy"),
        (
            Builder(camera((0, -4, 4), (0, 8, 1), 60), 4, 3, medium=d.Medium(grey(0), grey(20))).sphere(
                (0, 8, 1), 9, d.Light(WHITE)
            ),
            "dense",
        ),
        (Builder(camera((0, -4, 4), (0, 8, 1), 60), 32, 24, medium=d.Medium(grey(0.1), grey(0.1))), "infinity"),
    ],
    ids=["inside glass", "narrow peak", "dense and white", "no light"],
)
def test_the_report_says_why_light_vertices_do_not_serve(scene: Builder, reason: str) -> None:
    with rendering(Scene(scene.done()), samples=1) as render:
        render.wait()
        lines = [line for line in render.report()["left_out"] if SHARED in line]
    assert len(lines) == 1 and reason in lines[0], lines
