# SPDX-License-Identifier: GPL-3.0-or-later
"""What comes from other machines is input like any other: scenes, ranges, and what workers say of themselves."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from engine.farm import ranges, scene_files
from engine.farm.engine import Identity
from engine.farm.problems import FarmError
from engine.farm.ranges import Expected, Order, Range

ORDER = Order("job", "0" * 64, 5, 105, 16, "program")
EXPECTED = Expected("xxh64:1", ("R", "G", "B"), (2, 3, 3))
GOOD = Range(5, 105, 16, "xxh64:1", ("R", "G", "B"), np.arange(18, dtype=np.float32).reshape(2, 3, 3))
HERE = Identity("0.1.0", "GCC 12, Embree 3", "AVX-512", "glibc 2.36", "0123")


def test_a_range_comes_back_as_it_was() -> None:
    found = ranges.decode(GOOD.encode(), ORDER, EXPECTED)
    assert (found.pixels == GOOD.pixels).all() and found.index == 5
    assert Order.decode(replace(ORDER, aovs=("depth",)).encode()) == replace(ORDER, aovs=("depth",))


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"index": 6}, "sent index 6, asked for 5"),
        ({"seed": 4}, "sent seed 4"),
        ({"samples": 8}, "sent samples 8"),
        ({"scene": "xxh64:2"}, "sent scene xxh64:2"),
        ({"channels": ("R", "G", "X")}, "sent channels"),
        ({"pixels": np.zeros((2, 2, 3), np.float32)}, "sent shape"),
        ({"pixels": np.full((2, 3, 3), np.nan, np.float32)}, "no finite numbers"),
    ],
)
def test_another_range_than_was_asked_for_is_refused(change: dict[str, object], words: str) -> None:
    with pytest.raises(FarmError, match=words):
        ranges.decode(replace(GOOD, **change).encode(), ORDER, EXPECTED)  # type: ignore[arg-type]


@pytest.mark.parametrize("data", [b"", b"\n", b"[]\n", b"{}\n", b"\x80\x04K\x01.\n", GOOD.encode()[:-1], b"{" * 10**6])
def test_garbage_is_refused(data: bytes) -> None:
    with pytest.raises(FarmError):
        ranges.decode(data, ORDER, EXPECTED)


def test_every_damage_of_a_head_is_refused_or_harmless() -> None:
    data = GOOD.encode()
    generator = np.random.default_rng(0)
    for _ in range(500):
        damaged = bytearray(data)
        for at in generator.integers(0, data.index(b"\n") + 1, 3):
            damaged[at] = generator.integers(256)
        try:
            found = ranges.decode(bytes(damaged), ORDER, EXPECTED)
        except FarmError as error:
            assert str(error).isprintable()
        else:
            assert found.pixels.shape == (2, 3, 3)


def test_a_failure_says_why_in_one_line() -> None:
    with pytest.raises(FarmError, match=r"^no space left on device on \[31mit$"):
        ranges.decode(ranges.failure("no space left on device\non\x1b[31mit"), ORDER, EXPECTED)


def scene_in(folder: Path, *names: str) -> Path:
    scene = folder / "scene.json"
    scene.write_text(json.dumps({"meshes": [{"file": name} for name in names]}))
    return scene


def test_a_scene_takes_what_it_names_and_nothing_else(tmp_path: Path) -> None:
    (tmp_path / "secret.txt").write_text("secret")
    folder = tmp_path / "scene"
    (folder / "data").mkdir(parents=True)
    (folder / "data" / "a.ply").write_bytes(b"ply" * 1000)
    (folder / "other.ply").write_bytes(b"not named")
    scene = scene_in(folder, "data/a.ply", "../secret.txt", str(tmp_path / "secret.txt"), "lambert")
    packed = scene_files.PackedScene.pack(scene, tmp_path / "stream")
    unpacked = scene_files.unpack(packed.stream, tmp_path / "there")
    assert unpacked.read_bytes() == scene.read_bytes()
    assert sorted(p.name for p in (tmp_path / "there").rglob("*") if p.is_file()) == ["a.ply", "scene.json"]
    assert (tmp_path / "there" / "data" / "a.ply").read_bytes() == b"ply" * 1000
    assert scene_files.digest_of(packed.stream) == packed.digest


@pytest.mark.parametrize(
    "index",
    [
        [["../x", 1]],
        [["/etc/x", 1]],
        [["a/../../x", 1]],
        [["a", 1], ["a", 0]],
        [["a", -1], ["b", 2]],
        [["a", 2]],
        [["a", 0]],
        [],
        {"a": 1},
        [["", 1]],
    ],
)
def test_a_stream_cannot_write_elsewhere(tmp_path: Path, index: object) -> None:
    (tmp_path / "stream").write_bytes(json.dumps(index).encode() + b"\nx")
    with pytest.raises(FarmError):
        scene_files.unpack(tmp_path / "stream", tmp_path / "in" / "folder")
    assert not list(tmp_path.rglob("x"))


@pytest.mark.parametrize(
    ("other", "words"),
    [
        (None, "was not started by"),
        (replace(HERE, instructions="AVX2"), "other bits: AVX2 in place of AVX-512"),
        (replace(HERE, version="0.2.0"), "0.2.0 in place of 0.1.0"),
        (replace(HERE, program="9"), "another build of the command"),
        (HERE, ""),
    ],
)
def test_a_worker_of_other_bits_is_refused_in_words(other: Identity | None, words: str) -> None:
    declared = {} if other is None else {other.text(): 1.0}
    assert Identity.among(declared) == other
    assert words in HERE.refusal(Identity.among(declared)) and bool(words) == bool(HERE.refusal(other))


@pytest.mark.parametrize("resources", [None, [], {"glimmer ": 1}, {"glimmer a; b": 1, "GPU": 2}, {3: 1}])
def test_what_is_no_identity_is_none(resources: object) -> None:
    assert Identity.among(resources) is None
