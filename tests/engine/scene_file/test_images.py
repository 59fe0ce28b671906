# SPDX-License-Identifier: GPL-3.0-or-later
"""Images of the environment: how their numbers are taken, and what is wrong with a bad one."""

from pathlib import Path

import numpy as np
import pytest

from tests.engine import scenes
from tests.engine.scene_file.outcome import message_of
from tests.engine.scenes import Scene

pytestmark = pytest.mark.usefixtures("glimmer_command")


def sky_scene(name: str) -> Scene:
    return scenes.scene(environment={"image": name})


def srgb_to_linear(value: float) -> float:
    """IEC 61966-2-1."""
    return value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4


def test_8_bit_images_are_srgb(tmp_path: Path) -> None:
    scenes.write_image(tmp_path / "sky.png", np.full((4, 8, 3), [188, 64, 255], np.uint8))
    picture = scenes.render(tmp_path, sky_scene("sky.png"), "--spp", 1).rgb
    expected = [srgb_to_linear(188 / 255), srgb_to_linear(64 / 255), 1]
    assert picture == pytest.approx(np.broadcast_to(expected, picture.shape), rel=1e-6)


def test_float_images_are_linear(tmp_path: Path) -> None:
    scenes.write_image(tmp_path / "sky.exr", np.full((4, 8, 3), [2.5, 0.25, 0], np.float32))
    picture = scenes.render(tmp_path, sky_scene("sky.exr"), "--spp", 1).rgb
    assert picture == pytest.approx(np.broadcast_to([2.5, 0.25, 0], picture.shape), rel=1e-6)


def test_alpha_is_ignored_and_grey_is_grey(tmp_path: Path) -> None:
    scenes.write_image(tmp_path / "alpha.png", np.full((4, 8, 4), [255, 188, 0, 40], np.uint8))
    alpha = scenes.render(tmp_path, sky_scene("alpha.png"), "--spp", 1).rgb
    assert alpha == pytest.approx(np.broadcast_to([1, srgb_to_linear(188 / 255), 0], alpha.shape), rel=1e-6)
    scenes.write_image(tmp_path / "grey.exr", np.full((4, 8, 1), 0.5, np.float32))
    grey = scenes.render(tmp_path, sky_scene("grey.exr"), "--spp", 1).rgb
    assert grey == pytest.approx(0.5, rel=1e-6)


@pytest.mark.parametrize(("value", "said"), [(np.nan, "nan"), (np.inf, "inf"), (-0.5, "-0.5")])
def test_bad_pixels(value: float, said: str, tmp_path: Path) -> None:
    pixels = np.ones((4, 8, 3), np.float32)
    pixels[2, 5, 1] = value
    scenes.write_image(tmp_path / "sky.exr", pixels)
    message = message_of(tmp_path, sky_scene("sky.exr"))
    assert message == f'environment.image: "sky.exr": pixel (5, 2) is {said}; finite numbers of 0 or more are allowed'


def test_cut_off_image(tmp_path: Path) -> None:
    scenes.write_image(tmp_path / "sky.exr", np.ones((64, 128, 3), np.float32))
    data = (tmp_path / "sky.exr").read_bytes()
    (tmp_path / "sky.exr").write_bytes(data[: len(data) // 2])
    assert message_of(tmp_path, sky_scene("sky.exr")).startswith(
        'environment.image: "sky.exr": is not an image that can be read'
    )
