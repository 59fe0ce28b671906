# SPDX-License-Identifier: GPL-3.0-or-later
"""What the command's pictures hold, whether two are the same, and merging."""

import subprocess
from pathlib import Path

from tests.engine.scenes import Exr, run_glimmer


def same_bits(a: Exr, b: Exr) -> bool:
    return a.channels.keys() == b.channels.keys() and all(
        a.channels[name].tobytes() == b.channels[name].tobytes() for name in a.channels
    )


AOV_CHANNELS = {
    "combined": "RGB",
    "stderr": "RGB",
    "albedo": "RGB",
    "normal": "XYZ",
    "depth": "Z",
    "emission": "RGB",
    "direct": "RGB",
    "indirect": "RGB",
    "fog": "RGB",
    "object_index": "X",
    "material_index": "X",
    "sample_count": "X",
    "alpha": "A",
    "position": "XYZ",
    "uv": "UVA",
    "mist": "Z",
    "emit": "RGB",
    "environment": "RGB",
    **{
        f"{lobe}_{part}": "RGB"
        for lobe in ("diffuse", "glossy", "transmission")
        for part in ("direct", "indirect", "color")
    },
    "volume_direct": "RGB",
    "volume_indirect": "RGB",
    "object_matte": "0123456789abcdefghijklmnopqrstuv",
    "material_matte": "0123456789abcdefghijklmnopqrstuv",
    **{f"light_group_{i + 1}": "RGB" for i in range(16)},
    **{f"aov_{i + 1}": "RGBA" for i in range(8)},
    "ambient_occlusion": "RGB",
}
IN_THE_MAIN_LAYER = ("combined", "alpha")


def merge(folder: Path, *names: str) -> "subprocess.CompletedProcess[str]":
    return run_glimmer("merge", *(folder / f"{name}.exr" for name in names), "-o", folder / "merged.exr")
