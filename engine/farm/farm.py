# SPDX-License-Identifier: GPL-3.0-or-later
"""Hands ranges of a frame to the workers of a Dask cluster and merges what comes back, until the merged error, the
samples or the time say that it is enough.

Dask brings the cluster: who is there, who is alive, and messages. Which range goes where is decided here: a range
belongs to one worker at a time and goes to another one when that dies, falls silent or takes too long. What comes
twice is counted once (merge.py).
"""

from __future__ import annotations

import heapq
import json
import tempfile
import time
import uuid
import warnings
from collections.abc import Callable
from concurrent.futures import Future as Fetch
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from math import isfinite
from pathlib import Path
from statistics import median
from typing import Any

from . import command, on_worker, picture, ranges
from .engine import Engine, Identity
from .error import REPLICATES, ErrorEstimate
from .merge import Sums
from .picture import Picture
from .problems import FarmError, one_line
from .ranges import Expected, Order, Work
from .scene_files import PackedScene

LOOK_SECONDS = 0.5  # from one look at the list of workers to the next
FEWEST_SAMPLES_TO_STOP = 16  # as of a render
MAX_FAILURES = 3  # in a row, then a worker gets no more work
MAX_TRIES = 5  # of one range
REST_SECONDS = 5.0  # after a failure
FETCH_SECONDS = 120.0
END_SECONDS = 3.0
SEEDS = 1 << 64


