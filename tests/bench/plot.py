# SPDX-License-Identifier: GPL-3.0-or-later
"""Error against CPU seconds on logarithmic axes, a panel for each scene."""

from collections.abc import Sequence
from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib import pyplot as plt

from tests.bench.errors import fit, mean_points
from tests.bench.report import TARGETS, SceneResult, agrees

_STYLE = {"path": ("#1b6ca8", "o"), "baseline": ("#c44e52", "s"), "Cycles": ("#5a5a5a", "^")}
_STYLE |= {"mitsuba": ("#2f8f5b", "D"), "luxcore": ("#b07aa1", "v")}
_LABEL = {"path": "Glimmer path", "baseline": "Glimmer baseline", "mitsuba": "Mitsuba 3", "luxcore": "LuxCore"}
_COLUMNS = 3


def write_plots(results: Sequence[SceneResult], stem: Path) -> None:
    """STEM.png and STEM.svg; the same results give the same bytes."""
    mpl.use("agg")
    mpl.rcParams["svg.hashsalt"] = "glimmer"
    columns = min(len(results), _COLUMNS)
    rows = -(-len(results) // columns)
    size = (4.2 * columns, 3.7 * rows)
    figure, grid = plt.subplots(rows, columns, figsize=size, sharey=True, squeeze=False)
    panels = grid.ravel()
    for panel in panels[len(results) :]:
        panel.set_visible(False)
    for panel, result in zip(panels, results, strict=False):
        for name, entry in result.entries.items():
            color, marker = _STYLE[name]
            label = _LABEL.get(name, name) + ("" if agrees(entry, results) else " (another picture)")
            points = [point for point in mean_points(entry.points) if point.error > 0]
            cpu = np.array([point.cpu for point in points])
            scattered = [point for row in entry.points for point in row if point.error > 0]
            panel.plot(
                [p.cpu for p in scattered], [p.error for p in scattered], marker, color=color, alpha=0.25, ms=3, mew=0
            )
            panel.plot(cpu, [p.error for p in points], marker, color=color, label=label, ms=6)
            line = fit(points)
            if line is not None:
                panel.plot(cpu, line.scale * cpu**-line.power, "-", color=color, lw=1)
        for target in TARGETS:
            panel.axhline(target, color="#aaaaaa", lw=0.7, ls=":")
        panel.set(xscale="log", yscale="log", title=result.name.replace("_", " "), xlabel="CPU seconds")
        panel.grid(True, which="major", color="#e6e6e6", lw=0.6)
        panel.set_axisbelow(True)
        panel.legend(fontsize=8, frameon=False)
    for row in grid:
        row[0].set_ylabel("relMSE")
    figure.tight_layout()
    figure.savefig(stem.with_suffix(".png"), dpi=110, metadata={"Software": None})
    figure.savefig(stem.with_suffix(".svg"), metadata={"Date": None, "Creator": None})
    plt.close(figure)
