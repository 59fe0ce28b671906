# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene that is not committed, by the bare C API."""

from collections.abc import Iterator
from ctypes import byref, c_void_p

import pytest

from tests.engine.library import call, functions


@pytest.fixture
def scene() -> Iterator[c_void_p]:
    handle = c_void_p()
    call("glimmer_scene_create", byref(handle))
    yield handle
    functions().glimmer_scene_destroy(handle)
