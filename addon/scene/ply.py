# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes as binary PLY files, bit for bit what the engine is given."""

from pathlib import Path

import numpy as np

from .description import Mesh


def write_ply(mesh: Mesh, path: Path) -> None:
    kind = "f4" if np.asarray(mesh.vertices).dtype == np.float32 else "f8"
    word = "float" if kind == "f4" else "double"
    names = ["x", "y", "z"] if mesh.normals is None else ["x", "y", "z", "nx", "ny", "nz"]
    columns = mesh.vertices if mesh.normals is None else np.column_stack((mesh.vertices, mesh.normals))
    faces = np.empty(len(mesh.triangles), [("count", "u1"), ("indices", "<i4", 3)])
    faces["count"] = 3
    faces["indices"] = mesh.triangles
    header = [
        "ply",
        "format binary_little_endian 1.0",
        f"element vertex {len(mesh.vertices)}",
        *(f"property {word} {name}" for name in names),
        f"element face {len(faces)}",
        "property list uchar int vertex_indices",
        "end_header",
    ]
    with path.open("wb") as file:
        file.write(("\n".join(header) + "\n").encode())
        file.write(np.ascontiguousarray(columns, f"<{kind}").tobytes())
        file.write(faces.tobytes())
