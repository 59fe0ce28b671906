# SPDX-License-Identifier: GPL-3.0-or-later
"""What moves while the shutter is open: the scene is evaluated at several moments, and what stands elsewhere moves.

As in Cycles, whose settings these are, an object is asked for at 2^steps + 1 moments, evenly spaced from when the
shutter opens to when it closes; in between, its place, turn and stretch are interpolated one by one. The engine
interpolates matrices, so it gets them at more moments where something turns.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable
from dataclasses import dataclass, field
from math import acos, ceil, floor
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..scene.description import Camera, Floats
from ..scene.problems import Notices
from .instance import Placed

if TYPE_CHECKING:
    import bpy

SetFrame = Callable[[int, float], None]

MOST_TURN = 0.05  # radians between two matrices: a chord then leaves the circle by less than 1 / 3000 of its radius
MOST_MATRICES = 1024  # the engine's limit
WARPED = 33  # matrices where the shutter opens gradually, at least
CURVE_POINTS = 1025  # of the shutter curve's integral


@dataclass(frozen=True)
class Shutter:
    """When it is open, in frames, and how its opening goes."""

    opens: float
    closes: float
    warp: tuple[float, ...] | None = (
        None  # the part of the time after which even shares of the light are in; None: even
    )

    def frame(self, moment: float) -> float:
        return self.opens + moment * (self.closes - self.opens)

    @property
    def middle(self) -> float:
        return self.frame(0.5)


def cycles_setting(owner: Any, name: str, default: Any) -> Any:
    """One of Cycles' properties of a scene or an object; the default where Cycles is not there."""
    return getattr(getattr(owner, "cycles", None), name, default)


def shutter_interval(frame: float, duration: float, position: str) -> tuple[float, float]:
    """position: which moment of it the frame is: START, CENTER, END."""
    opens = frame - {"START": 0.0, "CENTER": 0.5, "END": 1.0}[position] * duration
    return opens, opens + duration


def read_shutter(scene: bpy.types.Scene, notices: Notices) -> Shutter | None:
    """None where nothing is blurred."""
    render = scene.render
    if not render.use_motion_blur or render.motion_blur_shutter <= 0.0:
        return None
    if cycles_setting(scene, "rolling_shutter_type", "NONE") != "NONE":
        notices.add("", "a rolling shutter is not supported; all rows are taken at the same time")
    # Blender's own from 4.2, Cycles' before.
    position = getattr(render, "motion_blur_position", None) or cycles_setting(scene, "motion_blur_position", "CENTER")
    frame = scene.frame_current + scene.frame_subframe
    return Shutter(*shutter_interval(frame, render.motion_blur_shutter, position), _warp(render))


def _warp(render: bpy.types.RenderSettings) -> tuple[float, ...] | None:
    mapping = render.motion_blur_shutter_curve
    mapping.initialize()
    curve = mapping.curves[0]
    weights = np.array([max(mapping.evaluate(curve, i / (CURVE_POINTS - 1)), 0.0) for i in range(CURVE_POINTS)])
    return shutter_warp(weights)


def shutter_warp(weights: Floats) -> tuple[float, ...] | None:
    """weights: how open it is, at moments evenly spaced. None where it is open alike, or never."""
    if np.ptp(weights) <= 1e-5 * weights.max() or not weights.max() > 0.0:
        return None
    cumulative = np.concatenate([[0.0], np.cumsum(0.5 * (weights[1:] + weights[:-1]))])
    shares = np.linspace(0.0, cumulative[-1], WARPED)
    return tuple(np.interp(shares, cumulative, np.linspace(0.0, 1.0, len(cumulative))).tolist())


def motion_steps(item: bpy.types.Object, parent: bpy.types.Object | None = None) -> int:
    """Intervals of an object's motion, of an instance with those of what it is an instance by; 0: held still."""
    owners = [item] if parent is None else [item, parent]
    if not all(cycles_setting(owner, "use_motion_blur", True) for owner in owners):
        return 0
    return int(2 ** max(cycles_setting(owner, "motion_steps", 1) for owner in owners))


@dataclass(frozen=True, eq=False)
class Motion:
    """Which of an object's places move (n,), and where to (steps, moving, 4, 4)."""

    moving: NDArray[np.bool_]
    steps: Floats


