# SPDX-License-Identifier: GPL-3.0-or-later
"""The same picture from both integrators, where no closed form is known: block by block, channel by channel."""

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from addon.scene import description as d
from tests.engine.library import Scene, engine, rendering
from tests.render.build import WHITE, Array, Builder, box, camera, floor, grey, hexagon, look_at, octahedron, quad, sky
from tests.render.statistics import Measurement, Pictures, blocks, check_same

pytestmark = pytest.mark.timeout(900)  # some of its scenes take minutes on a busy machine

PLATE = d.Mix(0.25, d.Lambert((0.5, 0.5, 0.55)), d.Conductor(0.25, eta=(2.6, 2.4, 2.2), k=(3.3, 3.1, 2.9)))


def plates(rings: int = 5, spacing: float = 1.85, seed: int = 3, tilt: float = 0.05) -> Array:
    """(n, 4, 4): hexagons side by side, each a little off in height and tilt."""
    rng = np.random.default_rng(seed)
    matrices = []
    for q in range(-rings, rings + 1):
        for r in range(max(-rings, -q - rings), min(rings, -q + rings) + 1):
            tilt_x, tilt_y = rng.normal(0, tilt, 2)
            m = np.eye(4)
            m[:3, :3] = [[1, 0, tilt_y], [0, 1, -tilt_x], [-tilt_y, tilt_x, 1]]
            m[:3, 3] = spacing * np.array([q * np.sqrt(3) / 2, r + q / 2, 0]) + [0, 8, rng.normal(0, 0.2)]
            matrices.append(m)
    return np.array(matrices)


def field(medium: d.Medium | None, metal: d.Surface = PLATE) -> Builder:
    """A hexagon field with three moons."""
    scene = Builder(camera((0, -4, 4), (0, 8, 1.5), 60), 32, 24, medium=medium)
    scene.mesh(hexagon(1, 0.3), metal, instances=plates())
    scene.sphere((-3, 11, 4), 1.2, d.Light((3, 0.5, 0.3))).sphere((4, 9, 3), 0.8, d.Light((0.3, 3, 0.5)))
    return scene.sphere((0.5, 16, 6), 1.5, d.Light((1, 1, 3)))


def glass_in_fog() -> Builder:
    scene = field(d.Medium(grey(0.01), grey(0.06)))
    return scene.sphere((-0.5, 5, 1.6), 1, d.Glass(1.5)).sphere((1.6, 4, 1), 0.5, d.Mirror(grey(0.9)))


def thousand_lights() -> Builder:
    rng = np.random.default_rng(5)
    scene = Builder(camera((0, -4, 4), (0, 8, 1.5), 60), 32, 24, medium=d.Medium(grey(0.005), grey(0.03)))
    scene.mesh(hexagon(1, 0.3), PLATE, instances=plates())
    centers = rng.uniform((-8, 0, 1), (8, 18, 6), (1000, 3))
    return scene.spheres(centers, rng.uniform(0.02, 0.08, 1000), d.Light(grey(8)))


def mesh_light_in_fog() -> Builder:
    scene = Builder(camera((0, -6, 3), (0, 4, 1), 60), 32, 24, medium=d.Medium(grey(0.01), (0.08, 0.05, 0.03), 0.3))
    scene.mesh(floor(0, 8, (0, 4)), d.Lambert(grey(0.6))).mesh(octahedron((1.5, 4, 1.5), 0.7), d.Light((2, 3, 1)))
    scene.mesh(quad((-2, 5, 2), (0.7, 0, 0), (0, 0.2, 0.7)), d.Lambert(grey(0.4), emission=grey(1)))
    return scene.sphere((0, 3, 0.6), 0.6, d.Conductor(0.2, f0=(0.9, 0.7, 0.4)))


