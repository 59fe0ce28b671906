# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the tests find what build.py made, and which of them run by default."""

import os
import shutil
from pathlib import Path
from typing import Any

import pytest

from tests.render.statistics import budget

ROOT = Path(__file__).resolve().parent.parent


def default_environment() -> dict[str, Path]:
    """What `build.py test` sets, for whoever runs pytest directly."""
    paths = {
        "GLIMMER_BIN": ROOT / "build" / "bin" / "glimmer",
        "GLIMMER_LIB_DIR": ROOT / "build" / "lib",
        "GLIMMER_BPY_PYTHON": ROOT / "build" / "venv" / "bpy" / "bin" / "python",
        "GLIMMER_NEWEST_PYTHON": ROOT / "build" / "hosts" / "newest" / "venv" / "bin" / "python",
    }
    blender = shutil.which("blender")
    return {**paths, "GLIMMER_BLENDER": Path(blender)} if blender else paths


for _name, _path in default_environment().items():
    os.environ.setdefault(_name, str(_path))


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--full", action="store_true", help="also the long tests, marked `full`")


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    if config.getoption("--full"):
        return
    long = [item for item in items if item.get_closest_marker("full")]
    if long:
        config.hook.pytest_deselected(items=long)
        items[:] = [item for item in items if not item.get_closest_marker("full")]


def pytest_sessionfinish(session: pytest.Session) -> None:
    """A worker among several tells how many comparisons of pictures it made: all workers share one level."""
    if hasattr(session.config, "workeroutput"):
        session.config.workeroutput["comparisons"] = budget.used


@pytest.hookimpl(optionalhook=True)
def pytest_testnodedown(node: Any, error: object) -> None:
    budget.add(getattr(node, "workeroutput", {}).get("comparisons", 0))


def product(variable: str, what: str, file: str = "") -> Path:
    """The path in an environment variable; the test fails, and says how to get it, when nothing is there."""
    value = os.environ.get(variable)
    if value is None or not (Path(value) / file).exists():
        pytest.fail(f"{what} is missing ({variable}={value}); run the tests by `python3 build.py test`", pytrace=False)
    return Path(value)


@pytest.fixture(scope="session")
def repository() -> Path:
    """The root of the checkout."""
    return ROOT


@pytest.fixture(scope="session")
def glimmer_command() -> Path:
    """The `glimmer` executable."""
    return product("GLIMMER_BIN", "the command line")


@pytest.fixture(scope="session")
def library_dir() -> Path:
    """The folder of libglimmer.so and libglimmer_probe.so."""
    return product("GLIMMER_LIB_DIR", "the engine", "libglimmer.so")


@pytest.fixture(scope="session")
def blender() -> Path:
    """A Blender executable."""
    return product("GLIMMER_BLENDER", "Blender")


@pytest.fixture(scope="session")
def bpy_python() -> Path:
    """A Python that can import bpy."""
    return product("GLIMMER_BPY_PYTHON", "the bpy wheel")


@pytest.fixture(scope="session")
def newest_python() -> Path:
    """A Python that can import the newest bpy there is. Where it could not be made, its tests are skipped, but under
    CI=true.
    """
    if os.environ.get("CI") != "true" and not Path(os.environ["GLIMMER_NEWEST_PYTHON"]).exists():
        made = "it is not made yet; `python3 build.py setup --test` makes it"
        pytest.skip(f"the newest Blender: {os.environ.get('GLIMMER_NO_NEWEST', made)}")
    return product("GLIMMER_NEWEST_PYTHON", "the newest bpy wheel")
