# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes for tests of sessions: one with every kind of transport, one that keeps the engine busy."""

import numpy as np

from addon.scene import description as d
from tests.render.build import Builder, camera, floor, grey, hexagon, octahedron


def everything(width: int = 40, height: int = 28, fog: bool = True, glass: bool = True) -> d.SceneDescription:
    """Fog, glass, mirrors, metal, instances, lamps, a mesh light, moons, a lens, a coloured and forward haze."""
    view = camera((0, -6, 3), (0, 4, 1), 60)
    view = d.Camera(view.to_world, view.projection, lens_radius=0.02, focus_distance=9)
    medium = d.Medium((0.01, 0.02, 0.0), (0.05, 0.03, 0.06), 0.2) if fog else None
    scene = Builder(view, width, height, medium=medium, environment=d.Environment(grey(0.1)))
    places = np.tile(np.eye(4), (9, 1, 1))
    places[:, :2, 3] = [(2.2 * i, 2.2 * j + 4) for i in (-1, 0, 1) for j in (-1, 0, 1)]
    metal = d.Mix(0.4, d.Lambert((0.7, 0.5, 0.3)), d.Conductor(0.2, eta=(2.6, 2.4, 2.2), k=(3.3, 3.1, 2.9)))
    scene.mesh(hexagon(1, 0.3), metal, instances=places).mesh(floor(-0.5, 20), d.Lambert(grey(0.4)))
    scene.mesh(octahedron((1.5, 5, 1.5), 0.4), d.Light((2, 3, 1))).sphere((-2, 5, 2), 0.5, d.Light((6, 2, 1)))
    scene.sphere((-0.5, 2, 1), 0.6, d.Glass(1.5) if glass else d.Lambert(grey(0.5)))
    scene.sphere((1, 2.5, 0.7), 0.4, d.Mirror(grey(0.9)))
    scene.lamp(d.PointLight("point", (0, 4, 3), grey(4))).lamp(d.SunLight("sun", (0.3, 0.4, -1), grey(0.5), 0.5))
    return scene.done()


def heavy(width: int = 640, height: int = 480) -> d.SceneDescription:
    """Thick bright fog around many lights in a bright room: paths of dozens of vertices, hours to a clean picture."""
    rng = np.random.default_rng(2)
    scene = Builder(camera((0, -6, 3), (0, 4, 1), 60), width, height, medium=d.Medium(grey(0.05), grey(1)))
    scene.sphere((0, 0, 0), 15, d.Lambert(grey(0.9)))
    return scene.spheres(rng.uniform(-8, 8, (300, 3)), np.full(300, 0.1), d.Light(grey(5))).done()
