# SPDX-License-Identifier: GPL-3.0-or-later
"""The scene file: every key is read, in any order, out of its own folder alone; bad JSON is told of in one line."""

import json
import os
from pathlib import Path

import numpy as np
import pytest

from tests.engine import scenes
from tests.engine.scene_file.outcome import expect_good, message_of
from tests.engine.scenes import QUAD, Scene, changed, every_key, run_glimmer, write_scene

pytestmark = pytest.mark.usefixtures("glimmer_command")


def test_every_key_is_read(tmp_path: Path) -> None:
    expect_good(tmp_path, every_key(tmp_path))


def test_example_of_the_format(repository: Path, tmp_path: Path) -> None:
    """The file that SCENE_FORMAT.md shows."""
    text = (repository / "engine" / "cli" / "SCENE_FORMAT.md").read_text()
    example = text.split("```json\n")[1].split("```")[0]
    np.save(tmp_path / "plates.npy", np.tile(np.eye(3, 4, dtype=np.float32), (2, 1, 1)))
    np.save(tmp_path / "many.npy", np.array([[3.0, 20.0, 3.0]]))
    scenes.write_ply(tmp_path / "hex.ply", QUAD["vertices"], [[0, 1, 2, 3]])
    expect_good(tmp_path, json.loads(example))


HERE = "is not allowed here; allowed is"
KEY = "a key in double quotes"
VALUE = "a number, a text in double quotes, true, false, null, [...] or {...}"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", f"line 1, column 1: syntax error: the end of the file {HERE} {VALUE}"),
        ("{\n  ] ", f"line 2, column 3: syntax error: ']' {HERE} {KEY}"),
        ('{"glimmer": 1, "glimmer": 1}', 'key "glimmer" stands twice'),
        ('{"materials": {"a": {"type": "null", "type": "null"}}}', 'materials.a: key "type" stands twice'),
        ('{"objects": [{}, {"a": 1, "a": 2}]}', 'objects[1]: key "a" stands twice'),
        ("[]", "a list of 0 is not a scene, which is an object {...}"),
        ('{"glimmer": NaN}', f'glimmer: line 1, column 13: syntax error: "N" {HERE} {VALUE}'),
        ('{"glimmer": Infinity}', f'glimmer: line 1, column 13: syntax error: "I" {HERE} {VALUE}'),
        ('{"glimmer": 1e999}', "the number before character 17 is too large"),
        ('{"a": ' + "[" * 100 + "]" * 100 + "}", "a" + "[0]" * 63 + ": nested too deeply; 64 levels are allowed"),
        ('{"a": "\xff"}', None),
        ('{"glimmer": 1} x', f'line 1, column 16: syntax error: "x" {HERE} nothing more, after the closing brace'),
        (
            '{"film": {"width": 4 "height": 2}}',
            f"film.width: line 1, column 29: syntax error: a text {HERE} a comma",
        ),
        ('{"film": {"width": 4,,}}', f"film.width: line 1, column 22: syntax error: ',' {HERE} {KEY}"),
        ('{"film": {"width" 4}}', f"film.width: line 1, column 19: syntax error: a number {HERE} a colon"),
        ('{"film": {"width": 4, }}', f"film.width: line 1, column 23: syntax error: '}}' {HERE} {KEY}"),
        ('{"up": [0, 1 2]}', f"up[2]: line 1, column 14: syntax error: a number {HERE} a comma or a closing bracket"),
        ('{"glimmer": 1, // c\n}', f'glimmer: line 1, column 16: syntax error: "/" {HERE} {KEY}'),
        ("{'glimmer': 1}", f'line 1, column 2: syntax error: "\'" {HERE} {KEY}'),
        ('{"a": 1.}', "a: line 1, column 9: syntax error: invalid number; expected digit after '.'"),
        ('{"a": {"b": "\\q"}}', "a.b: line 1, column 15: syntax error: forbidden character after a backslash; allowed"),
        ('{"film": {"width": 4', f"film.width: line 1, column 21: syntax error: the end of the file {HERE} a comma or"),
    ],
    ids=[
        "empty",
        "bracket",
        "twice",
        "twice-deep",
        "twice-list",
        "list",
        "nan",
        "inf",
        "huge",
        "deep",
        "latin1",
        "tail",
        "no-comma",
        "two-commas",
        "no-colon",
        "last-comma",
        "list-no-comma",
        "comment",
        "single-quotes",
        "number",
        "escape",
        "cut-off",
    ],
)
def test_bad_json(text: str, message: str | None, tmp_path: Path) -> None:
    if message is None:  # bytes that are not UTF-8
        path = tmp_path / "scene.json"
        path.write_bytes(text.encode("latin-1"))
        done = run_glimmer(path, "-o", tmp_path / "out.exr")
        assert done.returncode == 1 and "ill-formed UTF-8" in done.stderr and done.stderr.count("\n") == 1
    else:
        assert message_of(tmp_path, text).startswith(message)


