# SPDX-License-Identifier: GPL-3.0-or-later
"""A report as the metadata of a picture: what Blender writes into the EXR or PNG."""

from __future__ import annotations

from typing import Any


def fields(report: dict[str, Any], layer: str) -> list[tuple[str, str]]:
    """(name, value) of each, under the name of its view layer."""
    if "spp" not in report:
        return []
    values: dict[str, Any] = {
        "engine": report["engine"],
        "integrator": report["integrator"],
        "samples": report["spp"],
        "seed": report["seed"],
        "seconds": report["seconds"]["render"],
        "cpu_seconds": report["seconds"]["cpu"],
        "biased_by": ", ".join(report["biased_by"]) or "nothing",
    }
    if error := report.get("error"):
        values |= {f"error.{name}": error[name] for name in ("relmse", "low", "high", "confidence")}
        if tails := error.get("tails"):
            values["error.certifiable"] = tails["certifiable"]
    return [
        (f"glimmer.{layer}.{name}", f"{value:.6g}" if isinstance(value, float) else str(value))
        for name, value in values.items()
        if value is not None
    ]
