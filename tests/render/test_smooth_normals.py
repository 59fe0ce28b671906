# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes shaded about other normals than their own: light paths carry the adjoint of what camera paths see.

No closed form: shared light vertices (`path`) against paths from the camera alone (`baseline`), in fog, where what
leaves a surface shows. The camera's way of shading is the definition: about the shading normal, but bent where rough
metal would reflect beneath the surface; of what is diffuse or has a mirror, about the true normal where the view is
beneath the shading normal's horizon, and nothing of what a mirror would send beneath the surface.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from addon.scene import description as d
from tests.render.build import WHITE, Array, Builder, box, camera, grey, quad
from tests.render.statistics import Measurement, Pictures, blocks, check_same

HAZE = d.Medium(grey(0.02), grey(0.15))


def with_normals(mesh: d.Mesh, normals: Array) -> d.Mesh:
    return replace(mesh, normals=normals / np.linalg.norm(normals, axis=1, keepdims=True))


def plate(material: d.Material) -> Builder:
    """A flat plate whose normals lean outwards, at the corners by 70 degrees, with a moon low beside it: on the other
    side they are far beneath its light, and much is seen from beneath theirs."""
    scene = Builder(camera((0, -3, 1.5), (0, 4, 1.2), 40), 32, 24, medium=HAZE)
    return scene.mesh(fan(), material).sphere((-2.2, 4, 1.2), 0.7, d.Light(grey(5)))


def plate_from_above(material: d.Material) -> Builder:
    """The same with the moon above, out of view."""
    scene = Builder(camera((0, -3, 1.5), (0, 4, 1), 30), 32, 24, medium=HAZE)
    return scene.mesh(fan(), material).sphere((0, 4, 5), 0.7, d.Light(grey(5)))


def fan() -> d.Mesh:
    flat = quad((0, 4, 0), (2, 0, 0), (0, 2, 0))
    outwards = (flat.vertices - (0, 4, 0)) / np.sqrt(8) * np.tan(np.radians(70))
    return with_normals(flat, outwards + np.array((0, 0, 1)))


def pane() -> d.Mesh:
    """A flat box; the normals of its two faces lean outwards, too."""
    flat = box((-1.5, 2.5, 1), (1.5, 5.5, 1.4))
    from_middle = flat.vertices - (0, 4, 1.2)
    outwards = from_middle * (1, 1, 0) / (1.5 * np.sqrt(2)) * np.tan(np.radians(70))
    return with_normals(flat, outwards + np.sign(from_middle) * (0, 0, 1))


def pane_from_above() -> Builder:
    scene = Builder(camera((0, -3, 1.5), (0, 4, 1.5), 40), 32, 24, medium=HAZE)
    return scene.mesh(pane(), d.Glass(1.5)).sphere((0, 4, 3), 0.8, d.Light(grey(5)))


def pane_from_beneath() -> Builder:
    """Most of the light leaves it from beneath the horizon of the normals."""
    scene = Builder(camera((0, -3, 1.7), (0, 4, 2), 40), 32, 24, medium=HAZE)
    return scene.mesh(pane(), d.Glass(1.5)).sphere((0, 5, 0), 0.6, d.Light(grey(5)))


# And the widest half-width of the sum's interval, relative, at which blocks that are off by a tenth show.
SCENES: dict[str, tuple[Callable[[], Builder], float]] = {
    "mirror": (lambda: plate(d.Mirror(WHITE)), 0.018),
    "mirror in a mix": (lambda: plate(d.Mix(0.5, d.Lambert(grey(0.8)), d.Mirror(WHITE))), 0.013),
    "rough metal": (lambda: plate_from_above(d.Conductor(0.3, f0=WHITE)), 0.025),
    "diffuse": (lambda: plate_from_above(d.Lambert(WHITE)), 0.025),
    "glass": (pane_from_above, 0.011),
    "glass from beneath": (pane_from_beneath, 0.018),
}


LONG = ("mirror in a mix", "glass from beneath")


@pytest.mark.parametrize("name", [pytest.param(name, marks=[pytest.mark.full] * (name in LONG)) for name in SCENES])
def test_light_paths_are_adjoint_to_camera_paths(name: str) -> None:
    build, within = SCENES[name]
    scene = build().done()
    path, baseline = (Pictures(Measurement(scene, integrator, samples=2)) for integrator in ("path", "baseline"))
    check_same(lambda seed: blocks(path(seed), 8), lambda seed: blocks(baseline(seed), 8), within=within, what=name)
