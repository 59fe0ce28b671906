# SPDX-License-Identifier: GPL-3.0-or-later
"""The engine's library for tests: scenes by the add-on's binding, renders with every call of the C API."""

import ctypes
import json
import os
from collections.abc import Iterator
from contextlib import contextmanager
from ctypes import POINTER, byref, c_char_p, c_int, c_size_t, c_void_p
from functools import cache
from pathlib import Path
from types import TracebackType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from addon.native import structs
from addon.native.library import FILE_NAME, SIGNATURES, Library
from addon.native.scene import MeshCache, NativeScene
from addon.native.structs import State
from addon.scene.description import SceneDescription

Image = NDArray[np.float32]


def library_path() -> Path:
    return Path(os.environ["GLIMMER_LIB_DIR"]) / FILE_NAME


@cache
def engine() -> Library:
    """What is under test, checked against the header's ABI number and the sizes of its structs."""
    return Library(library_path())


@cache
def functions() -> ctypes.CDLL:
    """The bare functions, which give back result codes; every handle is a c_void_p."""
    engine()
    library = ctypes.CDLL(str(library_path()))
    more: dict[str, tuple[object, list[object]]] = {
        "glimmer_render_save": (c_int, [c_void_p, POINTER(c_void_p), POINTER(c_size_t)]),
        "glimmer_render_load": (c_int, [c_void_p, c_void_p, c_size_t]),
    }
    for name, (result, arguments) in {**SIGNATURES, **more}.items():
        function = getattr(library, name)
        function.restype, function.argtypes = result, arguments
    for name, struct in structs.INITIALISERS.items():
        function = getattr(library, name)
        function.restype, function.argtypes = None, [POINTER(struct)]
    return library


def last_error() -> str:
    message: bytes = functions().glimmer_last_error()
    return message.decode()


def call(name: str, *arguments: object) -> None:
    """A call that must succeed."""
    result = getattr(functions(), name)(*arguments)
    assert result == structs.Result.OK, f"{name}: {last_error()}"


@cache
def pass_table() -> dict[str, tuple[int, str]]:
    return engine().passes()


class Scene:
    """A committed scene; freed with the object."""

    def __init__(self, description: SceneDescription, shared: MeshCache | None = None) -> None:
        """shared: meshes of other scenes, which the caller clears in the end."""
        meshes = shared or MeshCache(engine())
        try:
            self._native = NativeScene(engine(), description, meshes)
        finally:
            if shared is None:
                meshes.clear()
        window = description.film.window
        self.width, self.height = window[2] - window[0], window[3] - window[1]

    @property
    def handle(self) -> c_void_p:
        return self._native.handle

    def warnings(self) -> list[str]:
        """Their codes."""
        return [warning.code for warning in self._native.warnings()]

    def __del__(self) -> None:
        if hasattr(self, "_native"):
            self._native.close()


class Render:
    """A render of a committed scene. For use in a `with`."""

    def __init__(self, scene: Scene, **settings: Any) -> None:
        """settings: fields of glimmer_render_desc; passes as names."""
        self.width, self.height = scene.width, scene.height
        desc = engine().init(structs.RenderDesc)
        passes = settings.pop("passes", ())
        integrator = settings.pop("integrator", None)
        desc.integrator = None if integrator is None else integrator.encode()
        below, desc.passes_above = structs.pass_bits(pass_table()[name][0] for name in passes)
        desc.passes |= below
        for key, value in settings.items():
            assert hasattr(desc, key), key
            setattr(desc, key, value)
        self.handle = c_void_p()
        call("glimmer_render_create", scene.handle, byref(desc), byref(self.handle))

    def __enter__(self) -> "Render":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        functions().glimmer_render_destroy(self.handle)
        self.handle = c_void_p()

    def start(self) -> None:
        call("glimmer_render_start", self.handle)

    def pause(self) -> None:
        call("glimmer_render_pause", self.handle)

    def resume(self) -> None:
        call("glimmer_render_resume", self.handle)

    def cancel(self) -> None:
        call("glimmer_render_cancel", self.handle)

    def wait(self, seconds: float = -1) -> None:
        call("glimmer_render_wait", self.handle, seconds)

    def run(self) -> "Render":
        self.start()
        self.wait()
        return self

    def poll(self) -> structs.ProgressDesc:
        progress = engine().init(structs.ProgressDesc)
        call("glimmer_render_poll", self.handle, byref(progress))
        return progress

    @property
    def state(self) -> State:
        return State(self.poll().state)

    def next_tile(self) -> structs.TileDesc | None:
        tile, found = structs.TileDesc(), c_int()
        call("glimmer_render_next_tile", self.handle, byref(tile), byref(found))
        return tile if found.value else None

    def tiles(self) -> Iterator[structs.TileDesc]:
        """Every tile that changed since it was last handed out."""
        while tile := self.next_tile():
            yield tile

    def read(self, name: str = "combined", rectangle: tuple[int, int, int, int] | None = None) -> Image:
        """(height, width, channels) of a pass; rectangle: x, y, width, height."""
        number, channels = pass_table()[name]
        x, y, width, height = rectangle or (0, 0, self.width, self.height)
        pixels = np.full((height, width, len(channels)), np.nan, np.float32)
        call("glimmer_render_read", self.handle, number, x, y, width, height, pixels.ctypes.data, pixels.size)
        return pixels

    def report(self) -> dict[str, Any]:
        text = c_char_p()
        call("glimmer_render_report", self.handle, byref(text))
        report: dict[str, Any] = json.loads(text.value or b"")
        return report

    def save(self) -> bytes:
        data, size = c_void_p(), c_size_t()
        call("glimmer_render_save", self.handle, byref(data), byref(size))
        return ctypes.string_at(data.value or 0, size.value)

    def load(self, state: bytes) -> None:
        call("glimmer_render_load", self.handle, state, len(state))


@contextmanager
def rendering(scene: Scene, **settings: Any) -> Iterator[Render]:
    """A render that was started."""
    with Render(scene, **settings) as render:
        render.start()
        yield render
