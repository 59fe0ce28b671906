# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's preferences and the scene -> what the command is told, and how a picture by tasks differs from another."""

from __future__ import annotations

import os
import shutil
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from ..film.passes import RenderPass
from ..scene.problems import GlimmerError, Notices

if TYPE_CHECKING:
    import bpy

ADDON = __package__.rpartition(".")[0]
COMMAND = "glimmer"
COMMAND_VARIABLE, SCHEDULER_VARIABLE = "GLIMMER_BIN", "GLIMMER_SCHEDULER"  # where the preferences say nothing
WHERE = "Preferences > Add-ons > Glimmer > Command"
FIRST_OF_ALL = "Render on Cluster"  # of notices
TASKS_FOR_THE_NOISE = 8  # the error is that of as many replicates
LEAST_TASK_SAMPLES = 2
SAMPLES_BEFORE_ADAPTING = 16


@dataclass(frozen=True)
class Cluster:
    command: Path
    scheduler: str  # address; "" is workers of this machine
    task_samples: int


def cluster_of(scene: bpy.types.Scene) -> Cluster | None:
    """None where the scene is rendered by this machine. Raises GlimmerError where there is no command."""
    import bpy

    if not scene.glimmer.use_cluster:
        return None
    entry = bpy.context.preferences.addons.get(ADDON)  # not there where Blender was given --addons
    command, scheduler = (
        (entry.preferences.farm_command, entry.preferences.scheduler) if entry is not None else ("", "")
    )
    command = bpy.path.abspath(command) if command else os.environ.get(COMMAND_VARIABLE, "")
    scheduler = scheduler or os.environ.get(SCHEDULER_VARIABLE, "")
    return Cluster(command_of(command), scheduler.strip(), scene.glimmer.cluster_task_samples)


def command_of(told: str) -> Path:
    """The command that is named, else the one of the checkout that this add-on is of, else the one on the path."""
    beside = Path(__file__).resolve().parents[2] / "build" / "bin" / COMMAND
    found = told or (str(beside) if beside.is_file() else shutil.which(COMMAND))
    if not found:
        raise GlimmerError(f"{FIRST_OF_ALL} needs the command {COMMAND} of a checkout; name it in {WHERE}")
    if not Path(found).is_file():
        raise GlimmerError(f"{FIRST_OF_ALL}: {found}: no such file; name the command {COMMAND} in {WHERE}")
    return Path(found)


def note_differences(
    settings: bpy.types.PropertyGroup, samples: int, passes: tuple[RenderPass, ...], notices: Notices
) -> None:
    """samples: of each pixel; 0: no limit."""
    size = settings.cluster_task_samples
    tasks = -(-samples // size)
    if samples and tasks * size != samples:
        notices.add(FIRST_OF_ALL, f"{samples} samples are {tasks} tasks of {size}, {tasks * size} in all")
    if samples and tasks < TASKS_FOR_THE_NOISE:
        size_for_it = samples // TASKS_FOR_THE_NOISE
        way = f"make Samples per Task {size_for_it} or less"
        if size_for_it < LEAST_TASK_SAMPLES:
            way = f"that takes {TASKS_FOR_THE_NOISE * LEAST_TASK_SAMPLES} samples"
        notices.add(FIRST_OF_ALL, f"the noise is not known below {TASKS_FOR_THE_NOISE} tasks: {way}")
    if samples and tasks < 2 and any(item.engine_name == "stderr" for item in passes):
        notices.add(FIRST_OF_ALL, "the pass Standard Error is black where there is but one task")
    if any(item.matte for item in passes):
        notices.add(FIRST_OF_ALL, f"Cryptomatte is that of the first task's {size} samples")
    if settings.use_adaptive:
        start = f"each task adapts by itself, after {SAMPLES_BEFORE_ADAPTING} samples"
        none = size <= SAMPLES_BEFORE_ADAPTING
        notices.add(FIRST_OF_ALL, f"Adaptive Sampling: {start}{', which it does not have' if none else ''}")
    if settings.use_seconds:
        notices.add(FIRST_OF_ALL, "Time Limit counts from when the cluster is asked, with sending and loading")
