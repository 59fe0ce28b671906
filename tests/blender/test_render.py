# SPDX-License-Identifier: GPL-3.0-or-later
"""F12 in real Blenders: render_script.py renders in one process a host, and the tests look at its files."""

import json
import subprocess
from pathlib import Path
from typing import Any
from zlib import crc32

import numpy as np
import OpenImageIO
import pytest
from hosts import Host
from numpy.typing import NDArray

from addon.film.passes import COMBINED, OPTIONAL

WIDTH, HEIGHT = 60, 40
Pixels = NDArray[np.float32]


@pytest.fixture(scope="module")
def out(host: Host, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("render")
    host.run_script(Path(__file__).with_name("render_script.py"), str(folder), timeout=280)
    return folder


@pytest.fixture(scope="module")
def facts(out: Path) -> dict[str, Any]:
    result: dict[str, Any] = json.loads((out / "facts.json").read_text())
    return result


def channels(path: Path) -> dict[str, Pixels]:
    """Every channel by its name, top row first."""
    image = OpenImageIO.ImageInput.open(str(path))
    assert image is not None, OpenImageIO.geterror()
    result = {}
    part = 0
    while image.seek_subimage(part, 0):
        names = image.spec().channelnames
        pixels = np.asarray(image.read_image(part, 0, 0, len(names), OpenImageIO.FLOAT), np.float32)
        result.update({name: pixels[..., i] for i, name in enumerate(names)})
        part += 1
    image.close()
    return result


def picture(path: Path) -> Pixels:
    found = channels(path)
    return np.stack([found[name] for name in "RGB"], axis=2)


def layer_pass(found: dict[str, Pixels], layer: str, name: str, parts: str) -> Pixels:
    return np.stack([found[f"{layer}.{name}.{part}"] for part in parts], axis=2)


def test_a_picture_comes_out(out: Path) -> None:
    pixels = picture(out / "full.exr")
    assert pixels.shape == (HEIGHT, WIDTH, 3)
    assert np.isfinite(pixels).all()
    assert pixels.min() > 0.0  # the world is grey, and nothing here is black
    # The moon stands to the right, and shows its own radiance.
    assert pixels.max() == pytest.approx(4.0)
    assert np.argmax(pixels.sum(axis=(0, 2))) > WIDTH / 2


def test_tiles_change_no_pixel(out: Path) -> None:
    np.testing.assert_array_equal(picture(out / "small_tiles.exr"), picture(out / "full.exr"))


def test_a_border_is_a_part_of_the_picture(out: Path) -> None:
    full = picture(out / "full.exr")
    x0, x1 = int(0.21 * WIDTH), int(0.77 * WIDTH)
    y0, y1 = HEIGHT - int(0.64 * HEIGHT), HEIGHT - int(0.13 * HEIGHT)
    np.testing.assert_array_equal(picture(out / "border.exr"), full[y0:y1, x0:x1])
    framed = np.zeros_like(full)
    framed[y0:y1, x0:x1] = full[y0:y1, x0:x1]
    np.testing.assert_array_equal(picture(out / "border_in_full.exr"), framed)


def test_the_command_line_renders_the_exported_scene_alike(out: Path, glimmer_command: Path) -> None:
    result_file = out / "command.exr"
    words = [str(out / "scene.json"), "-o", str(result_file), "--spp", "8", "--seed", "0", "--quiet"]
    result = subprocess.run([str(glimmer_command), *words], capture_output=True, text=True, check=False, timeout=60)
    assert result.returncode == 0, result.stderr
    np.testing.assert_array_equal(picture(result_file), picture(out / "full.exr"))


def test_export_leaves_the_scene_as_it_was(facts: dict[str, Any]) -> None:
    assert facts["engine_after_export"] == "GLIMMER"


def test_every_pass_is_in_the_multilayer_file(out: Path, facts: dict[str, Any]) -> None:
    found = channels(out / "layers.exr")
    for name, item in zip(["Combined", *facts["names"]], (COMBINED, *OPTIONAL), strict=True):
        for part in item.channels:
            assert f"ViewLayer.{name}.{part}" in found


def named_pass(found: dict[str, Pixels], facts: dict[str, Any], name: str) -> Pixels:
    """A pass of the view layer by the engine's name."""
    item = next(item for item in OPTIONAL if item.engine_name == name)
    return layer_pass(found, "ViewLayer", facts["names"][OPTIONAL.index(item)], item.channels)


def test_passes_hold_what_they_say(out: Path, facts: dict[str, Any]) -> None:
    found = channels(out / "layers.exr")
    alone = picture(out / "one_pass.exr")
    combined = layer_pass(found, "ViewLayer", "Combined", "RGBA")
    np.testing.assert_array_equal(combined[..., :3], alone)
    assert (combined[..., 3] == 1.0).all()
    samples = layer_pass(found, "ViewLayer", "Sample Count", "X")
    assert (samples == 8.0).all()
    objects, materials = (named_pass(found, facts, name)[..., 0] for name in ("object_index", "material_index"))
    assert set(np.unique(objects)) == {0.0, 5.0}
    assert set(np.unique(materials)) == {0.0, 9.0}
    np.testing.assert_array_equal(objects == 5.0, materials == 9.0)
    normal = layer_pass(found, "ViewLayer", "Normal", "XYZ")
    depth = layer_pass(found, "ViewLayer", "Depth", "Z")[..., 0]
    floor = np.abs(normal - [0.0, 0.0, 1.0]).max(axis=2) < 1e-5
    assert floor.mean() > 0.3
    assert 2.0 < depth[floor].min() < depth[floor].max() < 100.0
    # The parts of the light make up the picture, in both ways of cutting it.
    parts = sum(named_pass(found, facts, name) for name in ("emission", "direct", "indirect", "fog"))
    np.testing.assert_allclose(parts, combined[..., :3], rtol=2e-5, atol=1e-6)
    parts = sum(named_pass(found, facts, name) for name in ("emit", "environment", "volume_direct", "volume_indirect"))
    for lobe in ("diffuse", "glossy", "transmission"):
        direct, indirect, color = (
            named_pass(found, facts, f"{lobe}_{part}") for part in ("direct", "indirect", "color")
        )
        parts = parts + (direct + indirect) * color
    np.testing.assert_allclose(parts, combined[..., :3], rtol=2e-5, atol=1e-6)
    position = named_pass(found, facts, "position")
    np.testing.assert_allclose(position[floor][:, 2], 0.0, atol=1e-4)
    np.testing.assert_array_equal(layer_pass(found, "ViewLayer", "Noisy Image", "RGBA"), combined)
    error = layer_pass(found, "ViewLayer", "Standard Error", "RGB")
    assert np.isfinite(error).all() and error.min() >= 0.0 and error.max() > 0.0


@pytest.mark.parametrize("name", ["clear", "opaque"])
def test_alpha_is_that_of_cycles(out: Path, name: str) -> None:
    ours, cycles = (
        np.stack([channels(out / f"{name}_{engine}.exr")[part] for part in "RGBA"], axis=2)
        for engine in ("glimmer", "cycles")
    )
    edges = 0.1  # of balls whose outlines both sample eight times
    off = np.abs(ours[..., 3] - cycles[..., 3])
    assert off.mean() < 0.01 and (off > 0.01).mean() < edges
    assert (ours[..., 3] == 0.0).any() and (ours[..., 3] == 1.0).any()
    empty = ours[..., 3] == 0.0
    assert not ours[empty].any()
    # The hole is empty on any film, the sky on a transparent one.
    assert 0.1 < empty.mean() < 0.3 if name == "opaque" else empty.mean() > 0.5
    np.testing.assert_allclose(ours[..., :3].mean(), cycles[..., :3].mean(), rtol=0.05)


def test_a_view_layer_shows_its_own_collections(out: Path) -> None:
    found = channels(out / "layers.exr")
    other = layer_pass(found, "Without Ball", "Combined", "RGBA")[..., :3]
    assert np.isfinite(other).all() and other.min() > 0.0
    assert np.abs(other - picture(out / "full.exr")).max() > 0.05


def test_a_denoised_picture_keeps_the_noisy_one(out: Path, host: Host, facts: dict[str, Any]) -> None:
    found, report = channels(out / "denoised.exr"), facts["denoised_report"]
    shown, noisy = (layer_pass(found, "ViewLayer", name, "RGB") for name in ("Combined", "Noisy Image"))
    np.testing.assert_array_equal(noisy, layer_pass(channels(out / "not_denoised.exr"), "ViewLayer", "Combined", "RGB"))
    plain = layer_pass(channels(out / "plain.exr"), "ViewLayer", "Combined", "RGB")
    assert (noisy != plain).mean() > 0.5  # whose samples count for several pixels, as denoisers do not like it
    assert any("as denoisers need it" in line for line in report["left_out"])
    if not host.is_module:  # Debian's Blender has no denoiser
        assert not report["denoised"] and report["biased_by"] == []
        assert any("no Open Image Denoise" in warning for warning in report["warnings"])
        np.testing.assert_array_equal(shown, noisy)
        return
    assert report["denoised"] and report["biased_by"] == ["denoising"]
    assert facts["report"]["biased_by"] == []
    shown_grain, grain = (np.abs(np.diff(pixels[25:, :30], axis=1)).mean() for pixels in (shown, noisy))
    assert shown_grain < 0.5 * grain  # of the floor
    np.testing.assert_allclose(shown.mean(axis=(0, 1)), noisy.mean(axis=(0, 1)), rtol=0.05)


def test_what_a_view_is_denoised_by_can_be_stopped(host: Host, facts: dict[str, Any]) -> None:
    if not host.is_module:
        pytest.skip("Debian's Blender has no denoiser")
    quick = facts["quick"]  # of an even grey in noise as strong as itself
    assert quick["mean"] == pytest.approx(1.0, rel=0.1) and quick["spread"] < 0.25
    assert quick["stopped"]
    assert quick["again"] == pytest.approx(0.0, abs=1e-5)


def test_a_view_layer_may_have_samples_of_its_own(facts: dict[str, Any]) -> None:
    assert facts["layer_samples"] == {"ViewLayer": 8, "Without Ball": 3}


def test_light_groups_add_up(out: Path) -> None:
    found, cycles = (channels(out / f"groups_{engine}.exr") for engine in ("glimmer", "cycles"))
    groups = [layer_pass(found, "ViewLayer", f"Combined_{name}", "RGB") for name in ("key", "moon", "sky")]
    combined = layer_pass(found, "ViewLayer", "Combined", "RGB")
    np.testing.assert_allclose(sum(groups), combined, rtol=2e-5, atol=2e-6)
    for name, group in zip(("key", "moon", "sky"), groups, strict=True):
        theirs = layer_pass(cycles, "ViewLayer", f"Combined_{name}", "RGB")
        np.testing.assert_allclose(group.mean(), theirs.mean(), rtol=0.1)


def test_cryptomatte_names_what_cycles_names(out: Path) -> None:
    found, cycles = (channels(out / f"groups_{engine}.exr") for engine in ("glimmer", "cycles"))
    for kind in ("Object", "Material", "Asset"):
        for name in (f"Crypto{kind}00", f"Crypto{kind}01"):
            ours, theirs = (layer_pass(item, "ViewLayer", name, "rgba") for item in (found, cycles))
            for rank in (0, 2):
                shown = {value for value in np.unique(ours[..., rank]) if (ours[..., rank] == value).sum() > 20}
                expected = {value for value in np.unique(theirs[..., rank]) if (theirs[..., rank] == value).sum() > 20}
                assert shown == expected, name
                np.testing.assert_allclose(ours[..., rank + 1].mean(), theirs[..., rank + 1].mean(), atol=0.02)
        attributes = metadata(out / "groups_glimmer.exr"), metadata(out / "groups_cycles.exr")
        keys = [{key for key in item if key.startswith("cryptomatte/")} for item in attributes]
        assert keys[0] == keys[1] and len(keys[0]) == 12


def metadata(path: Path) -> dict[str, Any]:
    image = OpenImageIO.ImageInput.open(str(path))
    assert image is not None
    found = {attribute.name: attribute.value for attribute in image.spec().extra_attribs}
    image.close()
    return found


def test_blenders_own_node_reads_the_mattes(out: Path) -> None:
    matte = channels(out / "matte.exr")["R"]
    assert 0.05 < matte.mean() < 0.3 and matte.min() == 0.0 and matte.max() > 0.99


def test_passes_reach_the_compositor(out: Path, facts: dict[str, Any]) -> None:
    assert set(facts["names"]) <= set(facts["sockets"])
    albedo = layer_pass(channels(out / "layers.exr"), "ViewLayer", "Albedo", "RGB")
    np.testing.assert_array_equal(picture(out / "composited.exr"), albedo)


def test_an_animation_moves_and_keeps_its_noise(out: Path) -> None:
    first, second, third = (picture(out / f"fixed_{frame:04d}.exr") for frame in (1, 2, 3))
    np.testing.assert_array_equal(first, picture(out / "full.exr"))
    np.testing.assert_array_equal(second, first)
    assert np.abs(third - second).max() > 0.05


def test_seeds_per_frame_give_each_frame_noise_of_its_own(out: Path) -> None:
    first, second = (picture(out / f"per_frame_{frame:04d}.exr") for frame in (1, 2))
    assert not np.array_equal(first, second)


def test_frames_share_their_meshes(facts: dict[str, Any]) -> None:
    assert facts["meshes_kept"] == 2  # the floor and the ball; the moon is no mesh


def test_twenty_thousand_plates_are_read_well_within_a_second(facts: dict[str, Any]) -> None:
    export = facts["field_report"]["export"]
    assert export["seconds"] < 0.5
    # One matrix a plate at most: bulk instances, no copies of meshes.
    assert 20_419 * 12 * 4 < export["bytes"] < 20_419 * 16 * 8 * 1.2


def test_an_error_target_is_met(facts: dict[str, Any]) -> None:
    report = facts["target_report"]
    assert report["error"]["high"] <= 0.02
    assert report["threads"] == 1
    assert report["integrator"] == "path"
    fewest, most = report["adaptive"]["fewest"], report["adaptive"]["most"]
    assert 0 < fewest <= most
    assert f"Adaptive sampling: pixels took {fewest} to {most} samples" in facts["adaptive_summary"]


def test_a_time_limit_and_the_rest_of_the_settings_arrive(facts: dict[str, Any]) -> None:
    report = facts["time_report"]
    assert report["adaptive"] is None
    # One pass over 60 x 40 pixels takes some milliseconds; the limit is looked at between passes.
    assert 0.4 < report["seconds"]["render"] < 5.0
    assert (report["integrator"], report["seed"]) == ("baseline", 7)
    assert any("depth" in line for line in report["biased_by"])


def test_files_of_before_open_with_their_integrator(facts: dict[str, Any]) -> None:
    """A .blend file stores a number, which came from the integrator's name of that time."""
    assert facts["integrator_numbers"] == {"path": 0, "baseline": crc32(b"report") & 0x7FFFFFFF}


def test_the_report_is_whole(facts: dict[str, Any]) -> None:
    report = facts["report"]
    assert report["spp"] == 8
    assert report["biased_by"] == []
    assert report["export"]["seconds"] >= 0.0
    assert report["export"]["notices"] == []


def test_the_file_tells_how_it_was_made(out: Path, facts: dict[str, Any]) -> None:
    report = facts["report"]
    image = OpenImageIO.ImageInput.open(str(out / "full.exr"))
    assert image is not None, OpenImageIO.geterror()
    attributes = {item.name: str(item.value) for item in image.spec().extra_attribs}
    assert attributes["glimmer.ViewLayer.samples"] == "8"
    assert attributes["glimmer.ViewLayer.seed"] == "0"
    assert attributes["glimmer.ViewLayer.engine"] == report["engine"]
    assert attributes["glimmer.ViewLayer.biased_by"] == "nothing"
    for name in ("relmse", "low", "high"):
        assert float(attributes[f"glimmer.ViewLayer.error.{name}"]) == pytest.approx(report["error"][name], rel=1e-5)
    assert float(attributes["glimmer.ViewLayer.seconds"]) == pytest.approx(report["seconds"]["render"], rel=1e-5)


def test_the_panel_tells_the_error_and_the_time_to_half_of_it(facts: dict[str, Any]) -> None:
    report, lines = facts["target_report"], facts["target_summary"]
    assert lines[0].startswith(f"relMSE {report['error']['relmse']:.2g} (")
    assert any(line.startswith("Falls as time^-") for line in lines) == (report["rate"] is not None)
    assert any("Half of it after" in line for line in lines) == (report["seconds_to_half"] is not None)
    assert any("Not certifiable" in line for line in lines) != report["error"]["tails"]["certifiable"]


def test_the_error_curve_stands_beside_every_frame_where_it_is_asked_for(out: Path, facts: dict[str, Any]) -> None:
    assert not list(out.glob("fixed_*.error.*")) and not list(out.glob("full*.error.*"))
    for frame in (1, 2, 3):
        rows = (out / f"per_frame_{frame:04d}.error.csv").read_text().splitlines()
        assert rows[0] == "seconds,cpu_seconds,spp,relmse,low,high"
        assert [row.split(",")[2] for row in rows[1:]] == ["2", "4", "8"]
        picture = OpenImageIO.ImageInput.open(str(out / f"per_frame_{frame:04d}.error.png"))
        assert picture is not None, OpenImageIO.geterror()
    last = [float(cell) for cell in rows[-1].split(",")]
    assert last == pytest.approx(facts["last_curve"][-1], rel=1e-6)


def test_what_differs_from_cycles_is_shown_before_a_render_says_it(facts: dict[str, Any]) -> None:
    found = facts["differences"]
    assert sorted(found) == sorted(facts["differences_rendered"])
    for words in ("object 'Ball'", "object 'Text'", "object 'AREA'"):
        assert any(words in line for line in found), words
    (of_material,) = facts["differences_of_material"]
    assert of_material.startswith("material 'ShaderNodeBsdfToon")
    assert " ".join(facts["differences_drawn"]) == " ".join(found)
    assert not any("object 'Ball'" in line for line in facts["differences_after_edit"])
