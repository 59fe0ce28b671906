# SPDX-License-Identifier: GPL-3.0-or-later
"""What the engine takes of its host: threads, memory, the floating-point mode."""

import ctypes
import ctypes.util
import json
import os
import resource
import subprocess
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from ctypes import byref
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from addon.native.scene import MeshCache
from addon.scene import description as d
from addon.scene.problems import GlimmerError
from tests.engine.library import Render, Scene, engine
from tests.engine.scenes import furnace, run_glimmer, scene, write_scene
from tests.engine.worlds import everything
from tests.render.build import Builder, camera, grey

# ---- the floating-point mode ---------------------------------------------------------------------------------------

MXCSR = 28
"""Its offset in glibc's fenv_t on x86-64."""
FLUSH = 0x8040
"""Flush to zero, and denormals are zero: as Blender's threads run."""
ROUND_UP = 0x4000


@contextmanager
def floating_point(bits: int) -> Iterator[Callable[[], int]]:
    """This thread's MXCSR with some bits set; gives a function that reads the register."""
    libm = ctypes.CDLL(ctypes.util.find_library("m"))

    def current() -> Any:
        environment = (ctypes.c_ubyte * 32)()
        libm.fegetenv(byref(environment))
        return environment

    before = current()
    changed = current()
    value = int.from_bytes(bytes(before[MXCSR:]), "little") | bits
    changed[MXCSR:] = list(value.to_bytes(4, "little"))
    libm.fesetenv(byref(changed))
    try:
        yield lambda: int.from_bytes(bytes(current()[MXCSR:]), "little")
    finally:
        libm.fesetenv(byref(before))


def faint() -> d.SceneDescription:
    """A moon and fog whose numbers are denormal in float32."""
    view = camera((0, -6, 3), (0, 4, 1), 60)
    world = Builder(view, 16, 12, medium=d.Medium(grey(1e-39), grey(1e-2)))
    return world.sphere((0, 4, 1), 2, d.Light((1e-39, 1e-38, 1e-40))).done()


def picture(world: d.SceneDescription, bits: int) -> bytes:
    """Every call into the engine with those bits set, still there after it; Python's own conversions without."""
    library = engine()
    plain = library.call

    def call(name: str, *arguments: object) -> None:
        with floating_point(bits) as mode:
            assert mode() & bits == bits, "the mode was not set: nothing is tested"
            plain(name, *arguments)
            assert mode() & bits == bits, "the engine left another mode behind"

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(library, "call", call)
        committed = Scene(world)
    with floating_point(bits), Render(committed, samples=3, threads=1, passes=("depth", "fog")) as render:
        render.run()
        return b"".join(render.read(name).tobytes() for name in ("combined", "stderr", "depth", "fog"))


@pytest.mark.parametrize("bits", [FLUSH, ROUND_UP])
def test_the_hosts_mode_changes_no_bit_and_stays(bits: int) -> None:
    """Commit, pilot pass and reading run on the host's thread."""
    for world in (faint(), everything(16, 12)):
        assert picture(world, bits) == picture(world, 0)
    with Render(Scene(faint()), samples=1) as render:
        assert render.run().read().max() > 0, "black: nothing was tested"


# ---- memory --------------------------------------------------------------------------------------------------------


def grid(side: int) -> d.Mesh:
    """A wavy square of 2 side^2 triangles."""
    x, y = (a.ravel() for a in np.meshgrid(np.linspace(-5, 5, side + 1), np.linspace(-5, 5, side + 1)))
    corner = (np.arange(side)[:, None] * (side + 1) + np.arange(side)).ravel()
    a, b, c, e = corner, corner + 1, corner + side + 1, corner + side + 2
    triangles = np.stack([np.stack([a, b, e], 1), np.stack([a, e, c], 1)], 1).reshape(-1, 3).astype(np.uint32)
    return d.Mesh("grid", np.stack([x, y, np.sin(x * 7) * 0.1], 1), triangles)


def peak_bytes(side: int) -> int:
    world = Builder(camera((0, -6, 3), (0, 4, 1), 60), 8, 8)
    with Render(Scene(world.mesh(grid(side), d.Lambert(grey(0.5))).done()), samples=1) as render:
        return int(render.run().poll().peak_bytes)


def test_bvhs_count_in_the_peak() -> None:
    """A BVH takes more than the mesh that it is of; and no more than a few times as much."""
    extra = peak_bytes(300) - peak_bytes(100)
    triangles, vertices = 2 * (300**2 - 100**2), 301**2 - 101**2
    arrays = 12 * (triangles + vertices)
    assert 2 * arrays < extra < 12 * arrays


def test_shared_passes_count_in_the_peak() -> None:
    """More samples make larger batches, whose light vertices are kept; a medium that shares nothing needs none."""

    def growth(g: float) -> int:
        world = Builder(camera((0, -6, 3), (0, 4, 1), 60), 64, 64, medium=d.Medium(grey(0.01), grey(0.1), g))
        committed = Scene(world.sphere((0, 4, 1), 1, d.Light(grey(1))).done())
        peaks = []
        for samples in (1, 8):
            with Render(committed, samples=samples) as render:
                peaks.append(int(render.run().poll().peak_bytes))
        return peaks[1] - peaks[0]

    assert growth(0) > 10000
    assert growth(0.95) == 0


PLATE = {"vertices": [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], "triangles": [[0, 1, 2], [0, 2, 3]]}


def limited(megabytes: int) -> Callable[[], None]:
    return lambda: resource.setrlimit(resource.RLIMIT_AS, (megabytes << 20, megabytes << 20))


