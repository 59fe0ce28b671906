# SPDX-License-Identifier: GPL-3.0-or-later
"""build.py: what it installs, how it fails, and that its commands do what its help says."""

import ast
import io
import os
import re
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

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


@pytest.mark.parametrize(
    ("file", "own"),
    [
        ("build.py", {"tests", "engine"}),
        ("tests/newest_blender.py", set()),
        ("engine/farm/__main__.py", {"", "problems", "farm", "frame", "live"}),
    ],
)
def test_imports_nothing_but_the_standard_library(file: str, own: set[str]) -> None:
    tree = ast.parse((ROOT / file).read_text())
    names = {alias.name for node in ast.walk(tree) if isinstance(node, ast.Import) for alias in node.names}
    names |= {node.module or "" for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)}
    assert names, "no import found: this test reads the wrong file"
    assert {name.split(".")[0] for name in names} <= sys.stdlib_module_names | own


def test_help_names_every_command() -> None:
    text = build_py("--help").stdout
    for command in (
        "setup",
        "build",
        "render",
        "test",
        "bench",
        "compare",
        "check",
        "farm",
        "lint",
        "package",
        "clean",
    ):
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
        (("compare", "nowhere.blend"), "nowhere.blend: no such file"),
        (("compare", "nowhere.blend", "--width", "0"), "--width 0: must be from 1"),
        (("compare", "nowhere.blend", "--step-rate", "0"), "--step-rate 0: must be from 0.01 to 100"),
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
    assert {package.purpose for package in build.PACKAGES} == {"engine", "build", "render", "test", "mitsuba"}
    assert all(package.why for package in build.PACKAGES)


def test_a_foreign_blender_replaces_the_packages_of_debians(tmp_path: Path) -> None:
    foreign = tmp_path / "blender"
    foreign.touch()
    assert {"blender", "python3-numpy"} <= set(build.wanted_packages(("build", "render"), None))
    assert "python3-numpy" in build.wanted_packages(("render",), Path("/usr/bin/blender"))
    assert build.wanted_packages(("render",), foreign) == []
    assert build.wanted_packages(("render",), Path("/usr/bin/python3")) == []
    assert "python3-venv" not in build.wanted_packages(("build", "render"), None)


def test_the_library_alone_needs_a_compiler_and_no_more() -> None:
    assert set(build.wanted_packages(("engine",), None)) == {"g++", "cmake", "ninja-build"}
    assert {"g++", "libopenimageio-dev"} <= set(build.wanted_packages(("build",), None))


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


def test_a_target_alone_is_configured_without_the_rest_until_that_is_wanted(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, calls: Calls
) -> None:
    """The zip needs the library: neither the command nor what that has to find on the machine."""
    built: list[list[str]] = []

    def watch(command: list[str], *_: Any, **__: Any) -> int:
        built.append(command)
        return 0

    monkeypatch.setattr(build, "BUILD", tmp_path)
    monkeypatch.setattr(build, "watch", watch)
    home = f"CMAKE_HOME_DIRECTORY:INTERNAL={build.ENGINE}\n"
    (tmp_path / "release").mkdir()

    def configured_with(value: str) -> None:
        (tmp_path / "release" / "build.ninja").touch()
        (tmp_path / "release" / "CMakeCache.txt").write_text(f"{home}GLIMMER_COMMAND:BOOL={value}\n")

    build.build(target="glimmer")
    assert len(calls) == 1
    assert {"--fresh", "-DGLIMMER_COMMAND=OFF"} <= set(calls[0])
    assert built[0][-2:] == ["--target", "glimmer"]
    configured_with("OFF")
    build.build(target="glimmer")
    assert len(calls) == 1
    build.build()
    assert len(calls) == 2
    assert "-DGLIMMER_COMMAND=ON" in calls[1]
    assert "--fresh" not in calls[1]
    assert "--target" not in built[-1]
    configured_with("ON")
    build.build()
    build.build(target="glimmer")
    assert len(calls) == 2


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


# ---- Progress ----------------------------------------------------------------------------------------------------


class Screen(io.StringIO):
    """Stands in for the standard output."""

    def __init__(self, terminal: bool) -> None:
        super().__init__()
        self.terminal = terminal

    def isatty(self) -> bool:
        return self.terminal


def shown(monkeypatch: pytest.MonkeyPatch, terminal: bool, script: str) -> tuple[int, str]:
    """Exit status and output of a shell script that is watched as a build is."""
    screen = Screen(terminal)
    monkeypatch.setattr(sys, "stdout", screen)
    monkeypatch.setenv("COLUMNS", "80")
    status = build.watch(["sh", "-c", script], build.compiling)
    monkeypatch.undo()
    return status, screen.getvalue()


TWO_STEPS = "echo '[1/4] Building a'; echo strange >&2; echo '[3/4] Building b'; exit 3"


def test_on_a_terminal_progress_is_a_bar_in_place(monkeypatch: pytest.MonkeyPatch) -> None:
    status, text = shown(monkeypatch, True, TWO_STEPS)
    first = "Building  [######------------------]   25 %  1 of 4 steps"
    last = "Building  [##################------]   75 %  3 of 4 steps"
    assert text == f"\r{first}\x1b[K\r\x1b[Kstrange\n{first}\r{last}\x1b[K\n"
    assert status == 3


