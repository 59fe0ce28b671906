# SPDX-License-Identifier: GPL-3.0-or-later
"""Each kind of camera against itself: rays and projection, areas, and what it says about where it sees."""

from dataclasses import replace

import numpy as np
import pytest

from tests.engine.probe import camera as probe
from tests.engine.probe.call import Array
from tests.engine.probe.camera import ORTHOGRAPHIC, PERSPECTIVE, Camera

RNG_SEED = 7
COUNT = 2000


def axes(mirrored: bool = False) -> Array:
    rotation, _ = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))
    return rotation * (1 if (np.linalg.det(rotation) < 0) == mirrored else -1)


PLAIN = {
    "perspective": Camera(PERSPECTIVE, axes()),
    "orthographic": Camera(ORTHOGRAPHIC, axes(), half_width=3.0),
    "orthographic from behind": Camera(ORTHOGRAPHIC, axes(), half_width=3.0, clip_start=-20.0, clip_end=30.0),
}
PINHOLES = {
    **PLAIN,
    "perspective, all": replace(PLAIN["perspective"], shift=(0.3, -0.2), clip_start=0.5, clip_end=40.0),
    "orthographic, all": replace(PLAIN["orthographic"], shift=(0.3, -0.2), clip_start=0.5, clip_end=40.0),
    "mirrored": replace(PLAIN["perspective"], axes=axes(mirrored=True), shift=(0.1, 0.0)),
}
CAMERAS = {
    **PINHOLES,
    **{f"{name}, lens": replace(c, lens_radius=1.5, focus_distance=4.0) for name, c in PINHOLES.items()},
    **{
        f"{name}, aperture": replace(c, lens_radius=1.5, focus_distance=4.0, blades=5, rotation=0.4, scale=(0.6, 1.0))
        for name, c in PLAIN.items()
    },
}
APERTURES = [(0, 0.0, (0.5, 1.0)), (3, 0.0, (1.0, 1.0)), (4, 0.3, (1.0, 0.4)), (7, -2.0, (0.8, 1.0))]


def disk(rng: np.random.Generator, count: int) -> Array:
    angle, radius = rng.uniform(0, 2 * np.pi, count), np.sqrt(rng.uniform(0, 1, count))
    return np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1)


def points(rays: Array, t: Array) -> Array:
    return rays[:, :3].astype(np.float64) + rays[:, 3:6].astype(np.float64) * t[:, None]


@pytest.mark.parametrize("name", CAMERAS)
def test_projection_is_the_inverse(name: str) -> None:
    camera, rng = CAMERAS[name], np.random.default_rng(RNG_SEED)
    film, lens, t = rng.uniform(-0.5, 1.5, (COUNT, 2)), disk(rng, COUNT), rng.uniform(0.1, 20, COUNT)
    rays = probe.generate(camera, film, lens)
    np.testing.assert_allclose(np.linalg.norm(rays[:, 3:6], axis=1), 1, atol=1e-6)
    at = probe.project(camera, points(rays, t), lens)
    assert at.seen.all()
    np.testing.assert_allclose(at.film, film, atol=2e-5)
    np.testing.assert_allclose(at.rays[:, :6], rays[:, :6], atol=2e-5)
    np.testing.assert_allclose(at.rays[:, 6], t, rtol=1e-5, atol=2e-5)


@pytest.mark.parametrize("name", CAMERAS)
def test_clipping_planes_lie_across_the_axis(name: str) -> None:
    camera, rng = CAMERAS[name], np.random.default_rng(RNG_SEED)
    rays = probe.generate(camera, rng.uniform(0, 1, (COUNT, 2)), disk(rng, COUNT))
    forward = camera.axes[2]
    np.testing.assert_allclose(rays[:, :3] @ forward, camera.clip_start, atol=5e-6)
    if np.isinf(camera.clip_end):
        assert np.isinf(rays[:, 6]).all()
    else:
        np.testing.assert_allclose(points(rays, rays[:, 6]) @ forward, camera.clip_end, rtol=1e-5)
    lens = np.zeros((2, 2))
    for depth in (camera.clip_start - 0.1, min(camera.clip_end, 1e4) * 1.01):
        x = forward * depth + camera.axes[0] * 0.01
        assert probe.project(camera, [x, x], lens).seen.all() == (camera.clip_start < depth < camera.clip_end)


