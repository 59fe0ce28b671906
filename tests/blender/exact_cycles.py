# SPDX-License-Identifier: GPL-3.0-or-later
"""Cycles with nothing that biases, and pictures of all that a render holds: for scripts within Blender."""

from typing import Any

MOST_BOUNCES = 1024  # that Cycles takes
SETTINGS = {
    "device": "CPU",
    "use_denoising": False,
    "use_adaptive_sampling": False,
    "sample_clamp_direct": 0.0,
    "sample_clamp_indirect": 0.0,
    "light_sampling_threshold": 0.0,
    "blur_glossy": 0.0,
    "caustics_reflective": True,
    "caustics_refractive": True,
    "pixel_filter_type": "BOX",
    "use_light_tree": True,
    "use_fast_gi": False,
    "volume_biased": True,  # the volumes of later versions have a mean error, which depends on the sample count
    **{
        f"{kind}_bounces": MOST_BOUNCES
        for kind in ("max", "diffuse", "glossy", "transmission", "volume", "transparent_max")
    },
}


def set_up_cycles(scene: Any, **more: Any) -> dict[str, Any]:
    """Makes it the scene's engine; `more` is set of it too, or instead. What a version of Blender does not know is left
    out; the rest is returned, each value as Cycles took it."""
    scene.render.engine = "CYCLES"
    known = {name: value for name, value in {**SETTINGS, **more}.items() if hasattr(scene.cycles, name)}
    for name, value in known.items():
        setattr(scene.cycles, name, value)
        if getattr(scene.cycles, name) != value:
            raise RuntimeError(f"Cycles sets {name} to {getattr(scene.cycles, name)}, not {value}")
    if scene.world is not None:
        scene.world.cycles.volume_sampling = "MULTIPLE_IMPORTANCE"
    return known


def use_exr(scene: Any) -> None:
    """Pictures are written as float32."""
    image = scene.render.image_settings
    if hasattr(image, "media_type"):  # 5.0 on
        image.media_type = "IMAGE"
    image.file_format, image.color_mode, image.color_depth = "OPEN_EXR", "RGB", "32"
