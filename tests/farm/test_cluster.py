# SPDX-License-Identifier: GPL-3.0-or-later
"""Real clusters on this machine: the bits of one, whoever renders; and what befalls workers costs nothing but time."""

import os
import resource
import signal
import subprocess
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import dask
import numpy as np
import pytest
from distributed import LocalCluster

from addon.scene import description as d
from addon.scene.writer import write_scene
from engine.farm import command, picture
from engine.farm.cluster import connect, local_cluster
from engine.farm.engine import ROOT, Engine
from engine.farm.farm import Farm, FarmOptions, Progress
from engine.farm.merge import Sums
from engine.farm.problems import FarmError
from engine.farm.ranges import Order, Range
from tests.farm.machines import Wire, free_port, is_open, processes, started, wait_for
from tests.render.build import Builder, camera, floor, grey

AOVS = ("depth", "albedo", "object_index")


@pytest.fixture(scope="module")
def scene(tmp_path_factory: pytest.TempPathFactory) -> Path:
    builder = Builder(camera((0, -6, 1), (0, 0, 0), 60), 40, 24)
    builder.mesh(floor(z=-1, half=4), d.Lambert(grey(0.5)))
    builder.sphere((0, 0, 0), 1, d.Conductor(0.3, eta=grey(2.5), k=grey(3)))
    builder.sphere((0, 0, 4), 1.0, d.Light(grey(5)))
    path = tmp_path_factory.mktemp("scene") / "scene.json"
    write_scene(builder.done(), path)
    return path


def options_of(scene: Path, **changes: object) -> FarmOptions:
    options = FarmOptions(scene, samples=36, range_samples=4, threads=1, aovs=AOVS, wait_seconds=120)
    return replace(options, **changes)  # type: ignore[arg-type]


def on_one_machine(options: FarmOptions, count: int, folder: Path) -> tuple[Sums, list[Path]]:
    """The same ranges by the command alone, one after another."""
    engine, pictures = Engine.here(), []
    sums = None
    for i in range(count):
        order = Order("", "", i, options.seed + i, options.range_samples, "", 1, options.integrator, options.aovs)
        out = folder / f"{i}.exr"
        words = command.words_of(engine, order, options.scene, out, folder / "report.json", 2)
        command.finish(command.start(words))
        rendered = picture.read(out).layer_free("stderr")
        sums = sums or Sums(rendered.layout, engine.pass_rules)
        sums.put(Range(i, order.seed, order.samples, "", rendered.layout.channels, rendered.pixels))
        assert sums.add_next()
        pictures.append(out)
    assert sums is not None
    return sums, pictures


def test_the_cluster_makes_the_bits_of_one_machine(scene: Path, tmp_path: Path, glimmer_command: Path) -> None:
    options = options_of(scene)
    with local_cluster(2) as client:
        outcome = Farm(client, options, lambda line: None).run()
    report = outcome.report
    assert (report["spp"], report["ranges"], sum(w["ranges"] for w in report["workers"].values())) == (36, 9, 9)
    sums, pictures = on_one_machine(options, 9, tmp_path)
    alone = sums.picture(outcome.picture.facts)
    assert outcome.picture.pixels.tobytes() == alone.pixels.tobytes()
    assert outcome.error == sums.error(2) and outcome.error.low < outcome.error.relmse < outcome.error.high

    # `glimmer merge` joins the same pictures, by code of its own.
    out, merged = tmp_path / "farm.exr", tmp_path / "merged.exr"
    picture.write(outcome.picture, out)
    words = [str(glimmer_command), "merge", *map(str, pictures), "-o", str(merged)]
    subprocess.run(words, check=True, timeout=60)
    ours, theirs = picture.read(out), picture.read(merged)
    assert replace(ours.facts, seconds=0) == replace(theirs.facts, seconds=0)
    for name in (name for name in ours.layout.channels if not name.startswith("stderr")):
        a, b = (p.pixels[..., p.layout.channels.index(name)] for p in (ours, theirs))
        assert a == pytest.approx(b, rel=2e-7, abs=1e-30), name


