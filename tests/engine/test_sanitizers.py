# SPDX-License-Identifier: GPL-3.0-or-later
"""The engine under AddressSanitizer, UndefinedBehaviorSanitizer and ThreadSanitizer: fuzzers of the scene reader and of
the C API, and the command. Builds the presets, which takes minutes."""

import os
import subprocess
import sys
import zipfile
from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from tests.engine.scenes import Scene, every_key, furnace, hazy_moon, run_glimmer, write_image, write_scene

pytestmark = pytest.mark.timeout(1800)

GREY_FOG = {"sigma_a": 0.01, "sigma_s": 0.05}
INTERIOR = {"sigma_a": 0.1, "sigma_s": [0.2, 0.3, 0.5], "g": 0.2, "emission": 0.1}
"""Isotropic, so that light vertices are shared."""

FUZZERS = {"api": 20_000, "mesh_files": 100_000, "scene": 4_000}
"""How many inputs each runs, those of its corpus among them: half a minute on an idle machine."""
# Without leaks: LeakSanitizer now and then dies of TBB's threads. The fuzzers look for them by other means.
ENVIRONMENT = {
    "ASAN_OPTIONS": "exitcode=66:detect_leaks=0:allocator_may_return_null=1",
    "UBSAN_OPTIONS": "halt_on_error=1:print_stacktrace=1:exitcode=66",
}


def some_scenes(folder: Path) -> dict[str, Scene]:
    every = every_key(folder)
    return {
        "every key": every,
        "shared light vertices": {**every, "medium": GREY_FOG, "render": {}},
        "coloured fog": {**every, "medium": {"sigma_a": 0.01, "sigma_s": [0.05, 0.1, 0.02]}, "render": {}},
        "in glass": {**every, "camera": {"origin": [-1, -3, 1], "target": [0, 0, 0], "fov_x": 60}},
        "fog in bodies": {**every, "objects": [*every["objects"][:3], {**every["objects"][3], "interior": INTERIOR}]},
        "no fog": {key: value for key, value in every.items() if key != "medium"},
        "furnace": furnace(),
        "moon": hazy_moon(),
        "fog alone": {**hazy_moon(), "objects": []},
    }


