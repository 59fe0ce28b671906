# SPDX-License-Identifier: GPL-3.0-or-later
"""The benchmark's arithmetic: errors, the check of means, times, and that it refuses to rank different pictures."""

import argparse
import json
import math
import os
from pathlib import Path

import numpy as np
import pytest
from scipy import stats

import build
from tests.bench import errors, renderers
from tests.bench.__main__ import FULL, QUICK, Plan, Renderers, measure, peer_of, scenes_of, tasks
from tests.bench.errors import Agreement, Picture, Point, Run
from tests.bench.peers import scene_file
from tests.bench.renderers import CannotRenderError, Glimmer, Peer, Stage, Task, set_stage, without_set_up
from tests.bench.report import LEVEL, Entry, SceneResult, Setting, agrees, markdown
from tests.bench.scenes import SCENES

RNG = np.random.default_rng(20261122)
SHAPE = (24, 36, 3)
TRUTH = 1 + RNG.random(SHAPE)
SETTING = Setting("python3 build.py bench", "1", "commit 1", "Blender 1", (36, 24), 3, (0.0, 0.0))


def noisy(samples: int, deviation: float = 0.5, scale: float = 1.0) -> Picture:
    noise = RNG.normal(size=SHAPE) * deviation / math.sqrt(samples)
    return np.asarray(scale * TRUTH + noise, np.float32)


def runs(count: int, scale: float = 1.0) -> list[Run]:
    return [Run(samples, 1.0, noisy(samples, scale=scale)) for samples in (1, 4, 16) for _ in range(count)]


def test_the_noise_of_the_reference_cancels() -> None:
    """Thirds ten times noisier than the picture: by chance it fails once in ten thousand seeds."""
    small, large, trials = 0.02, 0.2, 300

    def reciprocals() -> float:
        c = noisy(1, large)
        return float(np.mean(1 / (c.astype(np.float64) ** 2 + (0.01 * c.mean()) ** 2)))

    found = np.array(
        [errors.relative_errors(noisy(1, small), [noisy(1, large) for _ in range(3)]).mean() for _ in range(trials)]
    )
    expected = small**2 * np.array([reciprocals() for _ in range(trials)])
    error = math.sqrt((found.var(ddof=1) + expected.var(ddof=1)) / trials)
    assert abs(found.mean() - expected.mean()) < stats.norm.isf(0.5e-4) * error
    assert 0 < error < 0.2 * expected.mean(), "too blunt to show anything"


def test_relmse_of_a_known_difference() -> None:
    flat = np.full(SHAPE, 2.0, np.float32)
    found = errors.relative_errors(1.1 * flat, [flat] * 3)
    assert found.mean() == pytest.approx(0.01 / 1.0001, rel=1e-5)
    assert errors.worst_share(found) == pytest.approx(0.01, abs=1 / found.size)
    found[0, 0, 0] = found.sum()
    assert errors.worst_share(found) == pytest.approx(0.5, abs=0.01)


def test_the_references_own_noise() -> None:
    """By chance, it fails once in ten thousand seeds."""
    found = [errors.noise_of([noisy(1, 0.05) for _ in range(3)]) for _ in range(100)]
    expected = np.mean(0.05**2 / 3 / (TRUTH**2 + (0.01 * TRUTH.mean()) ** 2))
    # Second order: the noise of mu in the denominator, 3 var / mu^2 at most.
    assert np.mean(found) == pytest.approx(expected, rel=0.05**2 + 3.9 * np.std(found) / 10 / expected)


def test_means_that_agree_are_found_to_agree_as_often_as_promised() -> None:
    """400 checks at a level of 5 %; Bonferroni's bound is nearly reached as the tests are nearly independent."""
    level, trials = 0.05, 400
    alarms = sum(errors.agreement(runs(3), runs(3)).p < level / errors.TESTS_PER_PAIR for _ in range(trials))
    assert alarms <= stats.binom.ppf(1 - 1e-4, trials, level)


def test_a_mean_that_differs_is_noticed() -> None:
    found = errors.agreement(runs(4, scale=1.05), runs(4))
    assert found.p < LEVEL / (errors.TESTS_PER_PAIR * 9)
    assert found.ratio == pytest.approx(1.05, abs=5 * found.error)
    one_block = runs(4)
    for run in one_block:
        run.picture[:12, :12, 2] *= 1.2
    assert errors.agreement(one_block, runs(4)).p < LEVEL / (errors.TESTS_PER_PAIR * 9)


def line(scale: float, seconds: float = 1.0) -> list[list[Point]]:
    return [
        [Point(n, n * seconds, n * seconds / 2, scale / n * noise, scale / n / n * noise, 0.01) for n in (1, 4, 16)]
        for noise in (0.99, 1.0, 1.01)
    ]


