# SPDX-License-Identifier: GPL-3.0-or-later
"""Every shader and each input of the Principled one beside Cycles: what differs is told."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hosts import Host

SCRIPT = Path(__file__).with_name("closures_script.py")
LARGE = 0.04  # of a block's brightness
SURE = 6.0  # standard errors


def differs(case: dict[str, Any]) -> bool:
    """Whether blocks of the picture are apart by more than a little, and more than by noise."""
    cycles, ours = np.array(case["CYCLES"]), np.array(case["GLIMMER"])
    difference = ours.mean(axis=0) - cycles.mean(axis=0)
    error = np.sqrt((ours.var(axis=0, ddof=1) + cycles.var(axis=0, ddof=1)) / len(ours)) + 1e-4
    apart = (np.abs(difference) > SURE * error) & (np.abs(difference) > LARGE * cycles.mean(axis=0))
    return bool(apart.any(axis=-1).mean() > 0.02)


@pytest.mark.full
@pytest.mark.timeout(1800)
def test_no_closure_differs_in_silence(host: Host, tmp_path: Path) -> None:
    path = tmp_path / "facts.json"
    host.run_script(SCRIPT, str(path), timeout=1700)
    cases: dict[str, Any] = json.loads(path.read_text())
    assert len(cases) > 40
    assert [name for name, case in cases.items() if differs(case) and not case["notices"]] == []
