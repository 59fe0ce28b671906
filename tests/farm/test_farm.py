# SPDX-License-Identifier: GPL-3.0-or-later
"""What is decided about ranges and workers, with workers that are played: they die, fall silent, lie and fail at will.

test_cluster.py has real ones.
"""

import itertools
import json
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from engine.farm import farm, on_worker, ranges
from engine.farm.engine import Engine as RealEngine
from engine.farm.engine import Identity
from engine.farm.farm import Farm, FarmOptions
from engine.farm.picture import Facts, Layout, Picture
from engine.farm.problems import FarmError
from engine.farm.ranges import Order, Range

HERE = Identity("0.1.0", "GCC 12, Embree 3", "AVX-512", "glibc 2.36", "0123")
CHANNELS = ("R", "G", "B", "albedo.R")
LAYOUT = Layout(6, 4, (0, 0, 6, 4), CHANNELS)
FACTS = Facts(1, (0,), 0.0, "0.1.0", "xxh64:1", "path", "")
LATER = "later"  # a behaviour: nothing comes until the worker is told so


def rendered(order: Order) -> Range:
    pixels = np.random.default_rng(order.seed).gamma(2.0, size=LAYOUT.shape).astype(np.float32)
    return Range(order.index, order.seed, order.samples, "xxh64:1", CHANNELS, pixels)


@dataclass
class Task:
    status: str = "pending"
    data: bytes = b""

    def result(self, timeout: float) -> bytes:
        return self.data

    def finish(self, data: bytes) -> None:
        self.status, self.data = "finished", data


@dataclass
class Played:
    """A worker. behave: what comes of its n-th range: bytes, LATER, or the status of a task that is lost."""

    behave: Callable[[int, Order], bytes | str] = lambda n, order: rendered(order).encode()
    resources: dict[str, float] = field(default_factory=lambda: {HERE.text(): 1.0})
    is_alive: bool = True
    is_heard: bool = True
    orders: list[Order] = field(default_factory=list)
    tasks: list[Task] = field(default_factory=list)
    last_seen: float = 0.0


class Cluster:
    """Of Dask's client what a farm uses."""

    def __init__(self, **workers: Played) -> None:
        self.workers = workers
        self._ticks = itertools.count(1)
        self.scheduler = type("Scheduler", (), {"address": "tcp://played:1"})

    def seen_workers(self) -> dict[str, Any]:
        for worker in self.workers.values():
            worker.last_seen = next(self._ticks) if worker.is_heard else worker.last_seen
        alive = {name: worker for name, worker in self.workers.items() if worker.is_alive}
        return {name: {"resources": w.resources, "last_seen": w.last_seen} for name, w in alive.items()}

    def submit(self, function: Any, *arguments: Any, workers: list[str], **_: Any) -> Task:
        worker, task = self.workers[workers[0]], Task()
        if function is not on_worker.render_range:
            task.finish(b"")
            return task
        order = Order.decode(arguments[0])
        worker.orders.append(order)
        worker.tasks.append(task)
        came = worker.behave(len(worker.orders), order)
        if isinstance(came, bytes):
            task.finish(came)
        elif came != LATER:
            task.status = came
        return task

    def cancel(self, tasks: list[Task], force: bool) -> None:
        for task in tasks:
            task.status = "cancelled"


@pytest.fixture(autouse=True)
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(farm, "LOOK_SECONDS", 0.02)
    monkeypatch.setattr(farm, "REST_SECONDS", 0.0)
    monkeypatch.setattr(farm, "END_SECONDS", 0.0)

    class Engine:
        identity = HERE
        pass_rules = {"albedo": 0}

    monkeypatch.setattr(RealEngine, "here", staticmethod(Engine))
    probe = Picture(LAYOUT, FACTS, np.zeros(LAYOUT.shape, np.float32))
    monkeypatch.setattr(Farm, "_probe", lambda self, folder: probe)


@pytest.fixture
def options(tmp_path: Path) -> FarmOptions:
    (tmp_path / "scene.json").write_text(json.dumps({"glimmer": 1}))
    options = FarmOptions(tmp_path / "scene.json", samples=160, range_samples=4, seed=1000)
    return replace(options, silent_seconds=0.2, least_range_seconds=60.0, wait_seconds=0.5)


def run(options: FarmOptions, cluster: Cluster, watch: Any = None) -> tuple[bytes, dict[str, Any], list[str]]:
    lines: list[str] = []
    outcome = Farm(cluster, options, lines.append).run(watch)
    return outcome.picture.pixels.tobytes(), outcome.report, lines


@pytest.fixture
def alone(options: FarmOptions) -> bytes:
    bits, report, lines = run(options, Cluster(one=Played()))
    assert report["ranges"] == 40 and report["spp"] == 160 and lines == []
    return bits


