# SPDX-License-Identifier: GPL-3.0-or-later
"""What is told of a render: the report, the curve, and progress on the terminal."""

import csv
import json
import os
import pty
import re
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from addon.native import error_curve
from tests.engine import scenes
from tests.engine.library import engine
from tests.engine.scenes import hazy_moon, read_pixels, render, run_glimmer, write_scene

pytestmark = pytest.mark.usefixtures("glimmer_command")


def test_report(tmp_path: Path) -> None:
    content = hazy_moon()
    content["meshes"]["spare"] = scenes.QUAD
    picture = render(tmp_path, content, "--spp", 16, "--report", tmp_path / "r.json")
    report: dict[str, Any] = json.loads((tmp_path / "r.json").read_text())
    assert report["spp"] == 16
    seconds = report["seconds"]
    assert all(seconds[key] > 0 for key in ("load", "build", "render", "cpu"))
    assert report["rays"] > 16 * 24 * 16 and report["peak_bytes"] > 0
    assert report["invalid_samples"] == {"count": 0, "first": None}
    error = report["error"]
    assert 0 <= error["low"] <= error["relmse"] <= error["high"] and 0 < error["confidence"] < 1
    assert [row[2] for row in report["curve"]] == sorted({row[2] for row in report["curve"]})
    assert all(len(row) == 6 for row in report["curve"]) and report["curve"][-1][2] == 16
    assert report["biased_by"] == [] and isinstance(report["kernel"], str)
    assert 'mesh "spare": no object uses it' in report["left_out"] and isinstance(report["warnings"], list)
    assert picture.attributes["glimmer:seconds"] == pytest.approx(seconds["render"], rel=0.05, abs=0.01)


def test_curve_table(tmp_path: Path) -> None:
    render(tmp_path, hazy_moon(), "--spp", 32, "--report", tmp_path / "r.json", "--curve", tmp_path / "c.csv")
    rows = list(csv.reader((tmp_path / "c.csv").read_text().splitlines()))
    assert rows[0] == ["seconds", "cpu_seconds", "spp", "relmse", "low", "high"]
    curve = [row for row in json.loads((tmp_path / "r.json").read_text())["curve"] if row[3] is not None]
    assert len(curve) >= 3
    assert [[float(cell) if cell else None for cell in row] for row in rows[1:]] == curve


def test_curve_plot(tmp_path: Path) -> None:
    """It is the add-on's, from the same report; a picture without an estimate gets a plot that says so."""
    for spp, known in ((32, True), (1, False)):
        render(tmp_path, hazy_moon(), "--spp", spp, "--curve", tmp_path / "c.png", "--report", tmp_path / "r.json")
        report = json.loads((tmp_path / "r.json").read_text())
        assert error_curve.has_points(report) == known
        np.testing.assert_array_equal(read_pixels(tmp_path / "c.png", "uint8")[1], error_curve.plot(engine(), report))


def test_black_picture_has_no_relative_error(tmp_path: Path) -> None:
    render(tmp_path, scenes.scene(), "--spp", 8, "--report", tmp_path / "r.json", "--curve", tmp_path / "c.csv")
    assert json.loads((tmp_path / "r.json").read_text())["error"] is None
    assert (tmp_path / "c.csv").read_text() == "seconds,cpu_seconds,spp,relmse,low,high\n"


def test_summary_and_quiet(tmp_path: Path) -> None:
    path = write_scene(tmp_path, hazy_moon())
    loud = run_glimmer(path, "-o", tmp_path / "out.exr", "--spp", 4)
    assert re.search(
        r"out\.exr: 4 spp in \d+\.\d\d s, relMSE [0-9.e-]+ \([0-9.e-]+ to [0-9.e-]+\)(, not .*)?\n$", loud.stderr
    )
    assert loud.stdout == ""
    quiet = run_glimmer(path, "-o", tmp_path / "out.exr", "--spp", 4, "--quiet")
    assert quiet.stderr == "" and quiet.stdout == ""


def test_progress_on_a_terminal(tmp_path: Path) -> None:
    path = write_scene(tmp_path, hazy_moon())
    ours, theirs = pty.openpty()
    command = [os.environ["GLIMMER_BIN"], str(path), "-o", str(tmp_path / "out.exr"), "--time", "1.5"]
    process = subprocess.Popen(command, stderr=theirs)
    os.close(theirs)
    shown = b""
    try:
        while chunk := os.read(ours, 65536):
            shown += chunk
    except OSError:  # how Linux says that the other end is closed
        pass
    os.close(ours)
    assert process.wait(60) == 0
    updates = shown.decode().split("\r")
    assert sum("spp" in update and "left" in update for update in updates) >= 3
    assert "relMSE" in shown.decode() and shown.decode().count("\n") == 1
