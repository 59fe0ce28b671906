# SPDX-License-Identifier: GPL-3.0-or-later
"""What the methods of subsurface scattering mean in each Blender."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

# From here on light enters by refraction; before, by cosine.
REFRACTED_FROM = (4, 0)

DISK = "Christensen-Burley is not supported; light walks through the object, by about the same radius"


@dataclass(frozen=True)
class Method:
    """Of the engine's Subsurface."""

    model: str
    entry: str
    is_disk: bool = False  # Christensen and Burley's, which the walk stands in for


def subsurface_method(node: Any, setting: str, version: tuple[int, ...]) -> Method:
    """setting: the node's property that names the method."""
    name = getattr(node, setting)
    if name == "BURLEY":
        return Method("fixed_radius", "diffuse", is_disk=True)
    if version < REFRACTED_FROM:
        return Method("fixed_radius" if name == "RANDOM_WALK_FIXED_RADIUS" else "skin", "diffuse")
    if name == "RANDOM_WALK_SKIN":
        return Method("skin", "both")
    # Since there is a legacy, the radius of the new one is the mean free path itself.
    methods = {item.identifier for item in node.bl_rna.properties[setting].enum_items}
    is_new = name == "RANDOM_WALK" and "RANDOM_WALK_LEGACY" in methods
    return Method("random_walk" if is_new else "fixed_radius", "refracted")


def most_backward(method: Method) -> float:
    """The least anisotropy that Cycles has for it."""
    return -0.99 if method.model == "random_walk" else 0.0


def most_forward(method: Method) -> float:
    return 0.99 if method.model == "random_walk" else 0.9
