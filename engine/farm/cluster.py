# SPDX-License-Identifier: GPL-3.0-or-later
"""The Dask cluster: one of this machine alone, or one that is there.

Where a program of ours reads what comes over the network, pickled objects are refused: what workers send are bytes
(ranges.py). Dask itself unpickles tasks, on the scheduler and on the workers: whoever reaches them runs what he likes.
"""

from __future__ import annotations

import logging
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import dask
from distributed import Client, LocalCluster, Nanny

from .engine import ROOT, Engine
from .on_worker import THREADS_VARIABLE
from .problems import FarmError, one_line

CONNECT_SECONDS = 10
# One thread renders a range, the other one answers: that a job has ended, above all.
WORKER_THREADS = 2
_DESERIALIZERS = ["dask", "msgpack"]


def _settings() -> dict[str, Any]:
    return {
        "distributed.worker.memory.target": False,  # what is kept here are ranges on their way
        "distributed.worker.memory.spill": False,
        "distributed.worker.memory.pause": False,
        "distributed.worker.memory.terminate": False,
        "distributed.scheduler.worker-ttl": "60s",
        # A cluster of this machine lets go of a worker that is not back so soon, even while another takes its place.
        "distributed.deploy.lost-worker-timeout": "1h",
        "distributed.comm.timeouts.connect": f"{CONNECT_SECONDS}s",
    }


class FarmClient(Client):
    """Dask's client, and what a farm asks besides."""

    def seen_workers(self) -> dict[str, dict[str, Any]]:
        """By address, as the scheduler knows them now. Client.scheduler_info() is no answer: what it returns is set to
        an empty list by the client's own look, each 2 seconds, which may come in between.
        """
        found: dict[str, dict[str, Any]] = self.sync(self.scheduler.identity)["workers"]
        return found


def _client(address: Any) -> FarmClient:
    logging.getLogger("distributed").setLevel(logging.ERROR)
    return FarmClient(
        address,
        timeout=CONNECT_SECONDS,
        set_as_default=False,
        serializers=["dask", "msgpack", "pickle"],
        deserializers=_DESERIALIZERS,
    )


def worker_resources(engine: Engine) -> dict[str, float]:
    return {engine.identity.text(): 1}


@contextmanager
def local_cluster(workers: int, folder: Path | None = None) -> Iterator[FarmClient]:
    """Workers that are processes of this machine; one that dies is replaced. folder: for their files."""
    engine = Engine.here()
    with dask.config.set(_settings()):
        cluster = LocalCluster(
            n_workers=workers,
            threads_per_worker=WORKER_THREADS,
            host="127.0.0.1",
            dashboard_address="127.0.0.1:0",
            memory_limit=0,
            resources=worker_resources(engine),
            local_directory=None if folder is None else str(folder),
            silence_logs=logging.CRITICAL,
        )
        with cluster, _client(cluster) as client:
            yield client


@contextmanager
def connect(address: str) -> Iterator[FarmClient]:
    """Raises FarmError where no scheduler answers."""
    with dask.config.set(_settings()):
        try:
            client = _client(address)
        except (OSError, TimeoutError, ValueError) as error:
            raise FarmError(f"{address}: no scheduler of Dask answers there: {one_line(str(error))}") from error
        with client:
            yield client


def run_worker(address: str, threads: int, folder: Path | None) -> int:
    """A worker that serves the scheduler until it is ended."""
    import asyncio

    engine = Engine.here()
    os.environ[THREADS_VARIABLE] = str(threads)
    os.environ["PYTHONPATH"] = os.pathsep.join([str(ROOT), *filter(None, [os.environ.get("PYTHONPATH")])])

    async def serve() -> None:
        async with Nanny(
            address,
            nthreads=WORKER_THREADS,
            memory_limit=0,
            resources=worker_resources(engine),
            local_directory=None if folder is None else str(folder),
        ) as nanny:
            await nanny.finished()

    with dask.config.set(_settings()):
        try:
            asyncio.run(serve())
        except (OSError, TimeoutError, ValueError) as error:
            raise FarmError(f"{address}: no scheduler of Dask answers there: {one_line(str(error))}") from error
        except KeyboardInterrupt:
            return 130
    return 0


def run_scheduler(host: str, port: int) -> int:
    """Dask's own, without its dashboard, until it is ended."""
    words = [sys.executable, "-m", "distributed.cli.dask_scheduler", "--host", host, "--port", str(port)]
    os.execv(sys.executable, [*words, "--no-dashboard"])
