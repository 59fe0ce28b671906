# SPDX-License-Identifier: GPL-3.0-or-later
"""How the add-on renders on a cluster, without Blender: what it shows meanwhile, what it keeps, what it refuses."""

import json
import os
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from addon.cluster.live_files import read_picture, read_told
from addon.cluster.render import ClusterRender
from addon.cluster.settings import Cluster, command_of
from addon.native.render import Tile
from addon.native.structs import State
from addon.scene import description as d
from addon.scene.problems import GlimmerError
from tests.farm.machines import PYTHON, cluster
from tests.render.build import Builder, camera, floor, grey

WINDOW = (3, 2, 21, 12)


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    with cluster(1, tmp_path_factory.mktemp("workers")) as found:
        yield found


@pytest.fixture
def endless(library_dir: Path, monkeypatch: pytest.MonkeyPatch) -> d.SceneDescription:
    monkeypatch.setenv("GLIMMER_LIBRARY", str(library_dir / "libglimmer.so"))
    builder = Builder(camera((0, -6, 1), (0, 0, 0), 60), 24, 16)
    builder.mesh(floor(z=-1, half=4), d.Lambert(grey(0.5)))
    builder.sphere((0, 0, 4), 1.0, d.Light(grey(5)))
    scene = builder.done()
    settings = replace(scene.settings, samples=1 << 20, passes=("combined", "depth", "stderr"))
    return replace(scene, film=replace(scene.film, crop=WINDOW), settings=settings)


def test_a_picture_appears_and_one_that_is_ended_stays(
    endless: d.SceneDescription, address: str, glimmer_command: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name, value in PYTHON.items():
        monkeypatch.setenv(name, value)
    with ClusterRender(endless, Cluster(glimmer_command, address, 2), tmp_path) as render:
        render.start()
        progress, tiles = render.poll(), render.changed_tiles()
        assert progress.samples == 0 and not tiles and not render.read("combined", whole(WINDOW)).any()
        end = time.monotonic() + 120
        while not (tiles := render.changed_tiles()):
            assert not render.poll().ended and time.monotonic() < end
            render.wait(0.05)
        assert tiles == [whole(WINDOW)] and (render.read("combined", tiles[0]) > 0).any()
        while render.poll().samples < 16:
            assert time.monotonic() < end
            render.wait(0.05)
        render.cancel()
        while not (progress := render.poll()).ended:
            assert time.monotonic() < end
            render.wait(0.05)
        assert progress.state == State.CANCELLED and progress.workers == 1
        assert progress.samples >= 16 and progress.relmse_low < progress.relmse < progress.relmse_high
        assert render.changed_tiles() == [whole(WINDOW)]
        for name in ("combined", "stderr", "depth"):
            assert (render.read(name, whole(WINDOW)) > 0).mean() > 0.3, name
        assert render.report()["spp"] == progress.samples
    assert list(tmp_path.iterdir()) == []


def whole(window: tuple[int, int, int, int]) -> Tile:
    x0, y0, x1, y1 = window
    return Tile(0, 0, x1 - x0, y1 - y0)


def test_a_command_that_is_none_is_told_in_one_line(
    endless: d.SceneDescription, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with pytest.raises(
        GlimmerError, match=r"^Render on Cluster: /nowhere/glimmer: no such file; name .* in Preferences"
    ):
        command_of("/nowhere/glimmer")
    program = tmp_path / "program"
    program.write_text("#!/bin/sh\necho of another kind >&2\nexit 3\n")
    program.chmod(0o755)
    with ClusterRender(endless, Cluster(program, "", 2), tmp_path) as render:
        render.start()
        with pytest.raises(GlimmerError, match=r"^Render on Cluster: of another kind$"):
            render.wait(-1.0)
    program.chmod(0o644)
    with (
        pytest.raises(GlimmerError, match="program cannot be run: Permission denied"),
        ClusterRender(endless, Cluster(program, "", 2), tmp_path) as render,
    ):
        render.start()


@pytest.mark.parametrize(
    ("window", "data"),
    [(WINDOW, b"\0" * 4 * 18 * 10 * 3), ((0, 0, 18, 10), b"\0" * 4 * 18 * 10), (WINDOW, b"")],
)
def test_a_picture_of_another_size_is_refused(tmp_path: Path, window: tuple[int, ...], data: bytes) -> None:
    head = {"width": 24, "height": 16, "window": window, "channels": ["R"]}
    (tmp_path / "picture").write_bytes(json.dumps(head).encode() + b"\n" + data)
    with pytest.raises(GlimmerError, match="of another version than this add-on"):
        read_picture(tmp_path, WINDOW)
    (tmp_path / "picture").write_bytes(json.dumps({**head, "window": WINDOW}).encode() + b"\n" + os.urandom(720))
    assert read_picture(tmp_path, WINDOW).pixels.shape == (10, 18, 1)
    assert read_told(tmp_path) is None
