# SPDX-License-Identifier: GPL-3.0-or-later
"""Passes that compositors work with: parts of the light that make up the picture, alpha, and what the camera sees."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from addon.scene import description as d
from addon.scene.program import Op, programmed
from tests.engine.bits import all_passes, assert_same_bits, pictures, plain_passes
from tests.engine.library import Image, Render, Scene
from tests.engine.worlds import everything
from tests.render.build import Builder, camera, floor, grey, quad

LIGHT = (
    "emit",
    "environment",
    *(f"{lobe}_{part}" for lobe in ("diffuse", "glossy", "transmission", "volume") for part in ("direct", "indirect")),
)
VIEW = camera((0, -6, 2), (0, 0, 0.5), 50)
SKY = d.Environment((0.4, 0.5, 0.7))
HAZE = d.Medium(grey(0.01), grey(0.05), 0.3)
METAL = d.Mix(0.4, d.Lambert((0.7, 0.5, 0.3)), d.Conductor(0.2, f0=(0.9, 0.8, 0.5)))
WIDTH, HEIGHT = 40, 30


def balls(**parts: Any) -> d.SceneDescription:
    """One of each kind of lobe on a floor, under a lamp that is seen and a sky."""
    builder = Builder(VIEW, WIDTH, HEIGHT, **{"environment": SKY, **parts})
    materials: tuple[d.Material, ...] = (
        METAL,
        d.Glass(1.5),
        d.Glass(1.4, alpha=0.3),
        d.Mirror(grey(0.9)),
        d.Translucent((0.5, 0.6, 0.3)),
        d.Mix(0.5, d.Lambert(grey(0.5)), d.Transparent(grey(1))),
        d.Lambert((0.6, 0.3, 0.5), emission=(0.1, 0.2, 0.3)),
    )
    for i, material in enumerate(materials):
        builder.sphere((0.9 * i - 2.7, 0.3 * (i % 2), 0.5), 0.42, material)
    builder.sphere((1, 2, 2.5), 0.5, d.Light((8, 6, 5)))
    builder.mesh(floor(0, 8), d.Lambert(grey(0.5)))
    return builder.lamp(d.PointLight("point", (-3, -2, 4), grey(60))).done()


def render(scene: d.SceneDescription, *names: str, samples: int = 16, **settings: Any) -> dict[str, Image]:
    with Render(Scene(scene), samples=samples, passes=names, **settings) as handle:
        handle.run()
        return {name: handle.read(name) for name in ("combined", *names)}


def box_of(medium: d.Medium) -> d.SceneDescription:
    scene = balls()
    cube = Builder(VIEW).mesh(_cube(), d.Null(), interior=medium).done()
    shifted = [replace(item, materials=(len(scene.materials),)) for item in cube.objects]
    return replace(scene, objects=(*scene.objects, *shifted), materials=(*scene.materials, *cube.materials))


def _cube() -> d.Mesh:
    from tests.render.build import box

    return box((-4, -3, 0.01), (4, 4, 3))


WORLDS: dict[str, Callable[[], d.SceneDescription]] = {
    "a sky": balls,
    "fog": lambda: balls(medium=d.Medium(grey(0.01), grey(0.05), 0.3)),
    "fog without light vertices": lambda: balls(medium=d.Medium(grey(0.01), grey(0.05), 0.3)),
    "a cube of fog": lambda: box_of(d.Medium(grey(0.01), grey(0.1), 0.3)),
    "all there is": lambda: everything(48, 36),
}


@pytest.mark.parametrize("name", WORLDS)
def test_parts_of_the_light_make_up_the_picture(name: str) -> None:
    integrator = "path-no-light-vertices" if "without light vertices" in name else None
    found = render(WORLDS[name](), *LIGHT, integrator=integrator)
    parts = np.sum([found[part] for part in LIGHT], axis=0)
    np.testing.assert_allclose(parts, found["combined"], rtol=2e-5, atol=2e-6)
    if name != "all there is":
        empty = [part for part in LIGHT if not found[part].any()]
        # Nothing shines through fog without an end.
        endless = ["environment"] if name.startswith("fog") else []
        assert empty == (endless if "fog" in name else ["volume_direct", "volume_indirect"])


@pytest.mark.parametrize("build", [lambda: everything(48, 36), lambda: grouped(medium=HAZE)], ids=["all", "haze"])
def test_passes_change_no_bit_of_the_others(build: Callable[[], d.SceneDescription]) -> None:
    world = Scene(build())
    results = []
    for names in (plain_passes(), all_passes()):
        with Render(world, samples=4, passes=names) as handle:
            results.append(pictures(handle.run(), plain_passes()))
    assert_same_bits(*results)


@pytest.mark.parametrize("adaptive", [False, True])
def test_a_transparent_film_is_the_picture_without_its_environment(adaptive: bool) -> None:
    scene = balls()
    clear = replace(scene, film=replace(scene.film, transparent=True))
    # Emitter rays would have no alpha.
    opaque = render(scene, "environment", "alpha", samples=32, adaptive=adaptive, integrator="path-no-emitter-rays")
    found = render(clear, "environment", samples=32)
    np.testing.assert_allclose(opaque["alpha"], 1, rtol=1e-6)
    with Render(Scene(clear), samples=32) as handle:  # alpha is there without being asked for
        alpha = handle.run().read("alpha")
    assert alpha.min() == 0 and alpha.max() == 1 and ((alpha > 0.05) & (alpha < 0.95)).any()
    if not adaptive:
        np.testing.assert_array_equal(found["environment"], opaque["environment"])
        np.testing.assert_allclose(found["combined"] + found["environment"], opaque["combined"], rtol=1e-5, atol=1e-6)
        # A sky of one colour is seen where the picture is empty.
        np.testing.assert_allclose(
            (1 - alpha) * np.array(SKY.radiance, np.float32), found["environment"], rtol=1e-5, atol=1e-6
        )


def wall(material: d.Material, **film: Any) -> d.SceneDescription:
    """A plate that fills the left half of the picture, before the sky."""
    builder = Builder(camera((0, -4, 0), (0, 0, 0), 40), 8, 6, environment=SKY)
    scene = builder.mesh(quad((-5, 0, 0), (5, 0, 0), (0, 0, 5)), material).done()
    return replace(scene, film=replace(scene.film, **{"transparent": True, **film}))


def test_alpha_is_the_opacity_of_what_is_seen() -> None:
    half = render(wall(d.Mix(0.75, d.Transparent(grey(1)), d.Lambert(grey(0.5)))), "alpha", samples=512)["alpha"]
    np.testing.assert_allclose(half[:, :4].mean(), 0.25, atol=5 * 0.44 / np.sqrt(512 * 24))
    assert (half[:, 4:] == 0).all()
    tinted = render(wall(d.Transparent((0.9, 0.3, 0.6))), "alpha")
    np.testing.assert_allclose(tinted["alpha"][:, :4], 0.4, rtol=1e-5)
    assert not tinted["combined"].any()


@pytest.mark.parametrize("limit", [None, 0.01, 0.3])
@pytest.mark.parametrize("width", [0.0, 0.09])
def test_glass_is_empty_up_to_the_roughness_that_is_asked_for(limit: float | None, width: float) -> None:
    pane = d.Glass(1.000001 if width == 0 else 1.0001, alpha=width, reflection=grey(0), transmission=grey(0.8))
    found = render(wall(pane, transparent_glass=limit), "alpha", samples=64)
    expected = 0.2 if limit is not None and width <= limit else 1.0
    np.testing.assert_allclose(found["alpha"][:, :4].mean(), expected, atol=2e-3)


@pytest.mark.parametrize("transparent", [False, True])
def test_a_holdout_is_empty(transparent: bool) -> None:
    scene = wall(d.Lambert(grey(0.5)), transparent=transparent)
    hole = replace(scene, objects=(replace(scene.objects[0], is_holdout=True),))
    found = render(hole, "alpha")
    assert not found["combined"][:, :4].any() and not found["alpha"][:, :4].any()
    assert (found["alpha"][:, 4:] == (0 if transparent else 1)).all()


def test_a_material_may_be_a_hole_in_part() -> None:
    scene = wall(d.Mix(0.25, d.Holdout(), d.Lambert(grey(0.5))))
    found, whole = render(scene, "alpha", samples=8), render(wall(d.Lambert(grey(0.5))), samples=8)
    np.testing.assert_allclose(found["alpha"][:, :4], 0.75, rtol=1e-5)
    np.testing.assert_allclose(found["combined"][:, :4].mean(), 0.75 * whole["combined"][:, :4].mean(), rtol=0.02)
    behind = wall(d.Mix(0.5, d.Transparent(grey(1)), d.Lambert(grey(0.5))))
    back = replace(behind.objects[0], to_world=behind.objects[0].to_world + np.diag([0, 0, 0, 0]), name="back")
    back.to_world[1, 3] += 1
    named = (behind.materials[0], d.NamedMaterial("hole", d.Holdout()))
    through = replace(behind, materials=named, objects=(behind.objects[0], replace(back, materials=(1,))))
    np.testing.assert_allclose(render(through, "alpha", samples=256)["alpha"][:, :3].mean(), 0.5, atol=0.03)


def test_aovs_show_what_materials_give() -> None:
    """Also through what is transparent, where values add up."""
    place = Op("geometry", (1.0,), ("position", "center"))
    found, program = programmed((d.Lambert(grey(0.5)), place, Op("separate", (place,), ("z",))))
    plain = wall(d.Lambert(grey(0.5)))
    shown = d.NamedMaterial("shown", found[0], program=program, aovs=((1, found[1]), (8, found[2])))
    scene = replace(plain, materials=(shown,))
    names = ("aov_1", "aov_8", "aov_2")
    first = render(scene, *names, "position", samples=1)
    np.testing.assert_allclose(first["aov_1"][..., :3], first["position"], atol=1e-5)
    np.testing.assert_allclose(first["aov_8"][..., 0], first["position"][..., 2], atol=1e-5)
    assert (first["aov_1"][..., 3] == (first["position"] != 0).any(axis=-1)).all()
    assert not first["aov_2"].any()
    np.testing.assert_array_equal(first["combined"], render(plain, "position", samples=1)["combined"])
    clear = replace(shown, material=d.Transparent(grey(1)), name="clear")
    before = replace(scene.objects[0], name="before", to_world=scene.objects[0].to_world.copy(), materials=(1,))
    before.to_world[1, 3] -= 1
    both = replace(scene, materials=(shown, clear), objects=(scene.objects[0], before))
    twice = render(both, *names, samples=1)
    assert (twice["aov_1"][:, :3, 3] == 2).all()


@pytest.mark.parametrize("distance", [0.5, 2.0, 100.0])
def test_occlusion_is_by_what_is_near(distance: float) -> None:
    """A floor under a ceiling, 1 above it: directions whose cosine is below 1 / distance meet it too late."""
    builder = Builder(camera((0, 0, 0.5), (0, 0.01, 0), 40), 8, 6, environment=SKY)
    builder.mesh(floor(0, 1e4), d.Lambert(grey(0.5))).mesh(floor(1, 1e4), d.Lambert(grey(0)))
    scene = builder.done()
    scene = replace(scene, film=replace(scene.film, occlusion_distance=distance))
    found = render(scene, "ambient_occlusion", "position", samples=256)
    expected = min(1 / distance, 1) ** 2
    np.testing.assert_allclose(found["ambient_occlusion"].mean(), expected, atol=5 * 0.5 / np.sqrt(256 * 48))
    np.testing.assert_array_equal(found["combined"], render(scene, "position", samples=256)["combined"])


def test_what_the_camera_sees_is_where_it_is() -> None:
    """A plate with texture coordinates across the view, 4 from the camera, its middle at the world's (100, 0, 0)."""
    plate = quad((100, 0, 0), (2, 0, 0), (0, 0, 2))
    plate = replace(plate, attributes=(d.Attribute("uv", "corner", _corner_uvs()),))
    view = camera((100, -4, 0), (100, 0, 0), 40)
    scene = Builder(view, 9, 9, environment=SKY).mesh(plate, d.Lambert(grey(0.5))).done()
    scene = replace(scene, film=replace(scene.film, mist=d.Mist(3, 2, 0.5)))
    found = render(scene, "position", "uv", "mist", "depth", "diffuse_color", samples=4)
    middle = found["position"][4, 4]
    np.testing.assert_allclose(middle, (100, 0, 0), atol=0.2)
    np.testing.assert_allclose(found["position"][..., 1], 0, atol=1e-4)
    # One sample for the position, four for the rest.
    np.testing.assert_allclose(found["uv"][..., 0], (found["position"][..., 0] - 98) / 4, atol=0.09)
    np.testing.assert_allclose(found["uv"][..., 1], (found["position"][..., 2] + 2) / 4, atol=0.09)
    assert (found["uv"][..., 2] == 1).all()
    distance = np.linalg.norm(found["position"] - np.array((100, -4, 0), np.float32), axis=-1)
    np.testing.assert_allclose(found["mist"][..., 0], np.sqrt((distance - 3) / 2), atol=0.05)
    np.testing.assert_allclose(found["diffuse_color"], 0.5, rtol=1e-6)


