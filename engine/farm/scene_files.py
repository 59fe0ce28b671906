# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene as one stream of bytes: the scene file and what it names, which may only lie below its folder.

One line of JSON, [[name, size], ...], the scene file first; then their bytes.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import Any, BinaryIO

from .problems import FarmError

CHUNK_BYTES = 8 << 20  # of one message
MAX_INDEX_BYTES = 64 << 20
MAX_FILES = 1 << 20


def _texts(value: Any) -> Iterator[str]:
    if isinstance(value, str):
        yield value
    elif isinstance(value, dict):
        for member in value.values():
            yield from _texts(member)
    elif isinstance(value, list):
        for member in value:
            yield from _texts(member)


def is_safe(name: str) -> bool:
    """Whether a name leads to a file below the folder that it is relative to."""
    path = PurePosixPath(name)
    return bool(path.parts) and "\0" not in name and not path.is_absolute() and ".." not in path.parts


def named_files(scene: Path) -> list[str]:
    """The scene file's own name, and every file below its folder that a text in it names. Raises FarmError."""
    try:
        document = json.loads(scene.read_bytes())
    except OSError as error:
        raise FarmError(f"{scene}: {error.strerror or error}") from error
    except ValueError as error:
        raise FarmError(f"{scene}: is no scene file: {error}") from error
    names = dict.fromkeys(name for name in _texts(document) if len(name) < 4096 and is_safe(name))
    return [scene.name, *(name for name in names if name != scene.name and (scene.parent / name).is_file())]


@dataclass(frozen=True)
class PackedScene:
    """A stream in a file, known by the SHA-256 of its bytes."""

    stream: Path
    digest: str
    size: int

    @staticmethod
    def pack(scene: Path, stream: Path) -> PackedScene:
        digest = hashlib.sha256()
        names = named_files(scene)
        sizes = [(scene.parent / name).stat().st_size for name in names]
        with stream.open("wb") as target:

            def put(data: bytes) -> None:
                digest.update(data)
                target.write(data)

            put(json.dumps(list(zip(names, sizes, strict=True))).encode() + b"\n")
            for name, size in zip(names, sizes, strict=True):
                begin = target.tell()
                with (scene.parent / name).open("rb") as source:
                    while data := source.read(CHUNK_BYTES):
                        put(data)
                if target.tell() - begin != size:
                    raise FarmError(f"{scene.parent / name}: changed while it was read")
        return PackedScene(stream, digest.hexdigest(), stream.stat().st_size)

    @property
    def chunks(self) -> int:
        return -(-self.size // CHUNK_BYTES)

    def chunk(self, number: int) -> bytes:
        with self.stream.open("rb") as source:
            source.seek(number * CHUNK_BYTES)
            return source.read(CHUNK_BYTES)


def _index(source: BinaryIO) -> list[tuple[str, int]]:
    try:
        index = [(str(name), int(size)) for name, size in json.loads(source.readline(MAX_INDEX_BYTES))]
    except (ValueError, TypeError) as error:
        raise FarmError(f"the scene's stream is damaged: {error}") from error
    for name, size in index:
        if not is_safe(name) or size < 0:
            raise FarmError(f"the scene's stream names {name!r} with {size} bytes, which is no file below its folder")
    if not 0 < len(index) <= MAX_FILES or len({name for name, _ in index}) != len(index):
        raise FarmError(f"the scene's stream names {len(index)} files, some of them twice or too many")
    return index


def unpack(stream: Path, folder: Path) -> Path:
    """Writes the files of a stream below a new folder; the path of the scene file. Raises FarmError, OSError."""
    folder.mkdir(parents=True)
    with stream.open("rb") as source:
        index = _index(source)
        if source.tell() + sum(size for _, size in index) != stream.stat().st_size:
            raise FarmError("the scene's stream is longer or shorter than its files")
        for name, size in index:
            path = folder / name
            path.parent.mkdir(parents=True, exist_ok=True)
            with path.open("xb") as target:
                for begin in range(0, size, CHUNK_BYTES):
                    target.write(source.read(min(size - begin, CHUNK_BYTES)))
    return folder / index[0][0]


def digest_of(stream: Path) -> str:
    with stream.open("rb") as source:
        digest = hashlib.sha256()
        while data := source.read(CHUNK_BYTES):
            digest.update(data)
        return digest.hexdigest()
