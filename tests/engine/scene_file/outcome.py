# SPDX-License-Identifier: GPL-3.0-or-later
"""What the command makes of a scene file: the one line that a bad one gets, or a picture."""

from pathlib import Path

from tests.engine.scenes import Scene, run_glimmer, write_scene


def message_of(folder: Path, content: Scene | str) -> str:
    """The one line that a bad scene gets, without the file's name."""
    path = write_scene(folder, content)
    done = run_glimmer(path, "-o", folder / "out.exr", "--spp", 1)
    assert done.returncode == 1, f"exit status {done.returncode}: {done.stderr}"
    assert done.stderr.startswith(f"{path}: ") and done.stderr.endswith("\n")
    assert done.stderr.count("\n") == 1, f"not one line: {done.stderr!r}"
    assert not list(folder.glob("out*")), "a failed run left a picture"
    return done.stderr[len(f"{path}: ") : -1]


def expect_good(folder: Path, content: Scene) -> None:
    path = write_scene(folder, content)
    done = run_glimmer(path, "-o", folder / "out.exr", "--spp", 1, "--quiet")
    assert done.returncode == 0, done.stderr
