# SPDX-License-Identifier: GPL-3.0-or-later
"""A white furnace: everything in it scatters all light and absorbs none, so every pixel is 1, the radiance of the wall.

blender -b --python blend_scenes/furnace.py [-- FOLDER]
"""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
import stage

WHITE = (1.0, 1.0, 1.0)


def build() -> None:
    scene = stage.clear()
    stage.picture(scene, 320, 180, samples=64)
    scene.view_settings.view_transform = "Standard"
    # A wall, as a sky behind endless fog would be black.
    stage.haze(scene, sigma_s=(0.05, 0.05, 0.05), g=0.3)
    stage.moon(scene, "Wall", WHITE, 1.0, radius=20.0, location=(0.0, 0.0, 0.0))
    lambert = stage.surface("Lambert", "ShaderNodeBsdfDiffuse", Color=WHITE)
    mirror = stage.surface("Mirror", "ShaderNodeBsdfGlossy", Color=WHITE, Roughness=0.0)
    glass = stage.surface("Glass", "ShaderNodeBsdfGlass", Color=WHITE, Roughness=0.0, IOR=1.5)
    # Flat facets: shading normals that are not the surface's own lose light, in every renderer.
    stage.field(
        scene, lambert, mirror, rings=6, hill_height=1.0, hill_wavelength=10.0, bevel_width=0.15, bevel_smooth=False
    )
    stage.sphere(scene, "Lambert Sphere", (-2.6, 0.0, 2.2), 1.0, lambert)
    stage.sphere(scene, "Mirror Sphere", (0.0, 0.0, 2.2), 1.0, mirror)
    stage.sphere(scene, "Glass Sphere", (2.6, 0.0, 2.2), 1.0, glass)
    stage.camera(scene, (0.0, -11.0, 4.0), (0.0, 0.0, 1.8), fov_x=50.0)


if __name__ == "__main__":
    build()
    stage.save(__file__)
