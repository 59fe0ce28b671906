# SPDX-License-Identifier: GPL-3.0-or-later
"""`World.glimmer_haze`: how far one sees, which is the density of the haze's node seen as a distance."""

from typing import Any

import bpy

from ..callbacks import of_group, of_group_and
from . import nodes
from .visual_range import density, visual_range

FARTHEST = 1e6


def _range(group: Any) -> float:
    node = nodes.node_of(group.id_data)
    return FARTHEST if node is None else min(visual_range(node.inputs["Density"].default_value), FARTHEST)


def _set_range(group: Any, value: float) -> None:
    node = nodes.node_of(group.id_data)
    if node is not None:
        node.inputs["Density"].default_value = density(value)


class GlimmerHaze(bpy.types.PropertyGroup):
    visual_range: bpy.props.FloatProperty(  # type: ignore[valid-type]
        name="Visual Range",
        description="How far away a dark object can still be told from the haze. To animate it, animate the density of"
        " the haze's node",
        min=0.01,
        max=FARTHEST,
        soft_min=1.0,
        soft_max=10000.0,
        unit="LENGTH",
        get=of_group(_range),
        set=of_group_and(_set_range),
        options=set(),
    )


def register() -> None:
    bpy.utils.register_class(GlimmerHaze)
    bpy.types.World.glimmer_haze = bpy.props.PointerProperty(type=GlimmerHaze, name="Haze")


def unregister() -> None:
    del bpy.types.World.glimmer_haze
    bpy.utils.unregister_class(GlimmerHaze)
