# SPDX-License-Identifier: GPL-3.0-or-later
"""addon/docs/nodes.md lists every shader node and its state: made by this test, and held up to date by it.

GLIMMER_WRITE_DOCS=1 lets the test of a host write its column.
"""

import json
import os
from pathlib import Path
from typing import Any

import pytest
from hosts import ROOT, Host

SCRIPT = Path(__file__).with_name("node_list_script.py")
TABLE = ROOT / "addon" / "docs" / "nodes.md"
COLUMNS = {"blender": "3.4", "newest": "newest"}
NOTHING = "-"

HEAD = """# Shader nodes

What Glimmer makes of each node of Blender's shader trees, in the oldest Blender that it knows and in the newest.

- A number: that many of the tests' cases have the node and show, as emission, pixel by pixel what Cycles shows
  (`tests/blender/test_shading.py`; `tests/blender/shading_cases.py` has the modes and options).
- `value`: translated, without a case of its own. `shader`: a closure; what of it differs is told where it is used.
- `told`: not translated. Its place takes what passes through the node, or a substitute, and a notice in Blender's info
  log, the report and the "Differs from Cycles" box names the object, the material and the node.
- `-`: this Blender has no such node.

Beneath the horizon the single scattering sky of Blender 5 differs by up to two hundredths. The sun of a Sky Texture is
a lamp of the mean of its disc, and the camera sees the disc itself.

Light Path: *Is Camera Ray* and *Is Shadow Ray* are exact. Light that is sampled, and light vertices, cannot know the
rest: they are asked for as by a diffuse ray of depth 1. The depths of single kinds of rays are 0, and both are told.

Attribute of type *Instancer*: what geometry nodes give instances is read from Blender 5.0 on, and told before.

| node | 3.4 | newest |
|---|---|---|
"""


def read() -> dict[str, dict[str, str]]:
    """The cells by node and column."""
    rows: dict[str, dict[str, str]] = {}
    for line in TABLE.read_text().splitlines() if TABLE.is_file() else ():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if len(cells) == 3 and cells[0] not in ("node", "---"):
            rows[cells[0]] = dict(zip(COLUMNS.values(), cells[1:], strict=True))
    return rows


def write(rows: dict[str, dict[str, str]]) -> None:
    lines = [f"| {name} | {row['3.4']} | {row['newest']} |\n" for name, row in sorted(rows.items())]
    TABLE.write_text(HEAD + "".join(lines))


def cells(found: dict[str, Any]) -> dict[str, str]:
    """What a host's column says, by the nodes' labels."""
    return {
        item["label"]: str(item["cases"]) if item["cases"] and item["state"] == "value" else item["state"]
        for item in found.values()
    }


@pytest.mark.parametrize("host", COLUMNS, indirect=True, scope="session")
def test_the_table_of_nodes_is_up_to_date(host: Host, tmp_path: Path) -> None:
    host.run_script(SCRIPT, str(tmp_path / "nodes.json"))
    now = cells(json.loads((tmp_path / "nodes.json").read_text()))
    column, rows = COLUMNS[host.kind], read()
    if os.environ.get("GLIMMER_WRITE_DOCS"):
        for name in {*rows, *now}:
            rows.setdefault(name, dict.fromkeys(COLUMNS.values(), NOTHING))[column] = now.get(name, NOTHING)
        write(rows)
    assert TABLE.read_text().startswith(HEAD)
    assert {name: row[column] for name, row in rows.items() if row[column] != NOTHING} == now
