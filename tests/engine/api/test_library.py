# SPDX-License-Identifier: GPL-3.0-or-later
"""What the library shows of itself."""

import re
import subprocess
from pathlib import Path

from addon.native import machine
from tests.engine.library import functions, library_path


def test_exports_are_its_own_alone() -> None:
    """Inside Blender any other symbol could be taken for the host's, or the host's for ours."""
    out = subprocess.run(
        ["nm", "-D", "--defined-only", library_path()], capture_output=True, text=True, check=True
    ).stdout
    names = [line.split()[-1].split("@")[0] for line in out.splitlines()]
    assert names and all(name.startswith("glimmer_") for name in names), names


def test_every_function_of_the_header_is_exported(repository: Path) -> None:
    header = (repository / "engine" / "include" / "glimmer.h").read_text()
    declared = set(re.findall(r"^GLIMMER_API .*?\b(glimmer_\w+)\(", header, re.MULTILINE | re.DOTALL))
    out = subprocess.run(
        ["nm", "-D", "--defined-only", library_path()], capture_output=True, text=True, check=True
    ).stdout
    assert declared == {line.split()[-1].split("@")[0] for line in out.splitlines()}
    assert len(declared) > 40


def test_needs_nothing_but_the_c_runtime() -> None:
    """Embree and libstdc++ are inside: a host brings others of its own."""
    out = subprocess.run(["readelf", "-d", library_path()], capture_output=True, text=True, check=True).stdout
    needed = set(re.findall(r"NEEDED.*\[(.+?)\]", out))
    allowed = {"libc.so.6", "libm.so.6", "libpthread.so.0", "libgcc_s.so.1", "ld-linux-x86-64.so.2"}
    assert needed and needed <= allowed, needed - allowed


def test_needs_nothing_but_the_c_library_that_the_add_on_asks_for() -> None:
    """No symbol is of a newer glibc, whatever the machine has that linked it."""
    out = subprocess.run(["objdump", "-T", library_path()], capture_output=True, text=True, check=True).stdout
    versions = re.findall(r"\(GLIBC_([\d.]+)\)", out)
    assert max(tuple(map(int, version.split("."))) for version in versions)[:2] == machine.GLIBC


def test_an_old_processor_is_refused_by_the_loader() -> None:
    """For callers other than the add-on: the mark that glibc reads, without which the process would end."""
    out = subprocess.run(["readelf", "-n", library_path()], capture_output=True, text=True, check=True).stdout
    assert "x86 ISA needed: x86-64-v3" in out


def test_tables_end() -> None:
    library = functions()
    for name in ("glimmer_pass_info", "glimmer_integrator_info"):
        assert getattr(library, name)(0)
        for index in (100, 1000, 0xFFFFFFFF):
            assert not getattr(library, name)(index)
