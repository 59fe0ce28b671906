# SPDX-License-Identifier: GPL-3.0-or-later
"""Where things are, how large, and what triangles they are made of must not matter."""

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from addon.scene import description as d
from addon.scene.problems import GlimmerError
from tests.check import fog, furnaces
from tests.check.case import Case, Estimate, picture
from tests.check.direct import ALBEDO, FLUX, lit_by
from tests.check.transform import rotation, similar
from tests.engine.library import Scene
from tests.render import closed_forms as exact
from tests.render.build import BLACK, WHITE, Builder, at, box, camera, floor, grey, octahedron, quad, radiometer, sky
from tests.render.statistics import ROUNDING, Clock, Measurement, Pictures

ODD = np.array([1 / 3, -0.1, np.pi / 7])
"""No float of any size holds these."""
LIT = FLUX * exact.sphere_irradiance(0.5, 1.3)
AIRLIGHT = exact.sphere_airlight(0.1, 0.08, 0.3, 0.3, (0.5, 1.5, 0), fog.ALONG, np.inf)


def bodies() -> d.SceneDescription:
    """White bodies of every kind close together under a white sky: 1."""
    scene = Builder(camera((0, -9, 4), (0, 0, 0.5), 30), 8, 8, environment=sky())
    scene.mesh(floor(-1), d.Lambert(WHITE)).sphere((0, 0, 0), 0.8, d.Lambert(WHITE))
    scene.sphere((0.3, 1.2, 0.2), 0.4, d.Mirror(WHITE)).sphere((-0.6, -1.3, -0.3), 0.6, d.Glass(1.5))
    scene.mesh(octahedron((0.8, -1, -0.3), 0.5), d.Glass(2.4))
    return scene.mesh(quad((2, 0, 0), (0, 2, 0), (-0.7, 0, 0.7)), d.Mix(0.5, d.Lambert(WHITE), d.Mirror(WHITE))).done()


def hazy() -> d.SceneDescription:
    return fog.beside_ray(d.Medium(grey(0.02), grey(0.08), 0.3), (0.3, 1))


def slab() -> d.SceneDescription:
    return furnaces.slab(45, 1.0, 5.0)


R45 = exact.fresnel(np.sqrt(0.5), 1.5)
SLOW = "white fog with bodies"
MOVED: dict[str, tuple[Callable[[], d.SceneDescription], ArrayLike, float, int]] = {
    # scene, expected, within, max_scatter
    "a lit plate": (lambda: lit_by(1.3, 0.5), LIT, 0.02, -1),
    "white bodies": (bodies, 1, 0.02, -1),
    "fog": (hazy, AIRLIGHT, 0.02, 1),
    SLOW: (lambda: fog.furnace(grey(1), 0, True, 8), 1, 0.05, -1),
    "a glass slab": (slab, [(1 - R45) / (1 + R45), 2 * R45 / (1 + R45), 1], 0.05, -1),
}


def telescope(distance: float) -> d.SceneDescription:
    """A plate of size 1 and its light, from afar."""
    way = np.array([0.3, -0.5, 0.8])
    view = camera(distance * way / np.linalg.norm(way), (0, 0, 0), float(np.degrees(1e-2 / distance)))
    scene = Builder(view).mesh(floor(half=1), d.Lambert(ALBEDO))
    return scene.sphere((0, 0, 10), 3, d.Light(WHITE)).done()


PLANET, EYE = 1e7, 1.7
"""Radius, and the camera's height above it."""
HORIZON_VIEW = 0.01
"""Radians that the picture of its horizon is wide."""


def planet(target: tuple[float, float, float], fov: float, **parts: d.Environment) -> Builder:
    """Above a black or grey ball of radius PLANET, which is yet to come."""
    return Builder(camera((0, 0, EYE), target, fov), 16, 16, **parts)


def horizon() -> float:
    """Share of sky in a picture whose middle row is level: the horizon's dip is sqrt(2 h / R)."""
    return float(0.5 + np.sqrt(2 * EYE / PLANET) / (2 * np.tan(HORIZON_VIEW / 2)))


