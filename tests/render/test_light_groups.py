# SPDX-License-Identifier: GPL-3.0-or-later
"""The pass of a light group is the picture that its lights alone would give."""

from collections.abc import Callable
from dataclasses import replace

import pytest

from addon.scene import description as d
from tests.engine.library import Render, Scene
from tests.render.build import Builder, camera, floor, grey
from tests.render.statistics import INTEGRATORS, Array, blocks, check_same


def world(first: d.Light) -> d.SceneDescription:
    """Haze between two moons, the second in group 3, metal that throws narrow light into it, and a ball in the way."""
    haze = d.Medium((0.01, 0.02, 0.01), (0.06, 0.05, 0.07), 0.2)
    builder = Builder(camera((0, -4, 2), (0, 8, 1.5), 60), 16, 12, medium=haze)
    builder.mesh(floor(0, 30), d.Mix(0.5, d.Lambert(grey(0.5)), d.Conductor(0.1, f0=grey(0.8))))
    builder.sphere((0, 5, 1), 1, d.Lambert(grey(0.7)))
    builder.sphere((-3, 8, 3), 0.8, first).sphere((2, 9, 4), 0.6, d.Light((1, 2, 4)))
    scene = builder.done()
    spheres = [replace(item, light_group=3 * (item is scene.spheres[-1])) for item in scene.spheres]
    return replace(scene, spheres=tuple(spheres))


def pictures(scene: d.SceneDescription, integrator: str, name: str) -> Callable[[int], Array]:
    committed = Scene(scene)

    def picture(seed: int) -> Array:
        with Render(committed, integrator=integrator, samples=4, seed=seed, threads=1, passes=(name,)) as render:
            return blocks(render.run().read(name), 4)

    return picture


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_group_is_the_picture_of_its_lights(integrator: str) -> None:
    together, alone = world(d.Light((3, 1, 0.6))), world(d.Light(grey(0)))
    check_same(
        pictures(together, integrator, "light_group_3"),
        pictures(alone, integrator, "combined"),
        within=0.05,
        what="group",
    )