def test_time_to_an_error() -> None:
    inside, beyond = errors.time_to(line(1.0), 0.1), errors.time_to(line(1.0), 0.01)
    assert inside is not None and beyond is not None
    assert inside.seconds == pytest.approx(10) and beyond.seconds == pytest.approx(100)
    assert (inside.extrapolated, beyond.extrapolated) == (False, True)
    # The mean of three that scatter by 1 %, by Student's t.
    assert inside.factor == pytest.approx(1 + 4.3027 * 0.01 / math.sqrt(3), rel=1e-3)
    blocks = errors.time_to(line(1.0), 0.01, "block")
    assert blocks is not None and blocks.seconds == pytest.approx(10)
    first = errors.time_to(line(0.05, seconds=0.2), 0.1)
    assert first is not None and first.at_most and first.seconds == pytest.approx(0.2)


def test_no_time_where_no_line_falls() -> None:
    first = Point(1, 1, 1, 0.1, 0.1, 0.01)
    for last in (0.1, -0.1):
        assert errors.time_to([[first, Point(4, 4, 4, last, 0.01, 0.01)]] * 2, 0.01) is None
        assert errors.time_to([[first, Point(4, 4, 4, last, 0.01, 0.01)]] * 2, 0.01, "block") is not None


def test_means_of_blocks() -> None:
    picture = np.arange(40 * 70 * 3, dtype=np.float32).reshape(40, 70, 3)
    found = errors.block_means(picture)
    assert found.shape == (2, 3, 3)
    for row, y in enumerate((slice(0, 32), slice(32, 40))):
        for column, x in enumerate((slice(0, 32), slice(32, 64), slice(64, 70))):
            np.testing.assert_allclose(found[row, column], picture[y, x].mean(axis=(0, 1), dtype=np.float64), rtol=1e-6)


def test_one_slow_run_does_not_move_the_seconds_but_every_error_counts() -> None:
    rows = [[Point(4, cpu, 2 * cpu, error, error, 0.1)] for cpu, error in ((1.0, 0.2), (1.1, 0.1), (9.0, 0.6))]
    (found,) = errors.mean_points(rows)
    assert (found.cpu, found.wall) == (1.1, 2.2)
    assert found.error == pytest.approx(0.3)


def test_another_picture_is_not_ranked() -> None:
    same, other = Agreement(0.5, 1.0, 0.001), Agreement(1e-9, 1.1, 0.001)
    entries = {"path": Entry(line(1.0), same, 0.1), "Cycles": Entry(line(2.0), other, 0.1)}
    page = markdown([SceneResult("somewhere", entries, 64, 1e-4)], SETTING)
    row = next(text for text in page.splitlines() if text.startswith("| somewhere | Cycles |"))
    assert row.count("not ranked") == 3 and "×**" not in page
    entries["Cycles"] = Entry(line(2.0), same, 0.1)
    page = markdown([SceneResult("somewhere", entries, 64, 1e-4)], SETTING)
    assert "20 s* (×/÷ 1.03), **2 ×** | 200 s* (×/÷ 1.03), **2 ×** | 2e+03 s* (×/÷ 1.03), **2 ×** | t^-1.00 |" in page
    page = markdown([SceneResult("somewhere", entries, 64, 1e-4, {"luxcore": "lamps"})], SETTING)
    assert "| somewhere | luxcore | cannot render it: lamps |" in page


@pytest.mark.parametrize("plan", [FULL, QUICK])
def test_no_seed_twice(plan: Plan) -> None:
    for levels in plan.levels.values():
        seeds = [task.seed for repetition in range(plan.repetitions) for task in tasks(levels, repetition)]
        assert len(seeds) == len(set(seeds))
    assert plan.reference_runs % 3 == 0


def test_set_up_is_subtracted() -> None:
    def run(samples: int) -> Run:
        return Run(samples, 3.0 + 0.25 * samples, TRUTH.astype(np.float32), wall=2.0 + 0.125 * samples, set_up=10.0)

    levels = QUICK.levels["Cycles"]
    found = without_set_up([[run(samples) for samples in levels]] * 3, [run(1)] * 3)
    assert [[item.cpu for item in row] for row in found] == [pytest.approx([0.25 * n for n in levels])] * 3
    assert [[item.wall for item in row] for row in found] == [pytest.approx([0.125 * n for n in levels])] * 3
    assert all(item.set_up == pytest.approx(13.0) for row in found for item in row)


