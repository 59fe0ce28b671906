# SPDX-License-Identifier: GPL-3.0-or-later
"""The two ends of a link in a node tree, and the constant that a socket holds where nothing is linked to it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ..scene.description import Rgb
from .color import luminance

Constant = tuple[float, ...]  # (v,) or (r, g, b)


@dataclass(frozen=True)
class Source:
    """Where the value of an input comes from: the output of a node, within the groups that were entered."""

    node: Any
    output: Any
    groups: tuple[Any, ...]
    kinds: tuple[str, ...] = ()  # of the sockets of groups on the way, each of which converts, from the input back
    is_muted: bool = False  # it is an input that a muted node passes on, with nothing linked to it

    def own_value(self) -> Constant:
        """Where no node makes it: the socket's, but black or 0 by way of a muted node."""
        value = default_value(self.output)
        return (0.0,) * len(value) if self.is_muted else value


@dataclass(frozen=True)
class Input:
    """An input socket within the groups that were entered."""

    socket: Any
    groups: tuple[Any, ...] = ()


class NotConstantError(Exception):
    """A value that varies over a surface or a direction."""


def find_input(node: Any, *names: str) -> Any:
    """The first of a node's inputs of these names: a name may change between versions of Blender."""
    for name in names:
        socket = node.inputs.get(name)
        if socket is not None:
            return socket
    return None


def default_value(socket: Any) -> Constant:
    value = getattr(socket, "default_value", 0.0)
    if isinstance(value, (int, float)):
        return (float(value),)
    return tuple(float(v) for v in value[:3])


def as_color(value: tuple[float, ...]) -> Rgb:
    return (value[0], value[0], value[0]) if len(value) == 1 else (value[0], value[1], value[2])


def as_number(value: tuple[float, ...]) -> float:
    return value[0] if len(value) == 1 else luminance(as_color(value))
