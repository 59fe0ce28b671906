# SPDX-License-Identifier: GPL-3.0-or-later
"""What tests/bench/compare.py makes of pictures whose difference is known; and the page it writes of a real file."""

import re
import subprocess
from collections.abc import Callable
from pathlib import Path

import numpy as np
import OpenImageIO
import pytest

import build
from tests.bench.compare import (
    BLOCK,
    SEEDS,
    TOLERANCE,
    Options,
    Rendered,
    Values,
    blocks_of,
    compare,
    difference_picture,
    judge,
    png,
    verdict_line,
)

HEIGHT, WIDTH = 3 * BLOCK + 5, 4 * BLOCK


def rendered(pictures: Values, view: Callable[[Values], Values] = lambda linear: linear) -> Rendered:
    """By a view transform."""
    without = (pictures.sum(axis=0) - pictures) / (len(pictures) - 1)
    return Rendered(pictures, view(pictures.mean(axis=0)), view(without), 1.0, 1 << 20, (), "0")


def noise_of(seed: int, amount: float) -> Values:
    return amount * np.random.default_rng(seed).standard_normal((SEEDS, HEIGHT, WIDTH, 3))


def noisy(seed: int, noise: float, brighter: float = 0.0) -> Rendered:
    """A grey picture; its first block, at the bottom left, is brighter."""
    pictures = 0.5 + noise_of(seed, noise)
    pictures[:, :BLOCK, :BLOCK] += brighter
    return rendered(pictures)


def test_blocks_are_means_also_where_the_picture_ends() -> None:
    picture = np.arange(HEIGHT * WIDTH * 3, dtype=np.float64).reshape(HEIGHT, WIDTH, 3)
    blocks = blocks_of(picture)
    assert blocks.shape == (4, 4, 3)
    np.testing.assert_allclose(blocks[3, 1], picture[3 * BLOCK :, BLOCK : 2 * BLOCK].mean(axis=(0, 1)))


@pytest.mark.parametrize("noise", [0.0, 0.05, 0.5])
def test_noise_alone_is_the_same_picture(noise: float) -> None:
    verdict = judge(noisy(1, noise), noisy(2, noise))
    assert verdict.apart == 0
    assert verdict.ratio == pytest.approx(1.0, abs=0.02)
    assert verdict_line(verdict).startswith("the same picture")


def test_a_block_that_differs_is_found_where_it_is() -> None:
    verdict = judge(noisy(1, 0.05), noisy(2, 0.05, brighter=0.2))
    assert verdict.apart == 1
    assert verdict.largest == pytest.approx(1.4, abs=0.05)
    assert np.abs(verdict.beyond).max(axis=-1).argmax() == 0
    picture = difference_picture(verdict, HEIGHT, WIDTH)  # top row first
    assert picture.shape == (HEIGHT, WIDTH, 3)
    assert picture[-1, 0, 0] > picture[-1, 0, 2]
    np.testing.assert_allclose(picture[0, -1], 0.5, atol=0.05)


def test_a_block_darker_than_the_tolerance_allows_differs_too() -> None:
    cycles = noisy(1, 0.01)
    assert judge(cycles, rendered(cycles.linear - 0.1)).apart == 16


def test_noise_that_the_view_cuts_off_is_no_difference() -> None:
    # A twelfth of the light of single pixels is cut off, which would make the noisy picture the darker one.
    def view(linear: Values) -> Values:
        return np.clip(linear, 0.0, 1.0)

    noise = noise_of(1, 0.3)
    assert 0.9 - view(0.9 + noise).mean() > TOLERANCE
    assert judge(rendered(0.9 + noise, view), rendered(0.9 + 0.0 * noise, view)).apart == 0


def test_png_is_read_back(tmp_path: Path) -> None:
    pixels = np.random.default_rng(1).random((5, 7, 3))
    path = tmp_path / "picture.png"
    path.write_bytes(png(pixels))
    read = np.asarray(OpenImageIO.ImageBuf(str(path)).get_pixels(OpenImageIO.UINT8))
    np.testing.assert_array_equal(read[..., :3], np.round(pixels * 255.0).astype(np.uint8))


def in_profile(folder: Path, library_dir: Path, executable: Path | None, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(build.ROOT / "tests" / "blender"))
    from hosts import environment

    for name, value in environment(folder, library_dir / "libglimmer.so", executable).items():
        monkeypatch.setenv(name, value)


def runner(program: Path) -> list[str]:
    return [str(word) for word in build.script_runner(program, "--disable-autoexec")]


