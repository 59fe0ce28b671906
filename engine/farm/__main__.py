# SPDX-License-Identifier: GPL-3.0-or-later
"""The command; see addon/docs/farm.md."""

from __future__ import annotations

import argparse
import json
import signal
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from .problems import FarmError

PROGRAM = "glimmer farm"
LINE_SECONDS = 5.0


def say(text: str) -> None:
    sys.stderr.write(text + "\n")
    sys.stderr.flush()


def arguments(program: str = PROGRAM) -> argparse.ArgumentParser:
    """program: as the user calls it."""
    parser = argparse.ArgumentParser(
        prog=program,
        description="Renders one frame by the workers of a Dask cluster: ranges of its samples, each with a seed of its"
        " own, merged as they come. Without --scheduler the workers are processes of this machine.",
    )
    parser.add_argument("scene", nargs="?", type=Path, metavar="SCENE.json")
    parser.add_argument("-o", "--output", type=Path, metavar="OUT.exr")
    parser.add_argument("--scheduler", metavar="ADDRESS", help="of the cluster, as tcp://host:8786")
    parser.add_argument("--workers", type=int, metavar="N", help="of this machine, without --scheduler (default: 2)")
    parser.add_argument("--error", type=float, default=0.0, metavar="RELMSE", help="stop when the relMSE is below this")
    parser.add_argument("--spp", type=int, default=0, metavar="N", help="stop at N samples a pixel, in whole ranges")
    parser.add_argument("--time", type=float, default=0.0, metavar="SECONDS", help="stop after this much rendering")
    parser.add_argument("--range", type=int, default=16, metavar="N", help="samples of a range (default: 16)")
    parser.add_argument("--seed", type=int, default=0, metavar="N", help="of the first range; the others count on")
    parser.add_argument("--integrator", default="", metavar="NAME")
    parser.add_argument("--aov", default="", metavar="NAME,...", help="extra layers")
    parser.add_argument("--adaptive", action="store_true", help="each range samples where the picture needs it")
    parser.add_argument("--independent-pixels", action="store_true", help="as of glimmer: for denoisers")
    parser.add_argument("--threads", type=int, default=0, metavar="N", help="of each worker")
    parser.add_argument("--report", type=Path, metavar="OUT.json", help="error, curve, workers, bytes that moved")
    parser.add_argument("--every", type=float, default=0.0, metavar="SECONDS", help="also write OUT.exr this often")
    parser.add_argument("--wait", type=float, default=60.0, metavar="SECONDS", help="for a worker (default: 60)")
    parser.add_argument(
        "--silent", type=float, default=20.0, metavar="SECONDS", help="until a silent worker loses its range"
    )
    parser.add_argument("--quiet", action="store_true", help="no progress on the standard error")
    parser.add_argument(
        "--live",
        type=Path,
        metavar="FOLDER",
        help="for a program that shows the picture: see engine/farm/live.py; -o can be left out",
    )
    parser.add_argument("--start-worker", metavar="ADDRESS", help="be a worker of this scheduler, until it is ended")
    parser.add_argument("--folder", type=Path, metavar="FOLDER", help="for a worker's files (default: temporary)")
    parser.add_argument("--start-scheduler", metavar="HOST:PORT", help="be a scheduler, as 0.0.0.0:8786")
    return parser


def check(parser: argparse.ArgumentParser, given: argparse.Namespace) -> None:
    if given.scene is None or (given.output is None and given.live is None):
        parser.error("SCENE.json and -o OUT.exr are needed")
    if given.output is not None and given.output.suffix.lower() != ".exr":
        parser.error(f"-o {given.output}: must end with .exr")
    if given.scheduler is not None and given.workers is not None:
        parser.error("--workers: are those of this machine, and --scheduler has its own")
    ranges = {"range": (2, 1 << 20), "spp": (0, 1 << 30), "seed": (0, (1 << 64) - 1), "threads": (0, 4096)}
    for name, (low, high) in ranges.items():
        if not low <= getattr(given, name) <= high:
            parser.error(f"--{name} {getattr(given, name)}: must be from {low} to {high}")
    if given.workers is not None and not 1 <= given.workers <= 256:
        parser.error(f"--workers {given.workers}: must be from 1 to 256")
    for name in ("error", "time", "every", "wait", "silent"):
        if not 0 <= getattr(given, name) < 1e9:
            parser.error(f"--{name} {getattr(given, name)}: must be a number of at least 0")