def lamps_in_fog() -> Builder:
    down = np.eye(4)
    down[:3, 3] = (2, 4, 3)
    scene = Builder(camera((0, -6, 3), (0, 4, 1), 60), 32, 24, medium=d.Medium(grey(0.02), grey(0.08), -0.3))
    scene.mesh(floor(0, 8, (0, 4)), d.Lambert(grey(0.6))).sphere((0, 3, 0.6), 0.6, d.Conductor(0.3, f0=WHITE))
    scene.lamp(d.PointLight("point", (-2, 4, 2.5), (9, 5, 2))).lamp(
        d.PointLight("ball", (-1, 7, 3), grey(9), radius=0.5)
    )
    scene.lamp(d.SpotLight("spot", (0, 1, 5), (0, 0.3, -1), (5, 9, 9), 50, 0.3))
    return scene.lamp(d.AreaLight("area", down, (1.5, 1), (2, 1, 4), ellipse=True))


def lamps_of_blender_3_in_fog() -> Builder:
    """Disks that face what they light, so large that the light between their rims and their middle counts; slats."""
    down = np.eye(4)
    down[:3, 3] = (2, 4, 3)
    scene = Builder(camera((0, -6, 3), (0, 4, 1), 60), 32, 24, medium=d.Medium(grey(0.04), grey(0.08), -0.3))
    scene.mesh(floor(0, 8, (0, 4)), d.Lambert(grey(0.6))).mesh(hexagon(0.7, 0.1), PLATE, instances=plates(1, 2.5))
    scene.lamp(d.PointLight("disk", (-1.5, 5, 1.5), (9, 5, 2), radius=1.2, is_disk=True))
    scene.lamp(d.SpotLight("spot", (0, 1, 4), (0, 0.3, -1), (5, 9, 9), 90, 0.3, 0.6, is_disk=True, times_cosine=True))
    return scene.lamp(d.AreaLight("area", down, (1.5, 1), (2, 1, 4), spread=70))


def hidden_from_the_camera_in_fog() -> Builder:
    """A floor and a metal ball that the camera looks through, in the light of lamps: gather points are behind them."""
    return lamps_in_fog().hide(d.EVERY_RAY & ~d.Rays.CAMERA)


def pond(water: d.Material, camera_height: float = 2) -> Builder:
    """A sheet of water over a floor, fog in and above it, a moon above, one beneath and one in a glass ball."""
    scene = Builder(camera((0, -4, camera_height), (0, 4, 0.7), 60), 32, 24, medium=d.Medium(grey(0.02), grey(0.1)))
    scene.mesh(floor(1, 20), water).mesh(floor(-0.5, 8, (0, 4)), d.Lambert(grey(0.6)))
    scene.sphere((-2, 6, 3), 0.8, d.Light((5, 2, 1))).sphere((2, 4, 0.2), 0.3, d.Light((1, 2, 9)))
    return scene.sphere((0, 4, 1.8), 0.6, d.Glass(1.7)).sphere((0, 4, 1.8), 0.25, d.Light((1, 9, 2)))


def glass_between_lights() -> Builder:
    """Two plates that shine, far apart: what is in their middle is not what is around them."""
    scene = Builder(camera((0, -4, 1), (0, 4, 0.5), 60), 32, 24, medium=d.Medium(grey(0.02), grey(0.15)))
    for x in (-3, 3):
        scene.mesh(quad((x, 2, 1), (0, 0.5, 0), (0, 0, 0.5)), d.Light((5, 3, 1)))
    return scene.sphere((0, 2, 1), 0.4, d.Glass(1.5))


def floor_under_a_beam() -> Builder:
    """A room whose floor is lit by nothing but the thin fog of a beam: along short segments, seldom looked at."""
    scene = Builder(camera((0, -2, 0.7), (0, 2, 0), 50), 32, 24, medium=d.Medium(grey(0.002), grey(0.02)))
    scene.mesh(floor(0, 8, (0, 2)), d.Lambert(grey(0.8))).mesh(floor(2, 8, (0, 2)), d.Lambert(grey(0)))
    return scene.lamp(d.SpotLight("beam", (-6, 2, 1.2), (1, 0, 0), grey(20), 8, 0.3))


def point_over_mirror() -> Builder:
    """What a mirror throws into the fog from a light without size is met by no path: none of it, in either picture."""
    scene = Builder(camera((0, -4, 1), (0, 4, 0.5), 60), 32, 24, medium=d.Medium(grey(0.02), grey(0.15)))
    scene.mesh(quad((0, 3, -0.5), (6, 0, 0), (0, 6, 0)), d.Mirror(WHITE))
    return scene.lamp(d.PointLight("point", (0, 2, 2), grey(10)))


