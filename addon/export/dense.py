# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether a world's haze is so dense that the camera sees nothing but haze."""

from __future__ import annotations

import numpy as np

from ..haze.visual_range import visual_range
from ..scene.description import AreaLight, Floats, Object, PointLight, SceneDescription, SpotLight
from ..scene.problems import Notices

# From here on less than 1 / 100 000 of the light arrives.
MOST_RANGES = 3.0


def warn_of_dense_haze(scene: SceneDescription, world: str, notices: Notices) -> None:
    medium = scene.medium
    if medium is None or medium.falloff is not None:
        return
    seen = visual_range(min(a + s for a, s in zip(*medium.constant_sigmas(), strict=True)))
    nearest = nearest_distance(scene)
    if nearest is not None and nearest > MOST_RANGES * seen:
        notices.add(
            f"world '{world}'",
            f"its haze is so dense that the camera sees nothing else: one sees {seen:.3g} m in it, and the nearest"
            f" object or lamp is {nearest:.3g} m away",
        )


def nearest_distance(scene: SceneDescription) -> float | None:
    """From the camera to what could be seen, at least: things count as balls about them. None where there are none."""
    eye = np.asarray(scene.camera.to_world, np.float64)[:3, 3]
    found = [_distance(item, eye) for item in scene.objects]
    for spheres in scene.spheres:
        if len(spheres.centers):
            found.append(float((np.linalg.norm(spheres.centers - eye, axis=1) - spheres.radii).min()))
    for lamp in scene.lights:
        if isinstance(lamp, (PointLight, SpotLight)):
            found.append(float(np.linalg.norm(np.array(lamp.position) - eye)) - lamp.radius)
        elif isinstance(lamp, AreaLight):
            place = np.asarray(lamp.to_world, np.float64)
            found.append(float(np.linalg.norm(place[:3, 3] - eye)) - 0.5 * float(np.linalg.norm(place[:3, :2])))
    return max(min(found), 0.0) if found else None


def _distance(item: Object, eye: Floats) -> float:
    low, high = item.mesh.vertices.min(axis=0), item.mesh.vertices.max(axis=0)
    middle, radius = np.append(0.5 * (low + high), 1.0), 0.5 * float(np.linalg.norm(high - low))
    places = np.asarray(item.to_world, np.float64)[None] if item.instances is None else item.to_world @ item.instances
    scales = np.linalg.norm(places[:, :3, :3], axis=(1, 2))  # no less than the largest along any axis
    return float((np.linalg.norm((places @ middle)[:, :3] - eye, axis=1) - radius * scales).min())
