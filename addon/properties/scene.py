# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"

from zlib import crc32

import bpy

from ..callbacks import of_group, of_group_and
from ..cluster.settings import LEAST_TASK_SAMPLES
from ..film.noise import percent, relmse_of
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


# What artists and Cycles count in, of what the engine and scene files do.


def _noise_limit(group: bpy.types.PropertyGroup) -> float:
    return percent(group.target_error)


def _set_noise_limit(group: bpy.types.PropertyGroup, value: float) -> None:
    group.target_error = relmse_of(value)


def _bounces(group: bpy.types.PropertyGroup) -> int:
    return max(group.max_depth - 1, 0)


def _set_bounces(group: bpy.types.PropertyGroup, value: int) -> None:
    group.max_depth = value + 1


def _volume_bounces(group: bpy.types.PropertyGroup) -> int:
    return max(group.max_scatter - 1, 0)


def _set_volume_bounces(group: bpy.types.PropertyGroup, value: int) -> None:
    group.max_scatter = value + 1


def _update_passes(group: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    """The compositor's sockets follow."""
    for view_layer in group.id_data.view_layers:
        view_layer.update_render_passes()


_change_passes = of_group_and(_update_passes)


class GlimmerSceneSettings(bpy.types.PropertyGroup):
    """How a scene is rendered. The first limit that is met ends the render."""

    use_samples: bpy.props.BoolProperty(
        name="Limit Samples", description="Stop when every pixel has this many samples", default=True
    )
    samples: bpy.props.IntProperty(
        name="Max Samples", description="Samples of every pixel", default=64, min=1, soft_max=65536
    )
    viewport_samples: bpy.props.IntProperty(
        name="Viewport Samples",
        description="Samples of every pixel of a 3D view in rendered shading; 0 goes on for ever",
        default=1024,
        min=0,
        soft_max=65536,
    )
    use_viewport_denoising: bpy.props.BoolProperty(
        name="Denoise",
        description="Runs Open Image Denoise over what 3D views in rendered shading show, as this Blender carries it."
        " A bias: fine detail may be lost or made up",
        default=False,
        update=_announce,
    )
    viewport_denoising_start: bpy.props.IntProperty(
        name="Start Sample",
        description="Samples of every pixel from which on a 3D view is denoised",
        default=1,
        min=1,
        soft_max=64,
        update=_announce,
    )
    preview_pause: bpy.props.BoolProperty(
        name="Pause",
        description="Stop rendering 3D views in rendered shading; what changes is still shown, in coarse pixels",
        default=False,
        options={"SKIP_SAVE"},
        update=_announce,
    )
    use_seconds: bpy.props.BoolProperty(
        name="Limit Time", description="Stop after this render time, loading and building left out", default=False
    )
    seconds: bpy.props.FloatProperty(
        name="Time Limit",
        description="Render time of a picture, loading and building left out",
        default=60.0,
        min=0.01,
        soft_max=86400.0,
        subtype="TIME_ABSOLUTE",
        unit="TIME_ABSOLUTE",
    )
    use_target_error: bpy.props.BoolProperty(
        name="Limit Noise", description="Stop when the noise is surely below this", default=False
    )
    target_error: bpy.props.FloatProperty(
        name="Error Target",
        description="Relative mean squared error of the picture, by the upper end of its interval",
        default=0.0009,
        min=1e-9,
        soft_max=0.1,
        precision=5,
    )
    noise_limit: bpy.props.FloatProperty(
        name="Noise Limit",
        description="Stop when the noise is surely below this part of what a pixel should show: 3 % looks clean, 10 %"
        " grainy. It is the root of target_error",
        subtype="PERCENTAGE",
        min=0.01,
        max=1000.0,
        soft_min=0.5,
        soft_max=50.0,
        precision=1,
        get=of_group(_noise_limit),
        set=of_group_and(_set_noise_limit),
        options=set(),
    )
    use_denoising: bpy.props.BoolProperty(
        name="Denoise",
        description="Runs Open Image Denoise over the finished picture, as this Blender carries it; the rendered one is"
        " kept as the pass Noisy Image, and its samples count for one pixel each. A bias, and how wrong the picture is"
        " then is not known",
        default=False,
        update=_change_passes,
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
        name="Limit Bounces",
        description="Cut light off after a number of bounces. This makes pictures darker",
        default=False,
    )
    max_depth: bpy.props.IntProperty(
        name="Depth",
        description="Scatterings of a light path, at surfaces and in fog; 0 is emission alone, 1 direct light",
        default=12,
        min=0,
        soft_max=1024,
    )
    max_bounces: bpy.props.IntProperty(
        name="Max Bounces",
        description="Bounces of light, at surfaces and in haze, as Cycles counts them: 0 is direct light alone. It is"
        " max_depth less one",
        min=0,
        soft_max=1024,
        get=of_group(_bounces),
        set=of_group_and(_set_bounces),
        options=set(),
    )
    use_max_scatter: bpy.props.BoolProperty(
        name="Limit Volume Bounces",
        description="Cut light off after a number of bounces in haze. This makes pictures darker",
        default=False,
    )
    max_scatter: bpy.props.IntProperty(
        name="Fog Depth",
        description="Scatterings of a light path in fog; 0 leaves absorption and out-scattering alone",
        default=12,
        min=0,
        soft_max=1024,
    )
    volume_bounces: bpy.props.IntProperty(
        name="Volume",
        description="Bounces of light in haze, as Cycles counts them: 0 is light that was scattered there once. It is"
        " max_scatter less one",
        min=0,
        soft_max=1024,
        get=of_group(_volume_bounces),
        set=of_group_and(_set_volume_bounces),
        options=set(),
    )
    use_curve_files: bpy.props.BoolProperty(
        name="Write Error Curve",
        description="Write how the error fell with time beside every picture that a render writes, as"
        " PICTURE.error.csv and PICTURE.error.png",
        default=False,
    )
    use_cluster: bpy.props.BoolProperty(
        name="Render on Cluster",
        description="Final renders are done by the cluster that the add-on's preferences name, in tasks of some samples"
        " of the whole picture each",
        default=False,
    )
    cluster_task_samples: bpy.props.IntProperty(
        name="Samples per Task",
        description="Each task loads the scene anew and should take much longer than that; there should be several for"
        " each worker, and the noise is known from eight on",
        default=8,
        min=LEAST_TASK_SAMPLES,
        soft_max=1024,
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
        description="How samples are weighed into pixels",
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
