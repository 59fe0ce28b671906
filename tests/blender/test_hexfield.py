# SPDX-License-Identifier: GPL-3.0-or-later
"""Hexagon fields and moons inside real Blenders: hexfield_checks.py runs once in each, and every check there is a
test here.
"""

import ast
import json
from pathlib import Path
from typing import Any

import pytest
from hosts import Host

SCRIPT = Path(__file__).with_name("hexfield_checks.py")


def check_names() -> list[str]:
    """The tuple CHECKS of the script, which cannot be imported without bpy."""
    for node in ast.parse(SCRIPT.read_text()).body:
        if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name) and node.target.id == "CHECKS":
            assert isinstance(node.value, ast.Tuple)
            return [ast.unparse(item) for item in node.value.elts]
    raise AssertionError(f"{SCRIPT.name} has no CHECKS")


@pytest.fixture(scope="module")
def results(host: Host, tmp_path_factory: pytest.TempPathFactory) -> Any:
    out = tmp_path_factory.mktemp("hexfield") / "results.json"
    host.run_script(SCRIPT, str(out), timeout=240)
    return json.loads(out.read_text())["results"]


@pytest.mark.parametrize("name", check_names())
def test_inside_blender(results: dict[str, str], name: str) -> None:
    assert results[name] == ""
