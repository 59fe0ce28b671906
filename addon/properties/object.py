# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"

import bpy


class GlimmerObjectSettings(bpy.types.PropertyGroup):
    """What Glimmer knows of an object beyond Blender."""

    is_sphere: bpy.props.BoolProperty(
        name="Analytic Sphere",
        description="Render this mesh sphere as an exact sphere: smooth at any distance, and quick to light with."
        " Its vertices must lie on a sphere that its faces follow, and its scale must be uniform; else it is rendered"
        " as a mesh, and the report says so",
        default=False,
    )