def channels_apart() -> Builder:
    """One channel not at all, one thin, one thick: the thin one decides how far a segment matters."""
    medium = d.Medium((0, 0.001, 1), (0, 0.02, 9))
    scene = Builder(camera((0, -4, 1), (0, 4, 3.5), 20), 16, 16, medium=medium)
    return scene.sphere((0, 3, 1), 0.5, d.Light((8, 5, 3)))


def glints_through_a_lens(aperture: d.Aperture = d.Camera.aperture) -> Builder:
    """What smooth metal and a mirror throw into the fog, in a picture with all that a camera has."""
    scene = field(d.Medium((0.01, 0.02, 0.01), (0.06, 0.1, 0.08)), d.Conductor(0.03, f0=grey(0.9)))
    scene.sphere((1.5, 3, 1), 0.7, d.Mirror(WHITE)).sphere((-1, 6, 0.8), 0.6, d.Glass(1.4))
    view = replace(camera((0, -4, 4), (0, 8, 1.5), 60), shift=(0.1, -0.05), lens_radius=0.2, focus_distance=7)
    view = replace(view, aperture=aperture)
    film = d.Film(40, 30, (5, 3, 37, 27), "blackman_harris", 1.8)
    return scene.seen_by(replace(view, clip_start=0.5, clip_end=40), film)


def light_by_way_of_metal(g: float = 0) -> Builder:
    """Fog that a screen hides from the light: half of what is seen was thrown there by smooth metal alone."""
    scene = Builder(camera((3, -3, 2.2), (3, 4, 2.2), 30), 32, 24, medium=d.Medium(grey(0.05), grey(0.1), g))
    scene.mesh(floor(0, 8, (0, 4)), d.Conductor(0.03, f0=WHITE))
    scene.mesh(quad((0.7, 4, 3), (0, 6, 0), (0, 0, 2.4)), d.Lambert(grey(0)))
    return scene.sphere((-1, 4, 1.2), 0.9, d.Light(grey(10)))


def from_a_distance(scene: Builder) -> Builder:
    """Seen by parallel rays, through a lens, from a plane within the fog."""
    origin, target = (0, -4, 4), (0, 8, 1.5)
    view = d.Camera(look_at(origin, target), d.Orthographic(9), shift=(0.05, -0.1), clip_start=-2, clip_end=60)
    return scene.seen_by(replace(view, lens_radius=0.3, focus_distance=9), d.Film(32, 24))


def metal_in_parallel_rays() -> Builder:
    """The fog behind the screen, half of its light thrown there by smooth metal, with all that a camera has but a
    lens."""
    view = d.Camera(look_at((3, -3, 2.2), (3, 4, 2.2)), d.Orthographic(4), shift=(0.05, -0.1), clip_start=0.5)
    return light_by_way_of_metal().seen_by(view, d.Film(40, 30, (5, 3, 37, 27), "blackman_harris", 1.8))


APERTURE = d.Aperture(blades=3, rotation=20, ratio=2)
PANORAMAS: dict[str, d.Panorama] = {
    "panorama": d.Equirectangular(),  # whole, so that filters reach past its edges
    "fisheye": d.FisheyeEquidistant(100.0),
    "equisolid": d.FisheyeEquisolid(0.4, 90.0),
    "polynomial": d.FisheyePolynomial((0.0, 1.5, 0.2, 0.3, 0.1), 100.0),
    "mirror ball": d.MirrorBall(),
    "cube face": d.CubeFace(),
    "cylinder": d.Cylindrical((-70.0, 50.0), (-0.6, 0.8)),
}


def metal_in_a_panorama(panorama: d.Panorama, aperture: d.Aperture = d.Camera.aperture) -> Builder:
    """The fog behind the screen, half of its light thrown there by smooth metal, through a lens."""
    view = d.Camera(look_at((3, -3, 2.2), (3, 4, 2.2)), panorama, lens_radius=0.3, focus_distance=5, clip_start=0.2)
    return light_by_way_of_metal().seen_by(
        replace(view, aperture=aperture), d.Film(32, 24, filter="blackman_harris", filter_width=2.5)
    )


