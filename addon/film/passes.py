# SPDX-License-Identifier: GPL-3.0-or-later
"""The passes, once: this table drives the switches in the panel, what is asked of the engine, what is registered with
Blender, and what is handed over."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from . import cryptomatte

Pixels = NDArray[np.float32]

# Since this version Blender spells names out that it abbreviated.
LONG_NAMES = (5, 0)


@dataclass(frozen=True)
class RenderPass:
    engine_name: str  # as in --aov
    short_name: str  # of the compositor's socket and the layer in a multilayer EXR, before Blender 5.0
    channels: str  # Blender's
    kind: str  # Blender's: COLOR, VECTOR, VALUE
    long_name: str = ""  # since then, where it is another
    builtin: str = ""  # Blender's own switch on the view layer, if it has one
    cycles: str = ""  # Cycles' own switch on its settings of the view layer, which are not there without it
    help: str = ""  # for the switch that we add where there is none
    matte: str = ""  # of what kind of name it is a Cryptomatte, and the how manieth of its passes
    layer: int = 0
    color: str = ""  # the engine's pass that Blender's light is divided by: it shows what falls on a white surface

    @property
    def switch(self) -> str:
        """The name of the switch: an attribute of its owner."""
        return self.builtin or self.cycles or f"use_{self.engine_name}"

    @property
    def is_ours(self) -> bool:
        return not self.builtin and not self.cycles

    def owner(self, view_layer: object) -> object | None:
        """What has the switch: the view layer, Cycles' settings of it, or ours."""
        if self.builtin:
            return view_layer
        return getattr(view_layer, "cycles" if self.cycles else "glimmer", None)

    def is_on(self, view_layer: object) -> bool:
        return bool(getattr(self.owner(view_layer), self.switch, False))

    def name(self, version: tuple[int, ...]) -> str:
        """version: Blender's."""
        return self.long_name if self.long_name and version >= LONG_NAMES else self.short_name

    @property
    def engine_names(self) -> tuple[str, ...]:
        return (self.engine_name, self.color) if self.color else (self.engine_name,)


COMBINED = RenderPass("combined", "Combined", "RGBA", "COLOR")
ALPHA = "alpha"  # the engine's pass that the fourth channel of Combined is


def _light(lobe: str, short: str) -> tuple[RenderPass, ...]:
    """Blender's three passes of one kind of scattering."""
    parts = (("direct", "Dir", "Direct"), ("indirect", "Ind", "Indirect"), ("color", "Col", "Color"))
    return tuple(
        RenderPass(
            f"{lobe}_{part}",
            short + ending,
            "RGB",
            "COLOR",
            long_name=f"{lobe.capitalize()} {word}",
            builtin=f"use_pass_{lobe}_{part}",
            color="" if part == "color" else f"{lobe}_color",
        )
        for part, ending, word in parts
    )


OPTIONAL: tuple[RenderPass, ...] = (
    RenderPass("depth", "Depth", "Z", "VALUE", builtin="use_pass_z"),
    RenderPass("mist", "Mist", "Z", "VALUE", builtin="use_pass_mist"),
    RenderPass("position", "Position", "XYZ", "VECTOR", builtin="use_pass_position"),
    RenderPass("normal", "Normal", "XYZ", "VECTOR", builtin="use_pass_normal"),
    RenderPass("uv", "UV", "UVA", "VECTOR", builtin="use_pass_uv"),
    RenderPass("object_index", "IndexOB", "X", "VALUE", "Object Index", builtin="use_pass_object_index"),
    RenderPass("material_index", "IndexMA", "X", "VALUE", "Material Index", builtin="use_pass_material_index"),
    *_light("diffuse", "Diff"),
    *_light("glossy", "Gloss"),
    *_light("transmission", "Trans"),
    RenderPass("volume_direct", "VolumeDir", "RGB", "COLOR", "Volume Direct", cycles="use_pass_volume_direct"),
    RenderPass("volume_indirect", "VolumeInd", "RGB", "COLOR", "Volume Indirect", cycles="use_pass_volume_indirect"),
    RenderPass("emit", "Emit", "RGB", "COLOR", "Emission", builtin="use_pass_emit"),
    RenderPass("environment", "Env", "RGB", "COLOR", "Environment", builtin="use_pass_environment"),
    RenderPass("ambient_occlusion", "AO", "RGB", "COLOR", "Ambient Occlusion", builtin="use_pass_ambient_occlusion"),
    RenderPass("stderr", "Standard Error", "RGB", "COLOR", help="Standard error of the mean of every pixel"),
    RenderPass("albedo", "Albedo", "RGB", "COLOR", help="Colour of the first surface that is no mirror or glass"),
    RenderPass("emission", "Seen Emission", "RGB", "COLOR", help="Light seen directly, also through mirrors and glass"),
    RenderPass("direct", "Direct", "RGB", "COLOR", help="Light scattered once, by a surface"),
    RenderPass("indirect", "Indirect", "RGB", "COLOR", help="Light scattered more than once, first by a surface"),
    RenderPass("fog", "Fog", "RGB", "COLOR", help="Light that the fog scattered last before it came to the camera"),
    RenderPass("sample_count", "Sample Count", "X", "VALUE", help="Samples of every pixel"),
    # What denoisers are fed with has a switch in Cycles' panel.
    RenderPass("combined", "Noisy Image", "RGBA", "COLOR", cycles="denoising_store_passes"),
    RenderPass("albedo", "Denoising Albedo", "RGB", "COLOR", cycles="denoising_store_passes"),
    RenderPass("normal", "Denoising Normal", "XYZ", "VECTOR", cycles="denoising_store_passes"),
    RenderPass("depth", "Denoising Depth", "Z", "VALUE", cycles="denoising_store_passes"),
)

