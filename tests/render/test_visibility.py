# SPDX-License-Identifier: GPL-3.0-or-later
"""Against closed forms: objects, lights and a sky that some rays do not see, lamps without shadows or with a limit of
bounces, holdouts and the film's exposure."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import ArrayLike

from addon.scene import description as d
from tests.render import closed_forms as exact
from tests.render.build import BLACK, Builder, at, floor, grey, quad, radiometer, sky
from tests.render.statistics import INTEGRATORS, Measurement, check_radiance

pytestmark = pytest.mark.parametrize("integrator", INTEGRATORS)

ALBEDO = 0.6
Rays = d.Rays
ALL = d.EVERY_RAY


def view(eye: ArrayLike = (0.3, -2, 0.7), **parts: Any) -> Builder:
    """A radiometer on the origin."""
    return Builder(radiometer(eye, (0, 0, 0)), **parts)


def plate(**parts: Any) -> Builder:
    return view(**parts).mesh(floor(), d.Lambert(grey(ALBEDO)))


def hidden(scene: d.SceneDescription, rays: Rays, which: int = -1, **more: Any) -> d.SceneDescription:
    """The scene with an object that only these rays meet."""
    objects = list(scene.objects)
    objects[which] = replace(objects[which], rays=rays, **more)
    return replace(scene, objects=tuple(objects))


def lamp(**flags: Any) -> d.PointLight:
    return d.PointLight("lamp", (0.0, 0.0, 2.0), grey(1.0), flags=d.LampFlags(**flags))


DIRECT = ALBEDO / np.pi / 4
"""Radiance of the plate at the origin under that lamp."""


def check(scene: d.SceneDescription, integrator: str, expected: float, samples: int = 2, within: float = 0.02) -> None:
    check_radiance(Measurement(scene, integrator, samples=samples), expected, within=within)


def test_the_camera_sees_through_what_is_hidden_from_it(integrator: str) -> None:
    """A black screen before the plate, of which the lamp knows as well: its shadow stays."""
    scene = plate().lamp(lamp()).mesh(quad((0.15, -1, 0.35), (0.1, 0, 0), (0, 0, 0.1)), d.Lambert(BLACK)).done()
    check(hidden(scene, ALL & ~Rays.CAMERA), integrator, DIRECT, within=1e-3)
    scene = plate().lamp(lamp()).mesh(quad((0, 0, 1), (0.1, 0, 0), (0, 0.1, 0)), d.Lambert(BLACK)).done()
    check(hidden(scene, ALL & ~Rays.CAMERA), integrator, 0.0, within=0)


def test_a_hidden_emitter_shines(integrator: str) -> None:
    """A luminous sphere that the camera looks through."""
    scene = plate().sphere(10 * at(0.5), 3, d.Light(grey(1.0))).done()
    unseen = replace(scene.spheres[0], rays=ALL & ~Rays.CAMERA)
    expected = ALBEDO / np.pi * exact.sphere_irradiance(0.3, 0.5)
    check(replace(scene, spheres=(unseen,)), integrator, expected, samples=4)
    away = view().sphere((0, 0, 0), 0.5, d.Light(grey(1.0))).done()
    check(replace(away, spheres=(replace(away.spheres[0], rays=ALL & ~Rays.CAMERA),)), integrator, 0.0, within=0)


def test_shadow_rays_pass_what_casts_no_shadow(integrator: str) -> None:
    scene = plate().lamp(lamp()).mesh(quad((0, 0, 1), (0.1, 0, 0), (0, 0.1, 0)), d.Lambert(BLACK)).done()
    check(scene, integrator, 0.0, within=0)
    check(hidden(scene, ALL & ~Rays.SHADOW), integrator, DIRECT, within=1e-3)
    small = replace(scene.objects[1], rays=ALL & ~Rays.SHADOW)
    spheres = plate().lamp(lamp()).sphere((0, 0, 1), 0.1, d.Lambert(BLACK)).done()
    assert small.rays != ALL
    unshaded = replace(spheres, spheres=(replace(spheres.spheres[0], rays=ALL & ~Rays.SHADOW),))
    check(unshaded, integrator, DIRECT, within=1e-3)


def test_a_lamp_without_shadows(integrator: str) -> None:
    screen = quad((0, 0, 1), (0.1, 0, 0), (0, 0.1, 0))
    for shadows, expected in ((True, 0.0), (False, DIRECT)):
        scene = plate().lamp(lamp(shadows=shadows)).mesh(screen, d.Lambert(BLACK)).done()
        check(scene, integrator, expected, within=1e-3 if expected else 0)


@pytest.mark.parametrize(
    ("material", "ray"),
    [
        (d.Lambert(grey(ALBEDO)), Rays.DIFFUSE),
        (d.Mirror(grey(ALBEDO)), Rays.GLOSSY),
        (d.Translucent(grey(ALBEDO)), Rays.TRANSMISSION),
    ],
)
def test_a_sky_by_the_lobe_that_looks(integrator: str, material: d.Material, ray: Rays) -> None:
    """A plate under an even sky shows its albedo, or nothing where its kind of rays does not see the sky."""
    for rays, expected in ((ray, ALBEDO), (ALL & ~ray, 0.0)):
        environment = replace(sky(), rays=rays | Rays.SHADOW)
        scene = view(environment=environment).mesh(floor(), material).done()
        check(scene, integrator, expected, samples=4, within=0.02 if expected else 0)


def test_a_sky_that_the_camera_does_not_see(integrator: str) -> None:
    environment = replace(sky(), rays=ALL & ~Rays.CAMERA)
    check(view(environment=environment).done(), integrator, 0.0, within=0)
    check(plate(environment=environment).done(), integrator, ALBEDO)


def test_an_object_by_the_lobe_that_looks(integrator: str) -> None:
    """A luminous ceiling that fills the sky, seen by diffuse or glossy rays alone; it does not light either."""
    ceiling = quad((0, 0, 5), (1e4, 0, 0), (0, -1e4, 0))
    for material, ray in ((d.Lambert(grey(ALBEDO)), Rays.DIFFUSE), (d.Mirror(grey(ALBEDO)), Rays.GLOSSY)):
        for rays, expected in ((ray, ALBEDO), (ALL & ~ray, 0.0)):
            scene = view().mesh(floor(), material).mesh(ceiling, d.Light(grey(1.0))).done()
            check(hidden(scene, rays | Rays.SHADOW), integrator, expected, samples=4, within=0.02 if expected else 0)


def test_a_lamp_lights_no_more_than_its_bounces(integrator: str) -> None:
    """Between two plates: with no bounce only the direct light, with any number all of it."""
    for bounces, bounded in ((0, True), (None, False)):
        scene = plate().lamp(lamp(max_bounces=bounces))
        scene.mesh(floor(3, half=3), d.Lambert(grey(ALBEDO)))
        measured = Measurement(scene.done(), integrator, samples=4, max_depth=1 if not bounded else -1)
        check_radiance(measured, DIRECT, within=1e-3)


def test_a_holdout_is_a_hole(integrator: str) -> None:
    """Black before a bright sky, also behind a pane; it still stands in the light of a lamp."""
    pane = quad((0.15, -1, 0.35), (0.1, 0, 0), (0, 0, 0.1))
    scene = view(environment=sky()).mesh(floor(), d.Lambert(grey(ALBEDO), emission=grey(1.0))).done()
    check(hidden(scene, ALL, is_holdout=True), integrator, 0.0, within=0)
    scene = view(environment=sky()).mesh(floor(), d.Lambert(grey(ALBEDO))).mesh(pane, d.Transparent(grey(1.0))).done()
    check(hidden(scene, ALL, 0, is_holdout=True), integrator, 0.0, within=0)
    scene = plate().lamp(lamp()).mesh(quad((0, 0, 1), (0.1, 0, 0), (0, 0.1, 0)), d.Lambert(BLACK)).done()
    check(hidden(scene, ALL, is_holdout=True), integrator, 0.0, within=0)
    scene = plate().lamp(lamp()).sphere((0, 0, 0.3), 0.1, d.Light(grey(1.0))).done()
    looking = replace(scene, spheres=(replace(scene.spheres[0], is_holdout=True),))
    looking = replace(looking, camera=radiometer((0.3, -2, 0.7), (0, 0, 0.3)))
    check(looking, integrator, 0.0, within=0)


def test_exposure_scales_all_light(integrator: str) -> None:
    scene = plate(environment=sky()).lamp(lamp()).done()
    bright = replace(scene, film=replace(scene.film, exposure=2.5))
    check(bright, integrator, 2.5 * (ALBEDO + DIRECT), samples=4)


def test_a_lamp_that_the_camera_sees(integrator: str) -> None:
    """Of the radiance that its intensity and size make."""
    flags = d.LampFlags(rays=ALL)
    for shown in (
        d.PointLight("ball", (0.0, 0.0, 0.0), grey(1.0), 0.5, flags=flags),
        d.PointLight("disk", (0.0, 0.0, 0.0), grey(1.0), 0.5, is_disk=True, flags=flags),
    ):
        check(view().lamp(shown).done(), integrator, 1 / (np.pi * 0.25), within=1e-3)