def moving_plates() -> Builder:
    """Plates and a ball that move far while the shutter is open, and hide the moons from the fog now and then, seen by
    a camera on its way: all pixels of a wave share light vertices and splats that were made at one moment."""
    rise = np.tile(np.eye(4), (3, 1, 1))
    rise[:, 2, 3], rise[:, 0, 3] = (0, 1, 3), (0, 2, 1)
    way = np.tile(np.eye(4), (3, 1, 1))
    way[:, 0, 3], way[:, 2, 3] = (-1, 0, 2), (0, 0.4, 0)
    view = camera((0, -4, 4), (0, 8, 1.5), 60)
    scene = Builder(replace(view, motion=way @ view.to_world), 32, 24, medium=d.Medium(grey(0.01), grey(0.06)))
    scene.mesh(hexagon(1, 0.3), PLATE, instances=plates(), motion=rise)
    scene.mesh(octahedron((0, 4, 0.5), 0.7), d.Conductor(0.03, f0=grey(0.9)), motion=rise)
    scene.sphere((-3, 11, 4), 1.2, d.Light((3, 0.5, 0.3))).sphere((4, 9, 3), 0.8, d.Light((0.3, 3, 0.5)))
    return scene.sphere((0.5, 16, 6), 1.5, d.Light((1, 1, 3)))


def black_ground() -> Builder:
    """Surfaces that hold no light vertices, beside one that does, and one that is black but for its highlight."""
    scene = Builder(camera((0, -4, 2), (0, 4, 1), 60), 32, 24, medium=d.Medium((0.01, 0.02, 0.01), (0.1, 0.08, 0.15)))
    scene.mesh(floor(0, 8, (0, 4)), d.Lambert(grey(0))).mesh(quad((-2, 4, 1), (0, 1, 0), (0, 0, 1)), d.Lambert(WHITE))
    scene.sphere((1.5, 3, 0.7), 0.7, d.Mix(0.5, d.Conductor(0.2, f0=grey(0.9)), d.Lambert(grey(0))))
    return scene.sphere((0.5, 5, 2.5), 0.5, d.Light((9, 6, 4)))


def light_close_above_metal() -> Builder:
    """A layer of fog on smooth metal: half of its light was thrown there from a shorter way than connections count."""
    scene = Builder(camera((3, -3, 0.3), (3, 4, 0.3), 4), 32, 24, medium=d.Medium(grey(0.05), grey(0.1)))
    scene.mesh(floor(0, 8, (3, 4)), d.Conductor(0.05, f0=WHITE))
    return scene.sphere((3, 4, 3), 0.5, d.Light(grey(10)))


def layers_in_fog() -> Builder:
    """Surfaces that reflect more or less by where they are seen from: light from them must know where it goes."""
    rough = d.Conductor(1, f0=grey(0.95), facets="multiple")
    scene = field(d.Medium(grey(0.01), grey(0.06)), d.Layer(0.6, d.Sheen(WHITE, 0.5), rough))
    plastic = d.Layer(1, d.Conductor(0.2, f0=grey(0.2), ior=2.6, facets="multiple"), d.Lambert(grey(0.8)))
    scene.sphere((1.6, 4, 1), 0.7, plastic)
    return scene.sphere((-0.5, 5, 1.6), 1, d.Layer(1, plastic.a, d.Glass(1.5, 0.7, facets="multiple")))


def metal_seen_in_a_mirror() -> Builder:
    """The same seen in a mirror, where nothing is splatted: what no vertex holds of it is brought by paths alone."""
    scene = Builder(camera((3, -2, 2.2), (3, -4, 2.2), 30), 32, 24, medium=d.Medium(grey(0.05), grey(0.1)))
    scene.mesh(floor(0, 8, (0, 4)), d.Conductor(0.1, f0=WHITE)).mesh(
        quad((3, -4, 2.2), (2, 0, 0), (0, 0, 2)), d.Mirror(WHITE)
    )
    scene.mesh(quad((0.7, 4, 3), (0, 6, 0), (0, 0, 2.4)), d.Lambert(grey(0)))
    return scene.sphere((-1, 4, 1.2), 0.9, d.Light(grey(10)))