# The engine keeps so many.
MOST_LEVELS, MOST_LIGHT_GROUPS, MOST_AOVS = 16, 16, 8

# Blender's and Cycles' switches of passes that there are none of, and what they are called.
MISSING = {
    "use_pass_vector": "Vector",
    "use_pass_shadow": "Shadow",
    "use_pass_subsurface_direct": "Subsurface Direct",
    "use_pass_subsurface_indirect": "Subsurface Indirect",
    "use_pass_subsurface_color": "Subsurface Color",
}
MISSING_OF_CYCLES = {
    "use_pass_shadow_catcher": "Shadow Catcher",
    "use_pass_volume_scatter": "Volume Scatter",
    "use_pass_volume_transmit": "Volume Transmit",
    "use_pass_volume_majorant": "Volume Majorant",
    "pass_debug_sample_count": "Debug Sample Count",
    "pass_render_time": "Render Time",
}


NOISY = next(item for item in OPTIONAL if item.short_name == "Noisy Image")
DENOISED_BY = ("albedo", "normal")  # what the engine is asked for besides the picture where that is to be denoised


def enabled(view_layer: object, is_denoised: bool = False) -> tuple[RenderPass, ...]:
    """The passes that a view layer asks for, combined first. is_denoised: the picture as it was rendered is one."""
    switched = (item for item in OPTIONAL if item.is_on(view_layer) or (is_denoised and item is NOISY))
    return (COMBINED, *switched, *_mattes(view_layer), *_light_groups(view_layer), *_aovs(view_layer))


