# SPDX-License-Identifier: GPL-3.0-or-later
"""`glimmer farm` and the page's lines of Python: one frame by two workers, with the same bits."""

import json
import os
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from addon.scene import description as d
from addon.scene.writer import write_scene
from engine.farm import picture
from engine.farm.engine import ROOT
from tests.farm.machines import PYTHON, cluster, free_port
from tests.render.build import Builder, camera, floor, grey

PAGE = ROOT / "addon" / "docs" / "farm.md"


@pytest.fixture(scope="module")
def scene(tmp_path_factory: pytest.TempPathFactory) -> Path:
    builder = Builder(camera((0, -6, 1), (0, 0, 0), 60), 24, 16)
    builder.mesh(floor(z=-1, half=4), d.Lambert(grey(0.5)))
    builder.sphere((0, 0, 4), 1.0, d.Light(grey(5)))
    path = tmp_path_factory.mktemp("scene") / "scene.json"
    write_scene(builder.done(), path)
    return path


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    with cluster(2, tmp_path_factory.mktemp("workers")) as found:
        yield found


def glimmer(command: Path, *words: object, **env: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [str(command), "farm", *map(str, words)],
        env={**os.environ, **PYTHON, **env},
        capture_output=True,
        text=True,
        check=False,
        timeout=200,
    )


def test_the_command_and_the_lines_of_python_make_one_picture(
    scene: Path, address: str, glimmer_command: Path, tmp_path: Path
) -> None:
    command, python, report = tmp_path / "command.exr", tmp_path / "python.exr", tmp_path / "report.json"
    words = (scene, "-o", command, "--scheduler", address, "--error", "0.05", "--range", "2", "--report", report)
    done = glimmer(glimmer_command, *words)
    assert done.returncode == 0, done.stderr
    assert "relMSE" in done.stderr.splitlines()[-1]
    told = json.loads(report.read_text())
    assert told["error"]["high"] <= 0.05 and told["seconds"]["cpu"] > 0
    assert [len(point) for point in told["curve"]] == [6] * len(told["curve"]), "as of every render's report"

    lines = re.findall(r"^```python\n(.*?)^```$", PAGE.read_text(), re.MULTILINE | re.DOTALL)[0]
    for old, new in {"SCENE.json": scene, "OUT.exr": python, "tcp://10.0.0.1:8786": address}.items():
        assert old in lines
        lines = lines.replace(old, str(new))
    lines = lines.replace("error=0.001", "error=0.05, range_samples=2")
    subprocess.run([sys.executable, "-c", lines], cwd=ROOT, check=True, timeout=200)
    ours, theirs = picture.read(command), picture.read(python)
    assert ours.pixels.tobytes() == theirs.pixels.tobytes() and ours.facts.samples == theirs.facts.samples


def test_where_there_is_no_scheduler_one_line_says_so(scene: Path, glimmer_command: Path, tmp_path: Path) -> None:
    address = f"tcp://127.0.0.1:{free_port()}"
    done = glimmer(glimmer_command, scene, "-o", tmp_path / "out.exr", "--scheduler", address)
    assert done.returncode == 1 and not list(tmp_path.iterdir())
    assert done.stderr.count("\n") == 1 and done.stderr.startswith(f"glimmer farm: {address}: no scheduler of Dask")


def test_where_there_is_no_python_with_dask_one_line_says_so(glimmer_command: Path, bpy_python: Path) -> None:
    nowhere = glimmer(glimmer_command, "scene.json", GLIMMER_FARM_PYTHON="/nowhere/python")
    assert nowhere.returncode == 2
    assert nowhere.stderr.startswith("glimmer farm: /nowhere/python cannot be run; `python3 build.py setup --farm`")
    without = glimmer(glimmer_command, "scene.json", "-o", "out.exr", GLIMMER_FARM_PYTHON=str(bpy_python))
    assert without.returncode == 1
    for said in (nowhere.stderr, without.stderr):
        assert said.count("\n") == 1 and "`python3 build.py setup --farm`" in said
