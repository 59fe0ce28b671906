# SPDX-License-Identifier: GPL-3.0-or-later
"""The ctypes binding: that it fits the library, and what it says when it does not."""

import ctypes
import ctypes.util
import re
from enum import IntEnum
from pathlib import Path

import pytest

from addon.native import library, structs
from addon.scene.problems import GlimmerError


def test_the_binding_fits_the_library(library_dir: Path) -> None:
    """Loading checks the ABI number and the size of every struct."""
    assert re.fullmatch(r"\d+\.\d+\.\d+.*", library.Library(library_dir / "libglimmer.so").version())


def test_every_function_of_the_header_that_is_bound_exists_there(repository: Path) -> None:
    header = (repository / "engine" / "include" / "glimmer.h").read_text()
    declared = set(re.findall(r"\b(glimmer_\w+)\(", header))
    assert set(library._SIGNATURES) | set(structs.INITIALISERS) <= declared
    number = re.search(r"#define GLIMMER_ABI_VERSION (\d+)", header)
    assert number is not None and int(number[1]) == structs.ABI_VERSION


def enumerators(header: str, name: str) -> dict[str, int]:
    body = re.search(rf"typedef enum {name} \{{(.*?)\}} {name};", header, re.DOTALL)
    assert body is not None
    return {key: int(value) for key, value in re.findall(r"GLIMMER_(\w+)\s*=\s*(\d+)", body[1])}


@pytest.mark.parametrize(
    ("enumeration", "name"),
    [
        (structs.Result, "glimmer_result"),
        (structs.Format, "glimmer_format"),
        (structs.MaterialType, "glimmer_material_type"),
        (structs.LightType, "glimmer_light_type"),
        (structs.Filter, "glimmer_filter"),
        (structs.State, "glimmer_render_state"),
    ],
)
def test_enumerations_are_the_headers(repository: Path, enumeration: type[IntEnum], name: str) -> None:
    header = (repository / "engine" / "include" / "glimmer.h").read_text()
    assert {item.name: item.value for item in enumeration} == enumerators(header, name)


def test_the_first_integrator_is_the_default(library_dir: Path) -> None:
    names = [name for name, _ in library.Library(library_dir / "libglimmer.so").integrators()]
    assert names[0] != "report"
    assert "report" in names


def test_a_missing_library_says_where_it_was_looked_for(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv(library.VARIABLE, str(tmp_path / "none.so"))
    library.load.cache_clear()
    with pytest.raises(GlimmerError, match=r"missing; looked for .*none\.so"):
        library.load()
    library.load.cache_clear()


def test_a_file_that_is_no_library_says_so(tmp_path: Path) -> None:
    path = tmp_path / "libglimmer.so"
    path.write_text("not a library")
    with pytest.raises(GlimmerError, match="cannot be loaded"):
        library.Library(path)


def test_another_library_says_so() -> None:
    other = ctypes.util.find_library("m")
    assert other is not None
    with pytest.raises(GlimmerError, match="not Glimmer's library, or an older one: it has no glimmer_abi_version"):
        library.Library(Path(other))


def test_a_library_of_another_interface_says_so(library_dir: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(library, "ABI_VERSION", structs.ABI_VERSION + 1)
    with pytest.raises(GlimmerError, match="install an add-on and a library that were built together"):
        library.Library(library_dir / "libglimmer.so")


def test_a_struct_of_another_size_is_found(library_dir: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    class Longer(ctypes.Structure):
        _fields_ = (*structs.FilmDesc._fields_, ("more", ctypes.c_double))

    monkeypatch.setitem(structs.INITIALISERS, "glimmer_film_init", Longer)
    with pytest.raises(GlimmerError, match="built from another header: glimmer_film_init"):
        library.Library(library_dir / "libglimmer.so")


def test_the_engines_words_reach_the_caller(library_dir: Path) -> None:
    engine = library.Library(library_dir / "libglimmer.so")
    desc = engine.init(structs.MeshDesc)
    handle = ctypes.c_void_p()
    with pytest.raises(GlimmerError) as caught:
        engine.call("glimmer_mesh_create", ctypes.byref(desc), ctypes.byref(handle))
    assert str(caught.value)
    assert "\n" not in str(caught.value)
    assert not handle
