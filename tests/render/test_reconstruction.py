# SPDX-License-Identifier: GPL-3.0-or-later
"""Samples that count for every pixel whose filter holds them: what a pixel must be then."""

from dataclasses import replace

import numpy as np
import pytest

from addon.scene import description as d
from tests.engine.library import Render, Scene
from tests.render.build import WHITE, Builder, camera, floor, grey, hexagon, look_at, quad
from tests.render.statistics import Array, Measurement, Pictures, check_mean, check_same

FILTER = "blackman_harris"
WIDTHS = (1.5, 3.0, 4.9)  # pixels; the last reaches two pixels to each side
PLAIN = ("albedo", "normal", "depth", "alpha")
ROUNDING = 32 * 2.0**-24
"""Relative: of sums of some dozen terms in float32."""


def window_below(offset: float, width: float) -> float:
    """The part of the filter, `width` pixels wide, that lies below an offset from its middle."""
    t = np.clip(offset / width + 0.5, 0, 1)
    a = 2 * np.pi * t
    return float(
        t + (-0.48829 * np.sin(a) + 0.14128 / 2 * np.sin(2 * a) - 0.01168 / 3 * np.sin(3 * a)) / (2 * np.pi) / 0.35875
    )


def filmed(scene: Builder, view: d.Camera, film: d.Film) -> d.SceneDescription:
    return scene.seen_by(view, film).done()


@pytest.mark.parametrize("width", WIDTHS)
@pytest.mark.parametrize("crop", [None, (3, 2, 67, 35)])
def test_what_is_the_same_everywhere_has_no_noise(width: float, crop: tuple[int, int, int, int] | None) -> None:
    """Exactly the sky's radiance, to the edges of the picture and across those of tiles, after any number of samples:
    the weights of a wave sum to 1 in every pixel."""
    view = camera((0, 0, 0), (0, 1, 0), 60)
    scene = Builder(view, environment=d.Environment((0.25, 1.5, 40)))
    sky = Scene(filmed(scene, view, d.Film(70, 36, crop, FILTER, width)))
    for samples in (1, 3, 11):
        with Render(sky, samples=samples, seed=3, tile_size=32) as render:
            picture = render.run().read().astype(np.float64)
        assert np.abs(picture / (0.25, 1.5, 40) - 1).max() < ROUNDING


@pytest.mark.parametrize(
    ("width", "kind", "aspect"),
    [(3.0, "mesh", 1.0), (3.0, "sphere", 1.0), (4.9, "mesh", 1.0), (3.0, "mesh", 2.5), (3.0, "sphere", 0.4)],
)
def test_a_corner_is_seen_as_the_integral_of_the_filter(width: float, kind: str, aspect: float) -> None:
    """A shining quadrant, which ends within a pixel, behind a frame: in every pixel around its corner. Of a sphere in
    place of the mesh, more camera rays are a part of the picture. aspect: width / height of a pixel."""
    film, edge_x, edge_y = d.Film(9, 7, None, FILTER, width, pixel_aspect=aspect), 4.3, 3.6
    view = d.Camera(look_at((0, -4, 0), (0, 0, 0)), d.Orthographic(9 * aspect))  # a unit is the height of a pixel
    scene, corner_x = Builder(view), (edge_x - 4.5) * aspect
    if kind == "mesh":
        scene.mesh(quad((corner_x - 20, 0, 3.5 - edge_y + 20), (20, 0, 0), (0, 0, 20)), d.Light(WHITE))
    else:
        scene.sphere((0, 300, 0), 200, d.Light(WHITE))
        scene.mesh(quad((corner_x + 20, 0, 0), (20, 0, 0), (0, 0, 50)), d.Lambert(d.BLACK))
        scene.mesh(quad((0, 0, 3.5 - edge_y - 20), (50, 0, 0), (0, 0, 20)), d.Lambert(d.BLACK))
    across = np.array([window_below(edge_x - x - 0.5, width) for x in range(9)])
    down = np.array([window_below(edge_y - y - 0.5, width) for y in range(7)])
    expected = np.outer(down, across)
    told = expected > 0.1  # of less, many pictures would tell little
    pictures = Pictures(Measurement(filmed(scene, view, film), "path", samples=8))
    check_mean(
        lambda seed: pictures(seed)[..., 0][told], expected[told], within=0.15, what=f"{kind}, {width}, {aspect}"
    )
    assert not pictures(0)[expected == 0].any()