def _corner_uvs() -> Image:
    corners = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], np.float32)
    return corners[[0, 1, 2, 0, 2, 3]]


def grouped(**parts: Any) -> d.SceneDescription:
    """The balls, each light of theirs in a group of its own."""
    scene = balls(**parts)
    spheres = tuple(replace(item, light_group=1) for item in scene.spheres)
    lights = tuple(replace(lamp, flags=replace(lamp.flags, light_group=2)) for lamp in scene.lights)
    panel = quad((-2, 3, 2), (0.5, 0, 0), (0, 0, 0.5))
    material = d.NamedMaterial("panel", d.Light((3, 4, 5)))
    glow = d.Object("panel", panel, (len(scene.materials),), light_group=16)
    return replace(
        scene,
        spheres=spheres,
        lights=lights,
        environment=replace(scene.environment, light_group=3),
        objects=(*scene.objects, glow),
        materials=(*scene.materials, material),
    )


GROUPS = tuple(f"light_group_{i}" for i in (1, 2, 3, 16))


@pytest.mark.parametrize("medium", [None, HAZE])
def test_light_groups_make_up_the_picture(medium: d.Medium | None) -> None:
    scene = grouped(medium=medium)
    found = render(scene, *GROUPS, "light_group_4")
    np.testing.assert_allclose(sum(found[name] for name in GROUPS), found["combined"], rtol=2e-5, atol=2e-6)
    assert not found["light_group_4"].any()
    for name in GROUPS if medium is None else ("light_group_1", "light_group_2", "light_group_16"):
        assert found[name].any(), name
    # A group alone is the picture without the other lights.
    if medium is None:
        dark = replace(scene, lights=(), materials=tuple(_dark(item) for item in scene.materials))
        alone = render(dark, samples=256)["combined"]
        sky = render(scene, "light_group_3", samples=256)["light_group_3"]
        np.testing.assert_allclose(sky.mean(axis=(0, 1)), alone.mean(axis=(0, 1)), rtol=0.02)