def fog_far_beyond_a_screen() -> Builder:
    """Half of the fog that is seen is close, before a screen: beyond it, the bounds of connections are many times those
    of there, and so is what they leave out.
    """
    scene = Builder(camera((0, -1, 0), (0, 4, 0), 40), 32, 24, medium=d.Medium(grey(0.002), grey(0.15)))
    scene.mesh(quad((0, 0, -0.35), (0.6, 0, 0), (0, 0, 0.4)), d.Lambert(grey(0.2)))
    return scene.sphere((0, 12, 9), 2, d.Light((5, 4, 3)))


def add_scales(scene: Builder, metal: d.Surface) -> Builder:
    """Tilted scales narrower than a pixel, over a floor."""
    scene.mesh(hexagon(0.12, 0.1), metal, instances=plates(30, 0.25, tilt=0.2))
    return scene.mesh(floor(-0.5, 12, (0, 8)), PLATE)


def glinting_field(medium: d.Medium | None, metal: d.Surface) -> Builder:
    """Scales lit by lights of all kinds: of each pixel, one of several points is lit."""
    scene = add_scales(Builder(camera((0, -4, 4), (0, 8, 1.5), 60), 32, 24, medium=medium), metal)
    scene.sphere((-3, 11, 4), 0.6, d.Light((6, 1, 0.6))).sphere((0.5, 16, 6), 0.7, d.Light((3, 3, 9)))
    scene.mesh(octahedron((3, 9, 3), 0.5), d.Light((1, 9, 2))).sphere((2, 4, 0.5), 0.5, d.Conductor(0.03, f0=WHITE))
    scene.lamp(d.PointLight("point", (-2, 6, 2.5), (2, 1, 1))).lamp(
        d.PointLight("ball", (0, 9, 4), grey(3), radius=0.3)
    )
    return scene


def glints_and_glass() -> Builder:
    """The same under a sun, with mirrors in the metal and glass before it, of a film like Cycles'."""
    scene = glinting_field(None, d.Mix(0.3, d.Mirror(WHITE), d.Conductor(0.04, f0=(0.9, 0.8, 0.6))))
    scene.sphere((-1, 3, 1), 0.7, d.Glass(1.4)).lamp(d.SunLight("sun", (0.3, 0.2, -1), (0.05, 0.05, 0.03), 4))
    view = replace(camera((0, -4, 4), (0, 8, 1.5), 60), shift=(0.1, -0.05), clip_end=40)
    return scene.seen_by(view, d.Film(40, 30, (5, 3, 37, 27), "blackman_harris", 1.8))


def glints_in_fog() -> Builder:
    scene = glinting_field(d.Medium((0.01, 0.02, 0.01), (0.06, 0.05, 0.07)), d.Conductor(0.05, f0=grey(0.8)))
    view = replace(camera((0, -4, 4), (0, 8, 1.5), 60), lens_radius=0.1, focus_distance=7, clip_start=0.5)
    return scene.seen_by(view, d.Film(32, 24))


def haze_box(view: d.Camera, metal: d.Surface = PLATE) -> Builder:
    """Fog in a box that ends amid the plates, lit from within and, by a sun and a sky, from outside."""
    scene = Builder(view, 32, 24, environment=d.Environment((0.1, 0.15, 0.3)))
    scene.mesh(hexagon(1, 0.3), metal, instances=plates())
    scene.mesh(box((-4, -5, -1), (3, 9, 5)), d.Null(), interior=d.Medium((0.01, 0.03, 0.0), (0.1, 0.08, 0.15), 0.3))
    scene.sphere((-2, 6, 3), 0.5, d.Light((6, 3, 2))).sphere((4, 9, 3), 0.8, d.Light((0.3, 3, 0.5)))
    return scene.lamp(d.SunLight("sun", (0.4, 0.3, -1), (1, 0.9, 0.7), 3)).lamp(
        d.PointLight("point", (1, 4, 2), grey(2))
    )


