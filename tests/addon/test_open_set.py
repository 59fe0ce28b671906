# SPDX-License-Identifier: GPL-3.0-or-later
"""What is open, on several threads."""

import gc
import sys
import threading

from addon.native.open_set import OpenSet


class Item:
    pass


def test_it_keeps_nothing_alive() -> None:
    items: OpenSet[Item] = OpenSet()
    kept, closed, forgotten = Item(), Item(), Item()
    for item in (kept, closed, forgotten):
        items.add(item)
    items.discard(closed)
    items.discard(closed)
    del item, forgotten
    gc.collect()
    assert items.all() == [kept]


def test_it_can_be_listed_while_others_open_and_close() -> None:
    """Fails with a bare WeakSet, which raises "Set changed size during iteration"."""
    interval = sys.getswitchinterval()
    items: OpenSet[Item] = OpenSet()
    kept = [Item() for _ in range(200)]  # a walk long enough for others to cut in
    for item in kept:
        items.add(item)
    done = threading.Event()

    def open_and_close() -> None:
        while not done.is_set():
            some = [Item() for _ in range(50)]
            for item in some:
                items.add(item)
            for item in some:
                items.discard(item)

    others = [threading.Thread(target=open_and_close) for _ in range(2)]
    sys.setswitchinterval(1e-6)
    try:
        for thread in others:
            thread.start()
        sizes = [len(items.all()) for _ in range(20_000)]
    finally:
        done.set()
        for thread in others:
            thread.join()
        sys.setswitchinterval(interval)
    assert all(200 <= size <= 300 for size in sizes)
