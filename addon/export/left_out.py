# SPDX-License-Identifier: GPL-3.0-or-later
"""The light that a file's settings have Cycles leave out of its picture, and that Glimmer renders all the same."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ..scene.problems import Notices

if TYPE_CHECKING:
    import bpy

CAUSTICS = ("reflective", "refractive")
BOUNCES = {
    "max": "",
    "diffuse": "diffuse ",
    "glossy": "glossy ",
    "transmission": "transmission ",
    "transparent_max": "transparent ",
}
CLAMPS = ("direct", "indirect")


def note_light_left_out(scene: bpy.types.Scene, notices: Notices) -> None:
    """One line for all that a person has set lower than Cycles sets it by itself. What it leaves out by itself, in
    every file, is said in using.md."""
    cycles = getattr(scene, "cycles", None)
    if cycles is None:
        return
    cuts = [f"no {name} caustics" for name in CAUSTICS if not getattr(cycles, f"caustics_{name}")]
    for name, kind in BOUNCES.items():
        bounces = getattr(cycles, f"{name}_bounces")
        if bounces < _default(cycles, f"{name}_bounces"):
            cuts.append(f"at most {bounces} {kind}bounces")
    for name in CLAMPS:
        limit, default = getattr(cycles, f"sample_clamp_{name}"), _default(cycles, f"sample_clamp_{name}")
        if 0.0 < limit < (default or float("inf")):
            cuts.append(f"{name} light clamped to {limit:g}")
    if cycles.blur_glossy > _default(cycles, "blur_glossy"):
        cuts.append(f"glossy light filtered by {cycles.blur_glossy:g}")
    if cycles.use_fast_gi:
        cuts.append("light that bounces often approximated")
    if cuts:
        notices.add("", f"Cycles is set to leave light out ({', '.join(cuts)}); none is left out here")


def _default(cycles: Any, name: str) -> float:
    return float(cycles.bl_rna.properties[name].default)
