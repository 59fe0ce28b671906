# SPDX-License-Identifier: GPL-3.0-or-later
"""The ctypes binding: that it fits the library, and what it says when it does not."""

import ctypes
import ctypes.util
import re
from dataclasses import MISSING, fields
from enum import IntEnum
from pathlib import Path
from typing import Any, get_args

import pytest

from addon.native import library, structs
from addon.scene import description as d
from addon.scene.problems import GlimmerError


def test_the_binding_fits_the_library(library_dir: Path) -> None:
    """Loading checks the ABI number and the size of every struct."""
    assert re.fullmatch(r"\d+\.\d+\.\d+.*", library.Library(library_dir / "libglimmer.so").version())


def test_every_function_of_the_header_that_is_bound_exists_there(repository: Path) -> None:
    header = (repository / "engine" / "include" / "glimmer.h").read_text()
    declared = set(re.findall(r"\b(glimmer_\w+)\(", header))
    assert set(library.SIGNATURES) | set(structs.INITIALISERS) <= declared
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
        (structs.ParameterKind, "glimmer_parameter_kind"),
        (structs.LightType, "glimmer_light_type"),
        (structs.Filter, "glimmer_filter"),
        (structs.State, "glimmer_render_state"),
    ],
)
def test_enumerations_are_the_headers(repository: Path, enumeration: type[IntEnum], name: str) -> None:
    header = (repository / "engine" / "include" / "glimmer.h").read_text()
    assert {item.name: item.value for item in enumeration} == enumerators(header, name)


def described_materials() -> dict[str, Any]:
    return {kind.TYPE: kind for kind in get_args(d.Material)}


def test_materials_are_the_engines(library_dir: Path) -> None:
    """Each class has the name, the parameters and the defaults of a row of the engine's table."""
    table = library.Library(library_dir / "libglimmer.so").materials()
    for kind, material in described_materials().items():
        own = {item.name: item for item in fields(material)}
        assert set(own) <= set(table[kind]), kind
        for key, row in table[kind].items():
            if row.required and not row.alternative:
                assert own[key].default is MISSING, f"{kind}: {key} is required"
            elif key in own and own[key].default is not None:
                of_kind = {
                    structs.ParameterKind.NUMBER: row.value,
                    structs.ParameterKind.COLOR: (row.value,) * 3,
                    structs.ParameterKind.WORD: (*row.words, None)[0],
                }
                default = own[key].default
                if isinstance(default, float):
                    default = ctypes.c_float(default).value  # as the engine's are
                assert default == of_kind[row.kind], f"{kind}: {key}"


def test_the_scene_formats_table_is_the_engines(repository: Path, library_dir: Path) -> None:
    """Every type has its row there, with every parameter and every word of it."""
    table = library.Library(library_dir / "libglimmer.so").materials()
    text = (repository / "engine" / "cli" / "SCENE_FORMAT.md").read_text()
    section = text[text.index("**materials**") : text.index("**meshes**")]
    rows = {kind: row for kind, row in re.findall(r"^\| `(\w+)` \| (.*) \|$", section, re.MULTILINE) if kind != "type"}
    assert set(rows) == set(table)
    with_emission = {kind for kind, parameters in table.items() if "emission" in parameters}
    listed = re.search(r"is allowed on (all\s+but\s+)?([\w,\s]+?)\.", section[section.rindex("|") :])
    assert listed is not None
    named = set(re.split(r",\s+|\s+and\s+", listed[2].strip()))
    assert (set(table) - named if listed[1] else named) == with_emission
    for kind, parameters in table.items():
        keys = set(re.findall(r"`(\w+)`", rows[kind])) - set(table) - {"true", "false"}
        words = {word for row in parameters.values() for word in row.words} - set(table)
        assert keys == (set(parameters) - {"emission"}) | words, kind


def test_the_first_integrator_is_the_default(library_dir: Path) -> None:
    names = [name for name, _ in library.Library(library_dir / "libglimmer.so").integrators()]
    assert names[0] != "baseline"
    assert "baseline" in names


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
