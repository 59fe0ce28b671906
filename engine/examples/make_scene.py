# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes glimmervoid_small.json and plates.npy beside this file: a small world of metal plates, moons and haze.

python3 make_scene.py && glimmer glimmervoid_small.json -o glimmervoid_small.png
"""

import json
import math
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

FOLDER = Path(__file__).resolve().parent
SPACING = 1.78  # of the plates' middles, whose corners are 1 from theirs: a gap of 0.05
FOV_X = 60.0
EYE, TARGET = (0.0, -3.0, 3.2), (0.0, 40.0, 6.6)

# name: centre, radius, radiance
MOONS = {
    "red": ((-17.0, 36.0, 11.0), 4.2, (9.0, 0.16, 0.05)),
    "green": ((-6.5, 60.0, 19.0), 3.6, (0.08, 7.0, 0.45)),
    "white": ((4.5, 44.0, 13.5), 2.2, (9.0, 8.6, 8.0)),
    "blue": ((19.0, 38.0, 9.0), 4.0, (0.05, 0.5, 12.0)),
    "black": ((9.5, 27.0, 4.3), 1.9, (0.03, 0.012, 0.055)),
}


def hill(x: NDArray[np.float64], y: NDArray[np.float64]) -> NDArray[np.float64]:
    """Height of the land, in plate radii."""
    return 0.9 * np.sin(0.21 * x + 0.4) * np.sin(0.17 * y) + 0.3 * np.sin(0.47 * x - 0.38 * y)


def plates(seed: int = 4) -> NDArray[np.float32]:
    """(n, 3, 4) float32: turned, tilted with the land and a little by chance, where the camera sees them."""
    rng = np.random.default_rng(seed)
    column, row = np.meshgrid(np.arange(-30, 31), np.arange(-2, 40))
    x = SPACING * (column + 0.5 * (row % 2)).ravel()
    y = SPACING * math.sqrt(3) / 2 * row.ravel()
    seen = np.abs(x) < (y - EYE[1] + 3) * math.tan(math.radians(FOV_X / 2)) + 2
    x, y = x[seen], y[seen]
    step = 1e-3
    slope_x = (hill(x + step, y) - hill(x - step, y)) / (2 * step)
    slope_y = (hill(x, y + step) - hill(x, y - step)) / (2 * step)
    normal = np.stack([-slope_x, -slope_y, np.ones_like(x)], axis=1)
    normal[:, :2] += rng.normal(0, 0.05, (len(x), 2))
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    side = np.cross([0.0, 1.0, 0.0], normal)
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    origin = np.stack([x, y, hill(x, y) + rng.uniform(-0.12, 0.12, len(x))], axis=1)
    return np.stack([side, np.cross(normal, side), normal, origin], axis=2).astype(np.float32)


def hexagon(bevel: float = 0.1, thickness: float = 0.5) -> dict[str, list[list[float]] | list[list[int]]]:
    """A plate with its top at z = 0: 6 corners of the top, 6 below the bevel, 6 of the bottom, which stays open."""
    rings = [(1 - bevel, 0.0), (1.0, -bevel), (1.0, -thickness)]
    corners = [math.radians(60 * i + 30) for i in range(6)]
    vertices = [[round(r * math.cos(a), 6), round(r * math.sin(a), 6), z] for r, z in rings for a in corners]
    triangles = [[0, i, i + 1] for i in range(1, 5)]
    for upper in (0, 6):
        for i in range(6):
            a, b = upper + i, upper + (i + 1) % 6
            triangles += [[a, a + 6, b + 6], [a, b + 6, b]]
    return {"vertices": vertices, "triangles": triangles}


def scene() -> dict[str, object]:
    metal = {"type": "conductor", "alpha": 0.12, "eta": [2.75, 2.5, 2.25], "k": [3.35, 3.15, 2.95]}
    return {
        "glimmer": 1,
        "film": {"width": 480, "height": 270, "filter": "blackman_harris"},
        "camera": {"origin": EYE, "target": TARGET, "fov_x": FOV_X},
        "materials": {
            "plate": {"type": "mix", "weight": 0.2, "a": {"type": "lambert", "albedo": [0.45, 0.45, 0.5]}, "b": metal},
            **{name: {"type": "light", "radiance": radiance} for name, (_, _, radiance) in MOONS.items()},
        },
        "meshes": {"hexagon": hexagon()},
        "objects": [{"mesh": "hexagon", "material": "plate", "instances": "plates.npy"}],
        "spheres": [
            {"center": center, "radius": radius, "material": name} for name, (center, radius, _) in MOONS.items()
        ],
        "medium": {"sigma_a": 0.001, "sigma_s": [0.005, 0.0055, 0.0065], "g": 0},
    }


def lines(value: object, indent: str = "") -> str:
    """JSON with one entry of each table on a line."""
    if isinstance(value, dict) and len(indent) < 2:
        entries = ",\n".join(f" {indent}{json.dumps(key)}: {lines(item, indent + ' ')}" for key, item in value.items())
        return f"{{\n{entries}\n{indent}}}"
    return json.dumps(value)


if __name__ == "__main__":
    np.save(FOLDER / "plates.npy", plates())
    (FOLDER / "glimmervoid_small.json").write_text(lines(scene()) + "\n")
