# SPDX-License-Identifier: GPL-3.0-or-later
"""Images as OpenEXR files: 32-bit float RGB scanlines without compression, every bit as it was.

The layout is that of "OpenEXR File Layout" (openexr.com): magic, version, attributes, line offsets, lines.
"""

import struct
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

_MAGIC_AND_VERSION = struct.pack("<ii", 20000630, 2)
_FLOAT = 2


def _attribute(name: str, kind: str, data: bytes) -> bytes:
    return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(data)) + data


def write_exr(pixels: NDArray[np.float32], path: Path) -> None:
    """pixels: (height, width, 3) linear, top row first."""
    height, width, _ = pixels.shape
    names = ("B", "G", "R")  # in the alphabetical order that the format wants
    channels = b"".join(name.encode() + b"\0" + struct.pack("<iiii", _FLOAT, 0, 1, 1) for name in names) + b"\0"
    window = struct.pack("<iiii", 0, 0, width - 1, height - 1)
    header = b"".join(
        (
            _attribute("channels", "chlist", channels),
            _attribute("compression", "compression", b"\0"),
            _attribute("dataWindow", "box2i", window),
            _attribute("displayWindow", "box2i", window),
            _attribute("lineOrder", "lineOrder", b"\0"),
            _attribute("pixelAspectRatio", "float", struct.pack("<f", 1.0)),
            _attribute("screenWindowCenter", "v2f", struct.pack("<ff", 0.0, 0.0)),
            _attribute("screenWindowWidth", "float", struct.pack("<f", 1.0)),
            b"\0",
        )
    )
    row = np.dtype([("y", "<i4"), ("size", "<i4"), ("values", "<f4", (3, width))])
    lines = np.empty(height, row)
    lines["y"] = np.arange(height)
    lines["size"] = 12 * width
    lines["values"] = np.moveaxis(pixels[..., ::-1], 2, 1)
    first = len(_MAGIC_AND_VERSION) + len(header) + 8 * height
    offsets = first + np.arange(height, dtype="<u8") * row.itemsize
    path.write_bytes(_MAGIC_AND_VERSION + header + offsets.tobytes() + lines.tobytes())
