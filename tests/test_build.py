# SPDX-License-Identifier: GPL-3.0-or-later
"""build.py: what it installs, how it fails, and that its commands do what its help says."""

import ast
import os
import re
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import pytest

import build

ROOT = Path(__file__).resolve().parent.parent
# The user's own python3, not the one of the tests' virtual environment.
PYTHON = "/usr/bin/python3" if Path("/usr/bin/python3").exists() else sys.executable


def build_py(*arguments: str | Path, **variables: str) -> subprocess.CompletedProcess[str]:
    command = [PYTHON, str(ROOT / "build.py"), *map(str, arguments)]
    return subprocess.run(
        command, env={**os.environ, **variables}, capture_output=True, text=True, check=False, timeout=280
    )


def test_imports_nothing_but_the_standard_library() -> None:
    tree = ast.parse((ROOT / "build.py").read_text())
    names = {alias.name for node in ast.walk(tree) if isinstance(node, ast.Import) for alias in node.names}
    names |= {node.module or "" for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)}
    assert names, "no import found: this test reads the wrong file"
    assert {name.split(".")[0] for name in names} <= sys.stdlib_module_names


def test_help_names_every_command() -> None:
    text = build_py("--help").stdout
    for command in ("setup", "build", "render", "test", "bench", "check", "lint", "package", "clean"):
        assert re.search(rf"^ +{command} ", text, re.MULTILINE), command
        assert build_py(command, "--help").stdout.startswith(f"usage: build.py {command}")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("render", "--samples", "0"), "--samples 0: must be from 1"),
        (("render", "--resolution", "101"), "--resolution 101: must be from 1 to 100"),
        (("render", "nowhere.blend"), "nowhere.blend: no such file"),
        (("setup", "--blender", "/nowhere/blender"), "--blender /nowhere/blender: no such executable"),
        (("bench", "--peers", "mitsuba,arnold"), "--peers arnold: must be of mitsuba, luxcore"),
        (("polish",), "invalid choice: 'polish'"),
    ],
)
def test_bad_arguments_are_refused_in_words(arguments: Sequence[str], message: str) -> None:
    result = build_py(*arguments)
    assert result.returncode in (1, 2)
    assert message in result.stderr
    assert "Traceback" not in result.stderr


# ---- Packages ----------------------------------------------------------------------------------------------------


def test_package_table_has_no_doubles_and_known_purposes() -> None:
    names = [package.name for package in build.PACKAGES]
    assert len(names) == len(set(names))
    assert {package.purpose for package in build.PACKAGES} == {"build", "render", "test", "mitsuba"}
    assert all(package.why for package in build.PACKAGES)


def test_a_foreign_blender_replaces_the_packages_of_debians(tmp_path: Path) -> None:
    foreign = tmp_path / "blender"
    foreign.touch()
    assert {"blender", "python3-numpy"} <= set(build.wanted_packages(("build", "render"), None))
    assert "python3-numpy" in build.wanted_packages(("render",), Path("/usr/bin/blender"))
    assert build.wanted_packages(("render",), foreign) == []
    assert "python3-venv" not in build.wanted_packages(("build", "render"), None)


def test_missing_packages_are_those_that_dpkg_does_not_know_as_installed() -> None:
    assert build.missing_packages(["zz-no-such-package", "dpkg", "aa-no-such-package"]) == [
        "zz-no-such-package",
        "aa-no-such-package",
    ]


class Calls(list[list[str]]):
    """Stands in for build.run and records what would have run."""

    def __call__(self, command: Sequence[str | Path], cwd: Path = ROOT, env: dict[str, str] | None = None) -> None:
        self.append([str(word) for word in command])
        self.environment = env or {}


@pytest.fixture
def calls(monkeypatch: pytest.MonkeyPatch) -> Calls:
    recorded = Calls()
    monkeypatch.setattr(build, "run", recorded)
    return recorded


def test_without_root_it_prints_the_one_command_to_run(monkeypatch: pytest.MonkeyPatch, calls: Calls) -> None:
    monkeypatch.setattr(os, "geteuid", lambda: 1000)
    with pytest.raises(build.BuildError, match=r"sudo sh -c 'apt-get update && apt-get install -y .*zz-absent'"):
        build.install_packages(["dpkg", "zz-absent"])
    assert calls == []


def test_as_root_it_installs_what_is_missing_without_a_question(monkeypatch: pytest.MonkeyPatch, calls: Calls) -> None:
    monkeypatch.setattr(os, "geteuid", lambda: 0)
    build.install_packages(["dpkg", "zz-absent"])
    assert [("update" in call, "install" in call) for call in calls] == [(True, False), (False, True)]
    assert calls[1][-1] == "zz-absent"
    assert "dpkg" not in calls[1]
    assert all("-y" in call for call in calls)
    assert calls.environment["DEBIAN_FRONTEND"] == "noninteractive"


def test_nothing_is_installed_when_nothing_is_missing(calls: Calls) -> None:
    build.install_packages(["dpkg"])
    assert calls == []


# ---- Virtual environments ----------------------------------------------------------------------------------------


