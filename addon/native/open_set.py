# SPDX-License-Identifier: GPL-3.0-or-later
"""What is open and must be closed with the add-on, whichever thread opens and closes it: F12 renders on a thread of
Blender's, each view on one of its own.
"""

from threading import RLock
from typing import Generic, TypeVar
from weakref import WeakSet

Item = TypeVar("Item")


class OpenSet(Generic[Item]):
    """Keeps nothing alive. A WeakSet alone raises where one thread walks it while another adds to it."""

    def __init__(self) -> None:
        self._items: WeakSet[Item] = WeakSet()
        self._lock = RLock()

    def add(self, item: Item) -> None:
        with self._lock:
            self._items.add(item)

    def discard(self, item: Item) -> None:
        with self._lock:
            self._items.discard(item)

    def all(self) -> list[Item]:
        with self._lock:
            return list(self._items)
