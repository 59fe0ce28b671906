# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs scripts inside a real Blender: the executable, or the bpy module."""

import os
import subprocess
from dataclasses import dataclass
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
HOSTS = ("blender", "bpy", "newest")  # the executable, the pinned bpy module, and the newest one there is
# For modules that take minutes a host: the pinned module is left to --full.
OLDEST_AND_NEWEST = pytest.mark.parametrize(
    "host", [pytest.param(kind, marks=[pytest.mark.full] * (kind == "bpy")) for kind in HOSTS], indirect=True
)


def environment(profile: Path, library: Path, blender: Path | None) -> dict[str, str]:
    """Blender sees nothing of the user's but an empty profile with addon/ as `glimmer`."""
    addons = profile / "scripts" / "addons"
    addons.mkdir(parents=True, exist_ok=True)
    link = addons / "glimmer"
    if not link.is_symlink():
        link.symlink_to(ROOT / "addon", target_is_directory=True)
    env = {name: value for name, value in os.environ.items() if not name.startswith("BLENDER_")}
    env["BLENDER_USER_RESOURCES"] = str(profile)
    env["BLENDER_USER_CONFIG"] = str(profile / "config")
    env["BLENDER_USER_SCRIPTS"] = str(profile / "scripts")
    env["GLIMMER_TEST_ADDONS"] = str(addons)
    env["GLIMMER_LIBRARY"] = str(library)
    if blender is not None:
        # Debian's Blender takes the first python3 on the path for its own.
        env["PATH"] = f"{blender.parent}{os.pathsep}{env.get('PATH', os.defpath)}"
    return env


@dataclass(frozen=True)
class Host:
    kind: str  # of HOSTS
    program: Path
    env: dict[str, str]

    @property
    def is_module(self) -> bool:
        return self.kind != "blender"

    def script_command(self, script: Path, *words: str) -> list[str]:
        if self.is_module:
            return [str(self.program), str(script), *words]
        options = ["-b", "--factory-startup", "--python-exit-code", "7", "--python", str(script), "--", *words]
        return [str(self.program), *options]

    def run(self, command: list[str], timeout: float = 200, **changes: str) -> subprocess.CompletedProcess[str]:
        env = {**self.env, **changes}
        return subprocess.run(command, capture_output=True, text=True, check=False, timeout=timeout, env=env)

    def run_script(self, script: Path, *words: str, timeout: float = 200, **changes: str) -> str:
        """What it printed. Fails the test unless it ends well."""
        result = self.run(self.script_command(script, *words), timeout, **changes)
        output = result.stdout[-6000:] + result.stderr[-6000:]
        assert result.returncode == 0, f"exit status {result.returncode}\n{output}"
        return result.stdout + result.stderr