def test_a_virtual_environment_is_made_once_per_requirements(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, calls: Calls
) -> None:
    monkeypatch.setattr(build, "ROOT", tmp_path)
    monkeypatch.setattr(build, "BUILD", tmp_path / "build")
    monkeypatch.setattr(build, "REQUIREMENTS", tmp_path)
    requirements = tmp_path / "some.txt"
    requirements.write_text("one==1\n")
    (tmp_path / "build" / "venv" / "some").mkdir(parents=True)  # `run` makes nothing here
    build.virtual_environment("some")
    assert [call[2] for call in calls] == ["venv", "pip"]
    build.virtual_environment("some")
    assert len(calls) == 2
    requirements.write_text("one==2\n")
    build.virtual_environment("some")
    assert len(calls) == 4


@pytest.mark.parametrize("name", ["test", "bpy", "bench", "mitsuba", "luxcore"])
def test_requirements_are_pinned(name: str) -> None:
    lines = (build.REQUIREMENTS / f"{name}.txt").read_text().splitlines()
    pins = [line for line in lines if line and not line.startswith("#")]
    assert pins
    assert all(re.fullmatch(r"[\w-]+==[\d.]+", line) for line in pins)


# ---- Rendering ---------------------------------------------------------------------------------------------------


def test_render_writes_a_png_and_an_exr_and_prints_their_paths(tmp_path: Path) -> None:
    stem = tmp_path / "picture"
    # With a suffix as well as without: as people type it.
    result = build_py("render", "--samples", "1", "--resolution", "10", "--output", stem.with_suffix(".png"))
    assert result.returncode == 0, result.stdout[-3000:] + result.stderr[-3000:]
    assert result.stdout.split()[-2:] == [f"{stem}.png", f"{stem}.exr"]
    assert (tmp_path / "picture.png").read_bytes().startswith(b"\x89PNG")
    assert (tmp_path / "picture.exr").read_bytes().startswith(b"\x76\x2f\x31\x01")


def test_a_target_that_cannot_be_written_is_told_before_rendering(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    (tmp_path / "folder.exr").mkdir()
    for stem, reason in ((tmp_path / "file" / "p", "is no folder"), (tmp_path / "folder", "Is a directory")):
        result = build_py("render", "--samples", "1", "--output", stem)
        assert result.returncode == 1
        assert "--output" in result.stderr and str(stem) in result.stderr and reason in result.stderr
        assert "Fra:" not in result.stdout


def test_without_a_blender_it_renders_in_the_bpy_module(bpy_python: Path, tmp_path: Path) -> None:
    assert build.virtual_environment("bpy") == bpy_python
    programs = tmp_path / "bin"
    programs.mkdir()
    for folder in reversed(os.environ["PATH"].split(os.pathsep)):
        for program in Path(folder).glob("*"):
            (programs / program.name).unlink(missing_ok=True)
            (programs / program.name).symlink_to(program)
    (programs / "blender").unlink(missing_ok=True)
    stem = tmp_path / "picture"
    result = build_py("render", "--samples", "1", "--resolution", "10", "--output", stem, PATH=str(programs))
    assert result.returncode == 0, result.stdout[-3000:] + result.stderr[-3000:]
    assert "Blender quit" not in result.stdout
    assert {path.name for path in tmp_path.iterdir()} == {"bin", "picture.png", "picture.exr"}


def test_a_scene_that_cannot_be_read_ends_without_a_picture(tmp_path: Path) -> None:
    scene = tmp_path / "broken.blend"
    scene.write_bytes(b"not a blend file")
    result = build_py("render", scene, "--output", tmp_path / "broken")
    assert result.returncode == 1
    assert list(tmp_path.iterdir()) == [scene]


def test_a_library_that_cannot_be_loaded_ends_without_a_picture(tmp_path: Path) -> None:
    result = build_py("render", "--output", tmp_path / "p", GLIMMER_LIBRARY=str(tmp_path / "libnone.so"))
    assert result.returncode == 1
    assert "libnone.so" in result.stdout + result.stderr
    assert list(tmp_path.iterdir()) == []


def test_blender_finds_its_own_python_behind_another_on_the_path(
    blender: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PATH", f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}")
    command = [str(blender), "-b", "--factory-startup", "--python-expr", "import sys; print('PREFIX', sys.prefix)"]
    env = build.host_environment(tmp_path, blender)
    result = subprocess.run(command, env=env, capture_output=True, text=True, check=False, timeout=60)
    assert "PREFIX " in result.stdout
    assert f"PREFIX {sys.prefix}" not in result.stdout


def test_ci_runs_lint_and_the_tests() -> None:
    script = (ROOT / ".ci" / "run").read_text()
    assert "set -euo pipefail" in script
    commands = re.findall(r"^python3 build\.py (.*)$", script, re.MULTILINE)
    assert commands == ["lint", "test"]


def test_check_passes_its_options_on() -> None:
    done = build_py("check", "--only", "no such case")
    assert done.returncode == 1
    assert "--only no such case: no case's name holds that" in done.stdout + done.stderr
