# SPDX-License-Identifier: GPL-3.0-or-later
"""Modules of the add-on inside Blender, without its registration and without the engine's library."""

import importlib
import sys
import types
from pathlib import Path
from typing import Any

ADDON = Path(__file__).resolve().parents[2] / "addon"


def load(name: str) -> Any:
    if "glimmer" not in sys.modules:
        package = types.ModuleType("glimmer")
        package.__path__ = [str(ADDON)]
        sys.modules["glimmer"] = package
    return importlib.import_module(f"glimmer.{name}")
