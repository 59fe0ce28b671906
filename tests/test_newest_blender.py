# SPDX-License-Identifier: GPL-3.0-or-later
"""The host that is not pinned: which wheel it takes, when it looks for a newer one, and what it says when it cannot."""

import os
import subprocess
import time
from pathlib import Path

import pytest

import build
from tests import newest_blender
from tests.newest_blender import UnavailableError, Wheel

# Stands in for `pip index versions bpy --python-version N`.
PIP = """#!/bin/sh
case "$5" in
{cases}
*) echo 'ERROR: No matching distribution found for bpy' >&2; exit 1;;
esac
"""


@pytest.fixture(autouse=True)
def releases(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(newest_blender, "RELEASES", {"3.13": "trixie", "3.14": "forky", "3.15": "next"})


def index(folder: Path, **newest: str) -> list[Path]:
    """A pip that knows these wheels: py313="5.3.0"."""
    cases = [f"3.{python[3:]}) echo 'bpy ({version})';;" for python, version in newest.items()]
    pip = folder / "pip"
    pip.write_text(PIP.format(cases="\n".join(cases)))
    pip.chmod(0o755)
    return [pip]


class Installed(list[Wheel]):
    """Stands in for install()."""

    def __call__(self, wheel: Wheel, folder: Path, _requirements: Path) -> None:
        self.append(wheel)
        folder.mkdir(exist_ok=True)


@pytest.fixture
def installed(monkeypatch: pytest.MonkeyPatch) -> Installed:
    recorded = Installed()
    monkeypatch.setattr(newest_blender, "install", recorded)
    return recorded


def a_day_later(folder: Path) -> None:
    then = time.time() - newest_blender.SECONDS_BETWEEN_LOOKS - 1
    os.utime(folder / "made", (then, then))


def make(folder: Path, pip: list[Path]) -> str:
    """What it said."""
    lines: list[str] = []
    newest_blender.make(folder, Path("newest.txt"), pip, lines.append)
    return "\n".join(lines)


def test_the_newest_wheel_decides_the_python(tmp_path: Path) -> None:
    assert newest_blender.newest_wheel(index(tmp_path, py313="5.9.2", py314="5.10.0")) == Wheel("5.10.0", "3.14")
    assert newest_blender.newest_wheel(index(tmp_path, py313="5.3.0")) == Wheel("5.3.0", "3.13")


def test_it_is_made_once_and_looks_for_a_newer_one_once_a_day(tmp_path: Path, installed: Installed) -> None:
    folder, old, new = tmp_path / "newest", Wheel("5.3.0", "3.13"), Wheel("5.3.1", "3.13")
    assert "bpy 5.3.0 in Python 3.13" in make(folder, index(tmp_path, py313="5.3.0"))
    assert "bpy 5.3.0 in Python 3.13" in make(folder, index(tmp_path, py313="5.3.1"))
    assert installed == [old]
    a_day_later(folder)
    assert "bpy 5.3.1 in Python 3.13" in make(folder, index(tmp_path, py313="5.3.1"))
    assert installed == [old, new]
    a_day_later(folder)
    make(folder, index(tmp_path, py313="5.3.1"))
    assert installed == [old, new]


def test_without_an_index_it_keeps_what_it_has_and_says_so(tmp_path: Path, installed: Installed) -> None:
    folder, silent = tmp_path / "newest", index(tmp_path)
    with pytest.raises(UnavailableError, match=r"no bpy for Python 3\.13, 3\.14, 3\.15 \(ERROR: No matching"):
        make(folder, silent)
    make(folder, index(tmp_path, py313="5.3.0"))
    a_day_later(folder)
    said = make(folder, index(tmp_path))
    assert "bpy 5.3.0 in Python 3.13; whether there is a newer one could not be found out: " in said
    assert "No matching distribution" in said and "\n" not in said
    assert len(installed) == 1


def test_an_install_that_fails_leaves_nothing_that_counts_as_made(
    tmp_path: Path, installed: Installed, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "newest"
    make(folder, index(tmp_path, py313="5.3.0"))
    a_day_later(folder)

    def fail(*_: object) -> None:
        raise UnavailableError("the disk is full")

    monkeypatch.setattr(newest_blender, "install", fail)
    with pytest.raises(UnavailableError, match="the disk is full"):
        make(folder, index(tmp_path, py313="5.4.0"))
    assert not (folder / "made").exists()
    assert len(installed) == 1


def test_a_python_on_the_path_that_does_not_run_is_passed_over(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    shim = tmp_path / "python3.13"
    shim.write_text("#!/bin/sh\nexit 127\n")
    shim.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path))
    assert newest_blender.python_on_path("3.13") is None
    shim.write_text("#!/bin/sh\nexit 0\n")
    assert newest_blender.python_on_path("3.13") == str(shim)
    monkeypatch.setenv("PATH", str(tmp_path / "empty"))
    with pytest.raises(UnavailableError, match=r"no Python 3\.13 on PATH, and no apt"):
        newest_blender.unpack_debian("3.13", tmp_path / "debian")


def test_a_command_that_fails_is_told_in_one_line() -> None:
    with pytest.raises(UnavailableError) as error:
        newest_blender.output_of(["sh", "-c", "echo 'E: no such package' >&2; echo 'W: never mind' >&2; exit 100"])
    assert str(error.value).startswith("E: no such package (from: sh -c ")
    assert "\n" not in str(error.value)
    with pytest.raises(UnavailableError, match="No such file or directory: 'no-such-program'"):
        newest_blender.output_of(["no-such-program"])


@pytest.mark.parametrize("ci", ["true", ""])
def test_where_it_cannot_be_made_its_tests_are_skipped_but_fail_under_ci(
    ci: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def fail(*_: object) -> Path:
        raise UnavailableError("no network")

    monkeypatch.setattr(build, "virtual_environment", Path)
    monkeypatch.setattr(newest_blender, "make", fail)
    monkeypatch.setenv("CI", ci)
    if ci:
        with pytest.raises(build.BuildError, match="the newest Blender cannot be made: no network"):
            build.newest_host()
    else:
        assert build.newest_host() == {"GLIMMER_NO_NEWEST": "no network"}
        assert "The tests in the newest Blender are skipped: no network" in capsys.readouterr().out


def test_it_is_not_pinned() -> None:
    lines = (build.REQUIREMENTS / "newest.txt").read_text().splitlines()
    assert [line for line in lines if not line.startswith("#")] == ["bpy"]


def test_it_is_newer_than_the_pinned_one(bpy_python: Path, newest_python: Path) -> None:
    def version(python: Path) -> list[int]:
        command = [str(python), "-c", "import importlib.metadata as m; print(m.version('bpy'))"]
        output = subprocess.run(command, check=True, capture_output=True, text=True, timeout=60).stdout
        return [int(part) for part in output.split(".")]

    assert version(newest_python) > version(bpy_python)