def test_scenes_and_peers_are_chosen_by_name() -> None:
    assert [scene.name for scene in scenes_of("clearing,moons_in_fog")] == ["moons_in_fog", "clearing"]
    with pytest.raises(argparse.ArgumentTypeError, match=r"fogg: no such scene; there are moons_in_fog"):
        scenes_of("fogg")
    with pytest.raises(argparse.ArgumentTypeError, match=r"arnold=x: must be NAME=PYTHON with one of mitsuba, luxcore"):
        peer_of("arnold=x")
    assert {scene.name for scene in SCENES} >= {"moons_in_fog", "glimmervoid", "clearing"}


@pytest.fixture
def in_a_profile(blender: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name, value in build.host_environment(tmp_path / "profile", blender).items():
        if os.environ.get(name) != value:
            monkeypatch.setenv(name, value)


@pytest.mark.usefixtures("in_a_profile")
@pytest.mark.parametrize("with_cycles", [True, False])
def test_a_scene_is_measured(
    with_cycles: bool, glimmer_command: Path, blender: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Small, from the .blend to the page. The seeds are fixed; of all seeds, one in a thousand would fail. Again, it
    renders nothing, unless a run was lost.
    """
    plan = Plan((32, 18), {"path": (1, 4), "baseline": (1, 4), "Cycles": (2, 64)}, 4, 16, 6)
    folder = tmp_path / "runs"
    tools = Renderers(glimmer_command, blender, with_cycles)
    result, version = measure(SCENES[0], plan, tools, folder)
    assert list(result.entries) == ["path", "baseline", *(["Cycles"] if with_cycles else [])]
    assert version[0].isdigit()
    for name, entry in result.entries.items():
        assert [[point.samples for point in row] for row in entry.points] == [list(plan.levels[name])] * 4
        assert all(point.cpu > 0 and point.wall > 0 for row in entry.points for point in row), name
        assert entry.peak_bytes > 2**20 and entry.set_up >= 0
        assert agrees(entry, [result]), (name, entry.agreement)
    assert "| moons_in_fog | path |" in markdown([result], SETTING)

    rendered: list[Task] = []
    render = Glimmer._render

    def counted(self: Glimmer, scene: Path, room: Path, task: Task) -> None:
        rendered.append(task)
        render(self, scene, room, task)

    monkeypatch.setattr(Glimmer, "_render", counted)
    lost = next(folder.glob("baseline-*")) / "4_2.json"
    lost.unlink()
    again, _ = measure(SCENES[0], plan, tools, folder)
    assert rendered == [Task(4, 2)]
    same = [name for name in result.entries if name != "baseline"]
    assert [again.entries[name] for name in same] == [result.entries[name] for name in same]


@pytest.mark.usefixtures("in_a_profile")
def test_variants_change_what_they_say_and_nothing_else(blender: Path, tmp_path: Path) -> None:
    told = {}
    for name in ("glimmervoid", "field_without_fog", "thick_fog", "smooth_metal"):
        (scene,) = scenes_of(name)
        stage = set_stage(blender, scene, (32, 18), tmp_path / name)
        told[name] = json.loads(stage.export.read_text())
        plates = scene_file.read_scene(stage.export).meshes
        assert len(plates) > 1 and all(mesh.normals is None for mesh in plates), "renderers differ in smooth normals"
    was = told["glimmervoid"]
    assert sum(was["medium"]["sigma_s"]) > 0
    clear = told["field_without_fog"]
    assert sum(clear.pop("medium", {"sigma_s": [0.0]})["sigma_s"]) == 0
    thick = told["thick_fog"]["medium"]
    total, before = (np.add(m["sigma_a"], m["sigma_s"]) for m in (thick, was["medium"]))
    np.testing.assert_allclose(total, 10 * before, rtol=1e-6)
    np.testing.assert_allclose(np.array(thick["sigma_s"]) / total, 0.99, rtol=1e-6)
    metal = [m["alpha"] for m in told["smooth_metal"]["materials"].values() if m["type"] == "conductor"]
    assert metal == [pytest.approx(0.02, rel=1e-6)] * 2
    for name, scene_told in told.items():
        changed = {key for key in was if scene_told.get(key) != was[key]}
        assert changed <= ({"materials"} if name == "smooth_metal" else {"medium"}), name


# ---- Peers -------------------------------------------------------------------------------------------------------

SMALL = {
    "glimmer": 1,
    "film": {"width": 8, "height": 4, "filter": "box"},
    "camera": {"to_world": np.eye(4).tolist(), "fov_x": 60.0},
    "materials": {
        "moon": {"type": "light", "radiance": 2},
        "plate": {"type": "conductor", "alpha": 0.1, "f0": [0.6, 0.5, 0.4], "f90": [0.6, 0.5, 0.4]},
    },
    "spheres": [{"center": [0, 0, -5], "radius": 1, "material": "moon"}],
    "medium": {"sigma_s": 0.1, "sigma_a": [0.1, 0.2, 0.3]},
}


def test_what_the_peers_read_of_a_scene(tmp_path: Path) -> None:
    told = json.loads(json.dumps(SMALL))
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]], np.float32)
    normals = np.array([[0, 0, 1], [0, 0, 1], [0, 0, 1], [0, 0, 0]], np.float32)
    head = "ply\nformat binary_little_endian 1.0\nelement vertex 4\n"
    head += "".join(f"property float {name}\n" for name in ("x", "y", "z", "nx", "ny", "nz"))
    head += "element face 2\nproperty list uchar int vertex_indices\nend_header\n"
    faces = np.array([(3, (0, 1, 2)), (3, (2, 1, 3))], [("count", "u1"), ("corners", "<i4", 3)])
    (tmp_path / "m.ply").write_bytes(head.encode() + np.hstack([vertices, normals]).tobytes() + faces.tobytes())
    np.save(tmp_path / "i.npy", np.stack([np.eye(4), 2 * np.eye(4)])[:, :3])
    told["meshes"] = {"m": {"file": "m.ply"}}
    told["objects"] = [{"mesh": "m", "material": "plate", "instances": "i.npy"}]
    (tmp_path / "s.json").write_text(json.dumps(told))
    scene = scene_file.read_scene(tmp_path / "s.json")
    assert scene.sigma_s == (0.1, 0.1, 0.1) and scene.sigma_a == (0.1, 0.2, 0.3) and scene.fog()
    assert scene.materials["moon"] == scene_file.Light((2.0, 2.0, 2.0))
    flat, smooth = scene.meshes
    assert flat.normals is None and smooth.normals is not None
    assert smooth.vertices.tolist() == vertices[:3].tolist() and flat.vertices.tolist() == vertices[1:].tolist()
    joined = scene_file.in_the_world(scene.meshes)
    assert [len(mesh.triangles) for mesh in joined] == [2, 2]
    assert joined[1].vertices[joined[1].triangles[1]].tolist() == (2 * vertices[:3]).tolist()


@pytest.mark.parametrize(
    ("place", "value", "message"),
    [
        (("lights",), [{"type": "point"}], "lamps"),
        (("environment",), {"radiance": 1}, "an environment that shines"),
        (("render",), {"max_depth": 3}, "a limit on depth"),
        (("film", "crop"), [0, 0, 1, 1], "film: crop"),
        (("camera", "lens_radius"), 1, "camera: lens_radius"),
        (("materials", "glass"), {"type": "glass", "ior": 1.5}, 'material "glass": glass'),
        (("materials", "plate", "f90"), 1, 'material "plate": Fresnel'),
    ],
)
def test_peers_refuse_what_they_would_render_otherwise(
    place: tuple[str, ...], value: object, message: str, tmp_path: Path
) -> None:
    told = json.loads(json.dumps(SMALL))
    inner = told
    for key in place[:-1]:
        inner = inner[key]
    inner[place[-1]] = value
    (tmp_path / "s.json").write_text(json.dumps(told))
    with pytest.raises(scene_file.UnsupportedError) as refused:
        scene_file.read_scene(tmp_path / "s.json")
    assert str(refused.value) == message


def test_a_peer_that_cannot_is_named_with_its_reason(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(command: list[str | Path], *_: object) -> tuple[str, int]:
        job = json.loads(Path(command[-1]).read_text())
        Path(job["result"]).write_text(json.dumps({"unsupported": "lamps"}))
        return "", 0

    monkeypatch.setattr(renderers, "_run", refuse)
    stage = Stage(SCENES[0], (8, 4), tmp_path, tmp_path / "s.json", "content", "3.4")
    with pytest.raises(CannotRenderError, match=r"^lamps$"):
        Peer("mitsuba", Path("python"), "3").runs(stage, [Task(1, 1)])


@pytest.mark.full
@pytest.mark.usefixtures("in_a_profile")
@pytest.mark.parametrize(("peer", "scene"), [("mitsuba", "clearing"), ("luxcore", "moons_in_fog")])
def test_peers_show_the_same_picture(
    peer: str, scene: str, glimmer_command: Path, blender: Path, tmp_path: Path
) -> None:
    """Fetches them from PyPI. The seeds are fixed; of all seeds, one in a thousand would fail."""
    build.install_packages(build.wanted_packages((peer,), blender))
    plan = Plan((64, 36), {"path": (1, 4), "baseline": (1, 4), peer: (16, 64)}, 4, 32, 6)
    tools = Renderers(glimmer_command, blender, False, [peer_of(f"{peer}={build.virtual_environment(peer)}")])
    result, _ = measure(scenes_of(scene)[0], plan, tools, tmp_path / "runs")
    assert not result.cannot and agrees(result.entries[peer], [result]), result.entries[peer].agreement
