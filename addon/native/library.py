# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the engine's library, loads it, and checks that it is the one this package was written for.

Inside Blender this must run after `import bpy`: loaded first, the host binds to our copies of shared symbols.
"""

import ctypes
import os
from ctypes import POINTER, byref, c_char_p, c_double, c_float, c_int, c_size_t, c_uint32, c_void_p
from dataclasses import dataclass
from functools import cache, cached_property
from pathlib import Path
from typing import TypeVar

from ..scene.problems import EngineWarning, GlimmerError
from . import machine, structs
from .ops import OpRow, op_rows
from .structs import ABI_VERSION, INITIALISERS, Result

FILE_NAME = "libglimmer.so"
VARIABLE = "GLIMMER_LIBRARY"

Struct = TypeVar("Struct", bound=ctypes.Structure)

_RESULT = c_int

# name: (result, argument types)
SIGNATURES: dict[str, tuple[object, list[object]]] = {
    "glimmer_abi_version": (c_uint32, []),
    "glimmer_version": (c_char_p, []),
    "glimmer_build_info": (c_char_p, []),
    "glimmer_last_error": (c_char_p, []),
    "glimmer_mesh_create": (_RESULT, [POINTER(structs.MeshDesc), POINTER(c_void_p)]),
    "glimmer_mesh_destroy": (None, [c_void_p]),
    "glimmer_image_create": (_RESULT, [c_uint32, c_uint32, c_uint32, c_void_p, POINTER(c_void_p)]),
    "glimmer_image_destroy": (None, [c_void_p]),
    "glimmer_texture_create": (_RESULT, [POINTER(structs.TextureDesc), POINTER(c_void_p)]),
    "glimmer_texture_destroy": (None, [c_void_p]),
    "glimmer_op_info": (POINTER(structs.OpInfo), [c_uint32]),
    "glimmer_scene_add_program": (_RESULT, [c_void_p, POINTER(structs.ProgramDesc), POINTER(c_uint32)]),
    "glimmer_scene_bind": (_RESULT, [c_void_p, c_uint32, c_char_p, c_uint32, c_uint32]),
    "glimmer_scene_bind_environment": (_RESULT, [c_void_p, c_uint32, c_uint32]),
    "glimmer_scene_bind_light": (_RESULT, [c_void_p, c_uint32, c_uint32, c_uint32, POINTER(c_double)]),
    "glimmer_scene_bind_sun": (_RESULT, [c_void_p, POINTER(c_double), c_double]),
    "glimmer_scene_create": (_RESULT, [POINTER(c_void_p)]),
    "glimmer_scene_destroy": (None, [c_void_p]),
    "glimmer_material_info": (POINTER(structs.MaterialInfo), [c_uint32]),
    "glimmer_parameter_info": (POINTER(structs.ParameterInfo), [c_uint32]),
    "glimmer_scene_add_material": (_RESULT, [c_void_p, POINTER(structs.MaterialDesc), POINTER(c_uint32)]),
    "glimmer_scene_add_object": (_RESULT, [c_void_p, POINTER(structs.ObjectDesc)]),
    "glimmer_scene_add_spheres": (_RESULT, [c_void_p, POINTER(structs.SpheresDesc)]),
    "glimmer_scene_add_light": (_RESULT, [c_void_p, POINTER(structs.LightDesc)]),
    "glimmer_scene_set_environment": (_RESULT, [c_void_p, POINTER(c_float), c_void_p, POINTER(c_double)]),
    "glimmer_scene_set_environment_visible": (_RESULT, [c_void_p, c_uint32]),
    "glimmer_scene_set_environment_light_group": (_RESULT, [c_void_p, c_uint32]),
    "glimmer_scene_set_medium": (_RESULT, [c_void_p, POINTER(c_double), POINTER(c_double), c_double]),
    "glimmer_scene_set_medium_falloff": (_RESULT, [c_void_p, c_double, c_double]),
    "glimmer_scene_set_camera": (_RESULT, [c_void_p, POINTER(structs.CameraDesc)]),
    "glimmer_scene_set_film": (_RESULT, [c_void_p, POINTER(structs.FilmDesc)]),
    "glimmer_scene_commit": (_RESULT, [c_void_p, c_uint32]),
    "glimmer_scene_warnings": (c_char_p, [c_void_p]),
    "glimmer_warning_name": (c_char_p, [c_uint32]),
    "glimmer_scene_warning_code": (c_uint32, [c_void_p, c_size_t]),
    "glimmer_pass_info": (POINTER(structs.PassInfo), [c_uint32]),
    "glimmer_integrator_info": (POINTER(structs.IntegratorInfo), [c_uint32]),
    "glimmer_render_create": (_RESULT, [c_void_p, POINTER(structs.RenderDesc), POINTER(c_void_p)]),
    "glimmer_render_destroy": (None, [c_void_p]),
    "glimmer_render_start": (_RESULT, [c_void_p]),
    "glimmer_render_pause": (_RESULT, [c_void_p]),
    "glimmer_render_resume": (_RESULT, [c_void_p]),
    "glimmer_render_cancel": (_RESULT, [c_void_p]),
    "glimmer_render_wait": (_RESULT, [c_void_p, c_double]),
    "glimmer_render_poll": (_RESULT, [c_void_p, POINTER(structs.ProgressDesc)]),
    "glimmer_render_next_tile": (_RESULT, [c_void_p, POINTER(structs.TileDesc), POINTER(c_int)]),
    "glimmer_render_read": (
        _RESULT,
        [c_void_p, c_int, c_uint32, c_uint32, c_uint32, c_uint32, c_void_p, c_size_t],
    ),
    "glimmer_render_report": (_RESULT, [c_void_p, POINTER(c_char_p)]),
    "glimmer_error_curve_table": (_RESULT, [POINTER(structs.CurvePoint), c_size_t, POINTER(c_char_p)]),
    "glimmer_plot_error_curve": (
        _RESULT,
        [POINTER(structs.CurvePoint), c_size_t, POINTER(structs.PlotDesc), c_void_p, c_size_t],
    ),
}


def candidates() -> list[Path]:
    """Where the library may lie, in order: as told, inside the installed add-on, in a developer's build folder."""
    told = os.environ.get(VARIABLE)
    if told:
        return [Path(told)]
    package = Path(__file__).resolve().parent.parent
    return [package / "lib" / FILE_NAME, package.parent / "build" / "lib" / FILE_NAME]