@dataclass(frozen=True)
class FarmOptions:
    """What is rendered, and when it is enough: whichever of samples, error and seconds is met first."""

    scene: Path
    samples: int = 0  # of each pixel; rounded up to whole ranges. 0: no limit
    error: float = 0.0  # relMSE by the upper end of its interval; 0: no limit
    seconds: float = 0.0
    range_samples: int = 16
    seed: int = 0  # of the first range
    integrator: str = ""
    aovs: tuple[str, ...] = ()
    adaptive: bool = False
    independent_pixels: bool = False
    threads: int = 0  # of each worker; 0: its own number
    wait_seconds: float = 60.0  # without any worker
    silent_seconds: float = 20.0  # a worker that gives no sign of life so long loses its range
    least_range_seconds: float = 60.0  # a range may take so long, or ten times the median

    @property
    def range_limit(self) -> int:
        """The number of ranges; 0: no limit."""
        samples = self.samples or (0 if self.error > 0 or self.seconds > 0 else 64)
        return -(-samples // self.range_samples)


@dataclass
class Worker:
    address: str
    last_seen: float  # by its scheduler's clock
    seen_at: float  # by ours
    scene: PackedScene | None = None  # what it was sent whole
    task: Any = None  # Dask's future of what it does now
    order: Order | None = None
    given_at: float = 0.0
    lost_order: bool = False  # another one has its range now
    fetch: Fetch[bytes] | None = None
    chunk: int = -1  # of the scene, that is under way
    failures: int = 0
    rests_until: float = 0.0
    silent: bool = False
    ranges: int = 0
    seconds: float = 0.0


@dataclass
class Cost:
    """What moved, and what merging took in seconds of this thread's CPU time."""

    scene_bytes: int = 0
    result_bytes: int = 0
    check_seconds: float = 0.0  # whether a range is what was asked for
    merge_seconds: float = 0.0
    look_seconds: float = 0.0  # at the error


@dataclass(frozen=True)
class Outcome:
    picture: Picture
    error: ErrorEstimate
    report: dict[str, Any]

    def write(self, path: str | Path) -> None:
        """The picture, as .exr. Raises FarmError."""
        picture.write(self.picture, Path(path))


@dataclass
class Progress:
    ranges: int
    samples: int
    workers: int
    seconds: float
    error: ErrorEstimate
    picture: Callable[[], Picture] = field(repr=False)  # what is merged so far; of one range at least
    report: Callable[[], dict[str, Any]] = field(repr=False)


class Farm:
    def __init__(self, client: Any, options: FarmOptions, say: Callable[[str], None]) -> None:
        """client: of Dask's cluster. say: is told what befalls workers, a line each."""
        self._client, self._options, self._say = client, options, say
        self._engine = Engine.here()
        self._job = uuid.uuid4().hex
        self._workers: dict[str, Worker] = {}
        self._told: set[str] = set()  # workers that were refused
        self._refused: list[str] = []
        self._again: list[int] = []  # ranges to be given once more
        self._tries: dict[int, int] = {}
        self._next = 0
        self._looks = 0
        self._seconds: list[float] = []  # of finished ranges, from giving to getting
        self._work = Work()  # of all of them
        self._said: dict[str, Any] = {"warnings": [], "warning_codes": [], "left_out": []}  # by the engine
        self._cost = Cost()
        self._error = ErrorEstimate()
        self._curve: list[list[float | None]] = []

    def run(self, watch: Callable[[Progress], None] | None = None, stop: Callable[[], bool] | None = None) -> Outcome:
        """Raises FarmError. watch: is told at every look and now and then. stop: whether to end with what is there."""
        with tempfile.TemporaryDirectory(prefix="glimmer-farm-") as folder, ThreadPoolExecutor(4) as pool:
            warnings.filterwarnings("ignore", message="Sending large graph", category=UserWarning)
            self._scene = PackedScene.pack(self._options.scene, Path(folder, "scene"))
            probe = self._probe(Path(folder))
            self._expected = Expected(probe.facts.scene, probe.layout.channels, probe.layout.shape)
            self._facts = probe.facts
            self._sums = Sums(probe.layout, self._engine.pass_rules)
            self._pool = pool
            self._start = time.monotonic()
            try:
                self._follow(watch, stop)
            finally:
                self._end()
        if self._sums.count == 0:
            raise FarmError("no picture: the farm was ended before its first range")
        return Outcome(self.picture(), self._error, self.report())

    def _probe(self, folder: Path) -> Picture:
        """One sample, rendered here: whether the scene is sound, and what ranges must look like."""
        options, out, report = self._options, folder / "probe.exr", folder / "probe.json"
        order = replace(self._order(0), samples=1)
        command.finish(
            command.start(command.words_of(self._engine, order, options.scene, out, report, options.threads))
        )
        told = json.loads(report.read_text())
        self._said = {name: told[name] for name in self._said}
        return picture.read(out).layer_free("stderr")

    # -- The loop

    def _follow(self, watch: Callable[[Progress], None] | None, stop: Callable[[], bool] | None) -> None:
        look_at = tell_at = 0.0
        alone_since = time.monotonic()
        while True:
            now = time.monotonic()
            if now >= look_at:
                self._look_at_workers(now)
                look_at = now + LOOK_SECONDS
            for worker in list(self._workers.values()):
                self._attend(worker, now)
            looked, done = self._merge()
            if watch is not None and (looked or now >= tell_at):
                watch(self._progress())
                tell_at = now + LOOK_SECONDS
            late = 0 < self._options.seconds <= now - self._start and self._sums.count > 0
            if done or late or (stop is not None and stop()):
                return
            if any(self._is_fit(worker) for worker in self._workers.values()):
                alone_since = now
            elif now - alone_since > self._options.wait_seconds:
                raise FarmError(self._why_alone())
            time.sleep(0.02)

    def _progress(self) -> Progress:
        fit = sum(self._is_fit(worker) for worker in self._workers.values())
        seconds = time.monotonic() - self._start
        count, samples = self._sums.count, self._sums.samples
        return Progress(count, samples, fit, seconds, self._error, self.picture, self.report)

    def _is_fit(self, worker: Worker) -> bool:
        return not worker.silent and worker.failures < MAX_FAILURES

    def _why_alone(self) -> str:
        why = f"; {self._refused[-1]}" if self._refused else ""
        return (
            f"{self._client.scheduler.address}: no worker for {self._options.wait_seconds:g} s{why};"
            " `glimmer farm --start-worker ADDRESS` on a machine starts one"
        )

    # -- Workers come, go and fall silent

    def _look_at_workers(self, now: float) -> None:
        try:
            found = self._client.seen_workers()
        except (OSError, TimeoutError, KeyError) as error:
            raise FarmError(f"the scheduler does not answer: {one_line(str(error))}") from error
        for address in set(self._workers) - set(found):
            self._say(f"{address}: is gone")
            self._take_back(self._workers.pop(address))
        for address, facts in found.items():
            worker = self._workers.get(address)
            if worker is None:
                self._welcome(address, facts, now)
                continue
            if facts["last_seen"] != worker.last_seen:
                worker.last_seen, worker.seen_at = facts["last_seen"], now
                if worker.silent:
                    worker.silent = False
                    self._say(f"{address}: is back")
            elif not worker.silent and now - worker.seen_at > self._options.silent_seconds:
                worker.silent = True
                self._say(f"{address}: gives no sign of life")
                self._take_back(worker)

    def _welcome(self, address: str, facts: dict[str, Any], now: float) -> None:
        if address in self._told:
            return
        refusal = self._engine.identity.refusal(Identity.among(facts.get("resources")))
        if refusal:
            self._told.add(address)
            self._refused.append(f"{address} is refused: {refusal}")
            self._say(self._refused[-1])
            return
        self._workers[address] = Worker(address, facts["last_seen"], now)

    def _take_back(self, worker: Worker) -> None:
        """Its range goes to somebody else. What it still sends is welcome, as long as it is the first."""
        if worker.order is not None and not worker.lost_order:
            worker.lost_order = True
            if not self._sums.has(worker.order.index):
                heapq.heappush(self._again, worker.order.index)

    # -- What a worker does

    def _attend(self, worker: Worker, now: float) -> None:
        if worker.task is not None:
            self._look_at_task(worker, now)
        if worker.task is None and self._is_fit(worker) and now >= worker.rests_until:
            self._give(worker, now)

    def _submit(self, worker: Worker, function: Callable[..., Any], *arguments: Any) -> Any:
        return self._client.submit(
            function,
            *arguments,
            key=f"glimmer-{uuid.uuid4().hex}",
            workers=[worker.address],
            allow_other_workers=False,
            pure=False,
        )

    def _give(self, worker: Worker, now: float) -> None:
        if worker.scene is None:
            worker.chunk += 1
            data = self._scene.chunk(worker.chunk)
            arguments = (self._scene.digest, worker.chunk, self._scene.chunks, data)
            worker.task = self._submit(worker, on_worker.put_chunk, *arguments)
            self._cost.scene_bytes += len(data)
        else:
            index = self._next_index()
            if index is None:
                return
            worker.order, worker.lost_order = self._order(index), False
            worker.task = self._submit(worker, on_worker.render_range, worker.order.encode())
        worker.given_at = now

    def _next_index(self) -> int | None:
        while self._again:
            index = heapq.heappop(self._again)
            if not self._sums.has(index):
                return index
        # What comes early waits in memory, so nobody runs far ahead of a range that is late.
        window = 4 * len(self._workers) + 2 * REPLICATES
        limit = self._options.range_limit
        if self._next >= self._sums.count + window or (limit and self._next >= limit):
            return None
        self._next += 1
        return self._next - 1

    def _order(self, index: int) -> Order:
        options = self._options
        return Order(
            job=self._job,
            scene=self._scene.digest,
            index=index,
            seed=self._seed(index),
            samples=options.range_samples,
            program=self._engine.identity.program,
            threads=options.threads,
            integrator=options.integrator,
            aovs=options.aovs,
            adaptive=options.adaptive,
            independent_pixels=options.independent_pixels,
        )

    def _seed(self, index: int) -> int:
        return (self._options.seed + index) % SEEDS

    def _look_at_task(self, worker: Worker, now: float) -> None:
        if worker.fetch is None:
            status = worker.task.status
            if status == "finished":
                worker.fetch = self._pool.submit(worker.task.result, timeout=FETCH_SECONDS)
            elif status in ("error", "cancelled", "lost"):
                self._failed(worker, "the task was lost", now)
            elif worker.order is not None and not worker.lost_order and now - worker.given_at > self._patience():
                self._say(f"{worker.address}: takes too long for range {worker.order.index}")
                self._take_back(worker)
        elif worker.fetch.done():
            fetch, worker.fetch = worker.fetch, None
            try:
                data = fetch.result()
            except Exception as error:  # noqa: BLE001 - whatever a connection ends with, it is this worker's
                self._failed(worker, one_line(str(error) or type(error).__name__), now)
                return
            self._got(worker, data, now)

    def _patience(self) -> float:
        usual = median(self._seconds[-64:]) if len(self._seconds) >= 3 else float("inf")
        return max(self._options.least_range_seconds, 10 * usual)

    def _got(self, worker: Worker, data: object, now: float) -> None:
        order = worker.order
        try:
            if not isinstance(data, bytes):
                raise FarmError("sent something that is no range")
            if order is None:
                ranges.refuse_failure(data)
                if worker.chunk + 1 == self._scene.chunks:
                    worker.scene = self._scene
                worker.task = None
                return
            start = time.thread_time()
            item = ranges.decode(data, order, self._expected)
            self._cost.check_seconds += time.thread_time() - start
        except FarmError as error:
            self._failed(worker, str(error), now)
            return
        seconds = now - worker.given_at
        self._seconds.append(seconds)
        worker.ranges, worker.seconds, worker.failures = worker.ranges + 1, worker.seconds + seconds, 0
        self._cost.result_bytes += len(data)
        if not self._sums.has(item.index):
            self._work += item.work
        self._sums.put(item)
        worker.task = worker.order = None

    def _failed(self, worker: Worker, words: str, now: float) -> None:
        worker.failures += 1
        worker.rests_until = now + REST_SECONDS
        what = "the scene" if worker.order is None else f"range {worker.order.index}"
        ends = "; it gets no more work" if worker.failures == MAX_FAILURES else ""
        self._say(f"{worker.address}: {what}: {words}{ends}")
        if worker.order is None or words == on_worker.MISSING_SCENE:
            worker.scene, worker.chunk = None, -1
        if worker.order is not None:
            index = worker.order.index
            self._tries[index] = self._tries.get(index, 0) + 1
            if self._tries[index] == MAX_TRIES and not self._sums.has(index):
                raise FarmError(f"range {index} failed {MAX_TRIES} times, at last on {worker.address}: {words}")
        self._take_back(worker)
        worker.task = worker.order = None

    # -- Merging

    def _merge(self) -> tuple[bool, bool]:
        """Whether there was a look at the error, and whether it is enough."""
        looked = False
        limit = self._options.range_limit
        while True:
            start = time.thread_time()
            if not self._sums.add_next():
                return looked, False
            self._cost.merge_seconds += time.thread_time() - start
            count = self._sums.count
            last = limit > 0 and count == limit
            # At every doubling, as a render looks: so what is rendered does not depend on who is fast.
            if count >= REPLICATES and (count & (count - 1) == 0 or last):
                self._look()
                looked = True
                enough = self._sums.samples >= FEWEST_SAMPLES_TO_STOP and self._error.meets(self._options.error)
                if enough:
                    return True, True
            if last:
                return looked, True

    def _look(self) -> None:
        start = time.thread_time()
        self._error = self._sums.error(self._looks + 1)
        if self._error.low == self._error.low:
            self._looks += 1
        self._cost.look_seconds += time.thread_time() - start
        error, seconds = self._error, time.monotonic() - self._start
        interval = [value if isfinite(value) else None for value in (error.relmse, error.low, error.high)]
        self._curve.append([seconds, self._work.cpu_seconds, self._sums.samples, *interval])

    def _end(self) -> None:
        """Ends what is still rendered for this job, and waits for nobody who does not answer at once."""
        busy = [worker for worker in self._workers.values() if worker.order is not None]
        ending = [self._submit(worker, on_worker.end_job, self._job) for worker in busy if not worker.silent]
        patience = time.monotonic() + END_SECONDS
        while any(task.status == "pending" for task in ending) and time.monotonic() < patience:
            time.sleep(0.02)
        self._client.cancel([worker.task for worker in busy], force=True)

    def picture(self) -> Picture:
        """What is merged so far; one range at least."""
        seeds = tuple(self._seed(index) for index in range(self._sums.count))
        seconds = time.monotonic() - self._start
        return self._sums.picture(replace(self._facts, samples=self._sums.samples, seeds=seeds, seconds=seconds))

    def report(self) -> dict[str, Any]:
        """As far as it is known. What a render's report has too has its names, and means the same."""
        facts, work, cost = self._facts, self._work, self._cost
        return {
            "engine": self._engine.identity.version,
            "build": self._engine.identity.text(),
            "scene": facts.scene,
            "integrator": facts.integrator,
            "biased_by": [name for name in facts.biased_by.split(", ") if name],
            "spp": self._sums.samples,
            "ranges": self._sums.count,
            "seed": self._options.seed,
            "seconds": {
                "render": time.monotonic() - self._start,
                "cpu": work.cpu_seconds,
                "load": work.load_seconds,
                "range": median(self._seconds) if self._seconds else 0.0,
                "check": cost.check_seconds,
                "merge": cost.merge_seconds,
                "look": cost.look_seconds,
            },
            "rays": work.rays,
            "invalid_samples": {"count": work.invalid_samples},
            "error": self._error.report(),
            "curve": list(self._curve),
            "workers": {w.address: {"ranges": w.ranges, "seconds": w.seconds} for w in self._workers.values()},
            "refused": list(self._refused),
            "bytes": {"scene": cost.scene_bytes, "results": cost.result_bytes},
            **self._said,
        }