def test_without_a_fit_worker_there_is_one_clear_line(scene: Path) -> None:
    lines: list[str] = []
    with (
        LocalCluster(n_workers=1, processes=False, dashboard_address="127.0.0.1:0") as cluster,
        connect(cluster.scheduler_address) as client,
        pytest.raises(FarmError, match=r"no worker for 1 s; .* refused: it was not started by") as caught,
    ):
        Farm(client, options_of(scene, wait_seconds=1.0), lines.append).run()
    assert "\n" not in str(caught.value) and len(lines) == 1


def test_no_look_at_the_workers_finds_none_while_there_are_some() -> None:
    with (
        dask.config.set({"distributed.client.scheduler-info-interval": "1ms"}),
        LocalCluster(n_workers=1, processes=False, dashboard_address="127.0.0.1:0") as cluster,
        connect(cluster.scheduler_address) as client,
    ):
        assert {len(client.seen_workers()) for _ in range(500)} == {1}


def test_a_bad_scene_is_told_before_any_worker_has_it(tmp_path: Path) -> None:
    (tmp_path / "scene.json").write_text('{"glimmer": 1}')
    with pytest.raises(FarmError, match=r"scene\.json") as caught:
        Farm(None, options_of(tmp_path / "scene.json"), lambda line: None).run()
    assert "\n" not in str(caught.value)
    with pytest.raises(FarmError, match="No such file"):
        Farm(None, options_of(tmp_path / "none.json"), lambda line: None).run()


# -- What befalls workers


def small_disk() -> None:
    """No file may grow beyond a few kilobytes, as where the disk is full."""
    resource.setrlimit(resource.RLIMIT_FSIZE, (6000, 6000))


@pytest.mark.full
@pytest.mark.timeout(900)
def test_killed_stopped_added_and_full_workers_change_no_bit(
    scene: Path, tmp_path: Path, glimmer_command: Path
) -> None:
    port = free_port()
    lines: list[str] = []
    address = f"tcp://127.0.0.1:{port}"
    other = tmp_path / "glimmer"
    other.write_bytes(glimmer_command.read_bytes() + b"\0")
    other.chmod(0o755)
    options = options_of(scene, samples=384, range_samples=16, silent_seconds=6.0, wait_seconds=500.0)
    with processes() as machines:
        machines.append(started("--start-scheduler", f"127.0.0.1:{port}"))
        wait_for(lambda: is_open(port))

        def add(setup: Callable[[], None] | None = None, **env: str) -> subprocess.Popen[bytes]:
            folder = tmp_path / str(len(machines))
            folder.mkdir()
            words = ("--start-worker", address, "--threads", "1", "--folder", str(folder))
            machines.append(started(*words, setup=setup, **env))
            return machines[-1]

        killed, stopped = add(), add()
        add()
        add(GLIMMER_BIN=str(other))
        happened: list[str] = []

        def watch(progress: Progress) -> None:
            for at, name, event in (
                (2, "killed", lambda: os.killpg(killed.pid, signal.SIGKILL)),
                (4, "stopped", lambda: os.killpg(stopped.pid, signal.SIGSTOP)),
                (6, "full", lambda: add(small_disk)),
                (6, "added", add),
                (16, "goes on", lambda: os.killpg(stopped.pid, signal.SIGCONT)),
            ):
                if progress.ranges >= at and name not in happened:
                    happened.append(name)
                    lines.append(f"{progress.ranges} ranges: {name}")
                    event()

        with connect(address) as client:
            outcome = Farm(client, options, lines.append).run(watch)
    assert happened == ["killed", "stopped", "full", "added", "goes on"]
    said = "\n".join(lines)
    for words in ("is refused: its pictures have other bits: another build", "is gone", "gives no sign of life"):
        assert words in said, said
    assert outcome.report["ranges"] == 24
    sums, _ = on_one_machine(options, 24, tmp_path)
    assert outcome.picture.pixels.tobytes() == sums.picture(outcome.picture.facts).pixels.tobytes()
    assert not np.isnan(outcome.picture.pixels).any()