@cache
def least_megabytes() -> int:
    """What the command needs to come to its own code: the libraries of the picture formats take hundreds of megabytes
    of addresses, and end the process where they lack them."""
    for megabytes in range(100, 4000, 20):
        if run_glimmer("--version", preexec_fn=limited(megabytes)).returncode == 0:
            return megabytes
    pytest.fail("the command does not start in 4 GB")


@pytest.mark.parametrize(
    ("plates", "side", "more"),
    [
        (200_000, 200, (*range(14, 22), 100, 150)),
        pytest.param(1_000_000, 700, range(0, 1600, 50), marks=pytest.mark.full),
    ],
    ids=["few", "many"],
)
def test_out_of_memory_is_one_line(plates: int, side: int, more: Sequence[int], tmp_path: Path) -> None:
    """Plates and a mesh of 2 side^2 triangles, in too little memory for this or that part of the work: one line and
    exit status 2, until there is enough."""
    instances = np.tile(np.eye(3, 4, dtype=np.float32), (plates, 1, 1))
    instances[:, :, 3] = np.random.default_rng(1).uniform(-100, 100, (plates, 3))
    np.save(tmp_path / "plates.npy", instances)
    mesh = grid(side)
    np.save(tmp_path / "vertices.npy", mesh.vertices)
    np.save(tmp_path / "triangles.npy", mesh.triangles)
    content = scene(
        materials={"grey": {"type": "lambert", "albedo": 0.5}},
        meshes={"plate": PLATE, "grid": {"vertices": "vertices.npy", "triangles": "triangles.npy"}},
        objects=[
            {"mesh": "plate", "material": "grey", "instances": "plates.npy"},
            {"mesh": "grid", "material": "grey"},
        ],
        environment={"radiance": 1},
    )
    path = write_scene(tmp_path, content)
    outcomes = []
    for megabytes in (*(least_megabytes() + m for m in more), 8000):
        output = tmp_path / "out.exr"
        output.unlink(missing_ok=True)
        done = run_glimmer(path, "-o", output, "--spp", 1, "--threads", 2, "--quiet", preexec_fn=limited(megabytes))
        outcomes.append(done.returncode)
        assert done.returncode in (0, 2), f"{megabytes} MB: {done.returncode} {done.stderr}"
        if done.returncode == 2:
            assert done.stderr.count("\n") == 1 and "memory" in done.stderr, f"{megabytes} MB: {done.stderr}"
            assert not output.exists()
    assert outcomes[0] == 2 and outcomes[-1] == 0, outcomes


# ---- threads -------------------------------------------------------------------------------------------------------

COUNT_THREADS = """
import sys
from pathlib import Path
from tests.engine.library import Scene
from tests.engine.test_resources import building

Scene(building(int(sys.argv[1])))
sys.stdout.write(str(len(list(Path("/proc/self/task").iterdir()))))
"""


def building(threads: int) -> d.SceneDescription:
    """A mesh that Embree builds on as many threads as it may."""
    world = Builder(camera((0, -6, 3), (0, 4, 1), 60), 8, 8)
    done = world.mesh(grid(300), d.Lambert(grey(0.5))).done()
    return replace(done, settings=d.RenderSettings(threads=threads))


def test_commit_builds_on_so_many_threads(repository: Path) -> None:
    """The threads of a process after its commit: Embree's workers stay. Those of numpy are none of ours."""

    def threads_after(threads: int) -> int:
        environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1", "PYTHONPATH": str(repository)}
        command = [sys.executable, "-c", COUNT_THREADS, str(threads)]
        done = subprocess.run(command, env=environment, cwd=repository, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
        return int(done.stdout)

    assert threads_after(1) == 1
    assert 1 < threads_after(2) <= 2


def test_commits_of_different_threads_share_meshes() -> None:
    """A mesh is built again for another number; the scenes of before go on as they are."""
    meshes = MeshCache(engine())
    first = Scene(building(1), meshes)
    pictures = []
    for committed in (first, Scene(building(2), meshes), Scene(building(1), meshes), first):
        with Render(committed, samples=2) as render:
            pictures.append(render.run().read().tobytes())
    meshes.clear()
    assert len(set(pictures)) == 1


def test_bad_number_of_threads() -> None:
    with pytest.raises(GlimmerError, match=r"commit: threads is 4097; allowed: 0 to 4096"):
        Scene(building(4097))


# ---- a million -----------------------------------------------------------------------------------------------------


@pytest.mark.full
@pytest.mark.parametrize("what", ["plates", "spheres"])
def test_a_million(what: str, tmp_path: Path) -> None:
    """Loads, builds and renders within a gigabyte and a half."""
    rng = np.random.default_rng(3)
    if what == "plates":
        instances = np.tile(np.eye(3, 4, dtype=np.float32), (1_000_000, 1, 1))
        instances[:, :, 3] = rng.uniform(-100, 100, (1_000_000, 3))
        np.save(tmp_path / "many.npy", instances)
        parts: dict[str, Any] = {
            "meshes": {"plate": PLATE},
            "objects": [{"mesh": "plate", "material": "grey", "instances": "many.npy"}],
        }
    else:
        np.save(tmp_path / "many.npy", rng.uniform(-100, 100, (1_000_000, 3)))
        parts = {"spheres": [{"centers": "many.npy", "radius": 0.3, "material": "grey"}]}
    content = {**furnace(), "materials": {"grey": {"type": "lambert", "albedo": 0.5}}, "spheres": [], **parts}
    path = write_scene(tmp_path, content)
    options = ["--spp", 4, "--report", tmp_path / "r.json"]
    done = run_glimmer(path, "-o", tmp_path / "out.exr", *options, preexec_fn=limited(4096))
    assert done.returncode == 0, done.stderr
    report = json.loads((tmp_path / "r.json").read_text())
    assert report["peak_bytes"] < 1.5 * 2**30 and report["invalid_samples"]["count"] == 0
