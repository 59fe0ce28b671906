# SPDX-License-Identifier: GPL-3.0-or-later
"""The `glimmer` command of this machine, and what its bits depend on."""

from __future__ import annotations

import ctypes
import hashlib
import os
from dataclasses import dataclass, fields
from functools import cached_property
from pathlib import Path

from .problems import FarmError, one_line

ROOT = Path(__file__).resolve().parents[2]
COMMAND_VARIABLE, LIBRARY_VARIABLE = "GLIMMER_BIN", "GLIMMER_LIB_DIR"
_MARK = "glimmer "  # what begins like this among the resources of a worker is an identity


@dataclass(frozen=True)
class Identity:
    """Two machines render the same bits where all of these are equal."""

    version: str
    compiler: str  # and Embree's version
    instructions: str  # of the processor that are used: AVX2 or AVX-512
    c_library: str  # its functions of floats
    program: str  # digest of the command's file

    def text(self) -> str:
        """As a worker of Dask declares it among its resources."""
        return _MARK + "; ".join(getattr(self, field.name) for field in fields(self))

    @staticmethod
    def among(resources: object) -> Identity | None:
        """The first that is found among the resources that a worker declares; they come from another machine."""
        for name in resources if isinstance(resources, dict) else ():
            parts = one_line(str(name)).removeprefix(_MARK).split("; ")
            if str(name).startswith(_MARK) and len(parts) == len(fields(Identity)):
                return Identity(*parts)
        return None

    def refusal(self, other: Identity | None) -> str:
        """Why a worker with another identity cannot take part, in words; empty when it can."""
        if other is None:
            return "it was not started by `glimmer farm --start-worker`"
        if other == self:
            return ""
        what = [
            f"{getattr(other, name)} in place of {getattr(self, name)}"
            for name in ("version", "compiler", "instructions", "c_library")
            if getattr(other, name) != getattr(self, name)
        ]
        return f"its pictures have other bits: {', '.join(what) or 'another build of the command'}"


class _PassInfo(ctypes.Structure):
    _fields_ = (
        ("name", ctypes.c_char_p),
        ("channels", ctypes.c_char_p),
        ("help", ctypes.c_char_p),
        ("rule", ctypes.c_int),
    )


@dataclass(frozen=True)
class Engine:
    command: Path
    library: Path

    @staticmethod
    def here() -> Engine:
        """The one that `python3 build.py build` leaves, unless the environment names another."""
        command = Path(os.environ.get(COMMAND_VARIABLE, ROOT / "build" / "bin" / "glimmer"))
        library = Path(os.environ.get(LIBRARY_VARIABLE, ROOT / "build" / "lib")) / "libglimmer.so"
        for path in (command, library):
            if not path.is_file():
                raise FarmError(f"{path}: no such file; `python3 build.py build` makes it")
        return Engine(command, library)

    @cached_property
    def _functions(self) -> ctypes.CDLL:
        try:
            functions = ctypes.CDLL(str(self.library))
        except OSError as error:
            raise FarmError(f"{self.library} cannot be loaded: {error}") from error
        functions.glimmer_version.restype = functions.glimmer_build_info.restype = ctypes.c_char_p
        functions.glimmer_pass_info.restype = ctypes.POINTER(_PassInfo)
        functions.glimmer_pass_info.argtypes = [ctypes.c_uint32]
        return functions

    @cached_property
    def identity(self) -> Identity:
        compiler, _, instructions = self._functions.glimmer_build_info().decode().rpartition(", ")
        return Identity(
            version=self._functions.glimmer_version().decode(),
            compiler=compiler,
            instructions=instructions,
            c_library=os.confstr("CS_GNU_LIBC_VERSION") or "another C library",
            program=hashlib.sha256(self.command.read_bytes()).hexdigest()[:16],
        )

    @cached_property
    def pass_rules(self) -> dict[str, int]:
        """glimmer_pass_rule by the name of the pass."""
        rules: dict[str, int] = {}
        while info := self._functions.glimmer_pass_info(len(rules)):
            rules[info.contents.name.decode()] = info.contents.rule
        return rules