@pytest.mark.parametrize("name", CAMERAS)
def test_area_is_what_neighbouring_rays_span(name: str) -> None:
    camera, rng = CAMERAS[name], np.random.default_rng(RNG_SEED)
    film, lens, t = rng.uniform(0, 1, (COUNT, 2)), disk(rng, COUNT), rng.uniform(1, 20, COUNT)
    middle = probe.generate(camera, film, lens)
    x, across = points(middle, t), middle[:, 3:6].astype(np.float64)
    step, spans = 0.05, []
    for side in np.eye(2) * step:
        ends = []
        for sign in (1, -1):
            rays = probe.generate(camera, film + sign * side, lens).astype(np.float64)
            # Where it meets the plane through x across the ray in the middle.
            away = ((x - rays[:, :3]) * across).sum(axis=1) / (rays[:, 3:6] * across).sum(axis=1)
            ends.append(rays[:, :3] + rays[:, 3:6] * away[:, None])
        spans.append((ends[0] - ends[1]) / (2 * step))
    expected = np.linalg.norm(np.cross(spans[0], spans[1]), axis=1)
    np.testing.assert_allclose(probe.project(camera, x, lens).area, expected, rtol=1e-2)


@pytest.mark.parametrize("name", PINHOLES)
def test_clip_keeps_what_the_film_may_see(name: str) -> None:
    camera, rng = CAMERAS[name], np.random.default_rng(RNG_SEED)
    part = (0.2, 0.1, 0.7, 0.9)
    rays = np.concatenate([rng.normal(0, 4, (COUNT, 3)), rng.normal(size=(COUNT, 3)), np.full((COUNT, 1), 30)], axis=1)
    rays[:, 3:6] /= np.linalg.norm(rays[:, 3:6], axis=1)[:, None]
    kept = probe.clip(camera, rays, part)
    assert 0.02 < (kept[:, 0] < kept[:, 1]).mean() < 0.98
    for _ in range(20):
        t = rng.uniform(0, 30, COUNT)
        at = probe.project(camera, points(rays, t), np.zeros((COUNT, 2)))
        begin, end = np.array(part[:2]), np.array(part[2:])
        inside = (at.seen == 1) & (at.film > begin + 1e-4).all(axis=1) & (at.film < end - 1e-4).all(axis=1)
        outside = (at.seen == 1) & ((at.film < begin - 1e-4) | (at.film > end + 1e-4)).any(axis=1)
        within = (t >= kept[:, 0]) & (t <= kept[:, 1])
        assert inside.any() and outside.any()
        assert within[inside].all() and not within[outside].any()


@pytest.mark.parametrize("extinction", [0.0, 0.3])
@pytest.mark.parametrize("name", PLAIN)
def test_points_of_a_beam_have_the_density_that_is_said(name: str, extinction: float) -> None:
    camera = CAMERAS[name]
    for direction in (camera.axes[0], camera.axes[2], camera.axes @ [0.6, 0.0, -0.8], -camera.axes[2]):
        ray = [*(camera.axes[2] * 3 + camera.axes[1] * 0.5), *direction, 9.0]
        u = (np.arange(4000) + 0.5) / 4000
        t, pdf = probe.sample_seen(camera, ray, [0.5, 2.5], extinction, u)
        assert ((t >= 0.5) & (t <= 2.5)).all() and (np.diff(t) > 0).all()
        steps = 0.5 * (pdf[1:] + pdf[:-1]) * np.diff(t.astype(np.float64))
        np.testing.assert_allclose(np.cumsum(steps), u[1:] - u[0], atol=1e-3)