@dataclass(frozen=True)
class ParameterRow:
    """A row of the engine's table of the parameters of materials; see glimmer_parameter_info_t."""

    type: str
    key: str
    kind: structs.ParameterKind
    required: bool
    alternative: int
    low: float
    high: float
    above_low: bool
    value: float
    words: tuple[str, ...]
    noun: str
    help: str

    @staticmethod
    def read(info: structs.ParameterInfo) -> "ParameterRow":
        return ParameterRow(
            info.type.decode(),
            info.key.decode(),
            structs.ParameterKind(info.kind),
            bool(info.required),
            info.alternative,
            info.low,
            info.high,
            bool(info.above_low),
            info.value,
            tuple(info.words.decode().split()),
            info.noun.decode(),
            info.help.decode(),
        )


class Library:
    """The loaded engine. Calls go through `call`, which turns a failure into a GlimmerError with the engine's words."""

    def __init__(self, path: Path) -> None:
        self.path = path
        try:
            self._library = ctypes.CDLL(str(path))
        except OSError as error:
            raise GlimmerError(f"The engine's library {path} cannot be loaded: {error}") from error
        self._materials: dict[str, dict[str, ParameterRow]] = {}
        self._declare()
        self._check()

    def _declare(self) -> None:
        for name, (result, arguments) in SIGNATURES.items():
            function = self._function(name)
            function.restype = result
            function.argtypes = arguments
        for name, struct in INITIALISERS.items():
            function = self._function(name)
            function.restype = None
            function.argtypes = [POINTER(struct)]

    def _function(self, name: str):  # type: ignore[no-untyped-def]  # ctypes has no public name for its functions
        try:
            return getattr(self._library, name)
        except AttributeError as error:
            raise GlimmerError(f"{self.path} is not Glimmer's library, or an older one: it has no {name}") from error

    def _check(self) -> None:
        found = self._library.glimmer_abi_version()
        if found != ABI_VERSION:
            raise GlimmerError(
                f"{self.path} speaks version {found} of the engine's interface, the add-on version {ABI_VERSION}:"
                " install an add-on and a library that were built together"
            )
        for name, struct in INITIALISERS.items():
            size = self.init(struct).struct_size
            if size != ctypes.sizeof(struct):
                raise GlimmerError(
                    f"{self.path} was built from another header: {name} fills {size} bytes,"
                    f" the add-on expects {ctypes.sizeof(struct)}"
                )

    def init(self, struct: type[Struct]) -> Struct:
        """A description with its size and the library's defaults."""
        # A larger library must not write past our struct: give it room, and compare afterwards what it wrote.
        room = ctypes.create_string_buffer(ctypes.sizeof(struct) + 1024)
        value = struct.from_buffer(room)
        name = next(key for key, known in INITIALISERS.items() if known is struct)
        getattr(self._library, name)(byref(value))
        return value

    def call(self, name: str, *arguments: object) -> None:
        result = getattr(self._library, name)(*arguments)
        if result != Result.OK:
            message = self._library.glimmer_last_error().decode("utf-8", "replace")
            known = result in Result.__members__.values()
            raise GlimmerError(message or f"{name} failed: {Result(result).name.lower() if known else result}")

    def free(self, name: str, handle: c_void_p) -> None:
        getattr(self._library, name)(handle)

    def version(self) -> str:
        return str(self._library.glimmer_version().decode())

    def build_info(self) -> str:
        """Compiler, Embree and the instruction set in use, in words."""
        return str(self._library.glimmer_build_info().decode())

    def warnings(self, scene: c_void_p) -> list[EngineWarning]:
        text = self._library.glimmer_scene_warnings(scene) or b""
        lines = [line for line in text.decode("utf-8", "replace").splitlines() if line]
        numbers = [self._library.glimmer_scene_warning_code(scene, i) for i in range(len(lines))]
        codes = [(self._library.glimmer_warning_name(number) or b"").decode() for number in numbers]
        return [EngineWarning(code, line) for code, line in zip(codes, lines, strict=True)]

    def integrators(self) -> list[tuple[str, str]]:
        """(name, help) of each; the first is the default."""
        return [(name, text) for name, _, text in self._table("glimmer_integrator_info")]

    def passes(self) -> dict[str, tuple[int, str]]:
        """name: (number, channels) of each."""
        return {name: (i, kind) for i, (name, kind, _) in enumerate(self._table("glimmer_pass_info"))}

    def materials(self) -> dict[str, dict[str, ParameterRow]]:
        """By type, the parameters of each by key."""
        if not self._materials:
            while entry := self._library.glimmer_material_info(len(self._materials)):
                self._materials[entry.contents.type.decode()] = {}
            number = 0
            while entry := self._library.glimmer_parameter_info(number):
                row = ParameterRow.read(entry.contents)
                self._materials[row.type][row.key] = row
                number += 1
        return self._materials

    @cached_property
    def op_rows(self) -> dict[str, OpRow]:
        """The operations of shader programs by name."""
        return op_rows(self._library.glimmer_op_info)

    def _table(self, name: str) -> list[tuple[str, str, str]]:
        rows: list[tuple[str, str, str]] = []
        while row := getattr(self._library, name)(len(rows)):
            entry = row.contents
            channels = getattr(entry, "channels", b"")
            rows.append((entry.name.decode(), channels.decode(), entry.help.decode()))
        return rows


def find() -> Path:
    """The library of this add-on. Raises GlimmerError where there is none, or none that can run on this machine, before
    any of its code runs.
    """
    places = candidates()
    for path in places:
        if path.is_file():
            refusal = machine.refusal(path)
            if refusal:
                raise GlimmerError(refusal)
            return path
    raise GlimmerError("The engine's library is missing; looked for " + " and ".join(str(path) for path in places))


@cache
def load() -> Library:
    """The engine, loaded once a process. Raises GlimmerError when there is none that fits."""
    return Library(find())
