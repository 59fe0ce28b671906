# SPDX-License-Identifier: GPL-3.0-or-later
"""Panoramic cameras: directions by the formulas of each, the inverse, solid angles, and lenses that face everywhere."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest

from tests.engine.probe import camera as probe
from tests.engine.probe.call import Array
from tests.engine.probe.camera import (
    CUBE_FACE,
    CYLINDRICAL,
    EQUIDISTANT,
    EQUIRECTANGULAR,
    EQUISOLID,
    MIRROR_BALL,
    PANORAMIC,
    POLYNOMIAL,
    Camera,
)
from tests.engine.test_camera import axes, disk, points

COUNT = 4000
AXES = axes()


def panorama(kind: int, **settings: object) -> Camera:
    return replace(Camera(PANORAMIC, AXES, panorama=kind), **settings)  # type: ignore[arg-type]


PANORAMAS = {
    "equirectangular": panorama(EQUIRECTANGULAR),
    "equirectangular, part": panorama(EQUIRECTANGULAR, longitude=(-1.0, 2.0), latitude=(-0.5, 1.2)),
    "equirectangular, mirrored": panorama(EQUIRECTANGULAR, longitude=(2.0, -1.0), latitude=(1.2, -0.5)),
    "equidistant": panorama(EQUIDISTANT, half_angle=1.9),
    "equisolid": panorama(EQUISOLID, half_angle=1.7),
    "polynomial": panorama(POLYNOMIAL, half_angle=1.6, polynomial=(1e-5, 2.5, 0.4, -0.8, 0.5)),
    "falling polynomial": panorama(POLYNOMIAL, half_angle=1.6, polynomial=(-1e-5, -2.5, -0.4, 0.8, -0.5)),
    "mirror ball": panorama(MIRROR_BALL),
    "cube face": panorama(CUBE_FACE),
    "cylindrical": panorama(CYLINDRICAL, longitude=(-1.0, 2.0), latitude=(-0.5, 1.2)),
}
ALL = {
    **PANORAMAS,
    **{
        f"{name}, window": replace(c, window=(0.2, 0.1, 0.9, 0.8), clip_start=0.3, clip_end=40.0)
        for name, c in PANORAMAS.items()
    },
}


def expected_directions(camera: Camera, film: Array) -> tuple[Array, Array]:
    """By the definition of each kind: (n, 3) right, up, forward, and whether anything is seen, (n)."""
    x0, y0, x1, y1 = camera.window
    u, v = x0 + film[:, 0] * (x1 - x0), 1.0 - (y0 + film[:, 1] * (y1 - y0))
    seen: Array = np.ones(len(film), bool)
    if camera.panorama in (EQUIRECTANGULAR, CYLINDRICAL):
        (left, right), (bottom, top) = camera.longitude, camera.latitude
        across, up = left + u * (right - left), bottom + v * (top - bottom)
        if camera.panorama == CYLINDRICAL:
            up = np.arctan(up)
        return np.stack([np.sin(across) * np.cos(up), np.sin(up), np.cos(across) * np.cos(up)], 1), seen
    if camera.panorama == CUBE_FACE:
        d = np.stack([np.tan((u - 0.5) * pi / 2), np.tan((v - 0.5) * pi / 2), np.ones_like(u)], 1)
        return d / np.linalg.norm(d, axis=1)[:, None], seen
    if camera.panorama == MIRROR_BALL:
        x, y = 2 * u - 1, 2 * v - 1
        z = np.sqrt(np.maximum(1 - x * x - y * y, 0))
        return np.stack([2 * z * x, 2 * z * y, 2 * z * z - 1], 1), x * x + y * y <= 1
    scale = (2.0, 2.0) if camera.panorama == EQUIDISTANT else (1.0, camera.aspect)
    x, y = (u - 0.5) * scale[0], (v - 0.5) * scale[1]
    r = np.hypot(x, y)
    if camera.panorama == EQUIDISTANT:
        angle, seen = r * camera.half_angle, r <= 1
    elif camera.panorama == EQUISOLID:
        angle = 2 * np.arcsin(np.minimum(r / (2 * camera.focal_length), 1))
        seen = r <= 2 * camera.focal_length * np.sin(camera.half_angle / 2)
    else:
        angle = np.polyval(camera.polynomial[::-1], r)
        seen = np.abs(angle) <= camera.half_angle
    return np.stack([x / r * np.sin(angle), y / r * np.sin(angle), np.cos(angle)], 1), seen


@pytest.mark.parametrize("name", ALL)
def test_rays_go_where_each_kind_says(name: str) -> None:
    camera, film = ALL[name], np.random.default_rng(1).uniform(0, 1, (COUNT, 2))
    expected, seen = expected_directions(camera, film)
    np.testing.assert_array_equal(probe.is_seeing(camera, film), seen)
    assert seen.mean() > 0.2
    rays = probe.generate(camera, film, np.zeros((COUNT, 2)))[seen]
    np.testing.assert_allclose(rays[:, 3:6] @ AXES.T, expected[seen], atol=1e-5)
    np.testing.assert_allclose(rays[:, :3], rays[:, 3:6] * camera.clip_start, atol=1e-6)
    np.testing.assert_allclose(rays[:, 6], camera.clip_end - camera.clip_start, rtol=1e-6)


@pytest.mark.parametrize("name", ALL)
def test_projection_is_the_inverse(name: str) -> None:
    camera, rng = ALL[name], np.random.default_rng(2)
    film = rng.uniform(0.001, 0.999, (COUNT, 2))
    seen = probe.is_seeing(camera, film)
    rays = probe.generate(camera, film, np.zeros((COUNT, 2)))
    t = rng.uniform(0.5, 20, COUNT)
    at = probe.project(camera, points(rays, t), np.zeros((COUNT, 2)))
    sure = seen & probe.is_seeing(camera, (film - 0.5) * 1.01 + 0.5)  # rounding decides at the edge of a circle
    assert at.seen[sure].all()
    for k in np.flatnonzero(sure)[:500]:
        # By the nearest of its places, since windows show some directions twice; poles are wide, not far.
        apart = np.abs(probe.places(camera, at.film[k]) - film[k]).max(axis=1).min()
        assert apart * np.sqrt(min(at.area[k] / t[k] ** 2, 1)) < 3e-4, (film[k], at.film[k])
    np.testing.assert_allclose(at.rays[sure, :6], rays[sure, :6], atol=2e-5)
    np.testing.assert_allclose(at.rays[sure, 6], t[sure], rtol=1e-5)
    # And a direction that the film does not show is not found on it.
    other = rng.normal(size=(COUNT, 3)) * 5
    at = probe.project(camera, other, np.zeros((COUNT, 2)))
    inside = (at.seen == 1) & (at.film > 0).all(axis=1) & (at.film < 1).all(axis=1)
    back = probe.generate(camera, at.film[inside], np.zeros((inside.sum(), 2)))
    way = other[inside] / np.linalg.norm(other[inside], axis=1)[:, None]
    told = way @ AXES[2] > -0.99  # all of a mirror ball's edge looks straight back
    np.testing.assert_allclose(back[told, 3:6], way[told], atol=3e-4)


@pytest.mark.parametrize("name", ALL)
def test_solid_angles_are_what_neighbouring_rays_span(name: str) -> None:
    camera, rng = ALL[name], np.random.default_rng(3)
    film, step = rng.uniform(0.05, 0.95, (COUNT, 2)), 2e-3
    sides = [
        probe.generate(camera, film + s * step * side, np.zeros((COUNT, 2))) for side in np.eye(2) for s in (1, -1)
    ]
    seen = np.all([probe.is_seeing(camera, film + s * step * side) for side in np.eye(2) for s in (1, -1)], axis=0)
    right, left, below, above = (rays[:, 3:6].astype(np.float64) for rays in sides)
    spanned = np.linalg.norm(np.cross(right - left, below - above), axis=1) / (4 * step * step)
    middle = probe.generate(camera, film, np.zeros((COUNT, 2)))
    area = probe.project(camera, points(middle, np.full(COUNT, 3.0 - camera.clip_start)), np.zeros((COUNT, 2))).area / 9
    whole = spanned[seen] > 0.02 * np.median(spanned[seen])
    whole &= middle[seen, 3:6] @ AXES[2] > -0.95  # near a mirror ball's edge the steps are too long
    assert whole.mean() > 0.9
    np.testing.assert_allclose(area[seen][whole], spanned[seen][whole], rtol=2e-2)


@pytest.mark.parametrize("away", [0.7, 3.5, 4.0005, 12.0])
@pytest.mark.parametrize("blades", [0, 3])
@pytest.mark.parametrize("name", ["equirectangular", "equisolid", "cube face", "polynomial"])
def test_a_lens_sees_as_much_by_rays_as_by_projection(name: str, blades: int, away: float) -> None:
    """What the film receives of a small glowing ball, from the camera's side and from the ball's."""
    camera = replace(PANORAMAS[name], lens_radius=0.5, focus_distance=4.0)
    if blades:
        camera = replace(camera, blades=blades, rotation=0.3, scale=(1.0, 0.7))
    rng, count, width = np.random.default_rng(4), 400_000, 0.15 * away
    center = AXES.T @ (np.array([0.5, 0.3, 0.8]) / np.linalg.norm([0.5, 0.3, 0.8])) * away
    # The film about the ball, so that few rays miss.
    at = probe.project(camera, [center], np.zeros((1, 2))).film[0]
    film = at + rng.uniform(-0.25, 0.25, (count, 2))
    film = film[(film > 0).all(axis=1) & (film < 1).all(axis=1)]
    seeing = probe.is_seeing(camera, film)
    rays = probe.generate(camera, film, disk(rng, len(film))).astype(np.float64)
    way = center - rays[:, :3]
    along = (way * rays[:, 3:6]).sum(axis=1)
    apart = np.linalg.norm(way - along[:, None] * rays[:, 3:6], axis=1)
    from_camera = np.exp(-0.5 * (apart / width) ** 2) / (2 * pi * width**2) * seeing  # the integral along the ray
    x = (center + rng.normal(size=(count, 3)) * width).astype(np.float32)
    found = probe.project(camera, x, disk(rng, count))
    inside = (found.seen == 1) & (np.abs(found.film - at) < 0.25).all(axis=1) & (found.film > 0).all(axis=1)
    inside &= (found.film < 1).all(axis=1)
    from_ball = np.where(inside, 1 / np.where(inside, found.area, 1), 0)
    share = len(film) / count * 0.25  # of the film that the first half has sampled
    expected, got = from_camera.mean() * share, from_ball.mean()
    error = np.hypot(from_camera.std() * share / np.sqrt(len(film)), from_ball.std() / np.sqrt(count))
    assert error < 0.02 * expected
    assert abs(got - expected) < 4.5 * error + 2e-3 * expected


def test_places_beyond_the_edges_show_the_same() -> None:
    camera = PANORAMAS["equirectangular"]
    for film in ((0.99, 0.4), (0.3, 0.01), (0.7, 0.98)):
        found = probe.places(camera, film)
        near = found[(np.abs(found - 0.5) < 0.6).all(axis=1)]
        assert len(near) >= 2
        rays = probe.generate(camera, near, np.zeros((len(near), 2)))
        np.testing.assert_allclose(rays[:, 3:6], np.broadcast_to(rays[0, 3:6], (len(near), 3)), atol=5e-6)


def test_what_is_seen_several_times_is_known() -> None:
    for name, camera in ALL.items():
        assert probe.is_invertible(camera), name
    assert not probe.is_invertible(panorama(EQUIDISTANT, half_angle=4.0))
    assert not probe.is_invertible(panorama(POLYNOMIAL, polynomial=(0.0, 2.0, -3.0, 0.0, 0.0)))
    assert not probe.is_invertible(panorama(POLYNOMIAL, polynomial=(-0.2, 2.0, 0.0, 0.0, 0.0)))
    assert not probe.is_invertible(panorama(CYLINDRICAL, longitude=(-30.0, 30.0)))
