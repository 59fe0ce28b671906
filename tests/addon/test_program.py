# SPDX-License-Identifier: GPL-3.0-or-later
"""Graphs of operations as straight-line code."""

from pathlib import Path

import numpy as np
import pytest

from addon.export.nodes import unknown_mode
from addon.native import library
from addon.scene.description import Lambert, Light, Mix
from addon.scene.program import Op, Output, Program, Texture, TooLargeError, compile_program, programmed


def add(a: Op | float, b: Op | float) -> Op:
    return Op("math", (a, b, 0.0), ("add", "free"))


def run(program: Program) -> list[float]:
    """The outputs of a program of additions."""
    registers: dict[int, float] = {}
    for instruction in program.instructions:
        values = [registers[i] if i >= 0 else float(program.constants[-1 - i][0]) for i in instruction.inputs]
        registers[instruction.out] = sum(values)
    return [registers[out] for out in program.outputs]


def test_what_is_shared_is_done_once() -> None:
    shared = add(1.0, 2.0)
    program = compile_program([add(shared, shared), add(shared, 10.0)])
    assert len(program.instructions) == 3
    assert run(program) == [6.0, 13.0]


def test_equal_constants_are_kept_once() -> None:
    assert len(compile_program([add(add(1.0, 2.0), add(2.0, 1.0))]).constants) == 3  # 1, 2 and the unused 0


def test_a_register_is_free_after_its_last_use() -> None:
    chain = add(1.0, 1.0)
    for _ in range(1000):
        chain = add(chain, 1.0)
    program = compile_program([chain])
    assert run(program) == [1002.0]
    assert max(instruction.out for instruction in program.instructions) <= 1


def test_an_output_keeps_its_register() -> None:
    first = add(1.0, 2.0)
    program = compile_program([first, add(add(first, 1.0), 1.0)])
    assert run(program) == [3.0, 5.0]


def test_what_is_too_large_is_refused() -> None:
    chain = add(1.0, 1.0)
    for _ in range(5000):
        chain = add(chain, 1.0)
    with pytest.raises(TooLargeError, match="5001 operations; allowed: 4096"):
        compile_program([chain])
    wide = [add(float(i), 1.0) for i in range(300)]
    tree = wide[0]
    for item in wide[1:]:
        tree = add(tree, item)
    assert run(compile_program([tree])) == [sum(range(300)) + 300.0]
    with pytest.raises(TooLargeError, match="65 values; allowed: 64"):
        compile_program(wide[:65])


def test_a_material_stands_with_outputs_in_the_place_of_operations() -> None:
    color, weight = Op("splat", (add(0.25, 0.25),)), add(0.5, 0.0)
    material, program = programmed(Mix(weight, Lambert(color), Lambert((1.0, 0.0, 0.0)), emission=color))
    assert program is not None
    assert material == Mix(Output(0, True), Lambert(Output(1, False)), Lambert((1.0, 0.0, 0.0)), Output(1, False))
    assert programmed(Light((1.0, 2.0, 3.0))) == (Light((1.0, 2.0, 3.0)), None)


def test_textures_of_equal_content_have_one_digest() -> None:
    pixels = np.arange(12, dtype=np.uint8).reshape(2, 2, 3)
    assert Texture("a", pixels).digest == Texture("b", pixels.copy()).digest
    assert Texture("a", pixels).digest != Texture("a", pixels, srgb=True).digest
    assert Texture("a", pixels).digest != Texture("a", pixels.reshape(1, 4, 3)).digest


def test_options_of_a_newer_blender_are_found(library_dir: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(library.VARIABLE, str(library_dir / "libglimmer.so"))
    assert unknown_mode(add(1.0, 2.0)) is None
    assert unknown_mode(Op("dot", ((0.0,) * 3, (0.0,) * 3))) is None
    assert unknown_mode(Op("math", (1.0, 2.0, 0.0), ("from_the_future", "free"))) == "from_the_future"