def test_points_of_an_endless_beam() -> None:
    """In a medium it has an end: what is left beyond is what the exponential says."""
    camera = CAMERAS["orthographic"]
    ray = [*camera.axes[1], *camera.axes[2], np.inf]
    u = (np.arange(4000) + 0.5) / 4000
    t, pdf = probe.sample_seen(camera, ray, [1, np.inf], 0.3, u)
    np.testing.assert_allclose(t, 1 - np.log1p(-u) / 0.6, rtol=1e-5)
    np.testing.assert_allclose(pdf, 0.6 * (1 - u), rtol=1e-4)


@pytest.mark.parametrize("name", PINHOLES)
def test_a_sphere_is_sought_where_rays_meet_it(name: str) -> None:
    camera, rng = CAMERAS[name], np.random.default_rng(RNG_SEED)
    film = rng.uniform(0, 1, (COUNT, 2))
    rays = probe.generate(camera, film, np.zeros((COUNT, 2))).astype(np.float64)
    for depth in (4.0, 12.0):
        center = camera.axes[2] * depth + camera.axes[0] * 0.3
        way = center - rays[:, :3]
        apart = np.linalg.norm(np.cross(way, rays[:, 3:6]), axis=1)
        seen = probe.sees(camera, [*center, 1.0], film)
        assert 0 < seen.sum() < COUNT
        assert seen[apart < 0.999].all() and not seen[apart > 1.001].any()


@pytest.mark.parametrize("name", CAMERAS)
def test_rays_start_within_the_region_that_is_said(name: str) -> None:
    camera, rng = CAMERAS[name], np.random.default_rng(RNG_SEED)
    corners = rng.integers(0, 2, (COUNT, 2))
    lens = disk(rng, COUNT)
    lens /= np.linalg.norm(lens, axis=1)[:, None]
    starts = probe.generate(camera, corners, lens)[:, :3]
    region = probe.start_region(camera)
    apart = np.linalg.norm(starts - region[:3], axis=1)
    assert apart.max() <= region[3] * (1 + 1e-5) + 1e-6
    assert apart.max() >= region[3] * 0.5  # not far too large


@pytest.mark.parametrize(("blades", "rotation", "scale"), APERTURES)
def test_an_aperture_is_a_polygon_seen_evenly(blades: int, rotation: float, scale: tuple[float, float]) -> None:
    camera = Camera(PERSPECTIVE, axes(), blades=blades, rotation=rotation, scale=scale)
    count = 400_000
    lens = probe.lens_points(camera, disk(np.random.default_rng(RNG_SEED), count)).astype(np.float64)
    assert probe.is_on_lens(camera, lens * (1 - 1e-5)).all()
    # Of a regular polygon of n corners on the unit circle: area n sin(2 pi / n) / 2, E[x^2] = (2 + cos(2 pi / n)) / 12.
    turn = 2 * np.pi / blades if blades else 0.0
    area = (blades * np.sin(turn) / (2 * np.pi) if blades else 1.0) * scale[0] * scale[1]
    assert probe.lens_area(camera) == pytest.approx(area, rel=1e-6)
    expected = np.diag(np.square(scale)) * (2 + np.cos(turn)) / 12
    np.testing.assert_allclose(lens.T @ lens / count, expected, atol=5 * 0.3 / np.sqrt(count))
    np.testing.assert_allclose(lens.mean(axis=0), 0, atol=5 * 0.5 / np.sqrt(count))
    # It holds as much of a square as the area says, and the same part of it.
    square = np.random.default_rng(1).uniform(-1, 1, (count, 2))
    inside = probe.is_on_lens(camera, square)
    assert inside.mean() * 4 / np.pi == pytest.approx(area, abs=5 * 0.65 / np.sqrt(count))
    np.testing.assert_allclose(
        square[inside].T @ square[inside] / inside.sum(), expected, atol=5 * 0.3 / np.sqrt(inside.sum())
    )
    if blades:
        middle = rotation + turn * np.arange(blades)
        out = lens / scale @ np.stack([np.cos(middle), np.sin(middle)])
        assert out.max() <= np.cos(turn / 2) + 1e-6
        np.testing.assert_allclose(out.max(axis=0), np.cos(turn / 2), atol=1e-3)