def triangles(*meshes: d.Mesh) -> d.SceneDescription:
    """lit_by(1.3, 0.5), its plate replaced by meshes."""
    gap = 0.05
    scene = Builder(radiometer((-0.4 * gap, -0.6 * gap, 0.4 * gap), (0, 0, 0)))
    for mesh in meshes:
        scene.mesh(mesh, d.Lambert(ALBEDO))
    return scene.sphere(10 * at(1.3), 5, d.Light(WHITE)).done()


def needles(x: NDArray[Any], half: float = 1e-3) -> d.Mesh:
    """A plate of strips, between these places."""
    count = len(x) - 1
    vertices = np.array([(a, s * half, 0) for a in x for s in (-1, 1)])
    i = 2 * np.arange(count)
    faces = np.concatenate([np.stack([i, i + 2, i + 1], axis=1), np.stack([i + 1, i + 2, i + 3], axis=1)])
    return d.Mesh("needles", vertices, faces.astype(np.uint32))


def with_degenerate(half: float = 1e-3) -> d.Mesh:
    """A plate that also has triangles without area, on it and across it."""
    mesh = floor(half=half)
    vertices = np.concatenate([mesh.vertices, [(0, 0, 0), (0, 0, 0), (half / 2, half / 2, 0), (0, 0, 3 * half)]])
    faces = [*mesh.triangles.tolist(), (4, 4, 4), (4, 5, 6), (0, 4, 2), (4, 5, 7), (1, 1, 3)]
    return d.Mesh("degenerate", vertices, np.array(faces, np.uint32))


def reversed_faces(mesh: d.Mesh) -> d.Mesh:
    return d.Mesh("reversed", mesh.vertices, np.ascontiguousarray(mesh.triangles[:, ::-1]))


def instanced(matrix: NDArray[np.float64], more: NDArray[np.float64] | None = None) -> d.SceneDescription:
    """The plate of lit_by as an instance, and maybe another instance."""
    gap = 0.05
    scene = Builder(radiometer((-0.4 * gap, -0.6 * gap, 0.4 * gap), (0, 0, 0)))
    places = [matrix] if more is None else [matrix, more]
    scene.mesh(floor(half=1e-3), d.Lambert(ALBEDO), instances=np.array(places))
    return scene.sphere(10 * at(1.3), 5, d.Light(WHITE)).done()


def matrix(rows: list[list[float]]) -> NDArray[np.float64]:
    m = np.eye(4)
    m[:3, :3] = rows
    return m


def mirrored_glass() -> d.SceneDescription:
    scene = Builder(camera(furnaces.FAR, (0, 0, 0), 25), environment=sky())
    flip = matrix([[-1, 0.3, 0], [0, 1, 0], [0, 0, 1]])
    return scene.mesh(octahedron((0, 0, 0), 3), d.Glass(1.5), instances=flip[None]).done()


def tiles(side: int = 1000, half: float = 1.0) -> d.SceneDescription:
    """A plate of side^2 instances of a tile."""
    size = half / side
    places = np.tile(np.eye(4), (side * side, 1, 1))
    grid = (2 * np.arange(side) + 1 - side) * size
    places[:, 0, 3], places[:, 1, 3] = (a.ravel() for a in np.meshgrid(grid, grid))
    scene = Builder(camera((-2, -3, 2), (0, 0, 0), 5))
    scene.mesh(quad((0, 0, 0), (size, 0, 0), (0, size, 0)), d.Lambert(ALBEDO), instances=places)
    return scene.sphere((0, 0, 1e4), 3e3, d.Light(WHITE)).done()


