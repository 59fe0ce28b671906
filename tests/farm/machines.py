# SPDX-License-Identifier: GPL-3.0-or-later
"""Machines of a cluster, played by processes of this one."""

import os
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from engine.farm.engine import ROOT

PYTHON = {"GLIMMER_FARM_PYTHON": sys.executable}  # for `glimmer farm`: the one with Dask


def started(*words: str, setup: Callable[[], None] | None = None, **env: str) -> subprocess.Popen[bytes]:
    """A process with a group of its own: killed or stopped, it is a machine that is."""
    return subprocess.Popen(
        [sys.executable, "-m", "engine.farm", *words],
        cwd=ROOT,
        env={**os.environ, **env},
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
        preexec_fn=setup,  # noqa: PLW1509
    )


def wait_for(condition: Callable[[], bool]) -> None:
    deadline = time.monotonic() + 300
    while not condition():
        assert time.monotonic() < deadline, "a machine under load; or it will never be"
        time.sleep(0.2)


def is_open(port: int) -> bool:
    with socket.socket() as connection:
        return connection.connect_ex(("127.0.0.1", port)) == 0


def free_port() -> int:
    with socket.socket() as connection:
        connection.bind(("127.0.0.1", 0))
        port: int = connection.getsockname()[1]
        return port


@contextmanager
def processes() -> Iterator[list[subprocess.Popen[bytes]]]:
    all_of: list[subprocess.Popen[bytes]] = []
    try:
        yield all_of
    finally:
        for process in all_of:
            with suppress(ProcessLookupError):  # ended by itself
                os.killpg(process.pid, signal.SIGCONT)
                os.killpg(process.pid, signal.SIGKILL)
            process.wait(10)


class Wire:
    """A network to the scheduler that can break: nothing gets through any more, and no end is told of it."""

    def __init__(self, port: int) -> None:
        self._to = port
        self._whole = threading.Event()
        self._whole.set()
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.port: int = self._listener.getsockname()[1]
        threading.Thread(target=self._accept, daemon=True).start()

    def breaks(self) -> None:
        self._whole.clear()

    def mends(self) -> None:
        self._whole.set()

    def _accept(self) -> None:
        while True:
            near, _ = self._listener.accept()
            far = socket.create_connection(("127.0.0.1", self._to))
            for ends in ((near, far), (far, near)):
                threading.Thread(target=self._carry, args=ends, daemon=True).start()

    def _carry(self, source: socket.socket, target: socket.socket) -> None:
        with suppress(OSError):
            while data := source.recv(1 << 16):
                self._whole.wait()
                target.sendall(data)
            target.shutdown(socket.SHUT_WR)


@contextmanager
def cluster(workers: int, folder: Path) -> Iterator[str]:
    """The address of a scheduler with workers. folder: for their files."""
    port = free_port()
    address = f"tcp://127.0.0.1:{port}"
    with processes() as machines:
        machines.append(started("--start-scheduler", f"127.0.0.1:{port}"))
        wait_for(lambda: is_open(port))
        for _ in range(workers):
            machines.append(started("--start-worker", address, "--folder", str(folder)))
        yield address