@cache
def built(repository: Path, preset: str) -> Path:
    """The preset's folder of executables, compiled as far as these tests need it."""
    others = [f"fuzz_{name}" for name in FUZZERS] if preset == "fuzz" else ["glimmer_probe", "glimmer_example"]
    targets = ["glimmer_command", *others]
    for command in (["cmake", "--preset", preset], ["cmake", "--build", "--preset", preset, "--target", *targets]):
        done = subprocess.run(command, cwd=repository / "engine", capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stdout + done.stderr
    return repository / "build" / preset / "bin"


# ---- fuzzing -------------------------------------------------------------------------------------------------------


def write_seeds(name: str, seeds: Path, folder: Path, corpus: Path) -> None:
    """What a fuzzer starts from: the tests' own files, and inputs that reached new code in earlier runs.

    folder: gets the files that scenes name. corpus: the folder of the earlier inputs.
    """
    with zipfile.ZipFile(corpus / f"{name}.zip") as archive:
        archive.extractall(seeds)
    scenes = some_scenes(folder)
    if name == "scene":
        for i, scene in enumerate(scenes.values()):
            write_scene(seeds, scene, f"{i}.json")
    elif name == "mesh_files":
        for file in folder.iterdir():
            if file.suffix in (".npy", ".ply", ".obj"):
                (seeds / file.name).write_bytes(file.read_bytes())


def start_fuzzer(name: str, folder: Path, repository: Path, limit: str) -> "subprocess.Popen[bytes]":
    """limit: libFuzzer's option that ends it. What it says goes to the folder's file `said`: a pipe that nobody reads
    yet would stop it."""
    files = folder / "files"
    files.mkdir(parents=True)
    corpus = repository / "tests" / "engine" / "fuzz"
    write_seeds(name, folder / "seeds", files, corpus)
    command = [
        *(built(repository, "fuzz") / f"fuzz_{name}", folder / "seeds"),
        *(limit, "-seed=1", "-timeout=60", "-rss_limit_mb=3000", "-max_len=8192"),
        *(f"-artifact_prefix={folder}/", "-print_final_stats=1", f"-dict={corpus / 'scene.dict'}"),
    ]
    environment = {**os.environ, **ENVIRONMENT, "GLIMMER_FUZZ_FOLDER": os.fspath(files)}
    with (folder / "said").open("wb") as said:
        return subprocess.Popen(list(map(str, command)), env=environment, stdout=said, stderr=subprocess.STDOUT)


def fuzz(folder: Path, repository: Path, seconds: int = 0) -> None:
    """All fuzzers at once, for so many inputs or seconds; each must have gone beyond what it started from, and found
    nothing."""
    processes = {
        name: start_fuzzer(
            name, folder / name, repository, f"-max_total_time={seconds}" if seconds else f"-runs={runs}"
        )
        for name, runs in FUZZERS.items()
    }
    for name, process in processes.items():
        process.wait(timeout=300 + 2 * seconds)
        said = (folder / name / "said").read_text(errors="replace")
        found = [line for line in said.splitlines() if "ERROR" in line or "SUMMARY" in line or line.startswith("fuzz:")]
        assert process.returncode == 0, f"fuzz_{name}: {found}\n{said[-6000:]}"
        new = [line for line in said.splitlines() if line.startswith("stat::new_units_added:")]
        assert new and int(new[0].split()[-1]) > 0, f"fuzz_{name} came upon nothing new:\n{said[-2000:]}"


def test_fuzzers(repository: Path, tmp_path: Path) -> None:
    fuzz(tmp_path, repository)


@pytest.mark.full
def test_fuzzers_for_long(repository: Path, tmp_path: Path) -> None:
    fuzz(tmp_path, repository, seconds=600)


# ---- the command ---------------------------------------------------------------------------------------------------


def render_all(scenes: dict[str, Scene], folder: Path, integrators: tuple[str, ...]) -> None:
    layers = "albedo,normal,depth,emission,direct,indirect,fog,object_index,material_index,sample_count"
    for name, scene in scenes.items():
        for integrator in integrators:
            path = write_scene(folder, scene)
            output, state = folder / "out.exr", folder / f"{name} {integrator}"
            for samples in (2, 5):  # the second from the first one's checkpoint
                done = run_glimmer(
                    *(path, "-o", output, "--spp", samples, "--threads", 4, "--tile", 8, "--aov", layers),
                    *("--integrator", integrator, "--checkpoint", state, "--report", folder / "report.json"),
                )
                assert done.returncode == 0, f"{name}, {integrator}: {done.stderr}"


@pytest.fixture
def sanitized(repository: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[[str], None]:
    """Makes a preset's command the one that run_glimmer runs."""

    def use(preset: str) -> None:
        suppressions = f"exitcode=66:suppressions={repository / 'engine' / 'tsan.supp'}"
        binary = built(repository, preset) / "glimmer"
        for name, value in {**ENVIRONMENT, "TSAN_OPTIONS": suppressions, "GLIMMER_BIN": os.fspath(binary)}.items():
            monkeypatch.setenv(name, value)

    return use


def test_command(sanitized: Callable[[str], None], tmp_path: Path) -> None:
    """Every key of the format, every output and a merge; and errors at every stage."""
    sanitized("fuzz")
    scenes = some_scenes(tmp_path)
    render_all({name: scenes[name] for name in ("shared light vertices", "fog alone")}, tmp_path, ("path",))
    path = write_scene(tmp_path, scenes["every key"])
    pictures = [tmp_path / f"{i}.exr" for i in range(2)]
    for seed, picture in enumerate(pictures):
        options = ("--spp", 4, "--seed", seed, "--integrator", "baseline", "--curve", tmp_path / f"c{seed}.png")
        done = run_glimmer(path, "-o", picture, *options)
        assert done.returncode == 0, done.stderr
    done = run_glimmer("merge", *pictures, "-o", tmp_path / "merged.exr")
    assert done.returncode == 0, done.stderr
    for name in ("out.png", "out.hdr", "out.pfm"):
        assert run_glimmer(write_scene(tmp_path, furnace()), "-o", tmp_path / name, "--spp", 1).returncode == 0
    write_scene(tmp_path, '{"glimmer": 1, "film"', "cut_off.json")
    foreign = tmp_path / "foreign.exr"
    write_image(foreign, np.ones((2, 2, 3), np.float32))
    for arguments in (["cut_off.json"], ["gone.json"], ["merge", foreign, *pictures]):
        assert run_glimmer(*arguments, "-o", "o.exr", cwd=tmp_path).returncode == 1


@pytest.mark.full
@pytest.mark.parametrize("preset", ["asan", "tsan"])
def test_command_for_long(preset: str, sanitized: Callable[[str], None], tmp_path: Path) -> None:
    sanitized(preset)
    render_all(some_scenes(tmp_path), tmp_path, ("path", "baseline"))


RUNTIMES = {"asan": ("libasan.so", "libubsan.so"), "tsan": ("libtsan.so",)}
"""What of a sanitizer must be in a Python that loads a library built with it."""
THREADED = ("test_session.py", "test_saved_state.py")
IN_PROCESS = (
    *THREADED,
    *("api", "test_bsdf.py", "test_determinism.py", "test_examples.py", "test_extremes.py", "test_fresnel.py"),
)
COMMANDS = ("command", "scene_file", "test_light_shapes.py", "test_medium.py", "test_phase.py", "test_samplers.py")


def test_the_sanitized_tests_are_there() -> None:
    folder = Path(__file__).parent
    assert [name for name in (*IN_PROCESS, *COMMANDS) if not (folder / name).exists()] == []


@pytest.mark.full
@pytest.mark.parametrize(("preset", "names"), [("asan", IN_PROCESS), ("asan", COMMANDS), ("tsan", THREADED)])
def test_engine_tests(preset: str, names: tuple[str, ...], repository: Path) -> None:
    """The engine's tests, with the library in this Python and with the command; under ThreadSanitizer those that start,
    pause, cancel and read while worker threads render."""
    paths = [
        subprocess.run(["g++", f"-print-file-name={name}"], capture_output=True, text=True, check=True).stdout.strip()
        for name in RUNTIMES[preset]
    ]
    binary = built(repository, preset).parent
    environment = {
        **os.environ,
        **ENVIRONMENT,
        "GLIMMER_LIB_DIR": os.fspath(binary / "lib"),
        "GLIMMER_BIN": os.fspath(binary / "bin" / "glimmer"),
        "LD_PRELOAD": ":".join(os.fspath(Path(path).resolve()) for path in paths),
        "TSAN_OPTIONS": f"exitcode=66:suppressions={repository / 'engine' / 'tsan.supp'}",
        "OPENBLAS_NUM_THREADS": "1",  # its own threads were built without the sanitizer
    }
    tests = [f"tests/engine/{name}" for name in names]
    # A sanitizer is one more library that the engine, and a C program with it, need.
    options = ["-q", "-s", "-p", "no:cacheprovider", "-k", "not needs_nothing_but and not c_program"]
    command = [sys.executable, "-m", "pytest", *options, *tests]
    done = subprocess.run(command, cwd=repository, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0 and " passed" in done.stdout, done.stdout[-4000:] + done.stderr[-8000:]
