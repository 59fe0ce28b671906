# SPDX-License-Identifier: GPL-3.0-or-later
"""Shader programs: what the check refuses, and values that have a closed form.

That nodes show what they show in Blender is compared with Cycles (tests/blender/test_shading.py).
"""

import ctypes
from typing import Any

import numpy as np
import pytest

from addon.scene.program import INPUTS, NUMBERS, RESOURCES, Op, Table, Texture, compile_program
from tests.engine.probe import program as probe

POSITION = Op("geometry", (1.0,), ("position", "center"))
PLACES = np.random.default_rng(3).uniform(-3.0, 3.0, (200, 3)).astype(np.float32)
ZERO = (0.0, 0.0, 0.0)


def math(operation: str, a: Any, b: Any = 0.0, c: Any = 0.0) -> Op:
    return Op("math", (a, b, c), (operation, "free"))


def axis(name: str) -> Op:
    return Op("separate", (POSITION,), (name,))


def test_the_add_on_knows_the_operations() -> None:
    rows = probe.rows()
    kinds = {"table": "t", "texture": "i", "attribute": "a"}
    assert {name for name, row in rows.items() if row.output == "n"} == NUMBERS
    assert {name: row.inputs for name, row in rows.items()} == INPUTS
    assert {name: row.resource for name, row in rows.items() if row.resource != "-"} == {
        name: kinds[word] for name, word in RESOURCES.items()
    }


def test_arithmetic() -> None:
    x, y = axis("x"), axis("y")
    roots = [
        math("multiply_add", x, y, 0.5),
        math("divide", x, 0.0),
        math("sqrt", math("multiply", x, x)),
        Op("vector_math", (POSITION, (1.0, 2.0, 3.0), ZERO, 1.0), ("cross_product",)),
    ]
    out = probe.evaluate(roots, PLACES)
    np.testing.assert_allclose(out[:, 0, 0], PLACES[:, 0] * PLACES[:, 1] + 0.5, rtol=1e-6, atol=1e-6)
    np.testing.assert_array_equal(out[:, 1, 0], 0.0)
    np.testing.assert_allclose(out[:, 2, 0], np.abs(PLACES[:, 0]), rtol=1e-6)
    np.testing.assert_allclose(out[:, 3], np.cross(PLACES, [1.0, 2.0, 3.0]), rtol=1e-4, atol=1e-5)


def test_a_rotation_and_its_inverse_cancel() -> None:
    angles = (0.3, -0.7, 1.9)
    turned = Op("vector_rotate", (POSITION, (0.1, 0.2, 0.3), ZERO, 0.0, angles), ("euler", "forward"))
    back = Op("vector_rotate", (turned, (0.1, 0.2, 0.3), ZERO, 0.0, angles), ("euler", "inverse"))
    mapped = Op("mapping", (POSITION, (1.0, 2.0, 3.0), angles, (2.0, 0.5, -1.5)), ("point",))
    unmapped = Op("mapping", (mapped, (1.0, 2.0, 3.0), angles, (2.0, 0.5, -1.5)), ("texture",))
    out = probe.evaluate([back, unmapped], PLACES)
    np.testing.assert_allclose(out[:, 0], PLACES, atol=2e-6)
    np.testing.assert_allclose(out[:, 1], PLACES, atol=4e-6)


def test_colours_there_and_back() -> None:
    color = Op("white_noise_color", (POSITION, 0.0), ("3d",))
    roots = [color]
    for space in ("hsv", "hsl"):
        there = Op("convert", (color,), (f"rgb_to_{space}",))
        roots.append(Op("convert", (there,), (f"{space}_to_rgb",)))
    out = probe.evaluate(roots, PLACES)
    np.testing.assert_allclose(out[:, 1], out[:, 0], atol=1e-6)
    np.testing.assert_allclose(out[:, 2], out[:, 0], atol=1e-6)