def glints_in_fog() -> Builder:
    """All that does not lie where a camera's ray does: points of scales that compete for being lit, more rays for
    moons, splats of light that metal throws into fog."""
    scene = Builder(camera((0, -4, 3), (0, 8, 2.5), 60), medium=d.Medium((0.01, 0.02, 0.01), (0.06, 0.05, 0.07)))
    rng = np.random.default_rng(4)
    scales = np.tile(np.eye(4), (900, 1, 1))
    scales[:, :2, :2] += rng.normal(0, 0.05, (900, 2, 2))
    scales[:, 2, :2] = rng.normal(0, 0.2, (900, 2))
    scales[:, :3, 3] = np.stack(np.meshgrid(np.arange(-15, 15), np.arange(30), 0), -1).reshape(-1, 3) * 0.25 + (0, 5, 0)
    scene.mesh(hexagon(0.12, 0.1), d.Conductor(0.05, f0=grey(0.8)), instances=scales)
    scene.mesh(floor(-0.5, 12, (0, 8)), d.Mix(0.1, d.Mirror(WHITE), d.Lambert(grey(0.5))))
    return scene.sphere((-2, 11, 4), 0.6, d.Light((6, 1, 0.6))).sphere((0.5, 12, 4), 0.9, d.Light((3, 3, 9)))


def test_every_pixel_has_the_mean_that_its_own_samples_give() -> None:
    film = d.Film(15, 11, (2, 2, 12, 9), FILTER, 3)
    scene = filmed(glints_in_fog(), camera((0, -4, 3), (0, 8, 2.5), 60), film)
    with Render(Scene(scene), samples=1) as render:
        assert not any("glint" in line for line in render.run().report()["left_out"])
    together, apart = (
        Pictures(Measurement(scene, integrator, samples=4)) for integrator in ("path", "path-no-reconstruction")
    )

    def pixels(picture: Array) -> Array:
        return picture[..., 1].ravel()

    check_same(lambda seed: pixels(together(seed)), lambda seed: pixels(apart(seed)), within=0.1)


def same_alone(scene: d.SceneDescription, within: float, samples: int = 8) -> None:
    """Each pixel's mean, in one channel, is that of samples which count for one pixel alone."""
    together, apart = (
        Pictures(Measurement(scene, integrator, samples)) for integrator in ("path", "path-no-reconstruction")
    )
    check_same(lambda seed: together(seed)[..., 0].ravel(), lambda seed: apart(seed)[..., 0].ravel(), within=within)


@pytest.mark.full
def test_a_moon_that_passes_by() -> None:
    """Some pixels take more camera rays for it than their neighbours do: those where it is halfway."""
    way = np.tile(np.eye(4), (3, 1, 1))
    way[:, 0, 3] = (-2, 0, 2)
    view = camera((0, 0, 0), (0, 1, 0), 40)
    film = d.Film(48, 36, (14, 17, 18, 19), FILTER, 3)
    scene = Builder(view).sphere((0, 6, 0), 0.6, d.Light(WHITE))
    same_alone(filmed(scene, replace(view, motion=way @ view.to_world), film), within=0.02, samples=32)


@pytest.mark.full
def test_the_edge_of_a_surface_that_glints() -> None:
    """White stripes narrower than a pixel, of which one point is lit: it has a place of its own."""
    view = d.Camera(look_at((0, -4, 0), (0, 0, 0)), d.Orthographic(9))  # a unit is a pixel
    low = np.arange(-8, 8, 0.25)
    corners = [[(-30, 0, z), (0.3, 0, z), (0.3, 0, z + 0.1), (-30, 0, z + 0.1)] for z in low]
    faces = [[(4 * k, 4 * k + 1, 4 * k + 2), (4 * k, 4 * k + 2, 4 * k + 3)] for k in range(len(low))]
    stripes = d.Mesh("stripes", np.array(corners, np.float64).reshape(-1, 3), np.array(faces, np.uint32).reshape(-1, 3))
    scene = Builder(view).mesh(stripes, d.Lambert(WHITE))
    scene.mesh(quad((-15 + 0.3, 0.1, 0), (15, 0, 0), (0, 0, 9)), d.Lambert(d.BLACK))
    scene.sphere((0, -40, 0), 2, d.Light(grey(900)))
    film = d.Film(9, 7, (3, 3, 7, 5), FILTER, 3)
    described = filmed(scene, view, film)
    with Render(Scene(described), samples=1) as render:
        assert not any("glint" in line for line in render.run().report()["left_out"])
    same_alone(described, within=0.06)


