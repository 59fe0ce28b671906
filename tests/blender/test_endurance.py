# SPDX-License-Identifier: GPL-3.0-or-later
"""Many renders in one window, stopped at random moments, with file loads, undo, rendered views and the add-on switched
off and on between them (rendered views among many rounds only): no crash, and nothing left behind.
"""

import json
import subprocess
from pathlib import Path

import numpy as np
import pytest
from hosts import Host

SCRIPT = Path(__file__).with_name("endurance_script.py")
# Of the film of a render, in bytes a render: nothing leaks 0, a film that is not freed 1. Blender's own memory comes
# and goes, so that a few renders tell less than many.
LEAKED_SHARE = {12: 0.5, 200: 0.1}


@pytest.mark.parametrize("count", [12, pytest.param(200, marks=[pytest.mark.full, pytest.mark.timeout(2400)])])
def test_nothing_is_left_of_many_renders(blender_host: Host, display: str, tmp_path: Path, count: int) -> None:
    env = {**blender_host.env, "DISPLAY": display, "LIBGL_ALWAYS_SOFTWARE": "1"}
    command = [str(blender_host.program), "--factory-startup", "--python", str(SCRIPT), "--", str(tmp_path), str(count)]
    result = subprocess.run(command, env=env, capture_output=True, text=True, check=False, timeout=250 + 10 * count)
    output = result.stdout[-3000:] + result.stderr[-3000:]
    # Blender's own status is 1 when Escape was the last thing that a render heard.
    assert result.returncode in (0, 1) and "Blender quit" in output, f"exit status {result.returncode}\n{output}"
    facts = json.loads((tmp_path / "facts.json").read_text())
    assert facts.get("is_finished"), facts.get("error")
    assert "Traceback" not in output and "a defect of the add-on" not in output, output
    rounds = facts["rounds"]
    assert len(rounds) == count
    assert {entry["renders"] for entry in rounds} <= {0, None}
    assert facts["renders_at_the_end"] == 0
    stops = [name for entry in rounds for name in entry["stops"]]
    assert {"cancel", "escape"} <= set(stops), "nothing was stopped: the renders ended by themselves"

    # Blender starts threads of its own in the first rounds.
    assert facts["tasks_at_the_end"] <= max(entry["tasks"] for entry in rounds[: len(rounds) // 2])
    second_half = np.array([entry["bytes"] for entry in rounds[len(rounds) // 2 :]], float)
    growth = np.polyfit(np.arange(len(second_half)), second_half, 1)[0]
    assert facts["film_bytes"] > 0
    assert growth < LEAKED_SHARE[count] * facts["film_bytes"], (
        f"{growth / 2**20:.1f} MB a render, of {facts['film_bytes'] / 2**20:.1f} MB that one holds"
    )
