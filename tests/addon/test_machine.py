# SPDX-License-Identifier: GPL-3.0-or-later
"""A machine that cannot run the engine is told so in one line, before any of the engine's code runs."""

import ctypes
import os
import platform
from pathlib import Path

import pytest

from addon.native import library, machine
from addon.scene.problems import GlimmerError

# What the kernel says of one core, less what nothing here reads.
HASWELL = """processor\t: 0
model name\t: Intel(R) Core(TM) i5-4570 CPU @ 3.20GHz
flags\t\t: fpu sse sse2 ssse3 fma sse4_1 sse4_2 movbe popcnt aes avx f16c rdrand lahf_lm abm bmi1 avx2 bmi2
bugs\t\t: spectre_v1

"""
IVY_BRIDGE = HASWELL.replace("i5-4570", "i5-3570")
for _feature in ("fma", "movbe", "abm", "bmi1", "avx2", "bmi2"):
    IVY_BRIDGE = IVY_BRIDGE.replace(f" {_feature}", "")


@pytest.fixture(autouse=True)
def forget_the_library() -> None:
    library.load.cache_clear()


@pytest.fixture
def engine_file(library_dir: Path) -> Path:
    return library_dir / "libglimmer.so"


def with_processor(monkeypatch: pytest.MonkeyPatch, folder: Path, text: str) -> None:
    (folder / "cpuinfo").write_text(text)
    monkeypatch.setattr(machine, "CPU_INFO", folder / "cpuinfo")


def test_this_machine_is_not_refused(engine_file: Path) -> None:
    assert machine.refusal(engine_file) == ""


def test_an_old_processor_gets_a_sentence(monkeypatch: pytest.MonkeyPatch, tmp_path: Path, engine_file: Path) -> None:
    with_processor(monkeypatch, tmp_path, IVY_BRIDGE * 2)
    assert machine.refusal(engine_file) == (
        "Glimmer needs a processor with AVX2, as most since 2015 have; "
        "Intel(R) Core(TM) i5-3570 CPU @ 3.20GHz lacks abm, avx2, bmi1, bmi2, fma, movbe"
    )


@pytest.mark.parametrize("text", [HASWELL * 2, "processor : 0\n", ""])
def test_a_processor_that_has_it_all_or_tells_nothing_is_not_refused(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, engine_file: Path, text: str
) -> None:
    with_processor(monkeypatch, tmp_path, text)
    assert machine.refusal(engine_file) == ""
    (tmp_path / "cpuinfo").unlink()
    assert machine.refusal(engine_file) == ""


def test_nothing_of_the_library_runs_on_an_old_processor(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, engine_file: Path
) -> None:
    def load(_: str) -> None:
        raise AssertionError("the library was loaded")

    with_processor(monkeypatch, tmp_path, IVY_BRIDGE)
    monkeypatch.setattr(ctypes, "CDLL", load)
    monkeypatch.setenv(library.VARIABLE, str(engine_file))
    with pytest.raises(GlimmerError, match="needs a processor with AVX2"):
        library.load()


@pytest.mark.parametrize(
    ("system", "processor", "words"),
    [
        ("Windows", "AMD64", "this is Windows on AMD64"),
        ("Darwin", "arm64", "this is macOS on arm64"),
        ("Linux", "aarch64", "this is Linux on aarch64"),
    ],
)
def test_another_system_gets_a_sentence(
    monkeypatch: pytest.MonkeyPatch, engine_file: Path, system: str, processor: str, words: str
) -> None:
    monkeypatch.setattr(platform, "system", lambda: system)
    monkeypatch.setattr(platform, "machine", lambda: processor)
    monkeypatch.delattr(os, "confstr")  # Windows has none
    assert machine.refusal(engine_file) == f"Glimmer runs on Linux on x86-64 only; {words}"


@pytest.mark.parametrize(
    ("told", "words"),
    [
        ("glibc 2.17", "glibc 2.27 or later; this one has 2.17"),
        ("glibc 2.9", "glibc 2.27 or later; this one has 2.9"),
        ("", "glibc 2.27 or later; this one has another C library"),
    ],
)
def test_an_old_c_library_gets_a_sentence(
    monkeypatch: pytest.MonkeyPatch, engine_file: Path, told: str, words: str
) -> None:
    def confstr(_: str) -> str:
        if not told:
            raise ValueError("unrecognized configuration name")
        return told

    monkeypatch.setattr(os, "confstr", confstr)
    assert machine.refusal(engine_file) == f"Glimmer needs a Linux with {words}"


@pytest.mark.parametrize("kept", [0, 10, 4096, -1])
def test_a_file_that_was_cut_off_gets_a_sentence(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, engine_file: Path, kept: int
) -> None:
    """Opened as it is, it could end Blender: its end is read where there is none."""
    broken = tmp_path / "libglimmer.so"
    broken.write_bytes(engine_file.read_bytes()[:kept])
    monkeypatch.setenv(library.VARIABLE, str(broken))
    with pytest.raises(GlimmerError, match=f"{broken} is damaged; install the add-on's zip again"):
        library.load()


def test_a_file_that_is_no_library_gets_a_sentence(tmp_path: Path) -> None:
    (tmp_path / "libglimmer.so").write_text("<html>404 Not Found</html>" * 10)
    assert "is damaged" in machine.refusal(tmp_path / "libglimmer.so")
