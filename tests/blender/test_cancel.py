# SPDX-License-Identifier: GPL-3.0-or-later
"""Stopping a render: Escape in a window, and an interrupt in the background."""

import json
import signal
import subprocess
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import OpenImageIO
import pytest
from hosts import Host

from tests.farm.machines import PYTHON, cluster

SCRIPT = Path(__file__).with_name("window_script.py")
# The render would take days. With software OpenGL on a loaded machine a redraw, and with it a look at the keyboard,
# takes up to some seconds; the engine itself stops within a tenth of one.
ESCAPE_SECONDS = 15.0


def wait_for(path: Path, process: subprocess.Popen[str], seconds: float) -> None:
    end = time.monotonic() + seconds
    while not path.exists():
        assert process.poll() is None, f"Blender ended with {process.returncode}"
        assert time.monotonic() < end, f"no {path.name} after {seconds} s"
        time.sleep(0.05)


@pytest.fixture(params=["here", pytest.param("cluster", marks=pytest.mark.full)])
def scheduler(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[list[str]]:
    """Of a cluster that renders; none where Blender does."""
    if request.param == "here":
        yield []
    else:
        with cluster(2, tmp_path) as address:
            yield [address]


def test_escape_stops_at_once_and_keeps_what_is_there(
    blender_host: Host, display: str, tmp_path: Path, scheduler: list[str]
) -> None:
    env = {**blender_host.env, "DISPLAY": display, "LIBGL_ALWAYS_SOFTWARE": "1", **PYTHON}
    if scheduler:
        env["GLIMMER_SCHEDULER"] = scheduler[0]
    command = [str(blender_host.program), "--factory-startup", "--python", str(SCRIPT), "--", str(tmp_path), *scheduler]
    log = (tmp_path / "log").open("w")
    process = subprocess.Popen(command, env=env, text=True, stdout=log, stderr=log)
    try:
        wait_for(tmp_path / "ready", process, 90)
        pressed = time.time()
        subprocess.run(["xdotool", "key", "Escape"], env=env, check=True, timeout=10)
        wait_for(tmp_path / "facts.json", process, 30)
    finally:
        process.terminate()
        process.wait(20)
        log.close()
    facts = json.loads((tmp_path / "facts.json").read_text())
    assert facts["ended"] is not None, "Escape did not stop the render"
    assert facts["ended"] - pressed < ESCAPE_SECONDS
    # The window's own timer went on while the engine rendered.
    assert sum(tick < pressed for tick in facts["ticks"]) >= 2
    image = OpenImageIO.ImageInput.open(str(tmp_path / "kept.exr"))
    assert image is not None, OpenImageIO.geterror()
    pixels = np.asarray(image.read_image(0, 0, 0, 3, OpenImageIO.FLOAT))
    assert pixels.shape == (400, 640, 3)
    assert np.isfinite(pixels).all()
    assert (pixels.sum(axis=2) > 0.0).all()  # the world is grey: every pixel was kept


def test_an_interrupt_in_the_background_stops_soon(blender_host: Host, tmp_path: Path) -> None:
    script = tmp_path / "endless.py"
    script.write_text(
        f"import sys; sys.path.insert(0, {str(SCRIPT.parent)!r})\n"
        "import bpy, inside\ninside.enable()\n"
        "scene = inside.empty_scene((0.3, 0.3, 0.3)); inside.ball('Ball')\n"
        "scene.glimmer.samples = 100_000_000\n"
        f"inside.render(__import__('pathlib').Path({str(tmp_path / 'picture')!r}))\n"
    )
    log = tmp_path / "log"
    with log.open("w") as file:
        command = blender_host.script_command(script)
        process = subprocess.Popen(command, env=blender_host.env, text=True, stdout=file, stderr=file)
        try:
            end = time.monotonic() + 60
            while "Sample" not in log.read_text():
                assert process.poll() is None and time.monotonic() < end, log.read_text()[-2000:]
                time.sleep(0.1)
            process.send_signal(signal.SIGINT)
            process.wait(10)
        finally:
            process.kill()
            process.wait(10)
    assert not list(tmp_path.glob("picture*"))
