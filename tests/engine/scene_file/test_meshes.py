# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes in .ply and .obj files: forms that are read, and what is wrong with a bad one."""

import struct
from pathlib import Path

import numpy as np
import pytest

from tests.engine import scenes
from tests.engine.scene_file.outcome import message_of
from tests.engine.scenes import QUAD, Scene, changed

pytestmark = pytest.mark.usefixtures("glimmer_command")


PLY_HEADER = """ply
format {format} 1.0
comment made for a test
element vertex 4
property float x
property float y
property float z
{more}element edge 1
property int vertex1
property int vertex2
element face 1
property uchar colour
property list uchar {index} vertex_indices
end_header
"""


def binary_ply(order: str, index: str = "int", code: str = "i") -> bytes:
    name = {"<": "binary_little_endian", ">": "binary_big_endian"}[order]
    header = PLY_HEADER.format(
        format=name, more="property double nx\nproperty double ny\nproperty double nz\n", index=index
    )
    rows = b"".join(struct.pack(order + "3f3d", *vertex, 0, 0, 1) for vertex in QUAD["vertices"])
    return (
        header.encode() + rows + struct.pack(order + "2i", 0, 1) + struct.pack(order + f"BB4{code}", 9, 4, 0, 1, 2, 3)
    )


def ascii_ply() -> bytes:
    header = PLY_HEADER.format(format="ascii", more="property float s\nproperty float t\n", index="int")
    rows = "".join(f"{x} {y} +{z}e0 0 1\n" for x, y, z in QUAD["vertices"])
    return (header + rows + "0 1\n9 4 0 1 2 3\n").encode()


OBJ = b"o quad\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvn 0 0 1\nvt 0 0\nusemtl x\nf -4/1/1 2/1/1 3/1/1 4/1/1\n"


def mesh_scene(folder: Path, name: str, data: bytes) -> Scene:
    (folder / name).write_bytes(data)
    to_world = [[1, 0, 0, 0.3], [0, 0, -1, 0], [0, 1, 0, 0.2], [0, 0, 0, 1]]  # upright, in view of the camera
    return scenes.scene(
        film={"width": 32, "height": 24},
        materials={"white": {"type": "light", "radiance": 1}},
        meshes={"m": {"file": name}},
        objects=[{"mesh": "m", "material": "white", "to_world": to_world}],
    )


@pytest.mark.parametrize(
    ("name", "data"),
    [
        ("little.ply", binary_ply("<")),
        ("big.ply", binary_ply(">", "ushort", "H")),
        ("text.ply", ascii_ply()),
        ("windows.ply", ascii_ply().replace(b"\n", b"\r\n")),
        ("quad.obj", OBJ),
        ("QUAD.OBJ", OBJ.replace(b"/1/1", b"")),
    ],
)
def test_mesh_files_give_the_same_picture(name: str, data: bytes, tmp_path: Path) -> None:
    content = mesh_scene(tmp_path, name, data)
    picture = scenes.render(tmp_path, content, "--spp", 1, name="file").rgb
    inline = changed(content, ("meshes", "m"), QUAD)
    reference = scenes.render(tmp_path, inline, "--spp", 1, name="inline").rgb
    assert 0 < reference.mean() < 1
    assert np.array_equal(picture, reference)


LITTLE = binary_ply("<")


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"", "is not a .ply file"),
        (b"ply\nformat ascii 1.0\n", "the .ply header has no end_header"),
        (b"ply\nend_header\n", "the .ply header has no format line"),
        (b"ply\nformat ascii 1.0\nend_header\n", 'has no element "vertex"'),
        (b"ply\nformat binary_middle_endian 1.0\nend_header\n", 'line 2: format "binary_middle_endian" is not known'),
        (b"ply\nformat ascii 1.0\nelement vertex -4\n\n", 'line 3: "-4" is not a count of elements'),
        (
            b"ply\nformat ascii 1.0\nelement vertex 99999999999999999999\n",
            'line 3: "99999999999999999999" is not a count',
        ),
        (b"ply\nformat ascii 1.0\nproperty float x\n", 'line 3: "property float x" is not understood'),
        (LITTLE.replace(b"float x", b"half x"), 'line 5: a type of "property half x" is not known'),
        (LITTLE.replace(b"uchar int vertex", b"float int vertex"), "line 16: a type of"),
        (LITTLE.replace(b"float x", b"float q"), 'element "vertex" has only a part of x, y, z'),
        (LITTLE.replace(b"double nz", b"double z"), 'element "vertex" has two properties for the place of "z"'),
        (LITTLE.replace(b"double nz", b"double n"), 'element "vertex" has only a part of nx, ny, nz'),
        (LITTLE[:-1], "is cut off"),
        (
            LITTLE.replace(b"vertex 4", b"vertex 400000000000"),
            'is cut off: 400000000000 of element "vertex" cannot be in the',
        ),
        (LITTLE.replace(b"face 1", b"face 18446744073709551615"), 'is cut off: 18446744073709551615 of element "face"'),
        (LITTLE[:-4] + struct.pack("<i", 4), "triangle 1 uses vertex 4; there are 4"),
        (LITTLE[:-4] + struct.pack("<i", -1), "face 0 has the vertex -1; vertices count from 0"),
        (LITTLE[:-17] + b"\x02" + LITTLE[-16:], "face 0 has 2 vertices; 3 or more are allowed"),
        (LITTLE.replace(b"vertex_indices", b"vertices"), 'element "face" does not have one list vertex_indices'),
        (LITTLE.replace(b"element face", b"element tristrips"), 'element "tristrips" is not supported'),
        (
            LITTLE.replace(struct.pack("<3f", *QUAD["vertices"][2]), struct.pack("<3f", 1, np.nan, 0)),
            "vertex 2 is not finite",
        ),
        (ascii_ply().replace(b"-1 -1 +0e0", b"-1 x +0e0"), '"x" is not a number'),
        (ascii_ply().replace(b"-1 -1 +0e0", b"-1 1e999 +0e0"), "vertex 0 is not finite"),
        (ascii_ply()[:-3], "is cut off"),
    ],
)
def test_bad_ply(data: bytes, message: str, tmp_path: Path) -> None:
    assert message_of(tmp_path, mesh_scene(tmp_path, "m.ply", data)).startswith('meshes.m.file: "m.ply": ' + message)


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"", "has 0 vertices; 3 or more are allowed"),
        (b"v 0 0 0\nv 1 0 0\nv 0 1 0\n", "has 0 vertices; 3 or more are allowed"),
        (b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", ""),
        (b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3 9\n", ""),
        (b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n", ""),
        (b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1//7 2//7 3//7\n", ""),
    ],
)
def test_bad_obj(data: bytes, message: str, tmp_path: Path) -> None:
    assert message_of(tmp_path, mesh_scene(tmp_path, "m.obj", data)).startswith('meshes.m.file: "m.obj": ' + message)
