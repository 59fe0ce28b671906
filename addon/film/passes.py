# SPDX-License-Identifier: GPL-3.0-or-later
"""The passes, once: this table drives the switches in the panel, what is asked of the engine, what is registered with
Blender, and what is handed over."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Pixels = NDArray[np.float32]


@dataclass(frozen=True)
class RenderPass:
    engine_name: str  # as in --aov
    blender_name: str  # of the compositor's socket and the layer in a multilayer EXR
    channels: str  # Blender's
    kind: str  # Blender's: COLOR, VECTOR, VALUE
    builtin: str = ""  # Blender's own switch on the view layer, if it has one
    help: str = ""  # for the switch that we add where it has none

    @property
    def switch(self) -> str:
        """The name of the switch: an attribute of the view layer, or of its `glimmer` group."""
        return self.builtin or f"use_{self.engine_name}"

    def is_on(self, view_layer: object) -> bool:
        owner = view_layer if self.builtin else getattr(view_layer, "glimmer", None)
        return bool(getattr(owner, self.switch, False))


COMBINED = RenderPass("combined", "Combined", "RGBA", "COLOR")

OPTIONAL: tuple[RenderPass, ...] = (
    RenderPass("depth", "Depth", "Z", "VALUE", builtin="use_pass_z"),
    RenderPass("normal", "Normal", "XYZ", "VECTOR", builtin="use_pass_normal"),
    RenderPass("object_index", "IndexOB", "X", "VALUE", builtin="use_pass_object_index"),
    RenderPass("material_index", "IndexMA", "X", "VALUE", builtin="use_pass_material_index"),
    RenderPass("emission", "Emit", "RGB", "COLOR", builtin="use_pass_emit"),
    RenderPass("stderr", "Standard Error", "RGB", "COLOR", help="Standard error of the mean of every pixel"),
    RenderPass("albedo", "Albedo", "RGB", "COLOR", help="Colour of the first surface that is no mirror or glass"),
    RenderPass("direct", "Direct", "RGB", "COLOR", help="Light scattered once, by a surface"),
    RenderPass("indirect", "Indirect", "RGB", "COLOR", help="Light scattered more than once, first by a surface"),
    RenderPass("fog", "Fog", "RGB", "COLOR", help="Light that the fog scattered last before it came to the camera"),
    RenderPass("sample_count", "Sample Count", "X", "VALUE", help="Samples of every pixel"),
)


def enabled(view_layer: object) -> tuple[RenderPass, ...]:
    """The passes that a view layer asks for, combined first."""
    return (COMBINED, *(item for item in OPTIONAL if item.is_on(view_layer)))


def engine_channels(item: RenderPass) -> int:
    """How many channels the engine gives: it knows no alpha."""
    return min(len(item.channels), 3)


def to_blender(item: RenderPass, pixels: Pixels, material_indices: NDArray[np.float32] | None = None) -> Pixels:
    """(height, width, channels) of the engine, top row first, as Blender's flat array, bottom row first.

    material_indices: Blender's index for each of the engine's numbers, which count from 1; 0 is no material.
    """
    flipped = pixels[::-1]
    if item is COMBINED:
        opaque = np.ones((*flipped.shape[:2], 4), np.float32)
        opaque[..., :3] = flipped
        flipped = opaque
    elif item.engine_name == "material_index" and material_indices is not None:
        numbers = np.clip(flipped.astype(np.int64), 0, len(material_indices) - 1)
        flipped = material_indices[numbers]
    return np.ascontiguousarray(flipped, np.float32).reshape(-1)


def hand_over(
    layer_passes: Iterable[str],
    shape: tuple[int, int],
    read: Callable[[RenderPass], Pixels] | None,
    combined: Pixels,
    material_indices: NDArray[np.float32] | None = None,
    channels: Iterable[int] = (),
) -> Pixels:
    """One flat array for all passes of a Blender render layer, in their order.

    layer_passes, channels: Blender's names and channel counts. shape: (height, width). read gives any other pass of
    the engine; without it, and for passes that are not ours, zeros stand in.
    """
    by_name = {item.blender_name: item for item in OPTIONAL}
    parts: list[Pixels] = []
    for name, count in zip(layer_passes, channels, strict=True):
        if name == COMBINED.blender_name:
            parts.append(to_blender(COMBINED, combined))
        elif read is not None and name in by_name:
            parts.append(to_blender(by_name[name], read(by_name[name]), material_indices))
        else:
            parts.append(np.zeros(shape[0] * shape[1] * count, np.float32))
    return parts[0] if len(parts) == 1 else np.concatenate(parts)
