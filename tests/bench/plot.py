# SPDX-License-Identifier: GPL-3.0-or-later
"""Error against CPU seconds on logarithmic axes, a panel for each scene."""

from collections.abc import Sequence
from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib import pyplot as plt

from tests.bench.errors import fit, mean_points
from tests.bench.report import TARGETS, SceneResult, agrees

_STYLE = {"path": ("#1b6ca8", "o"), "report": ("#c44e52", "s"), "Cycles": ("#5a5a5a", "^")}
_LABEL = {"path": "Glimmer path", "report": "Glimmer report"}


def write_plot(results: Sequence[SceneResult], file: Path) -> None:
    mpl.use("agg")
    figure, panels = plt.subplots(1, len(results), figsize=(4.2 * len(results), 3.9), sharey=True, squeeze=False)
    for panel, result in zip(panels[0], results, strict=True):
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
    panels[0][0].set_ylabel("relMSE")
    figure.tight_layout()
    figure.savefig(file, dpi=110, metadata={"Software": None})
    plt.close(figure)