def test_passes_are_filtered_as_the_picture_is() -> None:
    """Those of light add up to it, whatever parts of a sample they come from; what a plate has everywhere is exact, and
    of its edge no depth is made up."""
    view = camera((0, -4, 3), (0, 8, 2.5), 60)
    scene = Scene(filmed(glints_in_fog(), view, d.Film(40, 36, (3, 1, 38, 35), FILTER, 3)))
    by_path = ("emission", "direct", "indirect", "fog")
    by_lobe = ["emit", "environment", "volume_direct", "volume_indirect"]
    by_lobe += [f"{lobe}_{way}" for lobe in ("diffuse", "glossy", "transmission") for way in ("direct", "indirect")]
    with Render(scene, samples=5, tile_size=32, passes=(*by_path, *by_lobe)) as render:
        picture = render.run().read().astype(np.float64)
        for names in (by_path, by_lobe):
            total = sum(render.read(name).astype(np.float64) for name in names)
            assert np.abs(total - picture).max() < 1e-5 * picture.max()
    view = d.Camera(look_at((0, -4, 0), (0, 0, 0)), d.Orthographic(40))
    plate = Builder(view).mesh(quad((-30, 0, 0), (30, 0, 0), (0, 0, 40)), d.Lambert((0.2, 0.4, 0.8)))
    with Render(Scene(filmed(plate, view, d.Film(40, 36, None, FILTER, 3))), samples=5, passes=PLAIN) as render:
        render.run()
        albedo, normal, depth, alpha = (render.read(name).astype(np.float64) for name in PLAIN)
    assert np.abs(albedo[:, :18] / (0.2, 0.4, 0.8) - 1).max() < ROUNDING and not albedo[:, 22:].any()
    assert np.abs(normal[:, :18] - (0, -1, 0)).max() < ROUNDING
    assert np.abs(depth[:, :20, 0] / 4 - 1).max() < ROUNDING and (depth[:, 22:] == 1e10).all()
    assert np.abs(alpha - 1).max() < ROUNDING


def test_an_object_is_named_where_its_middle_is() -> None:
    """By samples of the pixel itself, not of those around that count for it."""
    view = d.Camera(look_at((0, -4, 0), (0, 0, 0)), d.Orthographic(9))
    plate = d.Object("plate", quad((0.5, 0, 0), (1, 0, 0), (0, 0, 9)), (0,), object_index=7)
    scene = Builder(view).done()
    scene = replace(
        scene,
        film=d.Film(9, 7, None, FILTER, 3),
        materials=(d.NamedMaterial("grey", d.Lambert(grey(0.5))),),
        objects=(plate,),
    )
    with Render(Scene(scene), samples=3, passes=("object_index",)) as render:
        index = render.run().read("object_index")[..., 0]
    assert (index[:, 4:6] == 7).all() and not index[:, :4].any() and not index[:, 6:].any()


def test_noise_is_less_than_half() -> None:
    """Of what the place in the pixel does not decide: the integral of the squared filter, .45, of its variance."""
    view = camera((0, 0, 2), (0, 4, 0), 50)
    scene = Builder(view).mesh(floor(0, 20), d.Lambert(grey(0.7))).sphere((0, 8, 6), 2, d.Light(grey(5)))
    built = Scene(filmed(scene, view, d.Film(24, 16, None, FILTER, 3)))

    def variance(integrator: str) -> float:
        with Render(built, integrator=integrator, samples=32, max_depth=1, passes=("stderr",)) as render:
            render.run()
            return float((render.read("stderr").astype(np.float64) ** 2).mean())

    ratio = variance("path") / variance("path-no-reconstruction")
    assert 0.35 < ratio < 0.55


def plate_over_cells() -> d.SceneDescription:
    """A plate with its edges within pixels, some of them next to the edges of cells of 32 pixels, before a sky. It and
    a moon are in light groups of their own, and so is the sky."""
    view = d.Camera(look_at((0, -4, 0), (0, 0, 0)), d.Orthographic(44))  # a unit is a pixel
    scene = Builder(view, environment=d.Environment((0.2, 0.4, 0.9)))
    scene.mesh(quad((9.8, 0, 1.3), (7.4, 0, 0), (0, 0, 9)), d.Lambert(grey(0.5), emission=(0.3, 0.1, 0.2)))
    scene.sphere((-9, 3, 0), 4, d.Light((3, 2, 1)))
    built = filmed(scene, view, d.Film(44, 36, None, FILTER, 3))
    assert built.environment is not None
    return replace(
        built,
        objects=tuple(replace(item, matte=5, light_group=1) for item in built.objects),
        spheres=tuple(replace(item, light_group=2) for item in built.spheres),
        environment=replace(built.environment, light_group=3),
    )


