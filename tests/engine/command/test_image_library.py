# SPDX-License-Identifier: GPL-3.0-or-later
"""OpenImageIO brings some 250 shared libraries: the command opens them for the images that it alone can read or write,
and for nothing else. An .exr is written by OpenEXR itself."""

import os
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from tests.engine.scenes import furnace, scene, write_image, write_scene


def run(command: Path, *arguments: str | Path, **environment: str) -> "subprocess.CompletedProcess[str]":
    return subprocess.run(
        [command, *map(str, arguments)],
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        check=False,
        timeout=60,
    )


def opened(command: Path, folder: Path, *arguments: str | Path) -> str:
    """What the dynamic linker says of the libraries that it opened, and when."""
    for log in folder.glob("linker.*"):
        log.unlink()
    run(command, *arguments, LD_DEBUG="files", LD_DEBUG_OUTPUT=str(folder / "linker"))
    said = "".join(log.read_text(errors="replace") for log in folder.glob("linker.*"))
    assert "libglimmer.so" in said, "the linker does not log what it opens"
    return said


def test_what_needs_no_image_opens_no_image_library(glimmer_command: Path, tmp_path: Path) -> None:
    good = write_scene(tmp_path, furnace(), "good.json")
    bad = write_scene(tmp_path, {**furnace(), "camera": {}}, "bad.json")
    gone = write_scene(tmp_path, scene(environment={"image": "gone.exr"}), "gone.json")
    for arguments in (
        ("--version",),
        ("--help",),
        ("--list-integrators",),
        (good, "-o", tmp_path / "o.exr", "--spp", "0"),
        (bad, "-o", tmp_path / "o.exr", "--curve", tmp_path / "o.png"),
        (gone, "-o", tmp_path / "o.exr"),
        (good, "-o", tmp_path / "o.pfm", "--spp", "1"),
        (good, "-o", tmp_path / "o.exr", "--spp", "1", "--curve", tmp_path / "o.csv"),
    ):
        said = opened(glimmer_command, tmp_path, *arguments)
        assert "OpenImageIO" not in said and "libglimmer_image" not in said, arguments


def test_images_open_it(glimmer_command: Path, tmp_path: Path) -> None:
    """Without this, the test above could not fail."""
    write_image(tmp_path / "sky.exr", np.ones((2, 4, 3), np.float32))
    good = write_scene(tmp_path, furnace(), "good.json")
    sky = write_scene(tmp_path, scene(environment={"image": "sky.exr"}), "sky.json")
    picture = tmp_path / "o.pfm"
    for arguments in (
        (good, "-o", tmp_path / "o.png"),
        (good, "-o", picture, "--curve", picture.with_suffix(".png")),
        (sky, "-o", picture),
    ):
        said = opened(glimmer_command, tmp_path, *arguments, "--spp", "1")
        assert "OpenImageIO" in said and "libglimmer_image.so" in said, arguments


@pytest.fixture
def moved(glimmer_command: Path, library_dir: Path, tmp_path: Path) -> Path:
    """The command with the engine's library alone, in another place."""
    (tmp_path / "bin").mkdir()
    (tmp_path / "lib").mkdir()
    shutil.copy(library_dir / "libglimmer.so", tmp_path / "lib")
    return Path(shutil.copy(glimmer_command, tmp_path / "bin"))


def test_a_missing_image_library_is_one_line_before_the_render(moved: Path, tmp_path: Path) -> None:
    library = tmp_path / "lib" / "libglimmer_image.so"
    path = write_scene(tmp_path, furnace())
    assert run(moved, "--version").returncode == 0
    assert run(moved, path, "-o", tmp_path / "o.exr", "--spp", "1").returncode == 0
    endless = run(moved, path, "-o", tmp_path / "o.png", "--time", "1000000")
    assert endless.returncode == 2
    assert endless.stderr == (
        f"images can be neither read nor written: {library}: cannot open shared object file: No such file or directory;"
        " `python3 build.py build` makes that library and installs what it needs\n"
    )


def test_another_builds_image_library_is_refused(moved: Path, library_dir: Path, tmp_path: Path) -> None:
    library = tmp_path / "lib" / "libglimmer_image.so"
    shutil.copy(library_dir / "libglimmer.so", library)
    done = run(moved, write_scene(tmp_path, furnace()), "-o", tmp_path / "o.png", "--spp", "1")
    assert done.returncode == 2
    assert f"{library} is of another version than this command; `python3 build.py build`" in done.stderr
    assert done.stderr.count("\n") == 1