def test_four_workers_of_which_one_dies_one_stops_and_one_comes_late(options: FarmOptions, alone: bytes) -> None:
    dies = Played(lambda n, order: LATER if n == 3 else rendered(order).encode())
    stops = Played(lambda n, order: LATER if n == 4 else rendered(order).encode())
    cluster = Cluster(good=Played(), dies=dies, stops=stops)
    late = Played()

    def watch(progress: Any) -> None:
        if len(dies.orders) == 3:
            dies.is_alive = False
        if len(stops.orders) == 4 and progress.ranges < 40:
            stops.is_heard = False
        if progress.ranges > 3:
            cluster.workers["late"] = late

    bits, report, lines = run(options, cluster, watch)
    assert bits == alone
    assert "dies: is gone" in lines and "stops: gives no sign of life" in lines
    assert late.orders and report["workers"]["late"]["ranges"] > 0
    given = [order.index for worker in cluster.workers.values() for order in worker.orders]
    assert sorted(set(given)) == list(range(40)), "and each once, but for those that were lost"
    assert len(given) == 42


def test_a_range_that_comes_twice_counts_once(options: FarmOptions, alone: bytes) -> None:
    """A worker that was silent sends, after all, what another one has rendered by then."""
    slow = Played(lambda n, order: LATER if n == 1 else rendered(order).encode())
    cluster = Cluster(good=Played(), slow=slow)

    def watch(progress: Any) -> None:
        slow.is_heard = not slow.tasks or progress.ranges > 5
        if progress.ranges > 5 and slow.tasks[0].status == "pending":
            slow.tasks[0].finish(rendered(slow.orders[0]).encode())

    bits, report, lines = run(options, cluster, watch)
    assert bits == alone and report["ranges"] == 40
    assert lines[:2] == ["slow: gives no sign of life", "slow: is back"]


def test_a_range_that_takes_far_too_long_goes_to_another(options: FarmOptions, alone: bytes) -> None:
    stuck = Played(lambda n, order: LATER)
    bits, _, lines = run(replace(options, least_range_seconds=0.3), Cluster(good=Played(), stuck=stuck))
    assert bits == alone and lines == [f"stuck: takes too long for range {stuck.orders[0].index}"]


@pytest.mark.parametrize(
    ("sent", "words"),
    [
        (lambda order: ranges.failure("range.exr: No space left on device"), "No space left on device"),
        (lambda order: b"\x80\x04garbage", "sent something that is no range"),
        (lambda order: replace(rendered(order), index=order.index + 1).encode(), "sent index"),
        (lambda order: replace(rendered(order), scene="xxh64:2").encode(), "sent scene"),
        (lambda order: "lost", "the task was lost"),
    ],
)
def test_who_fails_three_times_gets_no_more_work(options: FarmOptions, alone: bytes, sent: Any, words: str) -> None:
    bad = Played(lambda n, order: sent(order))
    bits, _, lines = run(options, Cluster(good=Played(), bad=bad))
    assert bits == alone and len(bad.orders) == len(lines) == 3
    assert all(words in line for line in lines) and lines[-1].endswith("it gets no more work")


def test_a_range_that_nobody_can_render_ends_the_render(options: FarmOptions) -> None:
    def behave(n: int, order: Order) -> bytes:
        return ranges.failure("out of memory") if order.index == 2 else rendered(order).encode()

    with pytest.raises(FarmError, match=r"range 2 failed 5 times, at last on .*: out of memory"):
        run(options, Cluster(**{f"w{i}": Played(behave) for i in range(6)}))


def test_a_worker_of_other_bits_gets_nothing(options: FarmOptions, alone: bytes) -> None:
    other = Played(resources={replace(HERE, instructions="AVX2").text(): 1.0})
    bits, report, lines = run(options, Cluster(good=Played(), other=other))
    assert bits == alone and other.orders == []
    assert lines == report["refused"] == ["other is refused: its pictures have other bits: AVX2 in place of AVX-512"]
    with pytest.raises(FarmError, match=r"no worker for 0.5 s; other is refused"):
        run(options, Cluster(other=other))


def test_the_error_ends_it_at_the_same_range_for_any_number_of_workers(options: FarmOptions) -> None:
    wanted = replace(options, samples=0, error=0.05)
    found = [run(wanted, Cluster(**{f"w{i}": Played() for i in range(count)})) for count in (1, 2, 7)]
    assert len({bits for bits, _, _ in found}) == 1
    report = found[0][1]
    assert report["ranges"] in (16, 32, 64, 128) and report["error"]["high"] <= 0.05
    assert [point[2] for point in report["curve"]] == [32 * 2**i for i in range(len(report["curve"]))]
