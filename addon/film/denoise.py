# SPDX-License-Identifier: GPL-3.0-or-later
"""Open Image Denoise as the host carries it: the library beside Blender's own, by its C interface (oidn.h, 2.x)."""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Iterable
from ctypes import POINTER, byref, c_bool, c_char_p, c_int, c_size_t, c_void_p
from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..scene.problems import GlimmerError

Pixels = NDArray[np.float32]

LIBRARY = "libOpenImageDenoise.so.2"
_CPU, _FLOAT3 = 1, 3
_CANCELLED = 6
BIAS = "denoising"  # in the report's biased_by
ABSENT = (
    "This Blender carries no Open Image Denoise, so the picture is not denoised; where the compositor has a Denoise"
    " node, that does it with the passes Albedo and Normal"
)
ABSENT_IN_VIEWS = "This Blender carries no Open Image Denoise, so views are not denoised"

# (what the caller gave, the share that is done) -> whether to go on. Called by the library's threads.
_Monitor = ctypes.CFUNCTYPE(c_bool, c_void_p, ctypes.c_double)

_SIGNATURES: dict[str, tuple[object, list[object]]] = {
    "oidnNewDevice": (c_void_p, [c_int]),
    "oidnCommitDevice": (None, [c_void_p]),
    "oidnReleaseDevice": (None, [c_void_p]),
    "oidnGetDeviceError": (c_int, [c_void_p, POINTER(c_char_p)]),
    "oidnNewFilter": (c_void_p, [c_void_p, c_char_p]),
    "oidnSetSharedFilterImage": (
        None,
        [c_void_p, c_char_p, c_void_p, c_int, c_size_t, c_size_t, c_size_t, c_size_t, c_size_t],
    ),
    "oidnSetFilterBool": (None, [c_void_p, c_char_p, c_bool]),
    "oidnSetFilterProgressMonitorFunction": (None, [c_void_p, _Monitor, c_void_p]),
    "oidnCommitFilter": (None, [c_void_p]),
    "oidnExecuteFilter": (None, [c_void_p]),
    "oidnReleaseFilter": (None, [c_void_p]),
}


def folders() -> Iterable[Path]:
    """Where official builds and the bpy module have their libraries."""
    import bpy

    yield Path(bpy.utils.resource_path("LOCAL")).parent / "lib"


@cache
def path() -> Path | None:
    """Where the host's library lies; None where it carries none."""
    return next((folder / LIBRARY for folder in folders() if (folder / LIBRARY).is_file()), None)


@cache
def find() -> ctypes.CDLL | None:
    """None where the host carries none, or one that is another than ours."""
    place = path()
    if place is None:
        return None
    try:
        library = ctypes.CDLL(str(place))
        for name, (result, arguments) in _SIGNATURES.items():
            function = getattr(library, name)
            function.restype, function.argtypes = result, arguments
    except (OSError, AttributeError):
        return None
    return library


def open_denoiser() -> Denoiser:
    """Raises GlimmerError."""
    library = find()
    if library is None:
        raise GlimmerError(ABSENT)
    return Denoiser(library)


class StoppedError(GlimmerError):
    """Since nobody waits for the picture any more."""


class Denoiser:
    """A device. Close it, or use it in a `with`."""

    def __init__(self, library: ctypes.CDLL) -> None:
        self._library = library
        self._device = c_void_p(library.oidnNewDevice(_CPU))
        library.oidnCommitDevice(self._device)
        self._check()

    def __enter__(self) -> Denoiser:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        self._library.oidnReleaseDevice(self._device)

    def picture(self, color: Pixels, albedo: Pixels, normal: Pixels) -> Pixels:
        """(height, width, 3) each, linear. Albedo and normal are denoised first, by themselves."""
        albedo, normal = self._run({"albedo": albedo}), self._run({"normal": normal})
        return self._run({"color": color, "albedo": albedo, "normal": normal}, hdr=True, cleanAux=True)

    def quick_picture(self, color: Pixels, albedo: Pixels, normal: Pixels, is_wanted: Callable[[], bool]) -> Pixels:
        """As `picture`, in a third of the time: albedo and normal are taken as they are. is_wanted: asked now and then
        on any thread; raises StoppedError when it says no."""
        return self._run({"color": color, "albedo": albedo, "normal": normal}, is_wanted, hdr=True)

    def _run(self, images: dict[str, Pixels], is_wanted: Callable[[], bool] | None = None, **switches: bool) -> Pixels:
        library = self._library
        held = {name: np.ascontiguousarray(np.nan_to_num(pixels), np.float32) for name, pixels in images.items()}
        output = np.empty_like(next(iter(held.values())))
        height, width, _ = output.shape
        handle = c_void_p(library.oidnNewFilter(self._device, b"RT"))
        try:
            for name, pixels in (*held.items(), ("output", output)):
                library.oidnSetSharedFilterImage(
                    handle, name.encode(), pixels.ctypes.data, _FLOAT3, width, height, 0, 0, 0
                )
            for name, value in switches.items():
                library.oidnSetFilterBool(handle, name.encode(), value)
            if is_wanted is not None:
                monitor = _Monitor(lambda _, __: is_wanted())
                library.oidnSetFilterProgressMonitorFunction(handle, monitor, None)
            library.oidnCommitFilter(handle)
            library.oidnExecuteFilter(handle)
            self._check()
        finally:
            library.oidnReleaseFilter(handle)
        return output

    def _check(self) -> None:
        words = c_char_p()
        code = self._library.oidnGetDeviceError(self._device, byref(words))
        if code == _CANCELLED:
            raise StoppedError("The denoiser was stopped")
        if code:
            raise GlimmerError(f"Open Image Denoise failed: {(words.value or b'').decode()}")


def denoised(read: Callable[[str], Pixels]) -> Pixels:
    """read: (height, width, 3) of a pass of the engine. Raises GlimmerError."""
    with open_denoiser() as denoiser:
        return denoiser.picture(read("combined"), read("albedo"), read("normal"))
