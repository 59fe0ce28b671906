# SPDX-License-Identifier: GPL-3.0-or-later
"""What the exporter reads can be set under Glimmer, and what Glimmer's panels draw is not for nothing.

panels_script.py draws all panels inside Blender and notes the properties.
"""

import json
from pathlib import Path
from typing import Any

import pytest
from hosts import Host

SCRIPT = Path(__file__).with_name("panels_script.py")

# Settings that are named in the exporter's source and that no panel needs, and why. Without a type: of every type.
NEEDS_NO_PANEL = {
    "Camera.angle": "the lens seen as an angle, which Blender's panel shows for another unit",
    "CyclesLightSettings.use_multiple_importance_sampling": "only Cycles' picture depends on it, which a notice says",
    "CyclesObjectSettings.use_adaptive_subdivision": "only Cycles' picture depends on it, which a notice says",
    "CyclesRenderSettings.blur_glossy": "only Cycles' picture depends on it, which a notice says",
    "CyclesRenderSettings.feature_set": "only Cycles' picture depends on it, which a notice says",
    "CyclesRenderSettings.filter_width": "Glimmer's own is meant",
    "CyclesRenderSettings.max_bounces": "Glimmer's own, and those of lamps and the world are meant",
    "CyclesRenderSettings.samples": "Glimmer's own is meant",
    "CyclesRenderSettings.seed": "Glimmer's own is meant",
    "CyclesRenderSettings.tile_size": "Glimmer's own is meant",
    "CyclesRenderSettings.use_fast_gi": "only Cycles' picture depends on it, which a notice says",
    "CyclesRenderSettings.use_denoising": "Glimmer's own is meant",
    "CyclesRenderLayerSettings.use_denoising": "Glimmer's own is meant",
    "GlimmerSceneSettings.max_depth": "drawn as max_bounces",
    "GlimmerSceneSettings.max_scatter": "drawn as volume_bounces",
    "GlimmerSceneSettings.target_error": "drawn as noise_limit",
    "Object.matrix_world": "drawn as location, rotation and scale",
    "RenderSettings.border_max_x": "set by a drag in the view",
    "RenderSettings.border_max_y": "set by a drag in the view",
    "RenderSettings.border_min_x": "set by a drag in the view",
    "RenderSettings.border_min_y": "set by a drag in the view",
    "Scene.frame_current": "in the timeline",
    "Scene.frame_subframe": "in the timeline",
    "RenderSettings.use_multiview": "in the header of Blender's panel Stereoscopy",
    "RenderSettings.views_format": "in Blender's panel Stereoscopy, as tabs",
    "Scene.use_nodes": "the compositor's",
    "WorldMistSettings.height": "another thing of that name is meant",
    "AreaLight.shadow_soft_size": "those of points and spots are meant",
    "CyclesObjectSettings.shadow_terminator_geometry_offset": "of newer Blenders the object's own is drawn",
    "CyclesObjectSettings.shadow_terminator_offset": "of newer Blenders the object's own is drawn",
    "shadow_terminator_shading_offset": "drawn where it is not 0",
    "SunLight.shadow_soft_size": "those of points and spots are meant",
    "grease_pencil": "that of evaluated geometry is meant",
    "use_camera_cull": "only Cycles' picture depends on it, which a notice says",
    "use_distance_cull": "only Cycles' picture depends on it, which a notice says",
    "distance": "another thing of that name is meant",
    "use_nodes": "drawn where there are none yet",
    "use_shadow": "read from 4.2 on, when it is drawn",
}
# What Glimmer's panels draw and the add-on's code does not name, and why.
IS_BLENDERS_WORK = {
    "GlimmerSceneSettings.noise_limit": "kept as target_error",
    "GlimmerSceneSettings.max_bounces": "kept as max_depth",
    "GlimmerSceneSettings.volume_bounces": "kept as max_scatter",
    "GlimmerSceneSettings.use_curve_files": "read by curve_files.py, beside the folders",
    "RenderSettings.use_simplify": "Blender evaluates the scene by it",
    "RenderSettings.simplify_child_particles": "Blender evaluates the scene by it",
    "RenderSettings.simplify_child_particles_render": "Blender evaluates the scene by it",
    "RenderSettings.simplify_subdivision": "Blender evaluates the scene by it",
    "RenderSettings.simplify_subdivision_render": "Blender evaluates the scene by it",
    "temperature": "read as temperature_color, which Blender makes of it",
}
# Names of passes are put together from their table, whose own test has them.
IS_A_PASS = ("ViewLayer.use_pass_", "GlimmerViewLayerSettings.use_", "CyclesRenderLayerSettings.")


@pytest.fixture(scope="module")
def facts(host: Host, tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    out = tmp_path_factory.mktemp("panels") / "facts.json"
    host.run_script(SCRIPT, str(out))
    found: dict[str, Any] = json.loads(out.read_text())
    return found


def left(settings: set[str], table: dict[str, str]) -> list[str]:
    return sorted(name for name in settings if name not in table and name.partition(".")[2] not in table)


def test_our_panels_can_be_drawn(facts: dict[str, Any]) -> None:
    assert facts["errors"] == []


def test_everything_that_the_exporter_reads_stands_in_a_panel(facts: dict[str, Any]) -> None:
    assert left(set(facts["read"]) - set(facts["drawn"]), NEEDS_NO_PANEL) == []


def test_nothing_that_our_panels_draw_is_ignored(facts: dict[str, Any]) -> None:
    ignored = left(set(facts["drawn_by_us"]) - set(facts["used"]), IS_BLENDERS_WORK)
    assert [name for name in ignored if not name.startswith(IS_A_PASS)] == []