@pytest.mark.parametrize("medium", [None, d.Medium(grey(0.01), grey(0.05))])
def test_light_groups_add_up_to_the_picture(medium: d.Medium | None) -> None:
    groups = ("light_group_1", "light_group_2", "light_group_3")
    scene = Scene(replace(plate_over_cells(), medium=medium))
    with Render(scene, samples=5, passes=groups, tile_size=32) as render:
        picture = render.run().read("combined").astype(np.float64)
        parts = [render.read(name).astype(np.float64) for name in groups]
    assert all(part.any() for part in parts[: 3 if medium is None else 2])  # no sky through fog without an end
    assert np.abs(sum(parts) - picture).max() < 1e-5 * picture.max()


def test_alpha_and_mattes_are_filtered_as_the_picture_is() -> None:
    """By the same weights: what alpha leaves empty is what shows the sky, and the plate's part of each pixel is one
    entry, whichever cells it comes from."""
    scene = plate_over_cells()
    scene = replace(scene, film=replace(scene.film, transparent=True), spheres=())
    with Render(Scene(scene), samples=5, passes=("environment", "object_matte"), tile_size=32) as render:
        alpha = render.run().read("alpha")[..., 0].astype(np.float64)
        sky = render.read("environment").astype(np.float64)
        matte = render.read("object_matte").astype(np.float64)
        picture = render.read("combined").astype(np.float64)
    assert ((alpha > 0.05) & (alpha < 0.95)).sum() > 50
    np.testing.assert_allclose(sky, (1 - alpha[..., None]) * np.array((0.2, 0.4, 0.9)), atol=1e-6)
    np.testing.assert_allclose(matte[..., 1], alpha, atol=1e-6)
    assert (matte[..., 0] == np.where(matte[..., 1] > 0, 5, 0)).all() and not matte[..., 2:].any()
    assert not picture[alpha == 0].any()


def test_glass_through_which_the_picture_is_empty() -> None:
    """Rough glass that may be chosen as the point that is lit: what goes on from there for the light alone must not
    make the picture emptier."""
    view = camera((0, -4, 3), (0, 8, 2.5), 60)
    scene = glints_in_fog()
    scene.mesh(quad((0, 3, 2), (2, 0, 0), (0, 0, 1)), d.Glass(1.0001, alpha=0.09, transmission=grey(0.8)))
    film = replace(d.Film(24, 18, None, FILTER, 3), transparent=True, transparent_glass=0.3)
    built = Scene(replace(filmed(scene, view, film), medium=None, environment=d.Environment(grey(1e-3))))

    def alpha(integrator: str) -> Array:
        with Render(built, integrator=integrator, samples=64, passes=("alpha",)) as render:
            plain = any("glint" in line for line in render.run().report()["left_out"])
            assert not plain or integrator != "path"
            return render.read("alpha").astype(np.float64)

    found = alpha("path")
    assert ((found > 0.15) & (found < 0.25)).sum() > 10
    np.testing.assert_allclose(found.mean(), alpha("path-no-pixel-ris").mean(), atol=0.01)


def test_independent_pixels_are_those_of_filter_importance_sampling() -> None:
    scene = Scene(filmed(glints_in_fog(), camera((0, -4, 3), (0, 8, 2.5), 60), d.Film(24, 18, None, FILTER, 3)))

    def rendered(**settings: object) -> tuple[Array, list[str]]:
        with Render(scene, samples=2, **settings) as render:
            return render.run().read().copy(), render.report()["left_out"]

    apart, told = rendered(independent_pixels=1)
    together, untold = rendered()
    np.testing.assert_array_equal(apart, rendered(integrator="path-no-reconstruction")[0])
    assert (apart != together).mean() > 0.9
    reason = "a sample counts for one pixel"
    assert any(reason in line for line in told) and not any(reason in line for line in untold)
    assert any("adaptive" in line and reason in line for line in rendered(adaptive=1)[1])