def render(given: argparse.Namespace) -> int:
    from . import picture
    from .farm import Progress
    from .frame import render_frame
    from .live import Live

    interrupted: list[int] = []
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda number, _: interrupted.append(number))
    live = None if given.live is None else Live(given.live)
    told = written = time.monotonic()

    def is_stopped() -> bool:
        return bool(interrupted) or (live is not None and live.is_ended)

    def watch(progress: Progress) -> None:
        nonlocal told, written
        now = time.monotonic()
        if live is not None:
            live.show(progress)
        if not given.quiet and now - told >= LINE_SECONDS:
            told = now
            say(line(progress))
        if given.output and given.every and now - written >= given.every and progress.ranges:
            picture.write(progress.picture(), given.output)
            written = time.monotonic()

    outcome = render_frame(
        given.scene,
        scheduler=given.scheduler,
        workers=given.workers,
        folder=given.folder,
        say=say,
        watch=watch,
        stop=is_stopped,
        samples=given.spp,
        error=given.error,
        seconds=given.time,
        range_samples=given.range,
        seed=given.seed,
        integrator=given.integrator,
        aovs=tuple(name for name in given.aov.split(",") if name),
        adaptive=given.adaptive,
        independent_pixels=given.independent_pixels,
        threads=given.threads,
        wait_seconds=given.wait,
        silent_seconds=given.silent,
    )
    if given.report is not None:
        given.report.write_text(json.dumps(outcome.report, indent=2) + "\n")
    if given.output is not None:
        outcome.write(given.output)
    if live is not None:
        live.finish(outcome)
    if not given.quiet:
        say(
            f"{given.output or given.scene}: {outcome.report['spp']} spp by {len(outcome.report['workers'])} workers in"
            f" {outcome.report['seconds']['render']:.1f} s, {error_words(outcome.error)}"
        )
    return 130 if is_stopped() else 0


def error_words(error: Any) -> str:
    if error.relmse != error.relmse:
        return "error not known yet"
    text = f"relMSE {error.relmse:.2g}"
    if error.low == error.low:
        text += f" ({error.low:.2g} to {error.high:.2g})"
        text += "" if error.certifiable else ", not certifiable: heavy tails"
    return text


def line(progress: Any) -> str:
    return (
        f"{progress.ranges} ranges, {progress.samples} spp, {progress.workers} workers, {progress.seconds:.0f} s,"
        f" {error_words(progress.error)}"
    )


def main(argv: Sequence[str]) -> int:
    parser = arguments()
    given = parser.parse_args(argv)
    try:
        from . import cluster
    except ImportError as error:
        say(f"{PROGRAM}: {sys.executable} has no {error.name}; `python3 build.py setup --farm` makes one that has")
        return 1
    try:
        if given.start_scheduler is not None:
            host, _, port = given.start_scheduler.rpartition(":")
            if not host or not port.isdigit():
                parser.error(f"--start-scheduler {given.start_scheduler}: must be HOST:PORT")
            return cluster.run_scheduler(host, int(port))
        if given.start_worker is not None:
            return cluster.run_worker(given.start_worker, given.threads, given.folder)
        check(parser, given)
        return render(given)
    except FarmError as error:
        say(f"{PROGRAM}: {error}")
        return 1
    except OSError as error:
        say(f"{PROGRAM}: {error}")
        return 2


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
