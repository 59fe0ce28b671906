# SPDX-License-Identifier: GPL-3.0-or-later
"""The engine's kernels in bulk, through libglimmer_probe (engine/probe): arrays in, arrays out.

One module for each kind of kernel. In all of them u has shape (n, 2), directions (n, 3).
"""

import ctypes
import os
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[Any]


@cache
def library() -> ctypes.CDLL:
    """The library in GLIMMER_LIB_DIR, else in the repository's build folder."""
    default = Path(__file__).resolve().parents[3] / "build" / "lib"
    path = Path(os.environ.get("GLIMMER_LIB_DIR", default)) / "libglimmer_probe.so"
    if not path.exists():
        raise FileNotFoundError(f"{path} is missing; run `python3 build.py build`")
    return ctypes.CDLL(str(path))


def _argument(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        if not value.flags.c_contiguous:
            raise ValueError("an array that is not C-contiguous")
        return ctypes.c_void_p(value.ctypes.data)
    if isinstance(value, np.float32):
        return ctypes.c_float(float(value))
    if isinstance(value, np.float64):
        return ctypes.c_double(float(value))
    if isinstance(value, np.uint64):
        return ctypes.c_uint64(int(value))
    return value  # int: a C int; ctypes structures


def call(name: str, *arguments: Any, returns: Any = None) -> Any:
    function = getattr(library(), name)
    function.restype = returns
    return function(*map(_argument, arguments))


def f32(values: ArrayLike, *shape: int) -> Array:
    array = np.ascontiguousarray(values, np.float32)
    return np.ascontiguousarray(np.broadcast_to(array, shape)) if shape else array


def f64(values: ArrayLike) -> Array:
    return np.ascontiguousarray(values, np.float64)


def empty(*shape: int, kind: Any = np.float32) -> Array:
    return np.zeros(shape, kind)