def sealed(body: d.Mesh, offset: float = 0, light: float = 1e12, around: float = 0) -> d.SceneDescription:
    """Inside a closed body; a light beside it, and a sky."""
    scene = Builder(camera((0.1, -0.2, 0.3), (0.3, 1, 0.1), 120), environment=sky(around))
    scene.mesh(body, d.Mix(0.5, d.Lambert(grey(0.5)), d.Mirror(grey(0.8))))
    scene.sphere((0, 0, 3.01), 1, d.Light(grey(light)))
    return similar(scene.done(), turn=rotation((1, 2, 3), 30), offset=np.full(3, offset) + ODD)


def walls(integrator: str, clock: Clock) -> Estimate:
    """1 and the light in a closed room whose walls are objects of their own, under a sky of 1."""
    scene = Builder(camera((0.1, -0.2, 0.3), (0.3, 1, 0.1), 120), environment=sky())
    for axis in range(3):
        out, u, v = 2 * np.roll(np.eye(3), axis, axis=0)
        for side in (-1, 1):
            scene.mesh(quad(side * out, u, v), d.Lambert(grey(0.9)))
    room = similar(scene.done(), turn=rotation((1, 2, 3), 30), offset=ODD)
    pictures = Pictures(Measurement(room, integrator, samples=8), clock)
    return lambda seed: 1 + float(pictures(seed).mean())


def along_edge() -> d.SceneDescription:
    """A black quad, its diagonal across the whole picture, before a light of 1e12."""
    scene = Builder(radiometer((0, 0, 5), (0, 0, 0))).mesh(quad((0, 0, 0), (1, 0, 0), (0, 1, 0)), d.Lambert(BLACK))
    return scene.mesh(floor(-1), d.Light(grey(1e12))).done()


def on_surface(sphere: bool) -> d.SceneDescription:
    scene = Builder(camera((0, 0, 0), (0, 0.1, 1), 60), environment=sky())
    if sphere:
        return scene.sphere((0, 0, -2), 2, d.Lambert(BLACK)).done()
    return scene.mesh(floor(), d.Lambert(BLACK)).done()


def clipped_glass() -> d.SceneDescription:
    """A camera in glass whose rays start outside it, in fog that absorbs, 8 from a light."""
    view = replace(radiometer((0, 0, 0), (0, 1, 0)), clip_start=2.0)
    scene = Builder(view, medium=d.Medium(grey(0.1), BLACK)).sphere((0, 0, 0), 1, d.Glass(1.5))
    return scene.sphere((0, 12, 0), 2, d.Light(WHITE)).done()


def lens_across_glass(sigma: float) -> d.SceneDescription:
    """A ball of glass of index 1 at the middle of a lens twice as wide, fog around it, a sheet of light at 1."""
    view = replace(camera((0, 0, 0), (0, 1, 0), 1e-2), lens_radius=1.0, focus_distance=1e4)
    scene = Builder(view, medium=d.Medium(grey(sigma), BLACK)).sphere((0, 0, 0), 0.5, d.Glass(1))
    return scene.mesh(quad((0, 1, 0), (5, 0, 0), (0, 0, 5)), d.Light(WHITE)).done()


def through_lens(sigma: float) -> float:
    """e^-sigma (3/4 + int_0^(1/2) 2 r e^(sigma sqrt(1/4 - r^2)) dr)."""
    s = sigma
    return float(np.exp(-s) * (0.75 + 2 * (np.exp(s / 2) * (0.5 / s - 1 / s**2) + 1 / s**2)))


def clipped_light() -> d.SceneDescription:
    """White fog in a ball of light around a smaller one, in which the camera stands; its rays start between."""
    view = replace(camera((0, 0, 0), (0, 1, 0), 60), clip_start=0.8)
    scene = Builder(view, medium=d.Medium(BLACK, grey(1)))
    return scene.sphere((0, 0, 0), 2, d.Light(WHITE)).sphere((0, 0, 0), 0.7, d.Light(WHITE)).done()