def test_a_worker_whose_network_breaks_loses_its_range_alone(scene: Path, tmp_path: Path) -> None:
    port, lines = free_port(), list[str]()
    options = options_of(scene, samples=192, range_samples=8, silent_seconds=4.0)
    with processes() as machines:
        machines.append(started("--start-scheduler", f"127.0.0.1:{port}"))
        wait_for(lambda: is_open(port))
        wire = Wire(port)
        for at in (port, wire.port):
            words = ("--start-worker", f"tcp://127.0.0.1:{at}", "--threads", "1", "--folder", str(tmp_path))
            machines.append(started(*words))
        with connect(f"tcp://127.0.0.1:{port}") as client:
            wait_for(lambda: len(client.seen_workers()) == 2)

            def watch(progress: Progress) -> None:
                if progress.ranges >= 4:
                    wire.breaks()
                if any("no sign of life" in line for line in lines) and progress.ranges >= 16:
                    wire.mends()

            outcome = Farm(client, options, lines.append).run(watch)
        wire.mends()
    assert any(line.endswith("gives no sign of life") for line in lines), lines
    sums, _ = on_one_machine(options, 24, tmp_path)
    assert outcome.report["ranges"] == 24
    assert outcome.picture.pixels.tobytes() == sums.picture(outcome.picture.facts).pixels.tobytes()


@pytest.mark.full
@pytest.mark.timeout(1100)
def test_glimmervoid_to_a_stated_error_while_two_of_four_workers_are_killed(tmp_path: Path) -> None:
    """As the page has it, by the command; and by one worker."""
    for name in ("glimmervoid_small.json", "plates.npy"):
        (tmp_path / name).write_bytes((ROOT / "engine" / "examples" / name).read_bytes())
    small = tmp_path / "glimmervoid_small.json"
    small.write_text(small.read_text().replace('"width": 480', '"width": 96').replace('"height": 270', '"height": 54'))

    def farm(workers: int, name: str) -> subprocess.Popen[bytes]:
        words = [str(small), "-o", str(tmp_path / name), "--error", "0.05", "--range", "16", "--workers", str(workers)]
        return started(*words, "--silent", "6")

    def workers_of(pid: int) -> list[int]:
        text = subprocess.run(["ps", "-ww", "-eo", "pid,ppid,args"], capture_output=True, text=True, check=True).stdout
        rows = [line.split(None, 2) for line in text.splitlines()[1:]]
        return [int(p) for p, parent, args in rows if int(parent) == pid and "spawn_main" in args]

    def rendering() -> list[str]:
        text = subprocess.run(["ps", "-ww", "-eo", "args"], capture_output=True, text=True, check=True).stdout
        return [line for line in text.splitlines() if "range.exr" in line and "glimmervoid_small" in line]

    with processes() as machines:
        machines.append(farm(4, "four.exr"))
        wait_for(
            lambda: (len(workers_of(machines[0].pid)) == 4 and len(rendering()) > 0) or machines[0].poll() is not None
        )
        assert machines[0].poll() is None, "it ended before a worker could be killed"
        for pid in workers_of(machines[0].pid)[:2]:
            os.kill(pid, signal.SIGKILL)
        assert machines[0].wait(500) == 0
        machines.append(farm(1, "one.exr"))
        assert machines[1].wait(500) == 0
    four, one = picture.read(tmp_path / "four.exr"), picture.read(tmp_path / "one.exr")
    assert four.facts.samples == one.facts.samples >= 128
    assert four.pixels.tobytes() == one.pixels.tobytes()