def _dark(named: d.NamedMaterial) -> d.NamedMaterial:
    if isinstance(named.material, d.Light):
        return replace(named, material=d.Light(grey(0)))
    if isinstance(named.material, d.Lambert):
        return replace(named, material=replace(named.material, emission=grey(0)))
    return named


def test_mattes_say_what_takes_up_how_much() -> None:
    """The half transparent plate before another one, each as wide as the picture."""
    builder = Builder(camera((0, -4, 0), (0, 0, 0), 40), 4, 3, environment=SKY)
    builder.mesh(quad((0, 0, 0), (5, 0, 0), (0, 0, 5)), d.Mix(0.25, d.Transparent(grey(1)), d.Lambert(grey(0.5))))
    scene = builder.mesh(quad((0, 1, 0), (9, 0, 0), (0, 0, 9)), d.Lambert(grey(0.5))).done()
    scene = replace(scene, objects=tuple(replace(item, matte=5 + i) for i, item in enumerate(scene.objects)))
    found = render(scene, "object_matte", "material_matte", samples=400)
    for name, numbers in (("object_matte", {5.0, 6.0}), ("material_matte", None)):
        pairs = found[name]
        assert numbers is None or set(np.unique(pairs[..., :4:2])) == numbers
        np.testing.assert_allclose(np.sort(pairs[..., 1:4:2]).mean(axis=(0, 1)), (0.25, 0.75), atol=0.02)
        np.testing.assert_allclose(pairs[..., 1::2].sum(axis=-1), 1, atol=0.06)
        assert (np.diff(pairs[..., 1::2], axis=-1) <= 0).all() and not pairs[..., 4:].any()


def test_saved_states_hold_the_new_passes() -> None:
    names = ("alpha", "mist", "glossy_direct", "object_matte", "light_group_16")
    scene = Scene(replace(balls(), film=replace(balls().film, transparent=True)))
    with Render(scene, samples=4, passes=names) as first:
        state = first.run().save()
    with Render(scene, samples=8, passes=names) as second:
        second.load(state)
        resumed = pictures(second.run(), names)
    with Render(scene, samples=8, passes=names) as whole:
        assert_same_bits(resumed, pictures(whole.run(), names))
