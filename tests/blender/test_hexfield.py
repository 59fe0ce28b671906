# SPDX-License-Identifier: GPL-3.0-or-later
"""Hexagon fields and moons inside real Blenders: hexfield_checks.py runs once in each, and every check there is a
test here.
"""

import ast
import json
import os
import subprocess
from pathlib import Path
from typing import Any

import pytest

SCRIPT = Path(__file__).with_name("hexfield_checks.py")
HOSTS = ("blender", "bpy")


def check_names() -> list[str]:
    """The tuple CHECKS of the script, which cannot be imported without bpy."""
    for node in ast.parse(SCRIPT.read_text()).body:
        if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name) and node.target.id == "CHECKS":
            assert isinstance(node.value, ast.Tuple)
            return [ast.unparse(item) for item in node.value.elts]
    raise AssertionError(f"{SCRIPT.name} has no CHECKS")


@pytest.fixture(scope="module", params=HOSTS)
def results(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Any:
    out = tmp_path_factory.mktemp("hexfield") / "results.json"
    if request.param == "blender":
        blender = str(request.getfixturevalue("blender"))
        command = [
            blender,
            "-b",
            "--factory-startup",
            "--python-exit-code",
            "7",
            "--python",
            str(SCRIPT),
            "--",
            str(out),
        ]
    else:
        command = [str(request.getfixturevalue("bpy_python")), str(SCRIPT), str(out)]
    # Debian's Blender takes the first python3 on PATH for its own, and that one's packages.
    environment = {**os.environ, "PATH": os.pathsep.join([str(Path(command[0]).parent), os.environ["PATH"]])}
    process = subprocess.run(command, check=False, env=environment, capture_output=True, text=True, timeout=240)
    assert process.returncode == 0, process.stdout[-2000:] + process.stderr[-4000:]
    return json.loads(out.read_text())["results"]


@pytest.mark.parametrize("name", check_names())
def test_inside_blender(results: dict[str, str], name: str) -> None:
    assert results[name] == ""