def test_elsewhere_progress_is_a_line_now_and_then_and_the_last(monkeypatch: pytest.MonkeyPatch) -> None:
    many = 'for i in $(seq 1 50); do echo "[$i/50] Building a"; done'
    assert shown(monkeypatch, False, TWO_STEPS) == (
        3,
        "Building   25 %  1 of 4 steps\nstrange\nBuilding   75 %  3 of 4 steps\n",
    )
    assert shown(monkeypatch, False, many) == (0, "Building    2 %  1 of 50 steps\nBuilding  100 %  50 of 50 steps\n")
    monkeypatch.setattr(build, "LINE_SECONDS", 0.0)
    assert shown(monkeypatch, False, many)[1].count("\n") == 50


@pytest.mark.parametrize(
    ("line", "text"),
    [
        ("Fra:1 Mem:18.25M (Peak 18.28M) | Time:00:00.03 | Reading the scene", "Rendering  reading the scene"),
        ("Fra:1 Building", "Rendering  building"),
        ("Fra:1 Mem:18.2M (Peak 18.4M) | Time:00:01.21 | Sample 0/32 | Mem 58 MB", "Rendering  0 of 32 samples"),
        (
            "Fra:1 Mem:20.23M (Peak 20.29M) | Time:01:31.21 | Sample 3/32 | 9 % | Left 04:12"
            " | Noise 33 % (27 to 190 %) | Mem 58 MB",
            "Rendering  [##----------------------]    9 %  4:12 left  3 of 32 samples  Noise 33 % (27 to 190 %)",
        ),
        (
            "Fra:12 Sample 32/32 | 100 % | Left 00:00 | Noise 14 % | Mem 58 MB",
            "Rendering  [########################]  100 %  32 of 32 samples  Noise 14 %",
        ),
        ("Fra:1 Sample 7 | Left 11:00:02 | Mem 58 MB", "Rendering  11:00:02 left  7 samples"),
    ],
)
def test_what_blender_prints_becomes_readable(line: str, text: str) -> None:
    progress = build.rendering(line)
    assert progress is not None and progress.text(bar=True) == text


def test_a_missing_program_is_named() -> None:
    with pytest.raises(build.BuildError, match=r"^no-such-program is not installed; "):
        build.watch(["no-such-program"], build.rendering)


def test_other_lines_of_blender_are_no_progress() -> None:
    assert build.rendering("Read blend: /scenes/Fra:1 glimmervoid.blend") is None
    assert build.rendering("Warning: Glimmer: Sample 3/32") is None


# ---- Rendering ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("options", "settings"),
    [
        ({}, {"resolution": 60, "samples": 32, "seconds": 150.0}),
        ({"samples": 3}, {"resolution": 60, "samples": 3}),  # as many as asked for, however long they take
        ({"resolution": 100}, {"resolution": 100, "samples": 32, "seconds": 150.0}),
        ({"frame": 7}, {"resolution": 60, "samples": 32, "seconds": 150.0, "frame": 7}),
        ({"full": True}, {}),
        ({"full": True, "samples": 3}, {"samples": 3}),
        ({"scene": build.DEFAULT_SCENE}, {}),  # named by the user: as the file has it
        ({"scene": build.DEFAULT_SCENE, "resolution": 50, "frame": 7}, {"resolution": 50, "frame": 7}),
    ],
)
def test_the_first_picture_is_quick_and_a_named_file_has_its_own_settings(
    options: dict[str, Any], settings: dict[str, float]
) -> None:
    given = {"scene": None, "output": None, "samples": None, "resolution": None, "frame": None, **options}
    assert build.settings_of(build.RenderOptions(**given)) == settings


def test_render_writes_a_png_and_an_exr_and_prints_their_paths(tmp_path: Path) -> None:
    stem = tmp_path / "picture"
    # With a suffix as well as without: as people type it.
    result = build_py("render", "--samples", "1", "--resolution", "10", "--output", stem.with_suffix(".png"))
    assert result.returncode == 0, result.stdout[-3000:] + result.stderr[-3000:]
    assert result.stdout.split()[-2:] == [f"{stem}.png", f"{stem}.exr"]
    assert (tmp_path / "picture.png").read_bytes().startswith(b"\x89PNG")
    assert (tmp_path / "picture.exr").read_bytes().startswith(b"\x76\x2f\x31\x01")
    assert "Rendering  100 %  1 of 1 samples" in result.stdout
    assert "Fra:" not in result.stdout


def test_a_target_that_cannot_be_written_is_told_before_rendering(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    (tmp_path / "folder.exr").mkdir()
    for stem, reason in ((tmp_path / "file" / "p", "is no folder"), (tmp_path / "folder", "Is a directory")):
        result = build_py("render", "--samples", "1", "--output", stem)
        assert result.returncode == 1
        assert "--output" in result.stderr and str(stem) in result.stderr and reason in result.stderr
        assert "Rendering" not in result.stdout


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
    assert "Rendering  100 %  1 of 1 samples" in result.stdout
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
