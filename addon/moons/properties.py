# SPDX-License-Identifier: GPL-3.0-or-later
"""`Object.glimmer_moon`: the radius of a moon, which is its scale seen as one number."""

from typing import Any

import bpy

from ..callbacks import of_group, of_group_and


def _radius(group: Any) -> float:
    return float(max(abs(scale) for scale in group.id_data.scale))


def _set_radius(group: Any, radius: float) -> None:
    group.id_data.scale = (radius,) * 3


class GlimmerMoon(bpy.types.PropertyGroup):
    radius: bpy.props.FloatProperty(  # type: ignore[valid-type]
        name="Radius",
        description="The scale of the moon; to animate it, animate the scale",
        min=1e-4,
        soft_max=100,
        unit="LENGTH",
        get=of_group(_radius),
        set=of_group_and(_set_radius),
        options=set(),
    )


def register() -> None:
    bpy.utils.register_class(GlimmerMoon)
    bpy.types.Object.glimmer_moon = bpy.props.PointerProperty(type=GlimmerMoon, name="Moon")


def unregister() -> None:
    del bpy.types.Object.glimmer_moon
    bpy.utils.unregister_class(GlimmerMoon)