def refused(_integrator: str, _clock: Clock) -> Estimate:
    """The share of bad inputs that the engine refuses."""
    good = floor()

    def bad(vertex: float | None = None, index: int | None = None) -> d.Mesh:
        vertices, faces = good.vertices.copy(), good.triangles.copy()
        if vertex is not None:
            vertices[1, 1] = vertex
        if index is not None:
            faces[1, 2] = index
        return d.Mesh("bad", vertices, faces)

    def scene() -> Builder:
        return Builder(radiometer((0, 0, 5), (0, 0, 0)), environment=sky())

    inputs: list[Callable[[], Builder]] = [
        lambda: scene().mesh(bad(np.nan), d.Lambert(WHITE)),
        lambda: scene().mesh(bad(np.inf), d.Lambert(WHITE)),
        lambda: scene().mesh(bad(index=4), d.Lambert(WHITE)),
        lambda: scene().mesh(bad(index=2**32 - 1), d.Lambert(WHITE)),
        lambda: scene().mesh(good, d.Lambert((np.nan, 0, 0))),
        lambda: scene().sphere((np.nan, 0, 0), 1, d.Lambert(WHITE)),
        lambda: scene().sphere((0, 0, 0), 0, d.Lambert(WHITE)),
        lambda: scene().sphere((0, 0, 0), np.inf, d.Lambert(WHITE)),
        lambda: scene().mesh(good, d.Lambert(WHITE), instances=np.full((1, 4, 4), np.nan)),
        lambda: scene().lamp(d.PointLight("point", (0, 0, np.inf), WHITE)),
        lambda: Builder(radiometer((0, 0, 5), (0, 0, 0)), medium=d.Medium(grey(np.nan), WHITE)),
        lambda: Builder(radiometer((0, 0, 5), (0, 0, 0)), medium=d.Medium(grey(-1), WHITE)),
    ]

    def estimate(seed: int) -> float:
        caught = 0
        for make in inputs:
            try:
                Scene(make().done())
            except GlimmerError:
                caught += 1
        return caught / len(inputs)

    return estimate


TURN = rotation((1, 2, 3), 40)
PLACES: tuple[tuple[str, dict[str, Any]], ...] = (
    # how they are moved, arguments of `similar`
    *((f"moved by {x:g}", {"offset": np.array([1, 2, -1]) * x}) for x in (1e3, 1e5, 1e7)),
    *(
        (f"moved by {x:g} and a bit, in its vertices", {"offset": x * ODD + ODD, "in_vertices": True})
        for x in (1e3, 1e5, 1e7)
    ),
    *((f"scaled by {x:g}", {"scale": x, "in_vertices": True}) for x in (1e-6, 1e-3, 1e3, 1e6, 1e9)),
    ("turned", {"turn": TURN}),
    ("turned, scaled by 1e-4 and moved by 1e4", {"turn": TURN, "scale": 1e-4, "offset": 1e4 * ODD}),
)


def moved() -> list[Case]:
    return [
        picture(
            f"{what}, {how}",
            partial(similar, scene(), **arguments),
            expected,
            within=within,
            max_scatter=max_scatter,
            rounding=1e-5,
            quick="1e-4" in how or (what != SLOW and ("a bit" in how or "1e-06" in how or "1e+09" in how)),
        )
        for what, (scene, expected, within, max_scatter) in MOVED.items()
        for how, arguments in PLACES
    ]


