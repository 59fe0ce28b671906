# SPDX-License-Identifier: GPL-3.0-or-later
"""The command under AddressSanitizer, UndefinedBehaviorSanitizer and ThreadSanitizer. Builds the presets: minutes."""

import os
import subprocess
from pathlib import Path

import pytest

from tests.engine.scenes import Scene, every_key, furnace, hazy_moon, run_glimmer, write_scene

pytestmark = [pytest.mark.full, pytest.mark.timeout(1800)]

GREY_FOG = {"sigma_a": 0.01, "sigma_s": 0.05}
"""Isotropic, so that light vertices are shared."""


def some_scenes(folder: Path) -> dict[str, Scene]:
    every = every_key(folder)
    return {
        "every key": every,
        "shared light vertices": {**every, "medium": GREY_FOG, "render": {}},
        "coloured fog": {**every, "medium": {"sigma_a": 0.01, "sigma_s": [0.05, 0.1, 0.02]}, "render": {}},
        "in glass": {**every, "camera": {"origin": [-1, -3, 1], "target": [0, 0, 0], "fov_x": 60}},
        "no fog": {key: value for key, value in every.items() if key != "medium"},
        "furnace": furnace(),
        "moon": hazy_moon(),
    }


@pytest.mark.parametrize("preset", ["asan", "tsan"])
def test_no_report(preset: str, repository: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    engine = repository / "engine"
    for command in (
        ["cmake", "--preset", preset],
        ["cmake", "--build", "--preset", preset, "--target", "glimmer_command"],
    ):
        done = subprocess.run(command, cwd=engine, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stdout + done.stderr
    # Without leaks: LeakSanitizer itself now and then dies of TBB's threads, and the process ends there anyway.
    options = {
        "ASAN_OPTIONS": "exitcode=66:detect_leaks=0",
        "UBSAN_OPTIONS": "halt_on_error=1:print_stacktrace=1:exitcode=66",
        "TSAN_OPTIONS": f"exitcode=66:suppressions={engine / 'tsan.supp'}",
        "GLIMMER_BIN": os.fspath(repository / "build" / preset / "bin" / "glimmer"),
    }
    for name, value in options.items():
        monkeypatch.setenv(name, value)
    layers = "albedo,normal,depth,emission,direct,indirect,fog,object_index,material_index,sample_count"
    for name, scene in some_scenes(tmp_path).items():
        for integrator in ("path", "report"):
            path = write_scene(tmp_path, scene)
            output, state = tmp_path / "out.exr", tmp_path / f"{name} {integrator}"
            for samples in (2, 5):  # the second from the first one's checkpoint
                done = run_glimmer(
                    *(path, "-o", output, "--spp", samples, "--threads", 4, "--tile", 8, "--aov", layers),
                    *("--integrator", integrator, "--checkpoint", state, "--report", tmp_path / "report.json"),
                )
                assert done.returncode == 0, f"{name}, {integrator}: {done.stderr}"
