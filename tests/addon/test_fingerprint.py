# SPDX-License-Identifier: GPL-3.0-or-later
"""Equal descriptions have one fingerprint, and any difference gives another."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from addon.scene import description as d
from addon.scene.fingerprint import LARGE, Fingerprints
from addon.scene.program import Op, programmed


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


def fingerprint(of: d.SceneDescription) -> bytes:
    return Fingerprints().of(of)


def test_equal_scenes_are_equal() -> None:
    assert fingerprint(scene()) == fingerprint(scene())


@pytest.mark.parametrize("change", CHANGES)
def test_every_change_is_seen(change: str) -> None:
    assert fingerprint(CHANGES[change](scene())) != fingerprint(scene())


@pytest.mark.parametrize("change", CHANGES)
def test_every_change_is_seen_after_another_scene(change: str) -> None:
    one = Fingerprints()
    first = one.of(scene())
    assert one.of(CHANGES[change](scene())) != first
    assert one.of(scene()) == first


def test_a_name_is_no_change() -> None:
    renamed = replace(scene(), objects=(replace(scene().objects[0], name="Other", random=0.5),))
    assert fingerprint(renamed) == fingerprint(scene())


def test_what_is_random_counts_where_a_material_asks_for_it() -> None:
    grey, _ = programmed(d.Lambert(Op("geometry_number", modes=("object_random",))))
    _, program = programmed(d.Lambert(Op("geometry_number", modes=("object_random",))))
    asking = replace(scene(), materials=(d.NamedMaterial("Grey", grey, program=program),))
    other = replace(asking, objects=(replace(asking.objects[0], random=0.5),))
    assert fingerprint(other) != fingerprint(asking)


def test_large_arrays_are_digested_once() -> None:
    places = np.broadcast_to(np.eye(4), (LARGE // 8, 4, 4)).copy()
    many = replace(scene(), objects=(replace(scene().objects[0], instances=places),))
    one = Fingerprints()
    first = one.of(many)
    assert set(one._known) == {id(places)}
    assert one.of(many) == first
    assert one.of(replace(many, objects=(replace(many.objects[0], instances=places.copy()),))) == first
    assert one.of(scene()) == fingerprint(scene()) and not one._known


def test_numbers_do_not_run_into_each_other() -> None:
    def with_passes(*names: str) -> d.SceneDescription:
        return replace(scene(), settings=d.RenderSettings(passes=names))

    assert fingerprint(with_passes("ab", "c")) != fingerprint(with_passes("a", "bc"))
