# SPDX-License-Identifier: GPL-3.0-or-later
"""Frames by Blender's command line alone, as render farms have them: a status, and no file that lies."""

import re
import signal
import subprocess
from pathlib import Path

import pytest
from hosts import Host

SCRIPT = Path(__file__).with_name("frames_script.py")
OLD = b"an older run's"
# What farm managers' logs take for a fault. OpenCue marks lines with these words, whatever the case.
ALARMS = ("error", "aborted", "fatal", "failed", "killed")


@pytest.fixture(scope="module")
def folder(blender_host: Host, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("frames")
    blender_host.run_script(SCRIPT, str(folder))
    return folder


def command(host: Host, file: Path, pictures: Path, *what: str) -> list[str]:
    words = [str(file), "-E", "GLIMMER", "-o", f"{pictures}/####", "-F", "PNG", *what]
    return [str(host.program), "-b", "--addons", "glimmer", *words]


def names(pictures: Path) -> list[str]:
    return sorted(path.name for path in pictures.iterdir())


def test_no_older_picture_stays_where_a_frame_fails(blender_host: Host, folder: Path, tmp_path: Path) -> None:
    for frame in (1, 2):
        (tmp_path / f"{frame:04d}.png").write_bytes(OLD)
    result = blender_host.run(command(blender_host, folder / "second_fails.blend", tmp_path, "-f", "1..2"))
    assert result.returncode == 1
    assert names(tmp_path) == ["0001.png"]
    assert (tmp_path / "0001.png").read_bytes().startswith(b"\x89PNG")
    lines = [line for line in result.stdout.splitlines() if any(word in line.lower() for word in ALARMS)]
    assert lines == [], "only the frame that failed may alarm, on the standard error"
    assert len([line for line in result.stderr.splitlines() if line.startswith("Error: Glimmer: Camera")]) == 1
    assert re.search(r"^Fra:1 .*\| Sample 2/2 \| 100 % \|", result.stdout, re.MULTILINE)


def test_an_animation_goes_on_where_it_was_broken_off(blender_host: Host, folder: Path, tmp_path: Path) -> None:
    """Finished frames are left alone, and what Blender says it saved is there. A failed one leaves no placeholder,
    which the next run would take for another machine's."""
    (tmp_path / "0001.png").write_bytes(OLD)
    words = command(blender_host, folder / "goes_on.blend", tmp_path)
    result = blender_host.run([*words, "-s", "1", "-e", "2", "-a"])
    assert result.returncode == 1
    assert names(tmp_path) == ["0001.png"]
    assert (tmp_path / "0001.png").read_bytes() == OLD

    result = blender_host.run([*words, "-f", "3"])
    assert result.returncode == 0
    assert names(tmp_path) == ["0001.png", "0003.png"]
    assert re.findall(r"^Saved: '(.*)'", result.stdout, re.MULTILINE)[-1] == str(tmp_path / "0003.png")


@pytest.mark.parametrize("name", ["SIGINT", "SIGKILL"])
def test_a_frame_that_is_broken_off_leaves_nothing_finished(
    blender_host: Host, folder: Path, tmp_path: Path, name: str
) -> None:
    (tmp_path / "0001.png").write_bytes(OLD)
    words = command(blender_host, folder / "endless.blend", tmp_path, "-s", "1", "-e", "2", "-a")
    with subprocess.Popen(words, stdout=subprocess.PIPE, text=True, env=blender_host.env) as process:
        assert process.stdout is not None
        for line in process.stdout:
            if "Sample" in line:
                break
        process.send_signal(signal.Signals[name])
        process.stdout.read()
        status = process.wait(60)
    assert status == (1 if name == "SIGINT" else -signal.SIGKILL)
    left = {path.name: path.stat().st_size for path in tmp_path.iterdir()}
    assert left.pop("0001.png") == len(OLD)
    assert left in ({}, {"0002.png": 0}), "at most an empty placeholder"
    assert name != "SIGINT" or not left
