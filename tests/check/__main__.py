# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders scenes whose pictures are known by a formula, and prints how they came out.

`python3 build.py check` runs this as `python -m tests.check` from the root of the checkout.
"""

import argparse
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

from tests import conftest as _environment  # where the engine is  # noqa: F401
from tests.check import cycles
from tests.check.report import Setting, as_json, line, markdown, summary
from tests.check.run import numbers, run
from tests.check.suite import chosen
from tests.engine.library import engine
from tests.render.statistics import INTEGRATORS, LEVEL


def say(text: str) -> None:
    sys.stdout.write(text + "\n")
    sys.stdout.flush()


def beside_cycles(blender: Path, words: str, report: Path | None, said: str) -> int:
    """Prints a table of what both renderers give, or writes it to extremes.md. Cycles may be wrong, Glimmer not."""
    choices = [choice for choice in cycles.CHOICES if words in choice.case]
    with tempfile.TemporaryDirectory() as folder:
        rows, told = cycles.compare(blender, choices, Path(folder))
    setting = cycles.Setting(said, f"glimmer {engine().version()}", told["version"], told["settings"])
    page = cycles.markdown(rows, setting)
    say(page)
    if report is not None:
        report.mkdir(parents=True, exist_ok=True)
        (report / "extremes.md").write_text(page)
    return 0 if all(row.ours.right for row in rows) else 1


def main(argv: Sequence[str]) -> int:
    parser = argparse.ArgumentParser(prog="python -m tests.check", description=__doc__)
    parser.add_argument("--quick", action="store_true", help="the short tier")
    parser.add_argument("--integrator", choices=INTEGRATORS, default="path")
    parser.add_argument("--only", metavar="TEXT", help="the cases whose name holds it")
    parser.add_argument("--report", type=Path, metavar="FOLDER", help="writes check.md and check.json there")
    parser.add_argument("--said", default="python -m tests.check", metavar="COMMAND", help="for the report")
    parser.add_argument("--cycles", type=Path, metavar="BLENDER", help="cases that Cycles can express, in both")
    given = parser.parse_args(argv)
    if given.cycles is not None:
        return beside_cycles(given.cycles, given.only or "", given.report, given.said)
    cases = [case for case in chosen(given.quick, given.only) if given.integrator in case.integrators]
    if not cases:
        parser.error(f"--only {given.only}: no case's name holds that")
    started = time.monotonic()
    results = []
    for case in cases:
        results.append(run(case, given.integrator, numbers(cases)))
        say(line(results[-1]))
    setting = Setting(given.said, f"glimmer {engine().version()}", LEVEL, numbers(cases), time.monotonic() - started)
    say(f"{summary(results)}, in {setting.seconds:.0f} s")
    if given.report is not None:
        given.report.mkdir(parents=True, exist_ok=True)
        (given.report / "check.md").write_text(markdown(results, setting))
        (given.report / "check.json").write_text(as_json(results, setting))
        say(str(given.report / "check.md"))
    return 0 if all(result.good for result in results) else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