def test_perlin_noise_is_zero_on_its_lattice_and_smooth_between() -> None:
    corners = np.random.default_rng(1).integers(-50, 50, (100, 3)).astype(np.float32)

    def noise(place: Any) -> Op:
        modes = ("3d", "fbm", "raw", "from_4")
        return Op("noise", (place, 0.0, 0.0, 0.5, 2.0, 0.0, 1.0, 0.0), modes)

    np.testing.assert_array_equal(probe.evaluate([noise(POSITION)], corners)[:, 0, 0], 0.0)
    values = probe.evaluate([noise(POSITION)], PLACES)[:, 0, 0]
    beside = probe.evaluate([noise(POSITION)], PLACES + np.float32(1e-3))[:, 0, 0]
    assert 0.1 < values.std() < 0.5 and np.abs(values).max() <= 1.0
    assert np.abs(values - beside).max() < 0.01


def test_the_nearest_point_of_voronoi_is_as_far_as_it_says() -> None:
    values = (POSITION, 0.0, 1.0, 0.0, 0.5, 2.0, 1.0, 0.5, 1.0)
    modes = ("3d", "f1", "euclidean", "raw", "pcg")
    out = probe.evaluate([Op("voronoi", values, modes), Op("voronoi_color", values, (*modes, "position"))], PLACES)
    np.testing.assert_allclose(out[:, 0, 0], np.linalg.norm(out[:, 1] - PLACES, axis=1), atol=2e-6)


def test_a_ramp_is_linear_between_its_rows() -> None:
    rows = np.zeros((3, 4), np.float32)
    rows[:, 0], rows[:, 3] = (0.0, 1.0, 4.0), (1.0, 0.5, 0.0)
    table = Table(rows, -1.0, 1.0)
    x = axis("x")
    out = probe.evaluate([Op("ramp", (x,), ("linear",), table), Op("ramp_alpha", (x,), ("linear",), table)], PLACES)
    np.testing.assert_allclose(out[:, 0, 0], np.interp(PLACES[:, 0], [-1, 0, 1], [0, 1, 4]), atol=1e-6)
    np.testing.assert_allclose(out[:, 1, 0], np.interp(PLACES[:, 0], [-1, 0, 1], [1, 0.5, 0]), atol=1e-6)


@pytest.mark.parametrize("as_float", [False, True])
def test_a_texture_is_bilinear_between_the_middles_of_its_texels(as_float: bool) -> None:
    pixels = np.array([[[0], [51]], [[102], [255]]], np.uint8)
    values = pixels.astype(np.float32) / 255.0
    texture = Texture("four", values if as_float else pixels)
    modes = ("flat", "linear", "extend", "as_is")
    out = probe.evaluate([Op("image", (POSITION, 0.0), modes, texture)], PLACES)[:, 0, 0]
    u, v = (np.clip(2.0 * PLACES[:, i] - 0.5, 0.0, 1.0) for i in (0, 1))
    rows = values[:, 0, 0][:, None] * (1 - u) + values[:, 1, 0][:, None] * u
    np.testing.assert_allclose(out, rows[0] * (1 - v) + rows[1] * v, atol=1e-6)


def test_a_flat_height_bends_no_normal_and_a_slope_the_right_way() -> None:
    # The probe's footprint is 0: nothing can be said of a slope, and the normal stays.
    normal = Op("geometry", (1.0,), ("normal", "center"))
    flat = Op("bump", (1.0, 1.0, 0.3, 0.3, 0.3, normal, 1.0))
    out = probe.evaluate([flat], PLACES, normals=(0.6, 0.0, 0.8))
    np.testing.assert_allclose(out[:, 0], np.broadcast_to([0.6, 0.0, 0.8], out[:, 0].shape), atol=1e-6)


# ---- What is refused ------------------------------------------------------------------------------------------------


