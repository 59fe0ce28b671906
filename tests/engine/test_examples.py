# SPDX-License-Identifier: GPL-3.0-or-later
"""engine/examples/: the scene is what its script writes and renders; the C program of a page does what it says."""

import importlib.util
import json
import subprocess
from pathlib import Path
from types import ModuleType

import numpy as np

from tests.engine.scenes import read_pfm, run_glimmer


def make_scene(examples: Path) -> ModuleType:
    specification = importlib.util.spec_from_file_location("make_scene", examples / "make_scene.py")
    assert specification is not None and specification.loader is not None
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    return module


def test_scene_is_what_the_script_writes(repository: Path) -> None:
    """To the rounding of sin and cos, which differ between machines."""
    examples = repository / "engine" / "examples"
    script = make_scene(examples)
    scene = json.loads((examples / "glimmervoid_small.json").read_text())
    assert scene == json.loads(json.dumps(script.scene()))
    plates = np.load(examples / "plates.npy")
    expected = script.plates()
    assert plates.shape == expected.shape and plates.dtype == np.float32
    assert np.allclose(plates, expected, rtol=0, atol=1e-5)


def test_scene_renders(repository: Path, glimmer_command: Path, tmp_path: Path) -> None:
    """The red moon is red, the blue one blue; the black one is darker than the fog about it."""
    assert glimmer_command.exists()
    picture = tmp_path / "small.pfm"
    done = run_glimmer(repository / "engine" / "examples" / "glimmervoid_small.json", "-o", picture, "--spp", 1)
    assert done.returncode == 0, done.stderr
    pixels = read_pfm(picture)
    assert pixels.shape == (270, 480, 3) and np.isfinite(pixels).all()
    red, blue, black, fog = (np.median(pixels[y : y + 8, x : x + 8], axis=(0, 1)) for x, y in MIDDLES)
    assert red.argmax() == 0 and red[0] > 1 and blue.argmax() == 2 and blue[2] > 1
    assert black.sum() < fog.sum()


MIDDLES = ((55, 81), (428, 105), (366, 148), (300, 130))
"""Top left corners, in pixels, of squares in the red, blue and black moon, and in the fog between them."""


def test_c_program(glimmer_command: Path, tmp_path: Path) -> None:
    done = subprocess.run(
        [glimmer_command.parent / "glimmer_example"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert "100 %, 16 samples a pixel" in done.stderr and done.stdout.startswith("render.pfm: relMSE ")
    pixels = read_pfm(tmp_path / "render.pfm")
    assert pixels.shape == (180, 320, 3) and np.isfinite(pixels).all()
    moon = pixels[38:46, 226:234].mean(axis=(0, 1))
    assert (moon > 5).all() and moon[0] > moon[1] > moon[2]
