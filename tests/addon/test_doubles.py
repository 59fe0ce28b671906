# SPDX-License-Identifier: GPL-3.0-or-later
"""Who is told that objects lie on others: only who has two of the same shape in the same place."""

from dataclasses import replace

import numpy as np
import pytest

from addon.export import doubles
from addon.export.doubles import warn_of_doubled_objects
from addon.scene.description import Floats, Medium, Object, Rays
from addon.scene.problems import Notices
from tests.render.build import box

BOX = box((0, 0, 0), (1, 1, 1))
COPY = replace(BOX, vertices=BOX.vertices.copy())


def moved(x: float) -> Floats:
    matrix: Floats = np.eye(4)
    matrix[0, 3] = x
    return matrix


def told(*objects: Object) -> list[tuple[str, str]]:
    notices = Notices()
    warn_of_doubled_objects(objects, notices)
    return [(notice.where, notice.what.split(",")[0]) for notice in notices.items]


FIRST = Object("a", BOX, (0,), to_world=moved(2.0))
SAME = Object("b", COPY, (0,), to_world=moved(2.0))


def test_a_copy_in_its_place_is_told_once() -> None:
    assert told(FIRST, SAME) == [("object 'b'", "lies on object 'a'")]
    assert told(FIRST, replace(SAME, to_world=moved(2.0 + 1e-12))) == [("object 'b'", "lies on object 'a'")]


@pytest.mark.parametrize(
    "other",
    [
        replace(SAME, to_world=moved(2.5)),
        replace(SAME, mesh=replace(BOX, vertices=BOX.vertices * np.float32(1.5))),
        replace(SAME, rays=Rays.SHADOW),
        replace(SAME, interior=Medium((1.0, 1.0, 1.0), (0.0, 0.0, 0.0))),
        replace(SAME, to_world=np.diag([-1.0, 1.0, 1.0, 1.0])),
    ],
    ids=["elsewhere", "of another shape", "for shadows alone", "with a volume", "mirrored"],
)
def test_others_are_not(other: Object) -> None:
    assert told(FIRST, other) == []


def test_an_instance_that_lies_on_an_object_is_told_once() -> None:
    many = Object("many", BOX, (0,), instances=np.stack([moved(x) for x in (0.0, 1.0, 2.0, 3.0)]))
    assert told(FIRST, many) == [("object 'many'", "lies on object 'a'")]


def test_very_many_places_are_not_held_against_each_other(monkeypatch: pytest.MonkeyPatch) -> None:
    many = Object("many", BOX, (0,), instances=np.stack([moved(x) for x in (0.0, 1.0, 2.0, 3.0)]))
    monkeypatch.setattr(doubles, "MOST_PLACES", 4)
    assert told(FIRST, many) == []


def test_the_same_object_twice_is_told() -> None:
    assert told(FIRST, FIRST) == [("object 'a'", "lies on another of its instances")]
