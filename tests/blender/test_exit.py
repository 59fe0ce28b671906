# SPDX-License-Identifier: GPL-3.0-or-later
"""A program that imported bpy and registered the add-on ends well."""

from pathlib import Path

from hosts import Host

# Blender 4.2, which no test runs, ends with a segmentation fault where the function of a property leads to bpy: each is
# looked at in the hosts there are.
SCRIPT = """
import sys
import bpy
sys.path.insert(0, {folder!r})
import inside
inside.enable()
from types import FunctionType

seen = 0
for group in bpy.types.PropertyGroup.__subclasses__():
    if not group.__module__.startswith("glimmer"):
        continue
    for name, definition in group.__annotations__.items():
        for function in definition.keywords.values():
            if isinstance(function, FunctionType):
                seen += 1
                held = [*function.__globals__.values(), *(cell.cell_contents for cell in function.__closure__ or ())]
                assert bpy not in held, f"{{group.__name__}}.{{name}} holds bpy"
assert seen > 20, seen
"""


def test_ends_well_and_properties_hold_nothing_of_blender(host: Host, tmp_path: Path) -> None:
    script = tmp_path / "exit.py"
    script.write_text(SCRIPT.format(folder=str(Path(__file__).parent)))
    host.run_script(script)