@dataclass
class Recording:
    """Where everything stands at moments evenly spaced while the shutter is open. An id stands for an object or for
    instances of a kind (see instance.Placed)."""

    shutter: Shutter
    places: list[dict[Hashable, Floats]] = field(default_factory=list)
    cameras: list[Camera] = field(default_factory=list)

    def motion_of(self, placed: Placed) -> tuple[Motion | None, bool]:
        """None where nothing moves; and whether all of it is there at all moments."""
        steps = motion_steps(placed.item, placed.instancer)
        if steps == 0:
            return None, True
        is_there, found = [], []
        for ident, matrices in placed.by_id():
            motion = self._of(ident, len(matrices), steps)
            is_there += [motion is not None] * len(matrices)
            if motion is not None:
                found.append(motion)
        if not found:
            return None, False
        motions = np.concatenate(found, axis=1)
        changes = (motions != motions[:1]).any(axis=(0, 2, 3))
        moving = np.array(is_there)
        moving[moving] = changes
        return Motion(moving, motions[:, changes]) if changes.any() else None, all(is_there)

    def _of(self, ident: Hashable, count: int, steps: int) -> Floats | None:
        """(steps + 1, count, 4, 4). None where it is not there, or another number of times, at some moment."""
        found = []
        for places in self.places[:: (len(self.places) - 1) // steps]:
            matrices = places.get(ident)
            if matrices is None or len(matrices) != count:
                return None
            found.append(matrices)
        return np.array(found)

    def cameras_of(self, steps: int) -> list[Camera]:
        return self.cameras[:: (len(self.cameras) - 1) // steps]


def record(
    shutter: Shutter,
    intervals: int,
    set_frame: SetFrame,
    look: Callable[[], tuple[dict[Hashable, Floats], Camera]],
) -> Recording:
    """look: where everything and the camera stand now. Leaves the scene at the middle of the shutter's time."""
    result = Recording(shutter)
    for moment in range(intervals + 1):
        go_to(set_frame, shutter.frame(moment / intervals))
        places, camera = look()
        result.places.append(places)
        result.cameras.append(camera)
    go_to(set_frame, shutter.middle)
    return result


def go_to(set_frame: SetFrame, frame: float) -> None:
    set_frame(floor(frame), frame - floor(frame))


def is_still(steps: Floats) -> bool:
    return bool((steps == steps[:1]).all())


def moves_as_one(steps: Floats, middle: Floats) -> Floats | None:
    """Of (steps, n, 4, 4) and the same in the middle (n, 4, 4): (steps, 4, 4) that carry all of it from there to where
    it is, None if there are none."""
    across = steps[:, 0] @ inverse(middle[0])
    size = np.abs(steps).max()
    return across if np.allclose(across[:, None] @ middle, steps, rtol=0.0, atol=1e-6 * size) else None


def inverse(matrix: Floats) -> Floats:
    """Of an affine matrix, by hand: LAPACK's last bits depend on where arrays lie in memory, and a picture must not."""
    cofactors, determinant = _cofactors(matrix[:3, :3])
    result = np.eye(4)
    result[:3, :3] = cofactors.T / determinant
    result[:3, 3] = -(result[:3, :3] * matrix[:3, 3]).sum(axis=1)
    return result


def smooth_motion(steps: Floats, shutter: Shutter) -> Floats:
    """What the engine, which interpolates matrices, needs to move as between steps (k, n, 4, 4): (m, n, 4, 4), at
    moments evenly spaced, or by the shutter's warp."""
    turns, stretches = _decompose(steps[..., :3, :3])
    cosines = np.abs((turns[1:] * turns[:-1]).sum(axis=-1))
    turn = max(2.0 * acos(min(float(cosines.min(initial=1.0)), 1.0)), 0.0)
    intervals = len(steps) - 1
    finer = ceil(turn / MOST_TURN) if turn > 1e-3 else 1
    if shutter.warp is not None:
        finer = max(finer, ceil((WARPED - 1) / intervals))
    elif finer == 1:
        return steps
    finer = min(finer, max((MOST_MATRICES - 1) // intervals, 1))
    moments = np.linspace(0.0, 1.0, finer * intervals + 1)
    if shutter.warp is not None:
        moments = np.interp(moments, np.linspace(0.0, 1.0, len(shutter.warp)), shutter.warp)
    result = np.empty((len(moments), *steps.shape[1:]))
    for out, moment in zip(result, moments, strict=True):
        first = min(int(moment * intervals), intervals - 1)
        f = moment * intervals - first
        out[:] = (1.0 - f) * steps[first] + f * steps[first + 1]
        stretch = (1.0 - f) * stretches[first] + f * stretches[first + 1]
        out[..., :3, :3] = _product(_rotation(_slerp(turns[first], turns[first + 1], f)), stretch)
    return result


def _product(a: Floats, b: Floats) -> Floats:
    return np.asarray((a[..., :, :, None] * b[..., None, :, :]).sum(axis=-2))


def _cofactors(matrix: Floats) -> tuple[Floats, Floats]:
    """Of (..., 3, 3): the matrix of cofactors, and the determinant (...)."""
    a, b, c = matrix[..., 0, :], matrix[..., 1, :], matrix[..., 2, :]
    cofactors = np.stack([np.cross(b, c), np.cross(c, a), np.cross(a, b)], axis=-2)
    return cofactors, (a * cofactors[..., 0, :]).sum(axis=-1)


def _decompose(linear: Floats) -> tuple[Floats, Floats]:
    """The polar decomposition of (..., 3, 3) into turns, quaternions (..., 4), and stretches (..., 3, 3), which hold
    the reflection if there is one (Higham 1986). What has no volume does not turn."""
    turn = np.array(linear, np.float64)
    flat = _cofactors(turn)[1] == 0.0
    turn[flat] = np.eye(3)
    for _ in range(20):
        cofactors, determinant = _cofactors(turn)
        turn = 0.5 * (turn + cofactors / determinant[..., None, None])
    turn[_cofactors(turn)[1] < 0.0] *= -1.0
    stretch = _product(np.swapaxes(turn, -1, -2), linear)
    return _quaternion(turn), stretch


def _quaternion(m: Floats) -> Floats:
    """(..., 4): w, x, y, z of rotations (..., 3, 3), from its largest component."""
    xx, yy, zz = m[..., 0, 0], m[..., 1, 1], m[..., 2, 2]
    squares = np.stack([1 + xx + yy + zz, 1 + xx - yy - zz, 1 - xx + yy - zz, 1 - xx - yy + zz], axis=-1)
    wx, wy, wz = m[..., 2, 1] - m[..., 1, 2], m[..., 0, 2] - m[..., 2, 0], m[..., 1, 0] - m[..., 0, 1]
    xy, xz, yz = m[..., 1, 0] + m[..., 0, 1], m[..., 0, 2] + m[..., 2, 0], m[..., 2, 1] + m[..., 1, 2]
    rows = np.stack(
        [
            np.stack([squares[..., 0], wx, wy, wz], axis=-1),
            np.stack([wx, squares[..., 1], xy, xz], axis=-1),
            np.stack([wy, xy, squares[..., 2], yz], axis=-1),
            np.stack([wz, xz, yz, squares[..., 3]], axis=-1),
        ],
        axis=-2,
    )
    largest = squares.argmax(axis=-1)
    row = np.take_along_axis(rows, largest[..., None, None], axis=-2)[..., 0, :]
    return np.asarray(row / np.sqrt((row**2).sum(axis=-1, keepdims=True)))


def _slerp(a: Floats, b: Floats, f: float) -> Floats:
    cosine = (a * b).sum(axis=-1, keepdims=True)
    b = np.where(cosine < 0.0, -b, b)
    angle = np.arccos(np.minimum(np.abs(cosine), 1.0))
    sine = np.sin(angle)
    even = sine < 1e-6
    safe = np.where(even, 1.0, sine)
    from_a = np.where(even, 1.0 - f, np.sin((1.0 - f) * angle) / safe)
    from_b = np.where(even, f, np.sin(f * angle) / safe)
    mixed = from_a * a + from_b * b
    return np.asarray(mixed / np.sqrt((mixed**2).sum(axis=-1, keepdims=True)))


def _rotation(q: Floats) -> Floats:
    w, x, y, z = (q[..., i] for i in range(4))
    return np.stack(
        [
            np.stack([1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)], axis=-1),
            np.stack([2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)], axis=-1),
            np.stack([2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)], axis=-1),
        ],
        axis=-2,
    )
