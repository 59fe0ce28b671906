# SPDX-License-Identifier: GPL-3.0-or-later
"""What a render has to say beyond its picture: for the info log, for the panel, and for scripts."""

from __future__ import annotations

from typing import Any

import bpy

from .export.scene import Exported

_last: dict[str, Any] = {}


def last() -> dict[str, Any]:
    """The report of the last render of this process: the engine's (see the scene file's documentation), and `export`
    with seconds, bytes and notices."""
    return _last


def collect(engine_report: dict[str, Any], exported: Exported, warnings: list[str]) -> dict[str, Any]:
    report = dict(engine_report)
    report["warnings"] = list(dict.fromkeys([*report.get("warnings", []), *warnings]))
    report["export"] = {
        "seconds": exported.seconds,
        "bytes": exported.bytes,
        "notices": [str(notice) for notice in exported.notices],
    }
    return report


def publish(engine: bpy.types.RenderEngine, report: dict[str, Any]) -> None:
    _last.clear()
    _last.update(report)
    for line in [*report["export"]["notices"], *report["warnings"]]:
        engine.report({"WARNING"}, f"Glimmer: {line}")
    if report.get("biased_by"):
        engine.report({"INFO"}, f"Glimmer: biased by {', '.join(report['biased_by'])}")


def clear() -> None:
    _last.clear()


def summary(report: dict[str, Any]) -> list[str]:
    """The report in a few short lines."""
    lines = []
    if "spp" in report:
        seconds = report.get("seconds", {})
        lines.append(f"{report['spp']} samples in {seconds.get('render', 0.0):.1f} s")
    export = report["export"]
    lines.append(f"Scene read in {export['seconds']:.2f} s, {export['bytes'] / 2**20:.1f} MB")
    error = report.get("error")
    if error and error.get("relmse") is not None:
        lines.append(f"Error (relMSE) {error['relmse']:.2g}, at most {error['high']:.2g}")
    if report.get("left_out"):
        lines.append(f"Left out: {', '.join(report['left_out'])}")
    return lines
