# SPDX-License-Identifier: GPL-3.0-or-later
"""Equal descriptions have one fingerprint, and any difference gives another."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from addon.scene import description as d
from addon.scene.fingerprint import fingerprint


def scene() -> d.SceneDescription:
    triangle = d.Mesh("Tri", np.eye(3, dtype=np.float32), np.array([[0, 1, 2]], np.uint32))
    return d.SceneDescription(
        film=d.Film(32, 18),
        camera=d.Camera(np.eye(4), d.Perspective(60.0)),
        materials=(d.NamedMaterial("Grey", d.Mix(0.3, d.Lambert((0.5, 0.5, 0.5)), d.Mirror(d.WHITE))),),
        objects=(d.Object("Tri", triangle, (0,)),),
        spheres=(d.Spheres("Ball", np.zeros((2, 3)), np.ones(2), 0),),
        medium=d.Medium((0.1, 0.1, 0.1), (0.2, 0.2, 0.2)),
    )


def moved(matrix: d.Floats) -> NDArray[np.float64]:
    result = np.array(matrix, np.float64)
    result[0, 3] += 1e-9
    return result


CHANGES = {
    "film": lambda s: replace(s, film=replace(s.film, width=33)),
    "camera": lambda s: replace(s, camera=replace(s.camera, to_world=moved(s.camera.to_world))),
    "material": lambda s: replace(s, materials=(replace(s.materials[0], material=d.Lambert((0.5, 0.5, 0.5))),)),
    "mesh": lambda s: replace(
        s, objects=(replace(s.objects[0], mesh=replace(s.objects[0].mesh, vertices=2 * s.objects[0].mesh.vertices)),)
    ),
    "object": lambda s: replace(s, objects=(replace(s.objects[0], to_world=moved(s.objects[0].to_world)),)),
    "instances": lambda s: replace(s, objects=(replace(s.objects[0], instances=np.eye(4)[np.newaxis]),)),
    "spheres": lambda s: replace(s, spheres=(replace(s.spheres[0], radii=np.array([1.0, 2.0])),)),
    "interior": lambda s: replace(s, objects=(replace(s.objects[0], interior=d.Medium(d.BLACK, d.WHITE)),)),
    "light": lambda s: replace(s, lights=(d.PointLight("Lamp", (0.0, 0.0, 1.0), d.WHITE),)),
    "medium": lambda s: replace(s, medium=None),
    "settings": lambda s: replace(s, settings=d.RenderSettings(seed=1)),
}


def test_equal_scenes_are_equal() -> None:
    assert fingerprint(scene()) == fingerprint(scene())


@pytest.mark.parametrize("change", CHANGES)
def test_every_change_is_seen(change: str) -> None:
    assert fingerprint(CHANGES[change](scene())) != fingerprint(scene())


def test_numbers_do_not_run_into_each_other() -> None:
    assert fingerprint((1, 23)) != fingerprint((12, 3))
    assert fingerprint(((1,), 2)) != fingerprint((1, (2,)))
