# SPDX-License-Identifier: GPL-3.0-or-later
"""Arrays in .npy files: versions and layouts that are read, and what is wrong with a bad one."""

import struct
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from tests.engine import scenes
from tests.engine.scene_file.outcome import expect_good, message_of
from tests.engine.scenes import QUAD, Scene

pytestmark = pytest.mark.usefixtures("glimmer_command")


def npy_bytes(header: str, data: bytes, version: int = 1) -> bytes:
    text = header.encode() + b"\n"
    length = struct.pack("<H" if version == 1 else "<I", len(text))
    return b"\x93NUMPY" + bytes([version, 0]) + length + text + data


GOOD_HEADER = "{'descr': '<f8', 'fortran_order': False, 'shape': (1, 3, 4), }"
IDENTITY_BYTES = np.eye(3, 4).tobytes()


def instance_scene(folder: Path, data: bytes) -> Scene:
    (folder / "i.npy").write_bytes(data)
    return scenes.scene(
        materials={"grey": {"type": "lambert", "albedo": 0.5}},
        meshes={"quad": QUAD},
        objects=[{"mesh": "quad", "material": "grey", "instances": "i.npy"}],
    )


@pytest.mark.parametrize("version", [1, 2, 3])
def test_npy_versions(version: int, tmp_path: Path) -> None:
    expect_good(tmp_path, instance_scene(tmp_path, npy_bytes(GOOD_HEADER, IDENTITY_BYTES, version)))


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"", "is not a .npy file"),
        (b"\x93NUMPY\x01", "the .npy header is cut off"),
        (npy_bytes(GOOD_HEADER, b"")[:40], "the .npy header is cut off"),
        (npy_bytes(GOOD_HEADER, IDENTITY_BYTES, 9), ".npy format version 9 is not known"),
        (npy_bytes(GOOD_HEADER, IDENTITY_BYTES[:-1]), "is cut off: shape (1, 3, 4) takes 96 bytes, but 95 are there"),
        (npy_bytes(GOOD_HEADER, IDENTITY_BYTES + b"x"), "has 1 bytes more than shape (1, 3, 4) takes"),
        (
            npy_bytes(GOOD_HEADER.replace("(1,", "(99999999999,"), IDENTITY_BYTES),
            "is cut off: shape (99999999999, 3, 4) takes",
        ),
        (
            npy_bytes(GOOD_HEADER.replace("(1,", "(9999999999999999999,"), b""),
            "the shape (9999999999999999999, 3, 4) is larger",
        ),
        (npy_bytes(GOOD_HEADER.replace("(1,", "(99999999999999999999,"), b""), "the .npy header is damaged"),
        (npy_bytes(GOOD_HEADER.replace("(1,", "(-1,"), b""), "the .npy header is damaged"),
        (npy_bytes(GOOD_HEADER.replace("<f8", "<c8"), IDENTITY_BYTES), 'dtype "<c8" is not allowed'),
        (npy_bytes(GOOD_HEADER.replace("<f8", "|O"), IDENTITY_BYTES), 'dtype "|O" is not allowed'),
        (
            npy_bytes(GOOD_HEADER.replace("'<f8'", "[('x', '<f8')]"), IDENTITY_BYTES),
            "a structured dtype is not allowed",
        ),
        (npy_bytes(GOOD_HEADER.replace("<f8", "<i8"), IDENTITY_BYTES), 'dtype "<i8" is not float32 or float64'),
        (npy_bytes(GOOD_HEADER.replace("'shape'", "'shapes'"), IDENTITY_BYTES), "the .npy header is damaged"),
        (npy_bytes("{}", IDENTITY_BYTES), "the .npy header is damaged"),
        (
            npy_bytes(GOOD_HEADER, np.where(np.eye(3, 4) == 1, np.nan, 0).tobytes()),
            "element [0][0][0] is nan; finite numbers are allowed",
        ),
        (
            npy_bytes(GOOD_HEADER, np.array([0] * 11 + [np.inf]).tobytes()),
            "element [0][2][3] is inf; finite numbers are allowed",
        ),
        (
            npy_bytes(GOOD_HEADER.replace("(1, 3, 4)", "(12,)"), IDENTITY_BYTES),
            "shape (12,) is not (n, 3, 4) or (n, 4, 4)",
        ),
        (
            npy_bytes(GOOD_HEADER.replace("(1, 3, 4)", "()"), IDENTITY_BYTES[:8]),
            "shape () is not (n, 3, 4) or (n, 4, 4)",
        ),
    ],
)
def test_bad_npy(data: bytes, message: str, tmp_path: Path) -> None:
    assert message_of(tmp_path, instance_scene(tmp_path, data)).startswith('objects[0].instances: "i.npy": ' + message)


def test_npy_last_row(tmp_path: Path) -> None:
    matrices = np.tile(np.eye(4), (3, 1, 1))
    matrices[2] = matrices[2].T + np.eye(4, k=-1)
    np.save(tmp_path / "m.npy", matrices)
    message = message_of(tmp_path, instance_scene(tmp_path, (tmp_path / "m.npy").read_bytes()))
    assert message.startswith("objects[0].instances: the last row of matrix 2 is not 0 0 0 1")


def sphere_pixels(folder: Path, centers: NDArray[Any], name: str) -> NDArray[Any]:
    """What spheres at these centres look like: tells whether they were read as they stand."""
    np.save(folder / f"{name}.npy", centers)
    content = scenes.scene(
        film={"width": 32, "height": 24},
        materials={"white": {"type": "light", "radiance": 1}},
        spheres=[{"centers": f"{name}.npy", "radius": 0.5, "material": "white"}],
    )
    return scenes.render(folder, content, "--spp", 1, name=name).rgb


CENTERS = np.array([[-2, 0, 1], [1, 3, 0], [0.5, 0, -1.5], [2, -1, 2]], np.float64)


@pytest.mark.parametrize(
    ("name", "convert"),
    [
        ("float32", lambda a: a.astype(np.float32)),
        ("float16", lambda a: a.astype(np.float16)),
        ("big_endian", lambda a: a.astype(">f8")),
        ("big_endian_single", lambda a: a.astype(">f4")),
        ("fortran", np.asfortranarray),
    ],
)
def test_npy_layouts_give_the_same_picture(
    name: str, convert: Callable[[NDArray[Any]], NDArray[Any]], tmp_path: Path
) -> None:
    reference = sphere_pixels(tmp_path, CENTERS, "reference")
    assert 0 < reference.mean() < 1
    assert np.array_equal(sphere_pixels(tmp_path, convert(CENTERS), name), reference)


def test_empty_fields_are_fields(tmp_path: Path) -> None:
    content = instance_scene(tmp_path, npy_bytes(GOOD_HEADER.replace("(1,", "(0,"), b""))
    content["spheres"] = [{"centers": [], "radius": 1, "material": "grey"}]
    content["environment"] = {"radiance": 0.5}
    assert (scenes.render(tmp_path, content, "--spp", 1).rgb == 0.5).all()