def spoilt(**changes: Any) -> str:
    """The refusal of a good program (geometry, separate, math) with something of it changed."""
    program = compile_program([math("add", axis("x"), 1.0)])
    desc, keep = probe.description(program)
    instructions = keep[0]
    for key, value in changes.items():
        if key.startswith("first_"):
            setattr(instructions[0], key[6:], value)
        elif key.startswith("input_"):
            instructions[2].inputs[int(key[6:])] = value
        elif key.startswith("mode_"):
            instructions[2].mode[int(key[5:])] = value
        elif key == "outputs_0":
            ctypes.cast(desc.outputs, ctypes.POINTER(ctypes.c_uint16))[0] = value
        else:
            setattr(desc, key, value)
    return probe.refusal(desc)


def test_the_program_that_is_spoilt_is_good() -> None:
    assert spoilt() == ""


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"first_op": 60000}, "op 60000 is not known"),
        ({"first_out": 256}, "output is register 256; allowed: 0 to 255"),
        ({"first_resource": 1}, "resource 1 of 1"),
        ({"input_0": 200}, "input 0 is register 200, which nothing has written"),
        ({"input_0": 40000 - 32768}, "is register 7232, which nothing has written"),
        ({"input_0": 0x8000 + 9000}, "is constant 9000 of"),
        ({"mode_0": 41}, "mode 0 is 41; allowed: 0 to 40"),
        ({"mode_5": 1}, "mode 5 is 1; allowed: 0 to 0"),
        ({"outputs_0": 77}, "output 0 is register 77, which nothing has written"),
        ({"output_count": 0}, "has no outputs"),
        ({"output_count": 65}, "outputs are 65; allowed: up to 64"),
        ({"instruction_count": 4097}, "instructions are 4097; allowed: up to 4096"),
        ({"constant_count": 8193}, "constants are 8193"),
        ({"constants": None}, "constants are null"),
        ({"instructions": None}, "instructions are null"),
        ({"table_count": 257}, "tables are 257"),
        ({"attribute_count": 3}, "attributes are null"),
    ],
)
def test_what_is_wrong_with_a_program_is_told(changes: dict[str, Any], words: str) -> None:
    if "attribute_count" in changes:
        changes = {**changes, "attributes": None}
    message = spoilt(**changes)
    assert words in message and 'program "test"' in message and "\n" not in message


def test_a_vector_is_no_number() -> None:
    program = compile_program([math("add", axis("x"), 1.0)])
    desc, keep = probe.description(program)
    keep[0][1].op = probe.rows()["convert"].number  # of a vector to a vector, in the place of one of its parts
    message = probe.refusal(desc)
    assert "input 0 is a vector; allowed: a number" in message


@pytest.mark.parametrize(
    ("table", "words"),
    [
        (Table(np.zeros((1, 4), np.float32)), "table 0 has 1 row(s); allowed: 2 to 65536"),
        (Table(np.zeros((2, 4), np.float32), 1.0, 1.0), "its interval is empty"),
        (Table(np.full((2, 4), np.nan, np.float32)), "table 0: row 0 is not finite"),
    ],
)
def test_what_is_wrong_with_a_table_is_told(table: Table, words: str) -> None:
    desc, keep = probe.description(compile_program([Op("ramp", (0.5,), ("linear",), table)]))
    assert words in probe.refusal(desc)
    del keep


def test_constants_are_finite() -> None:
    desc, keep = probe.description(compile_program([math("add", float("nan"), 1.0)]))
    assert "is not finite" in probe.refusal(desc)
    del keep


def test_random_programs_are_refused_or_evaluate() -> None:
    """Whatever bytes an instruction holds, the check or the interpreter must bear it."""
    random = np.random.default_rng(11)
    program = compile_program([math("add", axis("x"), 1.0)])
    taken = 0
    for _ in range(3000):
        desc, keep = probe.description(program)
        block = (ctypes.c_uint8 * ctypes.sizeof(keep[0])).from_buffer(keep[0])
        for _ in range(random.integers(1, 5)):
            block[int(random.integers(len(block)))] = int(random.integers(256))
        taken += probe.refusal(desc) == ""
    assert 0 < taken < 3000