@pytest.mark.parametrize(
    ("name", "message"),
    [("gone.json", "no such file"), (".", "is a folder; a file is allowed"), ("pipe", "is not a regular file")],
)
def test_bad_scene_path(name: str, message: str, tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    path = tmp_path / name
    done = run_glimmer(path, "-o", tmp_path / "out.exr", timeout=20)
    assert done.returncode == 1
    assert done.stderr == f"{path}: {message}\n"


def test_links(tmp_path: Path) -> None:
    """A link inside the folder is a file like any other; one that leads out is refused."""
    inside = tmp_path / "inside"
    inside.mkdir()
    content = every_key(inside)
    (inside / "hex.ply").rename(tmp_path / "hex.ply")
    (inside / "hex.ply").symlink_to(tmp_path / "hex.ply")
    assert message_of(inside, content).startswith('meshes.hex.file: "hex.ply" is a link out of the scene\'s folder')
    (inside / "hex.ply").unlink()
    scenes.write_ply(inside / "real.ply", QUAD["vertices"], [[0, 1, 2, 3]])
    (inside / "hex.ply").symlink_to("real.ply")
    expect_good(inside, content)


def test_folder_link_out(tmp_path: Path) -> None:
    inside = tmp_path / "inside"
    inside.mkdir()
    (inside / "sub").symlink_to(tmp_path)
    content = every_key(inside)
    (inside / "hex.ply").rename(tmp_path / "hex.ply")
    content = changed(content, ("meshes", "hex", "file"), "sub/hex.ply")
    assert "is a link out of the scene's folder" in message_of(inside, content)


def test_materials_in_any_order(tmp_path: Path) -> None:
    """A mix may name materials that stand after it; numbering puts parts before the mix."""
    content = scenes.furnace()
    content["materials"] = {
        "outer": {"type": "mix", "weight": 0.5, "a": "inner", "b": "black"},
        "inner": {"type": "mix", "weight": 0.5, "a": "white", "b": "black"},
        "black": {"type": "lambert", "albedo": 0},
        "white": {"type": "lambert", "albedo": 1},
    }
    content["spheres"][0]["material"] = "outer"
    picture = scenes.render(tmp_path, content, "--spp", 4, "--aov", "material_index,albedo")
    middle = np.s_[2:4, 3:5]
    assert picture.layer("albedo")[middle] == pytest.approx(0.25)
    assert (picture.channels["material_index.X"][middle] == 4).all()


def test_hash_is_of_the_content(tmp_path: Path) -> None:
    """White space and the order of keys do not count; values and the bytes of files do."""

    def hash_of(content: Scene | str) -> str:
        path = write_scene(tmp_path, content)
        done = run_glimmer(path, "-o", tmp_path / "out.exr", "--spp", 1, "--quiet")
        assert done.returncode == 0, done.stderr
        return str(scenes.read_exr(tmp_path / "out.exr").attributes["glimmer:scene"])

    content = every_key(tmp_path)
    first = hash_of(content)
    assert first.startswith("xxh64:") and len(first) == 22
    assert hash_of(json.dumps(content, sort_keys=True, indent=3)) == first
    assert hash_of(changed(content, ("lights", 0, "intensity"), 10.0)) == first
    assert hash_of(changed(content, ("lights", 0, "intensity"), 11)) != first
    np.save(tmp_path / "radii.npy", np.full(7, 0.1))
    assert hash_of(content) != first
