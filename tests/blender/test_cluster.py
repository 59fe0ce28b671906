# SPDX-License-Identifier: GPL-3.0-or-later
"""Render on Cluster: F12's picture is the command's, and what goes wrong ends as every render's does."""

import json
import os
import re
import signal
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import OpenImageIO
import pytest
from hosts import Host

from tests.farm.machines import PYTHON, cluster, free_port, wait_for

SCRIPT = Path(__file__).with_name("cluster_script.py")
THE_EXECUTABLE = pytest.mark.parametrize("host", ["blender"], indirect=True)
NAMES = {"depth.Z": "Depth.Z", "albedo.R": "Albedo.R", "stderr.G": "Standard Error.G"}


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    with cluster(2, tmp_path_factory.mktemp("workers")) as found:
        yield found


@dataclass(frozen=True)
class Rendered:
    folder: Path
    output: str

    def channels(self, name: str) -> dict[str, Any]:
        source = OpenImageIO.ImageInput.open(str(self.folder / name))
        assert source is not None, OpenImageIO.geterror()
        found: dict[str, Any] = {}
        part = 0
        while source.seek_subimage(part, 0):  # each pass is one, since 5.0
            spec = source.spec()
            pixels = np.asarray(source.read_image(part, 0, 0, spec.nchannels, OpenImageIO.FLOAT))
            found |= {name.removeprefix("ViewLayer."): pixels[..., i] for i, name in enumerate(spec.channelnames)}
            part += 1
        return found


@pytest.fixture(scope="module")
def rendered(host: Host, address: str, glimmer_command: Path, tmp_path_factory: pytest.TempPathFactory) -> Rendered:
    folder = tmp_path_factory.mktemp("cluster")
    return Rendered(
        folder, host.run_script(SCRIPT, str(folder), address, str(glimmer_command), GLIMMER_FARM_PYTHON=sys.executable)
    )


def test_the_picture_is_the_commands(rendered: Rendered, address: str, glimmer_command: Path) -> None:
    words = ["--scheduler", address, "--spp", "16", "--range", "2", "--seed", "5", "--aov", "depth,albedo,alpha"]
    command = [str(glimmer_command), "farm", str(rendered.folder / "scene.json"), *words, "--quiet", "-o"]
    subprocess.run([*command, str(rendered.folder / "command.exr")], env={**os.environ, **PYTHON}, check=True)
    ours, theirs = rendered.channels("cluster.exr"), rendered.channels("command.exr")
    names = {**{c: f"Combined.{c}" for c in "RGBA"}, **NAMES}
    for theirs_name, name in names.items():
        found, expected = ours[name], theirs[theirs_name]
        if theirs_name == "A":
            expected = np.clip(expected, 0, 1)
        assert np.array_equal(found, expected), name
    assert 0 < ours["Combined.A"].mean() < 1


def test_indices_and_names_are_those_of_this_machines_render(rendered: Rendered) -> None:
    on_cluster, local = rendered.channels("cluster.exr"), rendered.channels("local.exr")
    indices = [name for name in local if name in ("IndexMA.X", "Material Index.X", "IndexOB.X", "Object Index.X")]
    assert len(indices) == 2
    for name in indices:
        assert len(np.unique(local[name])) == 3 and np.array_equal(on_cluster[name], local[name]), name
    found, expected = (np.unique(channels["CryptoMaterial00.r"]) for channels in (on_cluster, local))
    assert np.array_equal(found, expected)


def test_noise_progress_and_differences_are_told(host: Host, rendered: Rendered) -> None:
    report = json.loads((rendered.folder / "report.json").read_text())
    assert report["spp"] == 16 and report["error"]["low"] < report["error"]["high"]
    assert report["seconds"]["cpu"] > 0 and len(report["workers"]) == 2
    assert report["export"]["notices"] == ["Render on Cluster: Cryptomatte is that of the first task's 2 samples"]
    assert report["before"] == report["export"]["notices"]
    if host.is_module:  # which prints no progress
        return
    last = [line for line in rendered.output.splitlines() if "Sample 16/16" in line and "worker" in line][-1]
    assert re.search(r"\| Sample 16/16 \| 100 % \|.* Noise .*\(.* to .*\)", last), last


def frame(host: Host, rendered: Rendered, pictures: Path) -> list[str]:
    words = [str(rendered.folder / "endless.blend"), "-E", "GLIMMER", "-o", f"{pictures}/####", "-F", "PNG"]
    return [str(host.program), "-b", "--addons", "glimmer", *words, "-f", "1"]


@THE_EXECUTABLE
def test_where_nobody_listens_one_line_says_so(host: Host, rendered: Rendered, tmp_path: Path) -> None:
    nobody = f"tcp://127.0.0.1:{free_port()}"
    (tmp_path / "0001.png").write_bytes(b"an older run's")
    result = host.run(frame(host, rendered, tmp_path), GLIMMER_SCHEDULER=nobody, GLIMMER_FARM_PYTHON=sys.executable)
    assert result.returncode == 1 and not list(tmp_path.iterdir())
    lines = [line for line in (result.stdout + result.stderr).splitlines() if "rror" in line]
    assert len(lines) == 1, lines
    assert lines[0].startswith(f"Error: Glimmer: Render on Cluster: {nobody}: no scheduler of Dask answers there")


@THE_EXECUTABLE
def test_an_interrupt_ends_it_and_the_command(host: Host, rendered: Rendered, address: str, tmp_path: Path) -> None:
    words, env = frame(host, rendered, tmp_path), {**host.env, **PYTHON, "GLIMMER_SCHEDULER": address}
    with subprocess.Popen(words, stdout=subprocess.PIPE, text=True, env=env) as process:
        assert process.stdout is not None
        for line in process.stdout:
            if (found := re.search(r"Sample (\d+)/", line)) and int(found[1]):
                break
        folder = next(Path("/proc").glob(f"{process.pid}/task/*/children")).read_text().split()
        process.send_signal(signal.SIGINT)
        process.stdout.read()
        assert process.wait(60) == 1
    assert not list(tmp_path.iterdir())
    wait_for(lambda: not any(Path("/proc", pid).exists() for pid in folder))
