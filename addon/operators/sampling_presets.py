# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""Presets of sampling: three to begin with, and what an artist keeps."""

from typing import Any, ClassVar

import bpy
from bl_operators.presets import AddPresetBase

PRESETS: dict[str, dict[str, Any]] = {
    "DRAFT": {"use_samples": True, "samples": 16, "use_target_error": False},
    "GOOD": {"use_samples": True, "samples": 128, "use_target_error": False},
    "FINAL": {"use_samples": False, "use_target_error": True, "target_error": 0.03**2},
}
_ITEMS = (
    ("DRAFT", "Draft", "16 samples"),
    ("GOOD", "Good", "128 samples"),
    ("FINAL", "Final", "As many samples as it takes until the noise is surely below 3 %"),
)


class GLIMMER_OT_sampling_preset(bpy.types.Operator):
    """Set how long pictures are rendered"""

    bl_idname = "render.glimmer_sampling_preset"
    bl_label = "Sampling Preset"
    bl_options = {"REGISTER", "UNDO", "INTERNAL"}

    kind: bpy.props.EnumProperty(name="Preset", items=_ITEMS)

    def execute(self, context: bpy.types.Context) -> set[str]:
        for name, value in PRESETS[self.kind].items():
            setattr(context.scene.glimmer, name, value)
        return {"FINISHED"}


class GLIMMER_OT_sampling_preset_add(AddPresetBase, bpy.types.Operator):
    """Keep these settings of sampling as a preset, or remove one"""

    bl_idname = "render.glimmer_sampling_preset_add"
    bl_label = "Add Sampling Preset"
    preset_menu = "GLIMMER_PT_sampling_presets"
    preset_subdir = "glimmer/sampling"
    preset_defines: ClassVar[list[str]] = ["settings = bpy.context.scene.glimmer"]
    preset_values: ClassVar[list[str]] = [
        f"settings.{name}"
        for name in (
            "viewport_samples",
            "use_target_error",
            "target_error",
            "use_samples",
            "samples",
            "use_seconds",
            "seconds",
            "use_adaptive",
        )
    ]


_CLASSES = (GLIMMER_OT_sampling_preset, GLIMMER_OT_sampling_preset_add)

register, unregister = bpy.utils.register_classes_factory(_CLASSES)
