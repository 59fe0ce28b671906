# SPDX-License-Identifier: GPL-3.0-or-later
"""The engine's table of the operations of shader programs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class OpRow:
    """A row of the engine's table of operations."""

    number: int
    modes: tuple[tuple[str, ...], ...]  # the words of each field
    inputs: str
    output: str
    resource: str


def op_rows(info: Any) -> dict[str, OpRow]:
    """info: the function that gives the engine's rows, by number."""
    rows: dict[str, OpRow] = {}
    while row := info(len(rows)):
        entry = row.contents
        fields = entry.modes.decode().split("|")
        rows[entry.name.decode()] = OpRow(
            len(rows),
            tuple(tuple(field.split()) for field in fields),
            entry.inputs.decode(),
            entry.output.decode(),
            entry.resource.decode(),
        )
    return rows
