# SPDX-License-Identifier: GPL-3.0-or-later
"""Shader nodes of real Blenders, as the engine's materials, world and fog; and the add-on's registration."""

import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import OpenImageIO
import pytest
from hosts import Host

from addon.scene.description import (
    Add,
    Burley,
    Conductor,
    Glass,
    Lambert,
    Layer,
    Material,
    Mix,
    Sheen,
    Translucent,
    Transparent,
)
from addon.scene.program import Output

RED = (0.8, 0.1, 0.1)


@pytest.fixture(scope="module")
def facts(host: Host, tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    path = tmp_path_factory.mktemp("nodes") / "facts.json"
    host.run_script(Path(__file__).with_name("nodes_script.py"), str(path))
    result: dict[str, Any] = json.loads(path.read_text())
    result["folder"] = path.parent
    return result


def material(facts: dict[str, Any], name: str, group: str = "nodes") -> tuple[Material, list[str]]:
    kinds = (Add, Burley, Conductor, Glass, Lambert, Layer, Mix, Output, Sheen, Translucent, Transparent)
    names = {kind.__name__: kind for kind in kinds}
    found = facts[group][name]
    return eval(found["is"], names), found["notices"]


def close(color: tuple[float, ...]) -> Any:
    return pytest.approx(color, abs=1e-6)


def test_constants_are_folded(facts: dict[str, Any]) -> None:
    found, notices = material(facts, "math_on_color")
    assert isinstance(found, Lambert)
    assert found.albedo == close((0.25, 1.0, 0.0))
    assert notices == []


@pytest.mark.parametrize("name", ["group", "muted", "principled_diffuse"])
def test_red_diffuse_by_way_of(facts: dict[str, Any], host: Host, name: str) -> None:
    found, notices = material(facts, name)
    assert isinstance(found, Burley if name == "principled_diffuse" and not host.is_module else Lambert)
    assert found.albedo == close(RED)
    assert notices == []


def test_emission_is_added(facts: dict[str, Any]) -> None:
    found, notices = material(facts, "sum_with_emission")
    assert isinstance(found, Lambert)
    assert (found.albedo, found.emission) == (close(RED), close((3.0, 3.0, 3.0)))
    assert notices == []


def test_principled_emission(facts: dict[str, Any]) -> None:
    found, _ = material(facts, "principled_emission")
    assert isinstance(found, (Burley, Lambert))
    assert found.emission == close((4.0, 2.0, 1.0))


def test_principled_metal(facts: dict[str, Any]) -> None:
    found, notices = material(facts, "principled_metal")
    assert isinstance(found, Conductor)
    assert found.alpha == pytest.approx(0.25)
    assert found.f0 == close(RED)
    assert notices == []


def test_principled_glass(facts: dict[str, Any]) -> None:
    found, notices = material(facts, "principled_glass")
    assert isinstance(found, Glass)
    assert found.ior == pytest.approx(1.33)
    assert notices == []


def is_rough_glass(material: Any, host: Host) -> bool:
    """Before 4.0 the angle at the surface says how much is reflected."""
    if host.is_module:
        return isinstance(material, Glass) and material.alpha == 0.25 and material.transmission == close(RED)
    gloss, glass = material.a, material.b
    return (
        isinstance(material, Mix)
        and (type(gloss), gloss.alpha, gloss.f0) == (Conductor, 0.25, close(RED))
        and (type(glass), glass.alpha, glass.lobes) == (Glass, 0.25, "refraction")
    )


def test_what_passes_light(facts: dict[str, Any], host: Host) -> None:
    expected: dict[str, Callable[[Any], bool]] = {
        "leaf": lambda m: (
            isinstance(m, Mix)
            and m.weight == pytest.approx(0.75)
            and isinstance(m.a, Add)
            and (type(m.a.a), type(m.a.b)) == (Lambert, Translucent)
            and m.b == Transparent((1.0, 1.0, 1.0))
        ),
        "rough_glass": lambda m: is_rough_glass(m, host),
        "refraction": lambda m: isinstance(m, Glass) and m.alpha == 0.0 and m.lobes == "refraction",
        "rough_diffuse": lambda m: isinstance(m, Lambert) and m.roughness == 0.5,
        "alpha": lambda m: isinstance(m, Mix) and m.weight == 0.75 and m.a == Transparent((1.0, 1.0, 1.0)),
    }
    for name, holds in expected.items():
        found, notices = material(facts, name)
        assert holds(found), found
        assert notices == []


def test_principled_default(facts: dict[str, Any], host: Host) -> None:
    """From 4.0 on a layer over a diffuse base; before, two lobes at full strength."""
    found, notices = material(facts, "principled_default")
    assert notices == []
    if host.is_module:
        assert isinstance(found, Layer) and found.weight == 1.0
        gloss, diffuse = found.a, found.b
        assert isinstance(diffuse, Lambert)
    else:
        assert isinstance(found, Add)
        diffuse, gloss = found.a, found.b
        assert isinstance(diffuse, Burley) and diffuse.roughness == 0.5
    assert diffuse.albedo == close((0.8, 0.8, 0.8))
    # F0 = 0.04 in all versions: by the specular of old ones, and by an IOR of 1.5 in new ones.
    assert isinstance(gloss, Conductor)
    assert gloss.f0 == close((0.04, 0.04, 0.04))
    assert gloss.ior == pytest.approx(1.5)
    assert (gloss.masking, gloss.facets) == (("smith", "multiple") if host.is_module else ("smith_separable", "single"))


NAMED = "material 'Test"


@pytest.mark.parametrize("name", ["texture", "procedural"])
def test_what_varies_becomes_a_program_and_needs_no_notice(facts: dict[str, Any], name: str) -> None:
    found, notices = material(facts, name)
    assert found == Lambert(Output(0, False))
    assert facts["nodes"][name]["operations"] > 0
    assert notices == []


def test_what_cannot_be_translated_is_named_and_not_black(facts: dict[str, Any]) -> None:
    found, notices = material(facts, "unknown_shader")
    assert isinstance(found, Lambert)
    assert found.albedo == close(RED)
    assert len(notices) == 1
    assert notices[0].startswith(NAMED) and "node '" in notices[0] and "a diffuse surface of its colour" in notices[0]


def test_a_coat(facts: dict[str, Any], host: Host) -> None:
    found, notices = material(facts, "principled_coat")
    assert isinstance(found, (Add, Layer))
    assert isinstance(found.a, Conductor)
    assert found.a.ior == pytest.approx(1.5)
    if host.is_module:
        assert isinstance(found, Layer) and found.weight == 0.5
        assert notices == []
    else:
        assert found.a.f90 == close((0.125, 0.125, 0.125))
        assert len(notices) == 1 and "clear coat" in notices[0]


def test_a_material_without_a_shader_is_black_as_in_cycles_and_named(facts: dict[str, Any]) -> None:
    found, notices = material(facts, "nothing")
    assert found == Lambert((0.0, 0.0, 0.0))
    assert len(notices) == 1 and "no surface shader" in notices[0]


def test_a_background(facts: dict[str, Any]) -> None:
    found = facts["nodes"]["background"]
    assert found["radiance"] == close((0.2, 0.4, 0.6))
    assert found["medium"] is None
    assert found["notices"] == []


def test_a_sky_varies_with_the_direction(facts: dict[str, Any]) -> None:
    found = facts["nodes"]["sky"]
    assert found["varies"] and not facts["nodes"]["background"]["varies"]
    assert found["notices"] == []


@pytest.mark.parametrize("name", ["all_volumes", "in all_volumes"])
def test_volumes_add_up(facts: dict[str, Any], name: str) -> None:
    medium = facts["nodes"][name]["medium"]
    assert medium["sigma_s"] == close((0.1, 0.2, 0.05))
    assert medium["sigma_a"] == close((0.05, 0.0, 0.075))
    assert medium["g"] == pytest.approx(0.5)


@pytest.mark.parametrize("name", ["principled_volume", "in principled_volume"])
def test_a_principled_volume(facts: dict[str, Any], name: str) -> None:
    medium = facts["nodes"][name]["medium"]
    assert medium["sigma_s"] == close((1.0, 0.5, 2.0))
    assert medium["sigma_a"] == close((1.0, 1.5, 0.0))


def test_a_volume_alone_has_no_surface(facts: dict[str, Any]) -> None:
    found = facts["nodes"]["in all_volumes"]
    assert found["is"] == "Null()"
    assert found["notices"] == []


def test_a_volume_may_shine_but_not_a_worlds(facts: dict[str, Any]) -> None:
    found, world = facts["nodes"]["in shining_volume"], facts["nodes"]["shining_volume"]
    assert found["medium"]["emission"] == close((0.5, 0.25, 1.0))
    assert world["medium"]["emission"] == close((0.0, 0.0, 0.0))
    assert sum("does not emit" in notice for notice in world["notices"]) == 1


def test_density_varies_but_for_a_worlds(facts: dict[str, Any]) -> None:
    found, world = facts["nodes"]["in shining_volume"], facts["nodes"]["shining_volume"]
    assert found["medium"]["varies"] == ["sigma_s"] and "noise" in found["medium"]["operations"]
    assert found["medium"]["g"] == pytest.approx(0.5)
    assert found["notices"] == []
    assert world["medium"]["varies"] == [] and any("Density uses" in notice for notice in world["notices"])


def test_all_of_a_volume_varies(facts: dict[str, Any]) -> None:
    found = facts["nodes"]["in varying_volume"]
    assert found["medium"]["varies"] == ["emission", "g", "sigma_a", "sigma_s"]
    assert found["notices"] == []


def test_haze_that_thins_out_with_height(facts: dict[str, Any]) -> None:
    found = facts["nodes"]["height_haze"]
    density = 0.02 * math.exp(0.75)
    assert found["medium"]["sigma_s"] == close((0.5 * density, density, 0.25 * density))
    assert found["medium"]["g"] == pytest.approx(0.5)
    assert found["medium"]["falloff"] == pytest.approx({"height": 0.0, "scale_height": 4.0})
    assert found["notices"] == []


def test_volume_coefficients(facts: dict[str, Any], host: Host) -> None:
    if "coefficients" not in facts["nodes"]:
        assert not host.is_module, "the bpy wheels have the node"
        return
    medium = facts["nodes"]["coefficients"]["medium"]
    assert medium["sigma_s"] == close((0.4, 0.5, 0.6))
    assert medium["sigma_a"] == close((0.1, 0.2, 0.3))
    assert medium["g"] == pytest.approx(-0.3)


def test_light_behind_endless_fog_is_warned_of_once(facts: dict[str, Any]) -> None:
    """The engine, which knows no names, warns of the same: the user reads one line, with names and what to do."""
    (line,) = facts["fog_and_sun"]
    assert line.startswith("world 'World")
    assert "its background and sun 'SUN' are black behind its endless fog" in line
    assert "use point, spot or area lamps" in line and "remove the world's Volume shader" in line


def test_what_is_marked_as_a_sphere_and_is_none_is_told_and_rendered_as_it_is(facts: dict[str, Any]) -> None:
    found = facts["marked_as_spheres"]
    as_mesh = "; rendered as the mesh that it is"
    marked = [
        f"object 'Cube': is marked as an analytic sphere, but is no sphere, though its vertices lie on one: its faces"
        f" are too coarse{as_mesh}",
        f"object 'Egg': is marked as an analytic sphere, but is scaled unevenly; scale it alike along x, y and z"
        f"{as_mesh}",
    ]
    assert found["unmarked.exr_says"] == []
    assert found["marked.exr_says"] == found["without_ball.exr_says"] == marked
    assert found["panel"] == {
        "Cube": "It is no sphere, though its vertices lie on one: its faces are too coarse",
        "Egg": "It is scaled unevenly",
        "Ball": "",
    }
    unmarked, marked_picture, without_ball = (
        np.asarray(OpenImageIO.ImageBuf(str(facts["folder"] / f"{name}.exr")).get_pixels(OpenImageIO.FLOAT))
        for name in ("unmarked", "marked", "without_ball")
    )
    np.testing.assert_array_equal(without_ball, unmarked)
    assert not np.array_equal(marked_picture, unmarked)  # a ball of 16 facets around is not round


def test_unregister_takes_back_what_register_did(facts: dict[str, Any]) -> None:
    registration = facts["registration"]
    assert registration["gone"]
    assert registration["left"] == []
    assert registration["again"]


def test_blenders_own_panels_stay_visible(facts: dict[str, Any]) -> None:
    wanted = {
        "RENDER_PT_format",
        "RENDER_PT_output",
        "RENDER_PT_color_management",
        "DATA_PT_lens",
        "DATA_PT_camera",
        "DATA_PT_context_mesh",
        "EEVEE_MATERIAL_PT_context_material",
        "WORLD_PT_context_world",
        "GLIMMER_PT_sampling",
        "GLIMMER_PT_depth_of_field",
        "GLIMMER_PT_light_nodes",
        "MATERIAL_PT_preview",
    }
    panels = set(facts["registration"]["panels"])
    assert wanted <= panels
    # What we replace must not stand there twice.
    assert not {"DATA_PT_light", "DATA_PT_area", "DATA_PT_spot", "VIEWLAYER_PT_layer_passes"} & panels
