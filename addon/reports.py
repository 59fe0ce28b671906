# SPDX-License-Identifier: GPL-3.0-or-later
"""What a render has to say beyond its picture: for the info log, for the panels, for scripts, and for its files."""

from __future__ import annotations

from typing import Any

import bpy
from bpy.app.handlers import persistent

from .export.scene import Exported
from .film import denoise
from .film.display import NOT_CERTIFIABLE, clock, error_text
from .film.noise import noise_text, seconds_to_half_the_noise, word_for
from .film.stamp import fields
from .scene.problems import ENDLESS_FOG

_current: dict[str, dict[str, Any]] = {"last": {}}
_layers: dict[str, dict[str, Any]] = {}  # of the render that is under way or was the last
_news = {"count": 0}


def last() -> dict[str, Any]:
    """The report of the last render of this process: the engine's (see the scene file's documentation), and `export`
    with seconds, bytes and notices. While it renders, as far as it is."""
    return _current["last"]


def layers() -> dict[str, dict[str, Any]]:
    """The same for each view layer of the last render."""
    return _layers


def news() -> int:
    """Another number whenever there is something new."""
    return _news["count"]


def collect(engine_report: dict[str, Any], exported: Exported) -> dict[str, Any]:
    report = dict(engine_report)
    # The export says these with names, so once is enough; and of a sky behind fog only where nothing shines inside.
    noticed = {notice.code for notice in exported.notices if notice.code} | {ENDLESS_FOG}
    warnings = zip(report.get("warnings", []), report.get("warning_codes", []), strict=True)
    kept = [(text, code) for text, code in warnings if code not in noticed]
    report["warnings"] = [text for text, _ in kept]
    report["warning_codes"] = [code for _, code in kept]
    report["export"] = {
        "seconds": exported.seconds,
        "bytes": exported.bytes,
        "notices": [str(notice) for notice in exported.notices],
    }
    return report


def update(report: dict[str, Any], layer: str) -> None:
    """May come from Blender's render thread: dictionaries are replaced, never changed while somebody reads them."""
    _current["last"] = report
    _layers[layer] = report
    _news["count"] += 1


def note_denoising(report: dict[str, Any], denoised: bool, problem: str) -> None:
    """problem: why the picture could not be denoised; empty where it was, or was not to be."""
    report["denoised"] = denoised
    if denoised:
        report["biased_by"] = [*report.get("biased_by", []), denoise.BIAS]
    if problem:
        report["warnings"].append(problem)
        report["warning_codes"].append("not_denoised")


def stamp(engine: bpy.types.RenderEngine, fields: list[tuple[str, str]]) -> None:
    """Into the metadata of the picture."""
    result = engine.get_result()
    if result is not None:
        for name, value in fields:
            result.stamp_data_add_field(name, value)


def publish(engine: bpy.types.RenderEngine, report: dict[str, Any], layer: str) -> None:
    update(report, layer)
    stamp(engine, fields(report, layer))
    notices = report["export"]["notices"]
    for line in notices:
        engine.report({"INFO"}, f"Glimmer: {line}")
    for line in report["warnings"]:
        engine.report({"WARNING"}, f"Glimmer: {line}")
    if report.get("biased_by"):
        engine.report({"INFO"}, f"Glimmer: biased by {', '.join(report['biased_by'])}")
    if notices and not bpy.app.background:  # last, since the window shows the last one alone
        engine.report({"WARNING"}, f"Glimmer: {count_of(len(notices))}: Render properties > Differs from Cycles")


def count_of(differences: int) -> str:
    things = "1 thing is" if differences == 1 else f"{differences} things are"
    return f"{things} not rendered as in Cycles"


def summary(report: dict[str, Any]) -> list[str]:
    """The report in a few short lines."""
    lines = []
    if "spp" in report:
        seconds = report.get("seconds", {})
        lines.append(f"{report['spp']} samples in {seconds.get('render', 0.0):.1f} s")
    if adaptive := report.get("adaptive"):
        lines.append(f"Adaptive sampling: pixels took {adaptive['fewest']} to {adaptive['most']} samples")
    export = report["export"]
    lines.append(f"Scene read in {export['seconds']:.2f} s, {export['bytes'] / 2**20:.1f} MB")
    if report.get("biased_by"):
        lines.append(f"Biased by {', '.join(report['biased_by'])}")
    return lines


def skipped(report: dict[str, Any]) -> list[str]:
    """The work that this scene has saved the engine."""
    return list(report.get("left_out", []))


def noise_summary(report: dict[str, Any]) -> list[str]:
    """How grainy the picture is, and how long until it is half as grainy."""
    error = report.get("error")
    if not error:
        return ["Noise is not known before there are some samples"]
    lines = [f"Noise about {noise_text(error['relmse'])}: {word_for(error['relmse'])}"]
    if report.get("seconds_to_half") is not None:
        seconds = report.get("seconds", {}).get("render", 0.0)
        lines.append(f"Half of it after {clock(seconds_to_half_the_noise(seconds, report['seconds_to_half']))} more")
    if report.get("seconds_to_target") is not None:
        lines.append(f"Noise limit after {clock(report['seconds_to_target'])} more")
    tails = error.get("tails")
    if tails and not tails["certifiable"]:
        lines.append(
            f"A few very bright pixels, above all {tails['x']}, {tails['y']}, make much of it: it may be worse"
        )
    return lines


def error_summary(report: dict[str, Any]) -> list[str]:
    """How wrong the picture is, and how long until it is half as wrong."""
    error = report.get("error")
    if not error:
        return ["Not known before there are some samples"]
    lines = [f"relMSE {error_text(error['relmse'], error['low'], error['high'])}"]
    if report.get("denoised"):
        lines.insert(0, "Of the noisy image; that of the denoised picture is not known")
    tails = error.get("tails")
    if tails and not tails["certifiable"]:
        lines.append(
            f"{NOT_CERTIFIABLE}, pixel {tails['x']}, {tails['y']} carries {100 * tails['largest_share']:.0f} % of it"
        )
    if rate := report.get("rate"):
        lines.append(f"Falls as time^-{rate['power']:.2f} ({rate['low']:.2f} to {rate['high']:.2f})")
    for name, what in (("seconds_to_half", "Half of it"), ("seconds_to_target", "Target")):
        if report.get(name) is not None:
            lines.append(f"{what} after {clock(report[name])} more")
    return lines


def clear() -> None:
    _current["last"] = {}
    _layers.clear()
    _news["count"] += 1


@persistent  # type: ignore[untyped-decorator]
def _on_render_pre(*_: object) -> None:
    clear()


def register() -> None:
    bpy.app.handlers.render_pre.append(_on_render_pre)


def unregister() -> None:
    bpy.app.handlers.render_pre.remove(_on_render_pre)
    clear()
