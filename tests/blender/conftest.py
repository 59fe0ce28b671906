# SPDX-License-Identifier: GPL-3.0-or-later

import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))

from hosts import HOSTS, Host, environment


@pytest.fixture(scope="session")
def blender_host(blender: Path, library_dir: Path, tmp_path_factory: pytest.TempPathFactory) -> Host:
    profile = tmp_path_factory.mktemp("profile")
    return Host("blender", blender, environment(profile, library_dir / "libglimmer.so", blender))


@pytest.fixture(scope="session", params=HOSTS)
def host(request: pytest.FixtureRequest, library_dir: Path, tmp_path_factory: pytest.TempPathFactory) -> Host:
    """Each of the Blenders in turn."""
    if request.param == "blender":
        found: Host = request.getfixturevalue("blender_host")
        return found
    profile = tmp_path_factory.mktemp("profile")
    python = request.getfixturevalue(f"{request.param}_python")
    return Host(request.param, python, environment(profile, library_dir / "libglimmer.so", None))


@pytest.fixture(scope="module")
def display() -> Iterator[str]:
    """An X server of our own."""
    for program in ("Xvfb", "xdotool", "import"):
        assert shutil.which(program), f"{program} is missing; run the tests by `python3 build.py test`"
    read_end, write_end = os.pipe()
    command = ["Xvfb", "-displayfd", str(write_end), "-screen", "0", "1280x800x24", "+extension", "GLX"]
    server = subprocess.Popen(command, pass_fds=[write_end], stderr=subprocess.DEVNULL)
    os.close(write_end)
    with os.fdopen(read_end) as pipe:
        number = pipe.readline().strip()
    assert number, "Xvfb did not start"
    yield f":{number}"
    server.terminate()
    server.wait(10)