def bodies_in_fog() -> Builder:
    """Fog within a moving box, a ball, murky glass and glass about glass, and about all of them."""
    scene = Builder(camera((0, -4, 2), (0, 4, 1), 60), 24, 16, medium=d.Medium(grey(0.005), grey(0.03)))
    scene.mesh(floor(0, 8, (0, 4)), d.Lambert(grey(0.6))).lamp(d.PointLight("point", (0, 3, 4), grey(30)))
    rise = np.tile(np.eye(4), (2, 1, 1))
    rise[1, :3, 3] = (1, 0, 1)
    thick = d.Medium((0.0, 0.1, 0.3), (1, 0.8, 0.2), 0.5)
    scene.mesh(box((-3, 3, 0.2), (-1, 5, 1.2)), d.Null(), motion=rise, interior=thick)
    scene.sphere((-0.5, 4.5, 0.8), 1, d.Null(), interior=replace(thick, g=-0.3, emission=(0.1, 0, 0.1)))
    scene.sphere((2, 4, 1), 0.8, d.Glass(1.3), interior=replace(thick, sigma_s=grey(0.5)))
    return scene.sphere((2, 4, 1), 0.4, d.Glass(1.5)).sphere((1, 7, 2), 0.6, d.Light((2, 2, 5)))


SCENES: dict[str, Callable[[], Builder]] = {
    "field": lambda: field(None),
    "field under a sky": lambda: Builder(camera((0, -4, 4), (0, 8, 1.5), 60), 32, 24, environment=sky(0.5)).mesh(
        hexagon(1, 0.3), PLATE, instances=plates()
    ),
    "fog": lambda: field(d.Medium(grey(0.01), grey(0.06))),
    "forward": lambda: field(d.Medium(grey(0.01), grey(0.06), 0.6)),
    "backward": lambda: field(d.Medium(grey(0.01), grey(0.06), -0.6)),
    "coloured": lambda: field(d.Medium((0.01, 0.03, 0.0), (0.02, 0.1, 0.06), 0.2)),
    "thick": lambda: field(d.Medium(grey(0.01), grey(0.29))),
    "smooth metal": lambda: field(d.Medium(grey(0.01), grey(0.06)), d.Conductor(0.05, f0=grey(0.8))),
    "glass": glass_in_fog,
    "light by way of metal": light_by_way_of_metal,
    "layers": layers_in_fog,
    "light by way of metal, in a mirror": metal_seen_in_a_mirror,
    "light by way of metal, forward": lambda: light_by_way_of_metal(0.4),
    "light close above metal": light_close_above_metal,
    "black ground": black_ground,
    "far forward": lambda: field(d.Medium((0.0, 0.01, 0.02), (0.06, 0.05, 0.05), 0.85)),
    "glints through a lens": glints_through_a_lens,
    "glints through an aperture": lambda: glints_through_a_lens(APERTURE),
    "metal, fisheye, aperture": lambda: metal_in_a_panorama(PANORAMAS["fisheye"], replace(APERTURE, ratio=0.5)),
    "light by way of metal, in parallel rays": metal_in_parallel_rays,
    "glass in parallel rays, through a lens": lambda: from_a_distance(glass_in_fog()),
    **{f"metal, {name}": partial(metal_in_a_panorama, kind) for name, kind in PANORAMAS.items()},
    "moving plates": moving_plates,
    "thousand lights": thousand_lights,
    "mesh light": mesh_light_in_fog,
    "lamps": lamps_in_fog,
    "lamps of Blender 3": lamps_of_blender_3_in_fog,
    "hidden from the camera": hidden_from_the_camera_in_fog,
    "floor under a beam": floor_under_a_beam,
    "glints": lambda: glinting_field(None, d.Conductor(0.05, f0=grey(0.8))),
    "glints in fog, through a lens": glints_in_fog,
    "glints and glass": glints_and_glass,
    "channels far apart": channels_apart,
    "glass between lights": glass_between_lights,
    "pond": lambda: pond(d.Glass(1.5)),
    "rough pond": lambda: pond(d.Glass(1.5, 0.3)),
    "milky pond": lambda: pond(d.Mix(0.4, d.Glass(1.5, 0.4, facets="multiple"), d.Translucent(WHITE))),
    "clear pond": lambda: pond(d.Mix(0.4, d.Glass(1.5), d.Transparent(WHITE))),
    "in the pond": lambda: pond(d.Glass(1.5), 0.4),
    "point over a mirror": point_over_mirror,
    "far beyond a screen": fog_far_beyond_a_screen,
    "haze box": lambda: haze_box(camera((0, -4, 4), (0, 8, 1.5), 60)),
    "haze box from outside": lambda: haze_box(camera((8, -8, 7), (0, 4, 1), 50), d.Conductor(0.05, f0=grey(0.8))),
    "bodies in fog": bodies_in_fog,
}


