# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's output size, border and Glimmer's render settings -> Film and RenderSettings."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..film import denoise
from ..film.passes import COMBINED, DENOISED_BY, NOISY, RenderPass, engine_names, missing
from ..scene.description import Film, Mist, RenderSettings
from ..scene.problems import GlimmerError, Notices
from .left_out import note_light_left_out

if TYPE_CHECKING:
    import bpy

# A material preview is small and must come at once.
PREVIEW_SAMPLES = 32
PREVIEW_SECONDS = 2.0
MIST_FALLOFF = {"QUADRATIC": 2.0, "LINEAR": 1.0, "INVERSE_QUADRATIC": 0.5}
NO_LIMIT = 2**40  # samples; without any limit the engine stops at 64


def full_size(render: bpy.types.RenderSettings) -> tuple[int, int]:
    """(width, height) of the whole picture, in Blender's own integer arithmetic."""
    scale = render.resolution_percentage
    return max(render.resolution_x * scale // 100, 1), max(render.resolution_y * scale // 100, 1)


def full_shape(render: bpy.types.RenderSettings) -> tuple[float, float]:
    """(width, height) of the whole picture as it is looked at, in heights of a pixel."""
    width, height = full_size(render)
    return width * render.pixel_aspect_x / render.pixel_aspect_y, float(height)


def border_window(size: tuple[int, int], border: tuple[float, float, float, float]) -> tuple[int, int, int, int]:
    """x0, y0, x1, y1 from the top left of a border (min_x, min_y, max_x, max_y), 0 to 1 from the bottom left.

    Blender multiplies in float32 and cuts off; another rounding gives a result of another size than it expects.
    """
    width, height = size
    x0, x1 = (int(np.float32(edge) * np.float32(width)) for edge in (border[0], border[2]))
    y0, y1 = (int(np.float32(edge) * np.float32(height)) for edge in (border[1], border[3]))
    return x0, height - y1, x1, height - y0


def filter_settings(settings: Any) -> dict[str, Any]:
    """Film's filter and filter_width. Cycles and we count a Blackman-Harris width from the middle, Film all of it."""
    return {"filter": settings.filter.lower(), "filter_width": 2.0 * settings.filter_width}


def film_exposure(scene: bpy.types.Scene) -> float:
    """Cycles' setting, which is not there where Cycles is switched off."""
    return float(getattr(getattr(scene, "cycles", None), "film_exposure", 1.0))


def export_film(scene: bpy.types.Scene, notices: Notices) -> Film:
    render = scene.render
    note_light_left_out(scene, notices)
    size = full_size(render)
    crop = None
    if render.use_border:
        edges = (render.border_min_x, render.border_min_y, render.border_max_x, render.border_max_y)
        crop = border_window(size, edges)
        if crop[2] <= crop[0] or crop[3] <= crop[1]:
            raise GlimmerError("The render border holds no pixel: make it larger, or clear it with Ctrl Alt B")
    return Film(
        width=size[0],
        height=size[1],
        crop=crop,
        exposure=film_exposure(scene),
        mist=_mist(scene.world),
        pixel_aspect=render.pixel_aspect_x / render.pixel_aspect_y,
        occlusion_distance=10.0 if scene.world is None else scene.world.light_settings.distance,
        **filter_settings(scene.glimmer),
        **transparency(scene),
    )


def transparency(scene: bpy.types.Scene) -> dict[str, Any]:
    """Film's transparent and transparent_glass. Cycles has the setting of glass, and squares its roughness."""
    if not scene.render.film_transparent:
        return {}
    cycles = getattr(scene, "cycles", None)
    if cycles is None or not cycles.film_transparent_glass:
        return {"transparent": True}
    return {"transparent": True, "transparent_glass": float(cycles.film_transparent_roughness) ** 2}


def _mist(world: bpy.types.World | None) -> Mist:
    if world is None:
        return Mist()
    settings = world.mist_settings
    return Mist(settings.start, settings.depth, MIST_FALLOFF[settings.falloff])


def note_missing_passes(view_layer: bpy.types.ViewLayer, notices: Notices) -> None:
    names = missing(view_layer)
    if names:
        notices.add(
            f"view layer '{view_layer.name}'",
            f"there is no pass for {', '.join(names)}; {'they are' if len(names) > 1 else 'it is'} left out",
        )


def export_view_settings(scene: bpy.types.Scene) -> RenderSettings:
    """Of a 3D view: it goes on until it is good enough to the eye, so only its own limit ends it."""
    settings, render = scene.glimmer, scene.render
    is_denoised = settings.use_viewport_denoising and denoise.path() is not None
    return RenderSettings(
        integrator=settings.integrator or None,
        samples=settings.viewport_samples or NO_LIMIT,
        seed=settings.seed,
        threads=render.threads if render.threads_mode == "FIXED" else 0,
        max_depth=settings.max_depth if settings.use_max_depth else None,
        max_scatter=settings.max_scatter if settings.use_max_scatter else None,
        passes=engine_names([COMBINED]) + (DENOISED_BY if is_denoised else ()),
        denoise=is_denoised,
    )


def layer_samples(scene: bpy.types.Scene, view_layer: bpy.types.ViewLayer) -> int:
    """A view layer's own number takes the scene's place; Cycles may have it as a bound, or nothing. 0: no limit."""
    settings = scene.glimmer
    samples = settings.samples if settings.use_samples else 0
    use = getattr(getattr(scene, "cycles", None), "use_layer_samples", "USE")
    own = view_layer.samples if use != "IGNORE" else 0
    if own and samples and use == "BOUNDED":
        return min(own, samples)
    return own or samples


def export_settings(
    scene: bpy.types.Scene,
    view_layer: bpy.types.ViewLayer,
    passes: tuple[RenderPass, ...],
    is_preview: bool = False,
) -> RenderSettings:
    settings = scene.glimmer
    is_denoised = settings.use_denoising and not is_preview
    names = engine_names(passes)
    if is_denoised:
        names = tuple(dict.fromkeys((*names, *DENOISED_BY)))
    if is_preview:
        return RenderSettings(samples=PREVIEW_SAMPLES, seconds=PREVIEW_SECONDS, passes=names)
    seed = settings.seed
    if settings.use_seed_per_frame:
        # Frames far apart in numbers, so that the seeds of two scenes do not meet by counting up.
        seed += (scene.frame_current % 2**32) << 32
    render = scene.render
    return RenderSettings(
        integrator=settings.integrator or None,
        samples=layer_samples(scene, view_layer),
        seconds=settings.seconds if settings.use_seconds else 0.0,
        target_error=settings.target_error if settings.use_target_error else 0.0,
        seed=seed,
        threads=render.threads if render.threads_mode == "FIXED" else 0,
        tile_size=settings.tile_size,
        max_depth=settings.max_depth if settings.use_max_depth else None,
        max_scatter=settings.max_scatter if settings.use_max_scatter else None,
        adaptive=settings.use_adaptive,
        passes=names,
        denoise=is_denoised,
        independent_pixels=NOISY in passes,  # denoised now, or by what it is stored for
    )
