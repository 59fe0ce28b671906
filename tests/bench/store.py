# SPDX-License-Identifier: GPL-3.0-or-later
"""Finished runs on disk, so that a benchmark that was broken off goes on where it was.

A folder holds the runs of one renderer on one scene; its name has a digest of all that could change them. A run is
SAMPLES_SEED.exr and SAMPLES_SEED.json; the record is written last and at once, so where it stands the picture is whole.
Standard library alone: the renderers' own processes write the records.
"""

import hashlib
import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any


def picture_of(folder: Path, samples: int, seed: int) -> Path:
    return folder / f"{samples}_{seed}.exr"


def record_of(folder: Path, samples: int, seed: int) -> Path:
    return folder / f"{samples}_{seed}.json"


def write_record(
    folder: Path,
    samples: int,
    seed: int,
    rendered: float,
    cpu: float,
    wall: float,
    peak_bytes: int,
    invalid: int,
    set_up: float | None,
) -> None:
    """samples: as asked for; rendered: samples a pixel that the picture has. set_up: seconds, where they are known."""
    told = {
        "samples": rendered,
        "cpu": cpu,
        "wall": wall,
        "peak_bytes": peak_bytes,
        "invalid": invalid,
        "set_up": set_up,
    }
    record = record_of(folder, samples, seed)
    partial = record.with_suffix(".partial")
    partial.write_text(json.dumps(told))
    partial.replace(record)


def read_record(folder: Path, samples: int, seed: int) -> dict[str, Any] | None:
    """None where the run has not been finished."""
    record = record_of(folder, samples, seed)
    told: dict[str, Any] | None = json.loads(record.read_text()) if record.exists() else None
    return told


def digest(words: Iterable[str], files: Iterable[Path]) -> str:
    """Of words and of the contents of files."""
    found = hashlib.sha256()
    for part in (*(word.encode() for word in words), *(file.read_bytes() for file in files)):
        found.update(len(part).to_bytes(8, "little") + part)
    return found.hexdigest()[:16]
