# SPDX-License-Identifier: GPL-3.0-or-later
"""A running render of the engine: start, poll, read, cancel."""

from __future__ import annotations

import json
from ctypes import byref, c_char_p, c_int, c_void_p
from dataclasses import dataclass
from math import nan
from types import TracebackType
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from ..scene.description import RenderSettings, SceneDescription
from ..scene.problems import EngineWarning, GlimmerError
from . import structs
from .library import Library, load
from .open_set import OpenSet
from .scene import MeshCache, NativeScene
from .structs import State


@dataclass(frozen=True)
class Progress:
    state: State
    samples: int
    fraction: float
    seconds: float
    seconds_left: float | None  # None when nothing tells
    relmse: float = nan  # NaN when not known
    relmse_low: float = nan  # its interval
    relmse_high: float = nan
    heavy_tails: bool = False  # too heavy to certify any interval
    seconds_to_target: float | None = None
    peak_bytes: int = 0
    invalid_samples: int = 0
    version: int = 0  # grows whenever a pixel changed
    workers: int | None = None  # of a cluster; None: this machine renders

    @property
    def ended(self) -> bool:
        return self.state in (State.FINISHED, State.CANCELLED, State.FAILED)


@dataclass(frozen=True)
class Tile:
    x: int  # of the crop, from its top left
    y: int
    width: int
    height: int


class Render(Protocol):
    """What is asked of a render, whoever renders."""

    @property
    def material_numbers(self) -> list[int]: ...
    @property
    def has_alpha(self) -> bool: ...
    def start(self) -> None: ...
    def cancel(self) -> None: ...
    def wait(self, seconds: float) -> None: ...
    def poll(self) -> Progress: ...
    def changed_tiles(self) -> list[Tile]: ...
    def read(self, name: str, tile: Tile) -> NDArray[np.float32]: ...
    def report(self) -> dict[str, Any]: ...


class NativeRender:
    """A render of a committed scene. Use it in a `with`; it cancels and frees at the end."""

    def __init__(self, library: Library, scene: NativeScene) -> None:
        self._library = library
        self._scene = scene
        self._passes = library.passes()
        self._handle = c_void_p()
        settings = scene.description.settings
        desc = self._describe(settings)
        library.call("glimmer_render_create", scene.handle, byref(desc), byref(self._handle))
        open_renders.add(self)

    def _describe(self, settings: RenderSettings) -> Any:
        desc = self._library.init(structs.RenderDesc)
        desc.integrator = None if settings.integrator is None else settings.integrator.encode()
        desc.samples, desc.seconds, desc.target_error = settings.samples, settings.seconds, settings.target_error
        desc.seed, desc.threads, desc.tile_size = settings.seed, settings.threads, settings.tile_size
        desc.max_depth = -1 if settings.max_depth is None else settings.max_depth
        desc.max_scatter = -1 if settings.max_scatter is None else settings.max_scatter
        desc.adaptive = settings.adaptive
        desc.independent_pixels = settings.independent_pixels
        names = (*settings.passes, "alpha") if self.has_alpha else settings.passes
        desc.passes, desc.passes_above = structs.pass_bits(self._pass(name)[0] for name in names)
        return desc

    def _pass(self, name: str) -> tuple[int, str]:
        try:
            return self._passes[name]
        except KeyError:
            raise GlimmerError(f"The engine has no pass '{name}'; it has {', '.join(self._passes)}") from None

    def __enter__(self) -> NativeRender:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        if self._handle:
            self._library.free("glimmer_render_destroy", self._handle)
            self._handle = c_void_p()
        self._scene.close()
        open_renders.discard(self)

    @property
    def material_numbers(self) -> list[int]:
        """The engine's number of each material of the description."""
        return self._scene.material_numbers

    @property
    def has_alpha(self) -> bool:
        """Whether the picture may be empty in places: the pass "alpha" is there then."""
        return self._scene.description.has_alpha

    def start(self) -> None:
        self._library.call("glimmer_render_start", self._handle)

    def pause(self) -> None:
        self._library.call("glimmer_render_pause", self._handle)

    def resume(self) -> None:
        self._library.call("glimmer_render_resume", self._handle)

    def cancel(self) -> None:
        self._library.call("glimmer_render_cancel", self._handle)

    def wait(self, seconds: float) -> None:
        """Until the render has ended, or for some seconds. Raises GlimmerError with the reason of a failed render."""
        self._library.call("glimmer_render_wait", self._handle, seconds)

    def poll(self) -> Progress:
        desc = self._library.init(structs.ProgressDesc)
        self._library.call("glimmer_render_poll", self._handle, byref(desc))
        return Progress(
            state=State(desc.state),
            samples=desc.samples,
            fraction=desc.fraction,
            seconds=desc.seconds,
            seconds_left=desc.seconds_left if desc.seconds_left >= 0 else None,
            relmse=desc.relmse,
            relmse_low=desc.relmse_low,
            relmse_high=desc.relmse_high,
            heavy_tails=bool(desc.heavy_tails),
            seconds_to_target=desc.seconds_to_target if desc.seconds_to_target >= 0 else None,
            peak_bytes=desc.peak_bytes,
            invalid_samples=desc.invalid_samples,
            version=desc.version,
        )

    def changed_tiles(self) -> list[Tile]:
        """The tiles whose pixels changed since they were last returned."""
        tiles: list[Tile] = []
        desc, found = structs.TileDesc(), c_int()
        while True:
            self._library.call("glimmer_render_next_tile", self._handle, byref(desc), byref(found))
            if not found.value:
                return tiles
            tiles.append(Tile(desc.x, desc.y, desc.width, desc.height))

    def read(self, name: str, tile: Tile) -> NDArray[np.float32]:
        """(height, width, channels) of a pass, top row first."""
        number, channels = self._pass(name)
        pixels = np.empty((tile.height, tile.width, len(channels)), np.float32)
        self._library.call(
            "glimmer_render_read",
            self._handle,
            number,
            tile.x,
            tile.y,
            tile.width,
            tile.height,
            pixels.ctypes.data,
            pixels.size,
        )
        return pixels

    def report(self) -> dict[str, Any]:
        text = c_char_p()
        self._library.call("glimmer_render_report", self._handle, byref(text))
        report: dict[str, Any] = json.loads((text.value or b"{}").decode())
        return report


open_renders: OpenSet[NativeRender] = OpenSet()
_meshes: dict[int, MeshCache] = {}


def open_render(scene: SceneDescription, meshes: MeshCache | None = None) -> tuple[NativeRender, list[EngineWarning]]:
    """Builds the scene and a render of it, ready to start, and the scene's warnings.

    Meshes of the last scene that are in this one too are not built again. They are kept in `meshes`, without which all
    callers share one; whoever builds on a thread of its own needs its own, since another's scene drops the meshes.
    """
    library = load()
    if meshes is None:
        meshes = _meshes.setdefault(id(library), MeshCache(library))
    native = NativeScene(library, scene, meshes)
    meshes.keep_only({mesh.digest for mesh in scene.meshes()})
    try:
        return NativeRender(library, native), native.warnings()
    except BaseException:
        native.close()
        raise


def close_all() -> None:
    """Cancels and frees whatever is still open: for when the add-on is switched off or the process ends."""
    for render in open_renders.all():
        render.close()
    for meshes in _meshes.values():
        meshes.clear()
