# SPDX-License-Identifier: GPL-3.0-or-later

import sys
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
    python = request.getfixturevalue("bpy_python")
    return Host("bpy", python, environment(profile, library_dir / "libglimmer.so", None))
