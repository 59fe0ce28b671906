# SPDX-License-Identifier: GPL-3.0-or-later
"""What cannot be rendered: one line that says why, no picture, and an exit status that tells."""

import json
from pathlib import Path
from typing import Any

import pytest
from hosts import Host

SCRIPT = Path(__file__).with_name("failure_script.py")

WORDS = {
    "flat_camera": "Camera 'Camera' has a scale of 0 or a matrix that is not finite",
    "unreadable_mesh": "cannot be read: vertex 3 has a coordinate that is not a finite number",
    "missing_library": "The engine's library is missing; looked for",
    "defect": "a defect of the add-on, please report it: ZeroDivisionError: thought of by nobody",
}


@pytest.fixture(scope="module")
def broken(host: Host, tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    folder = tmp_path_factory.mktemp("failures")
    result = host.run(host.script_command(SCRIPT, str(folder)))
    facts: dict[str, Any] = json.loads((folder / "facts.json").read_text())
    return {"status": result.returncode, "folder": folder, **facts}


@pytest.mark.parametrize("kind", WORDS)
def test_the_caller_gets_one_clear_line(broken: dict[str, Any], kind: str) -> None:
    message = broken["messages"][kind].strip()
    assert WORDS[kind] in message
    assert "\n" not in message


@pytest.mark.parametrize("kind", WORDS)
def test_no_picture_is_left(broken: dict[str, Any], kind: str) -> None:
    assert broken["files"][kind] == []


def test_a_script_that_catches_decides_in_the_module_alone(broken: dict[str, Any], host: Host) -> None:
    """The executable ends with 1 after a failed render, whatever its script caught; a program decides for itself."""
    assert broken["status"] == (0 if host.is_module else 1)


@pytest.mark.parametrize("what", [["-f", "1"], ["-s", "1", "-e", "2", "-a"]], ids=["frame", "animation"])
def test_the_command_line_of_blender_ends_with_a_status(blender_host: Host, tmp_path: Path, what: list[str]) -> None:
    blender_host.run(blender_host.script_command(SCRIPT, str(tmp_path)))
    words = [str(tmp_path / "broken.blend"), "-E", "GLIMMER", "-o", str(tmp_path / "picture_##"), *what]
    result = blender_host.run([str(blender_host.program), "-b", "--addons", "glimmer", *words])
    assert result.returncode == 1
    assert (result.stdout + result.stderr).count(WORDS["flat_camera"]) == 1
    assert not list(tmp_path.glob("picture_*"))


def test_an_uncaught_failure_ends_the_program(host: Host, broken: dict[str, Any], tmp_path: Path) -> None:
    script = tmp_path / "uncaught.py"
    script.write_text(
        f"import sys; sys.path.insert(0, {str(SCRIPT.parent)!r})\n"
        "import bpy, inside\ninside.enable()\n"
        f"bpy.ops.wm.open_mainfile(filepath={str(broken['folder'] / 'broken.blend')!r})\n"
        f"inside.render(__import__('pathlib').Path({str(tmp_path / 'picture')!r}))\n"
    )
    result = host.run(host.script_command(script))
    assert result.returncode == (1 if host.is_module else result.returncode)
    assert result.returncode != 0
    assert WORDS["flat_camera"] in result.stdout + result.stderr
    assert not list(tmp_path.glob("picture*"))
