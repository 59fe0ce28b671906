# SPDX-License-Identifier: GPL-3.0-or-later
"""Where light grazes coarse smooth meshes, lamps see the curved surface that the normals stand for; where it grazes
bumps, the terminator of the smooth surface is kept."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from addon.export.translate.values import op
from addon.scene import description as d
from addon.scene.program import programmed
from tests.render.build import WHITE, Array, Builder, floor, grey, octahedron, radiometer, unit
from tests.render.build import sky as uniform_sky
from tests.render.statistics import Measurement, Pictures, check_radiance

INTEGRATOR = "path"  # both have the same surfaces

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
def test_a_triangle_that_turns_away(terminator: float) -> None:
    mesh = ball()
    place, normal = grazed(mesh)
    scene = Builder(radiometer(place + 5 * normal, place))
    scene.mesh(mesh, d.Lambert(grey(0.8)))
    scene.lamp(d.SunLight("sun", tuple(-TO_SUN), grey(1.0), 0.0))
    done = scene.done()
    done = replace(done, objects=tuple(replace(item, shadow_terminator=terminator) for item in done.objects))
    expected = 0.8 / np.pi * float(normal @ TO_SUN) if terminator else 0.0
    check_radiance(Measurement(done, INTEGRATOR), expected, within=0.01 if terminator else 0.001)


def softened(key: str, tilt: float, lit: float, turned: float) -> float:
    """What is left of light, by the cosines of the smooth normal to the bumped one, and of each to the light."""
    if key == "normal":
        return 1.0
    if key == "bumped_normal_cubic":
        g = lit / (turned * tilt)
        return 1.0 if g >= 1 else g + g**2 - g**3
    alpha2 = min(0.125 * (1 / tilt**2 - 1), 1.0)
    return float(2 / (1 + np.sqrt(1 + alpha2 * (1 / lit**2 - 1))))


@pytest.mark.parametrize("sky", [False, True])
@pytest.mark.parametrize("key", ["normal", "bumped_normal", "bumped_normal_cubic"])
def test_a_bump_in_low_light(key: str, sky: bool) -> None:
    """A plate whose normal leans to a low sun. Under a sky, where both techniques find the light, by quadrature."""
    lean, low = np.radians(40), np.radians(70)
    bumped, to_sun = np.array((np.sin(lean), 0, np.cos(lean))), np.array((np.sin(low), 0, np.cos(low)))
    (material, normal), program = programmed((d.Lambert(grey(0.8)), op("combine", *map(float, bumped))))
    light: dict[str, Any] = {"environment": uniform_sky()} if sky else {}
    scene = Builder(radiometer((2, 0, 4), (0, 0, 0)), **light)
    scene.mesh(floor(), material)
    if not sky:
        scene.lamp(d.SunLight("sun", tuple(-to_sun), grey(1.0), 0.0))
    done = scene.done()
    named = replace(done.materials[0], program=program, normal=normal, normal_key=key)
    done = replace(done, materials=(named, *done.materials[1:]))

    def reflected(towards: Array) -> float:
        lit, turned = float(towards[2]), float(towards @ bumped)
        return 0.0 if lit <= 0 or turned <= 0 else turned * softened(key, bumped[2], lit, turned)

    if sky:
        z, turn = np.meshgrid((np.arange(200) + 0.5) / 200, 2 * np.pi * (np.arange(400) + 0.5) / 400)
        side = np.sqrt(1 - z**2)
        directions = np.stack([side * np.cos(turn), side * np.sin(turn), z], axis=-1).reshape(-1, 3)
        expected = 0.8 * 2 * float(np.mean([reflected(w) for w in directions]))
    else:
        expected = 0.8 / np.pi * reflected(to_sun)
    check_radiance(Measurement(done, INTEGRATOR), expected, within=0.02)


@pytest.mark.parametrize("terminator", [0.0, 0.1])
def test_a_bump_does_not_see_beneath_the_smooth_surface(terminator: float) -> None:
    """A plate whose normals lean away from a low sun, with a bump that does not; metal, whose light bumps leave."""
    lean, low = np.radians(40), np.radians(70)
    smooth, to_sun = np.array((-np.sin(lean), 0, np.cos(lean))), np.array((np.sin(low), 0, np.cos(low)))
    assert smooth @ to_sun < 0
    metal = d.Conductor(0.5, f0=WHITE, f90=WHITE)
    (material, normal), program = programmed((metal, op("combine", 0.0, 0.0, 1.0)))
    plate = floor()
    scene = Builder(radiometer((-2, 0, 4), (0, 0, 0)))
    scene.mesh(replace(plate, normals=np.tile(smooth, (4, 1))), material)
    scene.lamp(d.SunLight("sun", tuple(-to_sun), grey(1.0), 0.0))
    done = scene.done()
    named = replace(done.materials[0], program=program, normal=normal, normal_key="bumped_normal")
    item = replace(done.objects[0], shadow_terminator=terminator)
    pictures = Pictures(Measurement(replace(done, materials=(named,), objects=(item,)), INTEGRATOR))
    assert (pictures(1) > 0).any() == (terminator == 0)
