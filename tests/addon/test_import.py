# SPDX-License-Identifier: GPL-3.0-or-later
"""The modules below Blender import without it: in a Python that has no bpy."""

import subprocess
import sys
from pathlib import Path

MODULES = (
    "addon",
    "addon.scene.description",
    "addon.scene.writer",
    "addon.native.render",
    "addon.film.passes",
    "addon.film.display",
    "addon.export.scene",
    "addon.hexfield.layout",
)


def test_modules_below_blender_import_without_it(repository: Path) -> None:
    code = f"import sys; sys.modules['bpy'] = None\nimport {', '.join(MODULES)}"
    result = subprocess.run(
        [sys.executable, "-c", code], cwd=repository, capture_output=True, text=True, check=False, timeout=60
    )
    assert result.returncode == 0, result.stderr