def cases() -> list[Case]:
    result = moved()
    for distance in (1e3, 1e4, 1e5):
        # The point that is lit stands off the plate by 2^-20 of the distance or so.
        result.append(
            picture(
                f"a lit plate of size 1 seen from {distance:g}",
                partial(telescope, distance),
                FLUX * exact.sphere_irradiance(0.3, 0),
                rounding=2 * distance * 2.0**-19 / 10 + ROUNDING,
                quick=distance == 1e4,
            )
        )
    ground = d.Lambert(ALBEDO)
    result += [
        picture(
            "1.7 above a planet of radius 1e7, moonlit ground",
            lambda: (
                planet((0, 1, EYE - 1), 0.01)
                .sphere((0, 0, -PLANET), PLANET, ground)
                .sphere((0, EYE, 10), 3, d.Light(WHITE))
                .done()
            ),
            FLUX * exact.sphere_irradiance(0.3, 0),
            rounding=1e-5,
            quick=True,
        ),
        picture(
            "1.7 above a planet of radius 1e7, its horizon",
            lambda: (
                planet((0, 1, EYE), float(np.degrees(HORIZON_VIEW)), environment=sky())
                .sphere((0, 0, -PLANET), PLANET, d.Lambert(BLACK))
                .done()
            ),
            horizon(),
            within=0.005,
            rounding=1e-4,
        ),
    ]
    flat, cube = floor(half=1e-3), box((-2, -2, -2), (2, 2, 2))
    result += [
        picture("coincident quads", lambda: triangles(flat, flat), LIT, quick=True),
        picture("coincident quads, one reversed", lambda: triangles(flat, reversed_faces(flat)), LIT),
        picture("reversed triangles", lambda: triangles(reversed_faces(flat)), LIT),
        picture("needle triangles, 2e-6 by 2e-3", lambda: triangles(needles(np.linspace(-1e-3, 1.2e-3, 1001))), LIT),
        picture(
            "needle triangles, 2e-9 by 2e-3, where the camera looks",  # its view is 4e-6 wide
            lambda: triangles(needles(np.r_[-1e-3, np.linspace(-4e-6, 4e-6, 4001), 1.2e-3])),
            LIT,
        ),
        picture("triangles without area among others", lambda: triangles(with_degenerate()), LIT, quick=True),
        picture(
            "an instance of zero scale among others",
            lambda: instanced(np.eye(4), matrix([[1, 0, 0], [0, 0, 0], [0, 0, 1]])),
            LIT,
        ),
        picture("an instance of negative scale", lambda: instanced(matrix([[-1, 0, 0], [0, 1, 0], [0, 0, -1]])), LIT),
        picture("a sheared instance", lambda: instanced(matrix([[1, 2, 0], [0, 1, 0], [0, 0, 1e-3]])), LIT),
        picture("a glass body, mirrored and sheared", mirrored_glass, 1, quick=True),
        picture(
            "a plate of 1e6 instances",
            tiles,
            FLUX * exact.sphere_irradiance(0.3, 0),
            rounding=1e-5,
        ),
        picture(
            "rays that start outside the glass around the camera", clipped_glass, np.exp(-0.8), within=0, quick=True
        ),
        picture(
            "a ball of glass within a lens twice as wide", partial(lens_across_glass, 2), through_lens(2), rounding=2e-3
        ),
        picture("rays that start outside the light around the camera, in white fog", clipped_light, 1, within=0.03),
        picture("camera on a plate", lambda: on_surface(False), 1, within=0),
        picture("camera on a sphere", lambda: on_surface(True), 1, within=0),
        picture("rays along an edge", along_edge, 0, within=0, samples=4, quick=True),
        picture("a sealed box beside a light of 1e12", partial(sealed, cube), 0, within=0, samples=4, quick=True),
        picture("a sealed box, moved by 1e5", partial(sealed, cube, 1e5), 0, within=0, samples=4),
        picture("a sealed box under a sky of 1e12", partial(sealed, cube, 0, 0, 1e12), 0, within=0, samples=4),
        picture(
            "a sealed ball of 2048 triangles", partial(sealed, octahedron((0, 0, 0), 2, 4)), 0, within=0, samples=4
        ),
        picture(  # as many rays pass so close to an edge that Embree must not round it open
            "a sealed ball of 524288 triangles",
            lambda: sealed(octahedron((0, 0, 0), 2, 8)),
            0,
            within=0,
            samples=64,
        ),
        picture(
            "a sealed box beside a light of 1e12, under a sky of 1e12",
            partial(sealed, cube, 0, 1e12, 1e12),
            0,
            within=0,
            samples=4,
        ),
        Case("a room of six objects: not one ray in 1e4 passes their seams", 1, walls, within=1e-4, rounding=1e-4),
        Case("NaN, infinities and indices out of range are refused", 1, refused, within=0, rounding=0),
    ]
    return result