def _mattes(view_layer: object) -> Iterable[RenderPass]:
    levels = min(getattr(view_layer, "pass_cryptomatte_depth", 0), MOST_LEVELS)
    for kind in cryptomatte.KINDS:
        if getattr(view_layer, f"use_pass_cryptomatte_{kind}", False):
            engine_name = "material_matte" if kind == "material" else "object_matte"
            for i in range(-(-levels // cryptomatte.RANKS_A_LAYER)):
                yield RenderPass(engine_name, f"Crypto{kind.capitalize()}{i:02d}", "rgba", "COLOR", matte=kind, layer=i)


def light_groups(view_layer: object) -> list[str]:
    """Their names, in the order of the engine's numbers, which count from 1."""
    return [group.name for group in getattr(view_layer, "lightgroups", ())][:MOST_LIGHT_GROUPS]


def _light_groups(view_layer: object) -> Iterable[RenderPass]:
    for i, name in enumerate(light_groups(view_layer)):
        yield RenderPass(f"light_group_{i + 1}", f"Combined_{name}", "RGB", "COLOR")


def _aovs(view_layer: object) -> Iterable[RenderPass]:
    for i, aov in enumerate(list(getattr(view_layer, "aovs", ()))[:MOST_AOVS]):
        channels, kind = ("RGBA", "COLOR") if aov.type == "COLOR" else ("X", "VALUE")
        yield RenderPass(f"aov_{i + 1}", aov.name, channels, kind)


def missing(view_layer: object) -> list[str]:
    """The names of passes that a view layer asks for and that are not rendered."""
    cycles = getattr(view_layer, "cycles", None)
    names = [name for switch, name in MISSING.items() if getattr(view_layer, switch, False)]
    names += [name for switch, name in MISSING_OF_CYCLES.items() if getattr(cycles, switch, False)]
    groups = [group.name for group in getattr(view_layer, "lightgroups", ())]
    names += [f"light group '{name}' (of {MOST_LIGHT_GROUPS} at most)" for name in groups[MOST_LIGHT_GROUPS:]]
    aovs = [aov.name for aov in getattr(view_layer, "aovs", ())]
    return names + [f"shader AOV '{name}' (of {MOST_AOVS} at most)" for name in aovs[MOST_AOVS:]]


def engine_names(items: Iterable[RenderPass]) -> tuple[str, ...]:
    """The passes to ask of the engine, each once."""
    return tuple(dict.fromkeys(name for item in items for name in item.engine_names))


def without_color(light: Pixels, color: Pixels) -> Pixels:
    """light / color, as Cycles divides: a channel without colour takes the mean of those that have some."""
    has = color != 0.0
    shown = np.divide(light, color, out=np.zeros_like(light), where=has)
    mean = shown.sum(axis=-1, keepdims=True) / np.maximum(has.sum(axis=-1, keepdims=True), 1)
    return np.where(has, shown, mean).astype(np.float32)


def with_alpha(pixels: Pixels, alpha: Pixels | None) -> Pixels:
    """(height, width, 3), (height, width, 1) or none for an opaque picture -> (height, width, 4)"""
    result = np.ones((*pixels.shape[:2], 4), np.float32)
    result[..., :3] = pixels
    if alpha is not None:
        result[..., 3:] = np.clip(alpha, 0.0, 1.0)
    return result


def flat(pixels: Pixels) -> Pixels:
    """Rows from the top as Blender's array, which begins at the bottom."""
    return np.ascontiguousarray(pixels[::-1], np.float32).reshape(-1)


@dataclass(frozen=True)
class Reader:
    """Makes Blender's passes from the engine's."""

    read: Callable[[str], Pixels]  # (height, width, channels) of a pass of the engine, top row first
    has_alpha: bool = False
    material_indices: NDArray[np.float32] | None = None  # Blender's; the engine's numbers count from 1, 0 is none
    to_camera: NDArray[np.floating] | None = None  # (3, 3), of directions in the world
    names: cryptomatte.Names = field(default_factory=cryptomatte.Names)
    denoised: Pixels | None = None  # R G B in place of the engine's
    picture: Pixels | None = None  # (height, width, 4), in place of the engine's
    ranks: dict[str, cryptomatte.Ranks] = field(default_factory=dict)  # of each kind of name, once it was asked for

    def shown(self) -> Pixels:
        """The picture, (height, width, 4)."""
        if self.picture is not None:
            return self.picture
        if self.denoised is None:
            return self.combined()
        return with_alpha(self.denoised, self.read(ALPHA) if self.has_alpha else None)

    def combined(self) -> Pixels:
        return with_alpha(self.read(COMBINED.engine_name), self.read(ALPHA) if self.has_alpha else None)

    def pixels(self, item: RenderPass) -> Pixels:
        """(height, width, channels), top row first."""
        if item.engine_name == COMBINED.engine_name:
            return self.combined()
        if item.matte:
            return self._matte(item)
        values = self.read(item.engine_name)
        if item.channels == "X" and values.shape[-1] > 1:  # an AOV that is a number
            return np.ascontiguousarray(values[..., :1])
        if item.color:
            return without_color(values, self.read(item.color))
        if item.engine_name == "material_index" and self.material_indices is not None:
            return self.material_indices[np.clip(values.astype(np.int64), 0, len(self.material_indices) - 1)]
        if item.short_name == "Denoising Normal" and self.to_camera is not None:
            return (values @ self.to_camera.T).astype(np.float32)
        return values

    def _matte(self, item: RenderPass) -> Pixels:
        if item.matte not in self.ranks:
            self.ranks[item.matte] = cryptomatte.ranks(self.read(item.engine_name), self.names.of(item.matte))
        return cryptomatte.layer(self.ranks[item.matte], item.layer)


def hand_over(
    layer_passes: Iterable[tuple[str, int]],
    asked: Iterable[RenderPass],
    shape: tuple[int, int],
    reader: Reader,
    is_final: bool,
) -> Pixels:
    """One flat array for all passes of a Blender render layer, in their order.

    layer_passes: Blender's names and channel counts. asked: what the engine was asked for. shape: (height, width).
    Before the end, and for passes that are not ours, zeros stand in for all but the picture.
    """
    by_name = {name: item for item in asked for name in (item.short_name, item.long_name) if name}
    parts: list[Pixels] = []
    for name, count in layer_passes:
        if name == COMBINED.short_name:
            parts.append(flat(reader.shown()))
        elif is_final and name in by_name:
            parts.append(flat(reader.pixels(by_name[name])))
        else:
            parts.append(np.zeros(shape[0] * shape[1] * count, np.float32))
    return parts[0] if len(parts) == 1 else np.concatenate(parts)
