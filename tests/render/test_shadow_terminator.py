# SPDX-License-Identifier: GPL-3.0-or-later
"""Where light grazes coarse smooth meshes: lamps see the curved surface that the normals stand for."""

from dataclasses import replace

import numpy as np
import pytest

from addon.scene import description as d
from tests.render.build import Array, Builder, grey, octahedron, radiometer, unit
from tests.render.statistics import INTEGRATORS, Measurement, check_radiance

pytestmark = pytest.mark.parametrize("integrator", INTEGRATORS)

TO_SUN = unit((0.3, -0.2, 1.0))


def ball() -> d.Mesh:
    mesh = octahedron((0, 0, 0), 1, splits=2)
    return replace(mesh, normals=mesh.vertices)


def grazed(mesh: d.Mesh) -> tuple[Array, Array]:
    """A place on a triangle that turns away from the sun, whose normals do not; and its normal."""
    corners = mesh.vertices[mesh.triangles.astype(np.int64)]
    own = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    for weights in ((0.34, 0.33, 0.33), (0.6, 0.2, 0.2), (0.2, 0.6, 0.2), (0.2, 0.2, 0.6)):
        places = np.einsum("k,tki->ti", weights, corners)
        normals = places / np.linalg.norm(places, axis=1, keepdims=True)
        found = np.flatnonzero((own @ TO_SUN < 0) & (normals @ TO_SUN > 0.04))
        if found.size:
            return places[found[0]], normals[found[0]]
    raise AssertionError("no such triangle")


@pytest.mark.parametrize("terminator", [0.0, 0.5])
def test_a_triangle_that_turns_away(integrator: str, terminator: float) -> None:
    mesh = ball()
    place, normal = grazed(mesh)
    scene = Builder(radiometer(place + 5 * normal, place))
    scene.mesh(mesh, d.Lambert(grey(0.8)))
    scene.lamp(d.SunLight("sun", tuple(-TO_SUN), grey(1.0), 0.0))
    done = scene.done()
    done = replace(done, objects=tuple(replace(item, shadow_terminator=terminator) for item in done.objects))
    expected = 0.8 / np.pi * float(normal @ TO_SUN) if terminator else 0.0
    check_radiance(Measurement(done, integrator), expected, within=0.01 if terminator else 0.001)
