# SPDX-License-Identifier: GPL-3.0-or-later
"""One frame over many machines: ranges of its samples are tasks of a Dask cluster, and their sums one picture.

`glimmer farm SCENE.json -o OUT.exr` is the command, `render_frame` the same for programs, addon/docs/farm.md the page
of both. build.py reads the command's options and has the standard library alone: what needs more is imported when it is
used.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .frame import render_frame

__all__ = ["render_frame"]


def __getattr__(name: str) -> Any:
    if name == "render_frame":
        from .frame import render_frame

        return render_frame
    raise AttributeError(f"module {__name__} has no attribute {name}")