def saved(blender: Path, file: Path, *steps: str) -> Path:
    """Blender's first scene after these statements."""
    lines = ("import bpy", *steps, f"bpy.ops.wm.save_as_mainfile(filepath={str(file)!r})")
    words = [str(blender), "-b", "--factory-startup", "--python-exit-code", "1", "--python-expr", "\n".join(lines)]
    subprocess.run(words, check=True, capture_output=True, timeout=200)
    return file


@pytest.mark.parametrize("host", ["blender", "newest"])
def test_a_file_is_compared(
    host: str,
    request: pytest.FixtureRequest,
    library_dir: Path,
    repository: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    program = request.getfixturevalue("blender" if host == "blender" else "newest_python")
    in_profile(tmp_path / "profile", library_dir, program if host == "blender" else None, monkeypatch)
    file = repository / "blend_scenes" / "furnace.blend"
    line = compare(runner(program), file, Options(24, 16), tmp_path / "page", "a <command>", 200.0)
    assert line.startswith("the same picture; ratio of the means")
    page = (tmp_path / "page" / "index.html").read_text()
    assert "furnace.blend" in page
    assert "a &lt;command&gt;" in page
    for name in re.findall(r'src="([^"]+)"', page):
        assert (tmp_path / "page" / name).read_bytes().startswith(b"\x89PNG")


def test_a_file_without_a_camera_is_seen_whole(
    blender: Path, library_dir: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    in_profile(tmp_path / "profile", library_dir, blender, monkeypatch)
    file = saved(
        blender,
        tmp_path / "cube.blend",
        "bpy.data.objects.remove(bpy.data.objects['Camera'])",
        "bpy.data.objects['Cube'].location.x = 100",
        "bpy.ops.object.light_add(type='SUN')",
    )
    line = compare(runner(blender), file, Options(48, 12), tmp_path / "page", "a command", 200.0)
    assert line.startswith("the same picture")
    page = (tmp_path / "page" / "index.html").read_text()
    assert "has no camera; both engines look through &#x27;Compare&#x27;" in page
    picture = np.asarray(OpenImageIO.ImageBuf(str(tmp_path / "page" / "CYCLES.png")).get_pixels(OpenImageIO.FLOAT))
    assert np.abs(picture - picture[0, 0]).max() > 0.1  # the cube is there
    for edge in (picture[0], picture[-1], picture[:, 0], picture[:, -1]):
        np.testing.assert_allclose(edge, edge[:1].repeat(len(edge), axis=0), atol=0.02)  # and all of it


def test_steps_through_volumes_are_told_and_set(
    blender: Path, library_dir: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    in_profile(tmp_path / "profile", library_dir, blender, monkeypatch)
    # Dense where the noise is high: a step of the file's, a fifth of the cube, goes past most of it.
    file = saved(
        blender,
        tmp_path / "cloud.blend",
        "tree = bpy.data.materials['Material'].node_tree",
        "tree.nodes.remove(tree.nodes['Principled BSDF'])",
        "noise, volume = tree.nodes.new('ShaderNodeTexNoise'), tree.nodes.new('ShaderNodeVolumeScatter')",
        "tree.links.new(noise.outputs['Fac'], volume.inputs['Density'])",
        "tree.links.new(volume.outputs[0], tree.nodes['Material Output'].inputs['Volume'])",
        "bpy.context.scene.cycles.volume_step_rate = 2.0",
    )
    compare(runner(blender), file, Options(12, 6, 0.5), tmp_path / "page", "a command", 200.0)
    page = (tmp_path / "page" / "index.html").read_text()
    assert "Cycles goes through the volume of &#x27;Cube&#x27; by 0.1 at a time" in page


def test_what_lies_on_others_can_be_left_out_in_cycles(
    blender: Path, library_dir: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    in_profile(tmp_path / "profile", library_dir, blender, monkeypatch)
    file = saved(
        blender,
        tmp_path / "cubes.blend",
        "cube = bpy.data.objects['Cube']",
        "copy = bpy.data.objects.new('Copy', cube.data.copy())",
        "bpy.context.scene.collection.objects.link(copy)",
        "bpy.ops.object.light_add(type='SUN')",
    )
    assert not compare(runner(blender), file, Options(24, 96), tmp_path / "page", "", 200.0).startswith("the same")
    assert "object &#x27;Copy&#x27;: lies on object &#x27;Cube&#x27;" in (tmp_path / "page" / "index.html").read_text()
    line = compare(runner(blender), file, Options(24, 96, single=True), tmp_path / "page", "", 200.0)
    assert line.startswith("the same")
