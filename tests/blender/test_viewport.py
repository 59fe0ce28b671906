# SPDX-License-Identifier: GPL-3.0-or-later
"""Rendered shading in a 3D view: viewport_script.py works in a window, and the tests look at what it noted."""

import json
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import OpenImageIO
import pytest
from hosts import Host

SCRIPT = Path(__file__).with_name("viewport_script.py")
WORLD = (0.2, 0.4, 0.1)
MOON, OTHER_MOON = (0.8, 0.05, 0.6), (0.05, 0.6, 0.8)


@pytest.fixture(scope="module")
def folder(blender_host: Host, display: str, tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("viewport")
    # A small window at the top of the display: software draws it.
    options = ["--factory-startup", "--window-geometry", "0", "200", "800", "600"]
    command = [str(blender_host.program), *options, "--python", str(SCRIPT), "--", str(out)]
    env = {**blender_host.env, "DISPLAY": display, "LIBGL_ALWAYS_SOFTWARE": "1"}
    result = subprocess.run(command, env=env, capture_output=True, text=True, check=False, timeout=240)
    assert result.returncode == 0, f"exit status {result.returncode}\n{result.stdout[-3000:]}{result.stderr[-3000:]}"
    assert "Traceback" not in result.stderr, result.stderr[-3000:]
    return out


@pytest.fixture(scope="module")
def facts(folder: Path) -> dict[str, Any]:
    found: dict[str, Any] = json.loads((folder / "facts.json").read_text())
    assert found.get("is_finished"), found.get("error") or f"stuck after {found['done']}: {found.get('given up')}"
    return found


def test_the_picture_is_the_view_of_the_scene(facts: dict[str, Any]) -> None:
    """Where Blender says the moon is, there it is, in its own radiance: the view's matrices are read right."""
    colors = {"first": MOON, "turned": MOON, "recolored": OTHER_MOON, "orthographic": OTHER_MOON, "camera": OTHER_MOON}
    for name, color in colors.items():
        assert facts[name]["moon"] == pytest.approx(color, rel=1e-6), name


def srgb(value: float) -> float:
    return 12.92 * value if value <= 0.0031308 else 1.055 * value ** (1 / 2.4) - 0.055


def test_the_window_shows_it_in_the_displays_colors(folder: Path, facts: dict[str, Any]) -> None:
    image = OpenImageIO.ImageInput.open(str(folder / "colors.png"))
    assert image is not None, OpenImageIO.geterror()
    shot = np.asarray(image.read_image(0, 0, 0, 3, OpenImageIO.UINT8)).astype(int)
    first = facts["first"]
    height, width = first["size"]
    x0, y0 = first["region"]
    top = facts["window_height"] - y0 - height
    row, column = first["moon_pixel"]
    # The view's buttons lie over its upper part and the sides; a corner low on the left is free.
    for color, (y, x) in ((MOON, (top + row, x0 + column)), (WORLD, (top + height - 20, x0 + width // 2))):
        np.testing.assert_allclose(shot[y, x], [255 * srgb(value) for value in color], atol=1.5)


def test_only_what_shows_restarts_it(facts: dict[str, Any]) -> None:
    scenes = {name: facts[name]["counts"]["scenes"] for name in ("first", "turned", "recolored", "selected")}
    assert scenes["turned"] > scenes["first"]
    assert scenes["selected"] == scenes["recolored"], "a selection restarted the picture"
    moved, renamed = (facts[name]["counts"]["scenes"] for name in ("moved", "renamed"))
    assert renamed == moved > scenes["selected"]


def test_an_edit_reads_only_what_it_changed(facts: dict[str, Any]) -> None:
    reads = {name: facts[name]["reads"] for name in ("turned", "recolored", "selected", "moved", "reshaped")}
    first = reads["turned"]
    assert first["meshes"] == 1 and first["spheres"] == 1
    assert reads["recolored"] == reads["selected"] == reads["moved"] == {**first, "materials": first["materials"] + 1}
    assert reads["reshaped"]["meshes"] == 2


def test_meshes_are_kept_until_they_change(facts: dict[str, Any]) -> None:
    names = ("first", "turned", "recolored", "moved", "reshaped")
    assert [facts[name]["counts"]["meshes_created"] for name in names] == [1, 1, 1, 1, 2]


def test_a_border_in_the_view_is_all_that_is_rendered(facts: dict[str, Any]) -> None:
    width, height = facts["border"]["region"]
    x0, y0, x1, y1 = facts["border"]["window"]
    assert (y0, y1) == (0, pytest.approx(0.5 * height, abs=1))
    assert (x0, x1) == (pytest.approx(0.25 * width, abs=1), pytest.approx(0.75 * width, abs=1))


def test_the_pause_button_leaves_coarse_pixels(facts: dict[str, Any]) -> None:
    assert facts["paused"]["is_resting"]
    assert facts["paused"]["scale"] > 1


def test_the_view_is_of_the_windows_view_layer(facts: dict[str, Any]) -> None:
    """The moon is hidden in the second."""
    assert facts["second view layer"]["moon"] == pytest.approx(WORLD, rel=1e-6)


def test_a_final_render_beside_it_leaves_both_whole(folder: Path, facts: dict[str, Any]) -> None:
    assert (folder / "f12.exr").exists()
    assert facts["after F12"]["moon"] == pytest.approx(MOON, rel=1e-6)


def test_nothing_is_left_behind(facts: dict[str, Any]) -> None:
    """Not by another file, another shading, or the add-on switched off; and each time it comes back."""
    assert facts["threads_after_load"] == 0
    assert facts["loaded"]["moon"] == pytest.approx(MOON, rel=1e-6)
    assert facts["solid"] == {"views": 0, "threads": 0}
    assert facts["threads_after_disable"] == 0
    assert facts["enabled again"]["threads"] == 1
    assert all(facts[name]["threads"] == 1 for name in ("first", "turned", "reshaped", "loaded"))
