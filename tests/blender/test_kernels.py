# SPDX-License-Identifier: GPL-3.0-or-later
"""The benchmark's scenes run on kernels compiled for their like, which give the bits of the full one. See
tests/engine/test_kernels.py for scenes on either side of each feature.
"""

import json
import subprocess
from pathlib import Path

import numpy as np
import pytest
from hosts import Host

from tests.bench.renderers import set_stage
from tests.bench.scenes import SCENES, BenchScene
from tests.engine.scenes import read_exr

FOG, FIELD, HAZY = (
    "spheres that shine, in fog or none",
    "surfaces lit by spheres, without fog and glass",
    "surfaces lit by spheres, in fog, without glass",
)
KERNELS = {
    "moons_in_fog": FOG,
    "field_without_fog": FIELD,
    "glimmervoid": HAZY,
    "thick_fog": HAZY,
    "smooth_metal": HAZY,
    "clearing": HAZY,
}
AOVS = "albedo,normal,depth,emission,direct,indirect,fog,object_index,material_index"


@pytest.mark.parametrize("scene", SCENES, ids=lambda scene: scene.name)
def test_selected_and_full_kernel_give_the_same_bits(
    scene: BenchScene, blender_host: Host, glimmer_command: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name, value in blender_host.env.items():
        monkeypatch.setenv(name, value)
    export = set_stage(blender_host.program, scene, (48, 27), tmp_path).export
    pictures = []
    for options, kernel in (([], KERNELS[scene.name]), (["--full-kernel"], "everything")):
        output, report = tmp_path / f"{kernel}.exr", tmp_path / "report.json"
        words = [str(export), "-o", str(output), "--spp", "4", "--aov", AOVS, "--report", str(report), "--quiet"]
        subprocess.run([str(glimmer_command), *words, *options], check=True, timeout=120)
        assert json.loads(report.read_text())["kernel"].endswith(f" (compiled for {kernel})")
        pictures.append(read_exr(output).channels)
    selected, full = pictures
    assert selected.keys() == full.keys() and np.unique(full["R"]).size > 100
    for name in full:
        assert np.array_equal(selected[name].view(np.uint32), full[name].view(np.uint32)), name
