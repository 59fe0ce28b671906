# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether this machine can run the engine's library, found out before any of its code runs.

On a processor that lacks an instruction the library would end Blender, unsaved work and all, and what a system's loader
says of a library that it refuses helps no artist.
"""

import os
import platform
import struct
from pathlib import Path

# What the library is compiled for, x86-64-v3, in the kernel's names.
FEATURES = ("abm", "avx", "avx2", "bmi1", "bmi2", "f16c", "fma", "movbe")
GLIBC = (2, 27)  # what the library's symbols ask for; a test holds the two together
CPU_INFO = Path("/proc/cpuinfo")

# Of an ELF file: its first bytes, where its section headers begin, the size of each and their number. They come last.
_ELF = struct.Struct("<4s36xQ10xHH")


def refusal(library: Path) -> str:
    """Why this library cannot run here, in one line; empty when nothing speaks against it."""
    return _system() or _processor() or _c_library() or _file(library)


def _system() -> str:
    system, machine = platform.system(), platform.machine()
    if (system, machine) == ("Linux", "x86_64"):
        return ""
    return f"Glimmer runs on Linux on x86-64 only; this is {system.replace('Darwin', 'macOS')} on {machine}"


def _processor() -> str:
    info: dict[str, str] = {}
    try:
        for line in CPU_INFO.read_text(encoding="utf-8", errors="replace").splitlines():
            key, _, value = line.partition(":")
            info.setdefault(key.strip(), value.strip())
    except OSError:
        return ""  # the loader looks too
    known = info.get("flags", "").split()
    missing = [name for name in FEATURES if name not in known]
    if not known or not missing:
        return ""
    return (
        "Glimmer needs a processor with AVX2, as most since 2015 have; "
        f"{info.get('model name', 'this one')} lacks {', '.join(missing)}"
    )


def _c_library() -> str:
    wanted = ".".join(map(str, GLIBC))
    try:
        name, _, version = (os.confstr("CS_GNU_LIBC_VERSION") or "").partition(" ")
        found = tuple(int(part) for part in version.split(".")[:2])
    except (OSError, ValueError):
        name, version, found = "", "", ()
    if name != "glibc":
        return f"Glimmer needs a Linux with glibc {wanted} or later; this one has another C library"
    if found < GLIBC:
        return f"Glimmer needs a Linux with glibc {wanted} or later; this one has {version}"
    return ""


def _file(library: Path) -> str:
    try:
        size = library.stat().st_size
        with library.open("rb") as file:
            magic, begin, each, count = _ELF.unpack(file.read(_ELF.size))
        whole = magic == b"\x7fELF" and begin + each * count <= size
    except (OSError, struct.error):
        whole = False
    return "" if whole else f"The engine's library {library} is damaged; install the add-on's zip again"
