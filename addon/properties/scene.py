# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"

from zlib import crc32

import bpy

from ..callbacks import of_group_and
from ..native.library import load
from ..scene.problems import GlimmerError

# A .blend file stores an integrator's number, which came from the name that it had when it was new.
_FIRST_NAMES = {"baseline": "report"}

# Blender keeps only the C strings of dynamic items, so Python has to keep their owners.
_integrator_items: list[tuple[str, str, str, int]] = []


def list_integrators(
    group: bpy.types.PropertyGroup, context: bpy.types.Context | None
) -> list[tuple[str, str, str, int]]:
    if not _integrator_items:
        try:
            known = load().integrators()
        except GlimmerError:
            return [("path", "Path", "The engine's library is missing", 0)]
        for position, (name, text) in enumerate(known):
            if "-no-" in name:  # less one estimator: for comparisons by the command line
                continue
            # The default's number is 0, the others' depend on their names, never on their order.
            number = 0 if position == 0 else crc32(_FIRST_NAMES.get(name, name).encode()) & 0x7FFFFFFF
            _integrator_items.append((name, name.replace("_", " ").title(), text, number))
    return _integrator_items


def _announce_change(group: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    """That there is a function at all makes Blender tell 3D views of what a script changes."""


_announce = of_group_and(_announce_change)


class GlimmerSceneSettings(bpy.types.PropertyGroup):
    """How a scene is rendered. The first limit that is met ends the render."""

    use_samples: bpy.props.BoolProperty(
        name="Samples", description="Stop when every pixel has this many samples", default=True
    )
    samples: bpy.props.IntProperty(
        name="Samples", description="Samples of every pixel", default=64, min=1, soft_max=65536
    )
    viewport_samples: bpy.props.IntProperty(
        name="Viewport Samples",
        description="Samples of every pixel of a 3D view in rendered shading; 0 goes on for ever",
        default=1024,
        min=0,
        soft_max=65536,
    )
    preview_pause: bpy.props.BoolProperty(
        name="Pause",
        description="Stop rendering 3D views in rendered shading; what changes is still shown, in coarse pixels",
        default=False,
        options={"SKIP_SAVE"},
        update=_announce,
    )
    use_seconds: bpy.props.BoolProperty(
        name="Time Limit", description="Stop after this render time, loading and building left out", default=False
    )
    seconds: bpy.props.FloatProperty(
        name="Time Limit", default=60.0, min=0.01, soft_max=86400.0, subtype="TIME_ABSOLUTE", unit="TIME_ABSOLUTE"
    )
    use_target_error: bpy.props.BoolProperty(
        name="Error Target", description="Stop when the picture is known to be this good", default=False
    )
    target_error: bpy.props.FloatProperty(
        name="Error Target",
        description="Relative mean squared error of the picture, by the upper end of its interval",
        default=0.001,
        min=1e-9,
        soft_max=0.1,
        precision=5,
    )
    use_adaptive: bpy.props.BoolProperty(
        name="Adaptive Sampling",
        description="After 16 samples, take up to four times as many where the picture is noisy and down to a quarter"
        " elsewhere; Samples is then the mean. Unbiased. Helps where some parts are much noisier than others, and gains"
        " nothing in even haze",
        default=False,
    )
    integrator: bpy.props.EnumProperty(
        name="Integrator", description="How light is followed", items=of_group_and(list_integrators)
    )
    seed: bpy.props.IntProperty(
        name="Seed", description="Another seed gives other noise and the same picture", default=0, min=0
    )
    use_seed_per_frame: bpy.props.BoolProperty(
        name="Seed per Frame", description="Give every frame of an animation noise of its own", default=False
    )
    use_max_depth: bpy.props.BoolProperty(
        name="Limit Depth",
        description="Cut light off after a number of scatterings. This makes pictures darker",
        default=False,
    )
    max_depth: bpy.props.IntProperty(
        name="Depth",
        description="Scatterings of a light path, at surfaces and in fog; 0 is emission alone, 1 direct light",
        default=12,
        min=0,
        soft_max=1024,
    )
    use_max_scatter: bpy.props.BoolProperty(
        name="Limit Fog Depth",
        description="Cut light off after a number of scatterings in fog. This makes pictures darker",
        default=False,
    )
    max_scatter: bpy.props.IntProperty(
        name="Fog Depth",
        description="Scatterings of a light path in fog; 0 leaves absorption and out-scattering alone",
        default=12,
        min=0,
        soft_max=1024,
    )
    use_curve_files: bpy.props.BoolProperty(
        name="Write Error Curve",
        description="Write how the error fell with time beside every picture that a render writes, as"
        " PICTURE.error.csv and PICTURE.error.png",
        default=False,
    )
    tile_size: bpy.props.IntProperty(
        name="Tile Size",
        description="Side of the tiles in which the picture appears, in pixels. Changes no pixel",
        default=64,
        min=8,
        max=4096,
    )
    filter: bpy.props.EnumProperty(
        name="Pixel Filter",
        items=(
            ("BLACKMAN_HARRIS", "Blackman-Harris", "Soft edges, as Cycles has by default"),
            ("BOX", "Box", "Exactly the pixel's square"),
        ),
        default="BLACKMAN_HARRIS",
    )
    filter_width: bpy.props.FloatProperty(
        name="Filter Width",
        description="Blackman-Harris alone: how far from its middle a pixel gathers light, in pixels; as in Cycles",
        default=1.5,
        min=0.01,
        max=10.0,
    )