# Relatives of scenes that stay, and take long.
LONG = (
    "light by way of metal, in a mirror",
    "light by way of metal, forward",
    "light by way of metal, in parallel rays",
    *(f"metal, {name}" for name in (*PANORAMAS, "fisheye, aperture")),
    "glints in fog, through a lens",
    "rough pond",
    "clear pond",
    "in the pond",
)


@pytest.mark.parametrize("name", [pytest.param(name, marks=[pytest.mark.full] * (name in LONG)) for name in SCENES])
def test_both_integrators(name: str) -> None:
    scene = SCENES[name]().done()
    path, baseline = (Pictures(Measurement(scene, integrator, samples=2)) for integrator in ("path", "baseline"))
    check_same(
        lambda seed: blocks(path(seed), 8),
        lambda seed: blocks(baseline(seed), 8),
        within={"light by way of metal": 0.065, "glints": 0.04}.get(name, 0.08),
        what=name,
    )


def all_estimators_at_work() -> Builder:
    """Haze over scales that glint, with moons in view, on a film whose filter is wider than a pixel."""
    haze = d.Medium((0.01, 0.02, 0.01), (0.06, 0.05, 0.07))
    scene = Builder(camera((0, -4, 3), (0, 8, 2.5), 60), 32, 24, medium=haze)
    scene.seen_by(camera((0, -4, 3), (0, 8, 2.5), 60), d.Film(32, 24, None, "blackman_harris", 3))
    add_scales(scene, d.Conductor(0.05, f0=grey(0.8))).sphere((-3, 11, 4), 0.6, d.Light((6, 1, 0.6)))
    return scene.sphere((0.5, 16, 6), 0.7, d.Light((3, 3, 9))).sphere((2, 9, 3), 0.4, d.Light((1, 9, 2)))


SWITCHES = [
    "split",
    "all-lights",
    "emitter-rays",
    "branches",
    "guided-choice",
    "equiangular",
    "deep-equiangular",
    "late-roulette",
    "pixel-ris",
    "light-vertices",
    "reconstruction",
]


def test_switches_are_all_there() -> None:
    names = [name for name, _ in engine().integrators()]
    assert names == ["path", "baseline", *(f"path-no-{switch}" for switch in SWITCHES)]


LONG_SWITCHES = ("split", "branches", "guided-choice", "equiangular", "late-roulette")


@pytest.mark.parametrize("switch", [pytest.param(s, marks=[pytest.mark.full] * (s in LONG_SWITCHES)) for s in SWITCHES])
def test_estimators_change_no_mean(switch: str) -> None:
    name = f"path-no-{switch}"
    scene = all_estimators_at_work().done()
    all_at_work, without = (Pictures(Measurement(scene, integrator, samples=2)) for integrator in ("path", name))
    check_same(lambda seed: blocks(all_at_work(seed), 8), lambda seed: blocks(without(seed), 8), within=0.08, what=name)


def test_where_surfaces_glint() -> None:
    """The scenes made for it are those where several points of a pixel compete for being lit, a whole panorama, whose
    few pixels see much of the floor each, and one whose metal is beside black ground."""
    glinting = set()
    for name, build in SCENES.items():
        with rendering(Scene(build().done()), samples=1) as render:
            render.wait()
            if not any("glint" in line for line in render.report()["left_out"]):
                glinting.add(name)
    made_for_it = {"glints", "glints in fog, through a lens", "glints and glass"}
    without_surfaces = "channels far apart"
    assert glinting == {*made_for_it, "metal, panorama", "black ground", without_surfaces}
