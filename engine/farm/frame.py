# SPDX-License-Identifier: GPL-3.0-or-later
"""A frame from its scene file to its picture, in one call."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

from . import cluster
from .farm import Farm, FarmOptions, Outcome, Progress

LOCAL_WORKERS = 2


def render_frame(
    scene: str | Path,
    *,
    scheduler: str | None = None,
    workers: int | None = None,
    folder: Path | None = None,
    say: Callable[[str], None] = lambda line: None,
    watch: Callable[[Progress], None] | None = None,
    stop: Callable[[], bool] | None = None,
    **options: Any,
) -> Outcome:
    """By the workers of a scheduler of Dask ("tcp://host:8786"); without one, by `workers` processes of this machine
    (default: 2), whose files stand in `folder`. options: the other fields of FarmOptions. say, watch and stop: as of
    Farm. Raises FarmError.
    """
    given = FarmOptions(Path(scene), **options)
    if scheduler is not None:
        connection = cluster.connect(scheduler)
    else:
        count = workers or LOCAL_WORKERS
        connection = cluster.local_cluster(count, folder)
        if not given.threads:
            given = FarmOptions(Path(scene), **{**options, "threads": max((os.cpu_count() or 1) // count, 1)})
    with connection as client:
        return Farm(client, given, say).run(watch, stop)
