# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""Fields to begin with: what their plates and hills look like. All else of a field stays."""

import dataclasses
import math
from typing import Any

import bpy

from . import properties
from .parameters import FieldParameters

# In terms of a plate of radius 1; lengths grow with the plates of the field that is changed.
PRESETS: dict[str, dict[str, Any]] = {
    "PAVEMENT": {"gap": 0.03, "hill_height": 0.0, "mutation_height": 0.02, "mutation_tilt": math.radians(0.6)},
    "HILLS": {},
    "TERRACES": {
        "thickness": 3.0,
        "hill_height": 8.0,
        "hill_wavelength": 50.0,
        "hill_octaves": 2,
        "mutation_height": 0.0,
        "mutation_tilt": 0.0,
    },
    "DUNES": {
        "gap": 0.04,
        "hill_height": 10.0,
        "hill_wavelength": 60.0,
        "hill_octaves": 4,
        "hill_follow": 0.7,
        "mutation_tilt": math.radians(4.0),
    },
    "SHATTERED": {
        "thickness": 1.2,
        "mutation_height": 0.5,
        "mutation_tilt": math.radians(14.0),
        "mutation_turn": math.radians(8.0),
        "mutation_size": 0.3,
        "mutation_shape": 0.12,
        "mutation_bevel": 0.3,
        "prototypes": 16,
    },
}
_ITEMS = (
    ("PAVEMENT", "Pavement", "Level plates, close to each other"),
    ("HILLS", "Hills", "Low hills in steps: a new field"),
    ("TERRACES", "Terraces", "Tall, clean steps"),
    ("DUNES", "Dunes", "Plates that lean with high hills"),
    ("SHATTERED", "Shattered", "Broken plates that lean every way"),
)
_LENGTHS = ("gap", "thickness", "hill_height", "hill_wavelength", "mutation_height")
_LOOKS = sorted({name for changes in PRESETS.values() for name in changes})


def preset(kind: str, now: FieldParameters) -> FieldParameters:
    """A field as it is now, with the looks of a preset."""
    chosen = FieldParameters(**PRESETS[kind])
    looks = {name: getattr(chosen, name) * (now.plate_radius if name in _LENGTHS else 1) for name in _LOOKS}
    return dataclasses.replace(now, **looks)


class GLIMMER_OT_hexagon_field_preset(bpy.types.Operator):
    """Give the field the looks of a preset; its size, seed and materials stay"""

    bl_idname = "glimmer.hexagon_field_preset"
    bl_label = "Hexagon Field Preset"
    bl_options = {"REGISTER", "UNDO", "INTERNAL"}

    kind: bpy.props.EnumProperty(name="Preset", items=_ITEMS)

    @classmethod
    def poll(cls, context: Any) -> bool:
        obj = context.object
        return context.mode == "OBJECT" and obj is not None and obj.type == "MESH" and obj.glimmer_field.enabled

    def execute(self, context: Any) -> set[str]:
        group = context.object.glimmer_field
        try:
            properties.write(group, preset(self.kind, properties.read(group)))
        except ValueError as error:  # plates of an extreme size
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}


def register() -> None:
    bpy.utils.register_class(GLIMMER_OT_hexagon_field_preset)


def unregister() -> None:
    bpy.utils.unregister_class(GLIMMER_OT_hexagon_field_preset)
