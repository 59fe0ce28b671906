#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Glimmer's one command for setting up, building, rendering, testing and packaging.

A thin driver over apt, CMake presets, Blender, pytest and zipfile. Standard library only, because on a fresh Debian 12
it runs before anything else is installed (that python3 has neither venv nor pip).
"""

import argparse
import hashlib
import os
import platform
import re
import shlex
import shutil
import subprocess
import sys
import time
import zipfile
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from engine.farm import __main__ as farm_command
from tests import newest_blender

ROOT = Path(__file__).resolve().parent
ENGINE = ROOT / "engine"
ADDON = ROOT / "addon"
BUILD = ROOT / "build"
COMMAND = BUILD / "bin" / "glimmer"
LIBRARY = BUILD / "lib" / "libglimmer.so"
RENDER_SCRIPT = ROOT / "blend_scenes" / "render_blend.py"
DEFAULT_SCENE = ROOT / "blend_scenes" / "glimmervoid.blend"
REQUIREMENTS = ROOT / "tests" / "requirements"


class BuildError(Exception):
    """What stopped the command, in words for the user."""


def say(text: str) -> None:
    sys.stdout.write(text + "\n")
    sys.stdout.flush()


def not_installed(program: str) -> BuildError:
    return BuildError(f"{program} is not installed; `python3 build.py setup --test` installs what is missing")


def run(command: Sequence[str | Path], cwd: Path = ROOT, env: dict[str, str] | None = None) -> None:
    """Runs a command with its output passed through; a failure names the command."""
    words = [str(word) for word in command]
    try:
        status = subprocess.run(words, cwd=cwd, env=env, check=False).returncode
    except FileNotFoundError:
        raise not_installed(words[0]) from None
    if status != 0:
        raise BuildError(f"exit status {status} from: {shlex.join(words)}")


# ---- Progress ----------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Progress:
    """How far a step has come."""

    step: str
    fraction: float | None = None  # None: nothing tells yet
    left: str = ""  # time, as "1:12"
    details: tuple[str, ...] = ()

    def text(self, bar: bool) -> str:
        parts = [self.step]
        if self.fraction is not None:
            done = round(24 * self.fraction)
            parts += [f"[{'#' * done}{'-' * (24 - done)}]"] if bar else []
            parts.append(f"{100 * self.fraction:3.0f} %")
        if self.left:
            parts.append(f"{self.left} left")
        return "  ".join([*parts, *self.details])


LINE_SECONDS = 10.0  # from one line of progress to the next where it is no terminal that shows them


class Bar:
    """Progress as one line: on a terminal in place, else a line now and then, and the last one."""

    def __init__(self) -> None:
        self._terminal = sys.stdout.isatty()
        self._next = 0.0
        self._pending = ""  # what stands on the terminal's last line, or what no line has told yet

    def show(self, progress: Progress) -> None:
        self._pending = progress.text(bar=self._terminal)
        if self._terminal:
            self._pending = self._pending[: shutil.get_terminal_size().columns - 1]
            sys.stdout.write(f"\r{self._pending}\x1b[K")
            sys.stdout.flush()
        elif time.monotonic() >= self._next:
            self._next = time.monotonic() + LINE_SECONDS
            self.close()

    def say(self, line: str) -> None:
        """A line above the bar."""
        if not (self._terminal and self._pending):
            say(line)
            return
        sys.stdout.write(f"\r\x1b[K{line}\n{self._pending}")
        sys.stdout.flush()

    def close(self) -> None:
        """Leaves the last state to be read."""
        if self._pending:
            say("" if self._terminal else self._pending)
        self._pending = ""


def watch(
    command: Sequence[str | Path],
    read: Callable[[str], Progress | None],
    cwd: Path = ROOT,
    env: dict[str, str] | None = None,
) -> int:
    """Runs a command and returns its exit status. What `read` makes of a line of its output is shown as progress; lines
    that it makes nothing of are passed on.
    """
    bar = Bar()
    words = [str(word) for word in command]
    try:
        with subprocess.Popen(
            words,
            cwd=cwd,
            env=env,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            errors="replace",
        ) as process:
            assert process.stdout is not None
            for line in map(str.rstrip, process.stdout):
                progress = read(line)
                if progress is None:
                    bar.say(line)
                else:
                    bar.show(progress)
    except FileNotFoundError:
        raise not_installed(words[0]) from None
    finally:
        bar.close()
    return process.returncode


def compiling(line: str) -> Progress | None:
    """Reads the lines of Ninja, "[12/102] Building CXX object ..."."""
    found = re.match(r"\[(\d+)/(\d+)\] ", line)
    if not found:
        return None
    done, total = int(found[1]), int(found[2])
    if done == 0:  # it looks whether there is something to do
        return Progress("Building")
    return Progress("Building", done / total, details=(f"{done} of {total} steps",))


def rendering(line: str) -> Progress | None:
    """Reads Blender's progress, "Fra:1 Mem:20.2M ... | Sample 3/32 | 9 % | Left 01:12 | Noise 14 % (10 to 17 %)"."""
    if not re.match(r"Fra:\d+ ", line):
        return None
    sample = re.search(r"\bSample (\d+)(?:/(\d+))?", line)
    if not sample:
        return Progress("Rendering", details=(re.split(r" \| |^Fra:\d+ ", line)[-1].lower(),))
    fraction = re.search(r"\| (\d+) %", line)
    left = re.search(r"\| Left 0?([\d:]+)", line)
    noise = re.search(r"\| (Noise [^|]*[^| ])", line)
    samples = f"{sample[1]} of {sample[2]} samples" if sample[2] else f"{sample[1]} samples"
    return Progress(
        "Rendering",
        int(fraction[1]) / 100 if fraction else None,
        left[1] if left and left[1] != "0:00" else "",
        (samples, noise[1]) if noise else (samples,),
    )


# ---- What the machine needs --------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Package:
    """A Debian package, what needs it ("engine", which "build" needs too, "build", "render", "test", or a peer of the
    benchmark), and why.
    """

    name: str
    purpose: str
    why: str


PACKAGES = (
    Package("g++", "engine", "compiler"),
    Package("cmake", "engine", "drives the build, fetches Embree"),
    Package("ninja-build", "engine", "runs the build"),
    Package("libopenimageio-dev", "build", "images in and out of the command line"),
    Package("libopenexr-dev", "build", "its .exr pictures"),
    Package("nlohmann-json3-dev", "build", "scene files"),
    Package("libtinyobjloader-dev", "build", ".obj meshes"),
    Package("libcli11-dev", "build", "options of the command line"),
    Package("libxxhash-dev", "build", "hashes of scenes"),
    Package("blender", "render", "the host"),
    Package("python3-numpy", "render", "Debian's Blender does not bring it"),
    Package("python3-venv", "test", "virtual environments of the tests"),
    Package("ca-certificates", "test", "pip's downloads"),
    Package("clang-format", "test", "lint of the engine"),
    Package("clang", "test", "fuzzers"),
    Package("libclang-rt-14-dev", "test", "their runtime"),
    Package("xvfb", "test", "a display for Blender's window"),
    Package("xdotool", "test", "keys for that window"),
    Package("imagemagick", "test", "pictures of that window"),
    Package("libgl1-mesa-dri", "test", "draws it"),
    Package("libx11-6", "test", "the bpy wheel"),
    Package("libxrender1", "test", "the bpy wheel"),
    Package("libxfixes3", "test", "the bpy wheel"),
    Package("libxi6", "test", "the bpy wheel"),
    Package("libxkbcommon0", "test", "the bpy wheel"),
    Package("libsm6", "test", "the bpy wheel"),
    Package("libice6", "test", "the bpy wheel"),
    Package("libgl1", "test", "the bpy wheel"),
    Package("libllvm19", "mitsuba", "the benchmark's Mitsuba compiles with it; 14 and 15 are too old for it"),
)


def wanted_packages(purposes: Iterable[str], blender: Path | None) -> list[str]:
    """The packages for some purposes. A Blender that is not Debian's replaces `blender` and brings its own numpy."""
    wanted = {*purposes, *(["engine"] if "build" in purposes else [])}
    foreign = blender is not None and (has_module(blender) or not blender.resolve().is_relative_to("/usr/bin"))
    return [p.name for p in PACKAGES if p.purpose in wanted and not (foreign and p.purpose == "render")]


def missing_packages(names: Sequence[str]) -> list[str]:
    query = ["dpkg-query", "--show", "--showformat=${db:Status-Status} ${Package}\n", *names]
    result = subprocess.run(query, capture_output=True, text=True, check=False)
    installed = {line.split(" ", 1)[1] for line in result.stdout.splitlines() if line.startswith("installed ")}
    return [name for name in names if name not in installed]


def install_packages(names: Sequence[str]) -> None:
    """Installs what is missing of `names`, without a question, and leaves alone what is there."""
    if shutil.which("dpkg-query") is None:
        say(f"No apt here: presuming that these, or their like, are installed: {' '.join(names)}")
        return
    missing = missing_packages(names)
    if not missing:
        return
    apt = ["apt-get", "-y", "-o", "DPkg::Lock::Timeout=300", "-o", "Acquire::Retries=3"]
    install = [*apt, "install", "--no-install-recommends", *missing]
    if os.geteuid() != 0:
        line = f"sudo sh -c 'apt-get update && apt-get install -y --no-install-recommends {' '.join(missing)}'"
        raise BuildError(
            f"packages are missing; as root this command installs them, so do it once yourself:\n\n    {line}\n"
        )
    say(f"Installing {', '.join(missing)}")
    env = {**os.environ, "DEBIAN_FRONTEND": "noninteractive", "DEBCONF_NONINTERACTIVE_SEEN": "true"}
    run([*apt, "update"], env=env)
    run(install, env=env)


# ---- Virtual environments ----------------------------------------------------------------------------------------


def python_311() -> str:
    """A Python 3.11 that can make virtual environments; the bpy 5.0 wheel takes no other version."""
    probe = "import sys, venv, ensurepip; sys.exit(sys.version_info[:2] != (3, 11))"
    for candidate in ("/usr/bin/python3.11", shutil.which("python3.11"), sys.executable):
        if not candidate or not Path(candidate).exists():
            continue
        if subprocess.run([candidate, "-c", probe], capture_output=True, check=False).returncode == 0:
            return candidate
    raise BuildError("Python 3.11 with venv is needed (Debian 12: apt-get install python3-venv)")


def virtual_environment(name: str) -> Path:
    """build/venv/NAME with what tests/requirements/NAME.txt pins; made anew when that file changes. Its python."""
    requirements = REQUIREMENTS / f"{name}.txt"
    folder = BUILD / "venv" / name
    python = folder / "bin" / "python"
    stamp = folder / "requirements.sha256"
    digest = hashlib.sha256(requirements.read_bytes() + bytes(folder)).hexdigest()
    if stamp.exists() and stamp.read_text() == digest:
        return python
    if folder.is_symlink():  # another checkout's, which venv --clear would empty
        folder.unlink()
    say(f"Making the virtual environment {folder.relative_to(ROOT)}")
    run([python_311(), "-m", "venv", "--clear", folder])
    run([python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-input", "-r", requirements])
    stamp.write_text(digest)
    return python


def newest_host() -> dict[str, str]:
    """What tells the tests where the newest Blender is, or why it is not there. Under CI=true it must be there."""
    pip = (virtual_environment("test"), "-m", "pip")
    try:
        python = newest_blender.make(BUILD / "hosts" / "newest", REQUIREMENTS / "newest.txt", pip, say)
    except newest_blender.UnavailableError as error:
        if os.environ.get("CI") == "true":
            raise BuildError(f"the newest Blender cannot be made: {error}") from None
        say(f"The tests in the newest Blender are skipped: {error}")
        return {"GLIMMER_NO_NEWEST": str(error)}
    return {"GLIMMER_NEWEST_PYTHON": str(python)}


# ---- Blender -----------------------------------------------------------------------------------------------------


def find_blender(given: str | None) -> Path | None:
    """--blender PATH, else the one on PATH; None when there is none yet."""
    if given is not None:
        path = shutil.which(given)
        if path is None:
            raise BuildError(f"--blender {given}: no such executable")
        return Path(path).absolute()
    found = shutil.which("blender")
    return Path(found) if found else None


def has_module(blender: Path) -> bool:
    """Whether it is a Python with the bpy module, which was given in Blender's place."""
    return blender.name.startswith("python")


def script_runner(blender: Path | None, *options: str) -> list[str | Path]:
    """What runs the script that comes next inside Blender, or in a Python with the bpy module: ours where there is no
    Blender. Options are for Blender itself."""
    if blender is None:
        return [virtual_environment("bpy")]
    if has_module(blender):
        return [blender]
    return [blender, "-b", "--factory-startup", *options, "--python-exit-code", "1", "--python"]


def host_command(blender: Path | None, script: Path) -> list[str | Path]:
    return [*script_runner(blender), script, "--"]


def own_python_first(blender: Path | None) -> dict[str, str]:
    """Debian's Blender takes the first python3 on PATH for its own, and with it that one's packages."""
    path = os.environ.get("PATH", os.defpath)
    return {**os.environ, "PATH": path if blender is None else f"{blender.parent}{os.pathsep}{path}"}


def host_environment(profile: Path, blender: Path | None) -> dict[str, str]:
    """An environment in which Blender sees nothing of the user's but a profile of ours, with addon/ as `glimmer`."""
    addons = profile / "scripts" / "addons"
    addons.mkdir(parents=True, exist_ok=True)
    link = addons / "glimmer"
    if not link.is_symlink() or link.readlink() != ADDON:
        link.unlink(missing_ok=True)
        link.symlink_to(ADDON, target_is_directory=True)
    return {
        **own_python_first(blender),
        "BLENDER_USER_RESOURCES": str(profile),
        "BLENDER_USER_CONFIG": str(profile / "config"),
        "BLENDER_USER_SCRIPTS": str(profile / "scripts"),
    }


# ---- Commands ----------------------------------------------------------------------------------------------------


def setup(blender: str | None, purposes: Sequence[str]) -> Path | None:
    """Installs what is missing for `purposes`; returns the Blender to use (None: the bpy wheel)."""
    found = find_blender(blender)
    install_packages(wanted_packages(purposes, found))
    return found or find_blender(None)


def configure(preset: str, with_command: bool) -> None:
    """Makes the preset's build folder, when it is not there yet or was made without the command that is wanted now."""
    folder = BUILD / preset
    known = (folder / "CMakeCache.txt").read_text() if (folder / "build.ninja").exists() else ""
    switch = f"-DGLIMMER_COMMAND={'ON' if with_command else 'OFF'}"
    if f"CMAKE_HOME_DIRECTORY:INTERNAL={ENGINE}\n" not in known:
        mirror = newest_blender.mirror().rstrip("/") if shutil.which("apt-get") else newest_blender.MIRROR
        # --fresh: what a failed try or a checkout since moved left behind
        run(["cmake", "--fresh", "--preset", preset, switch, f"-DGLIMMER_DEBIAN_MIRROR={mirror}"], cwd=ENGINE)
    elif with_command and "GLIMMER_COMMAND:BOOL=OFF\n" in known:
        run(["cmake", "--preset", preset, switch], cwd=ENGINE)


def build(preset: str = "release", target: str | None = None) -> None:
    """Configures when needed and compiles. The release preset leaves build/bin/glimmer and build/lib/libglimmer.so; of
    a target, what it needs alone is compiled and has to be installed.
    """
    configure(preset, with_command=target is None)
    command = ["cmake", "--build", "--preset", preset, *(["--target", target] if target is not None else [])]
    env = {**os.environ, "NINJA_STATUS": "[%f/%t] "}
    status = watch(command, compiling, cwd=ENGINE, env=env)
    if status != 0:
        raise BuildError(f"exit status {status} from: {shlex.join(command)}; its reason stands above")


@dataclass(frozen=True)
class RenderOptions:
    scene: Path | None  # None: the default one
    output: Path | None
    samples: int | None
    resolution: int | None
    frame: int | None
    full: bool = False  # the default scene as large and as clean as its file says; other files are so anyway


@dataclass(frozen=True)
class QuickLook:
    """What the default scene is rendered with where nothing else is asked for: a picture worth looking at within three
    minutes on two cores.
    """

    resolution: int = 60  # percent
    samples: int = 32
    seconds: float = 150.0  # of rendering, on a machine that is slower or busy


PICTURE_SUFFIXES = (".png", ".exr")


def make_room(picture: Path) -> None:
    """Raises BuildError where no picture can be written: before the render, not after it."""
    try:
        picture.parent.mkdir(parents=True, exist_ok=True)
        picture.unlink(missing_ok=True)
        picture.touch(exist_ok=False)
        picture.unlink()
    except OSError as error:
        reason = error.strerror if picture.parent.is_dir() else f"{picture.parent} is no folder"
        raise BuildError(f"--output: {picture} cannot be written: {reason}") from None


def settings_of(options: RenderOptions) -> dict[str, int | float]:
    """What takes the place of the file's own settings, by the names of render_blend.py's options."""
    asked = {name: getattr(options, name) for name in ("samples", "resolution", "frame")}
    settings: dict[str, int | float] = {name: value for name, value in asked.items() if value is not None}
    if options.scene is not None or options.full:
        return settings
    quick = QuickLook()
    settings.setdefault("resolution", quick.resolution)
    if "samples" not in settings:
        settings |= {"samples": quick.samples, "seconds": quick.seconds}
    return settings


def render(blender: str | None, options: RenderOptions) -> None:
    scene = options.scene or DEFAULT_SCENE
    if not scene.exists():
        raise BuildError(f"{scene}: no such file; the scenes are blend_scenes/*.blend")
    stem = options.output or BUILD / "renders" / scene.stem
    if stem.suffix.lower() in PICTURE_SUFFIXES:
        stem = stem.with_suffix("")
    pictures = [stem.with_name(stem.name + suffix) for suffix in PICTURE_SUFFIXES]
    for picture in pictures:
        make_room(picture)  # what stands there afterwards is this render's
    executable = setup(blender, ("build", "render"))
    build()
    settings = settings_of(options)
    words: list[str | Path] = ["--scene", scene, "--output", stem]
    for name, value in settings.items():
        words += [f"--{name}", str(value)]
    if "seconds" in settings:
        say("A quick look at glimmervoid, two minutes on two cores; --full renders the picture that README.md shows.")
    started = time.monotonic()
    command = [*host_command(executable, RENDER_SCRIPT), *words]
    status = watch(command, rendering, env=host_environment(BUILD / "profile", executable))
    if status != 0 or not all(picture.exists() for picture in pictures):
        raise BuildError(f"no picture of {scene}; Blender's exit status is {status} and its reason stands above")
    say(f"Rendered in {time.monotonic() - started:.1f} s:")
    for picture in pictures:
        say(f"  {picture}")


def test(blender: str | None, full: bool, extra: Sequence[str]) -> None:
    executable = setup(blender, ("build", "render", "test"))
    build()
    python = virtual_environment("test")
    env = {
        **own_python_first(executable),
        "GLIMMER_BIN": str(COMMAND),
        "GLIMMER_LIB_DIR": str(LIBRARY.parent),
        "GLIMMER_BPY_PYTHON": str(virtual_environment("bpy")),
    }
    if executable is not None:
        env["GLIMMER_BLENDER"] = str(executable)
    if not extra:  # some tests alone take the newest Blender as it is, if it was made, and one process
        env |= newest_host()
        extra = ["--numprocesses", str(os.cpu_count() or 1), "--dist", "loadfile"]
    run([python, "-m", "pytest", *(["--full"] if full else []), *extra], env=env)


def lint() -> None:
    """Every check runs, also after one has failed."""
    install_packages(wanted_packages(("build", "test"), None))
    python = virtual_environment("test")
    sources = sorted(path for suffix in ("cpp", "h", "inl", "c") for path in ENGINE.rglob(f"*.{suffix}"))
    checks: tuple[Sequence[str | Path], ...] = (
        [python, "-m", "ruff", "check", ROOT],
        [python, "-m", "ruff", "format", "--check", ROOT],
        [python, "-m", "mypy", "build.py", "addon", "blend_scenes", "engine", "tests"],
        ["clang-format", "--dry-run", "-Werror", *sources],
    )
    failures = []
    for check in checks:
        say(f"-- {shlex.join(str(word) for word in check[:5])}")
        try:
            run(check)
        except BuildError as error:
            failures.append(shlex.join(str(word) for word in check[:5]))
            if "not installed" in str(error):
                raise
    say("-- compiler warnings")
    build()  # with -Wall -Wextra -Wconversion -Werror
    if failures:
        raise BuildError("lint found faults, printed above: " + "; ".join(failures))


PEERS = ("mitsuba", "luxcore")


@dataclass(frozen=True)
class BenchOptions:
    quick: bool
    cycles: bool
    scenes: str | None
    peers: Sequence[str]
    output: Path | None
    tuning: str | None


def bench(blender: str | None, given: BenchOptions) -> None:
    executable = setup(blender, ("build", "render", "test", *given.peers))
    if executable is None:
        raise BuildError("the benchmark needs a Blender: it exports the scenes, and Cycles runs in it")
    if given.tuning is not None:
        tune(given.tuning, given.scenes, executable)
        return
    build()
    options = [*(["--quick"] if given.quick else []), *([] if given.cycles else ["--no-cycles"])]
    options += ["--scenes", given.scenes] if given.scenes is not None else []
    said = ["python3", "build.py", "bench", *options]
    if given.peers:
        said += ["--peers", ",".join(given.peers)]
    if given.output is not None:
        said += [
            "--output",
            str(given.output.relative_to(ROOT) if given.output.is_relative_to(ROOT) else given.output.name),
        ]
    command: list[str | Path] = [virtual_environment("bench"), "-m", "tests.bench", *options]
    for peer in given.peers:
        command += ["--peer", f"{peer}={virtual_environment(peer)}"]
    command += ["--glimmer", COMMAND, "--blender", executable, "--output", given.output or BUILD / "bench"]
    run([*command, "--said", shlex.join(said)], env=host_environment(BUILD / "profile", executable))


def tune(name: str, scenes: str | None, blender: Path) -> None:
    """Varies one constant of the engine in a build that reads its constants from the environment."""
    build("tunable")
    command: list[str | Path] = [virtual_environment("bench"), "-m", "tests.bench.tuning", name]
    command += ["--scenes", scenes] if scenes is not None else []
    command += ["--glimmer", BUILD / "tunable" / "bin" / "glimmer", "--blender", blender]
    run([*command, "--output", BUILD / "bench" / "tuning"], env=host_environment(BUILD / "profile", blender))


@dataclass(frozen=True)
class CompareOptions:
    scene: Path
    width: int
    samples: int
    timeout: int
    step_rate: float | None
    single: bool
    output: Path | None


def compare(blender: str | None, options: CompareOptions) -> None:
    if not options.scene.exists():
        raise BuildError(f"{options.scene}: no such file")
    executable = setup(blender, ("build", "render", "test"))
    build()
    host = script_runner(executable, "--disable-autoexec")
    sizes = [f"--{name}={getattr(options, name)}" for name in ("width", "samples", "timeout")]
    sizes += [f"--step-rate={options.step_rate}"] if options.step_rate is not None else []
    sizes += ["--single"] if options.single else []
    said = shlex.join(["python3", "build.py", "compare", options.scene.name, *sizes])
    output = options.output or BUILD / "compare" / options.scene.stem
    command: list[str | Path] = [virtual_environment("test"), "-m", "tests.bench.compare", options.scene, *sizes]
    command += ["--output", output, "--said", said, "--", *host]
    run(command, env=host_environment(BUILD / "profile", executable))


def claims(blender: str | None, seeds: int) -> None:
    executable = setup(blender, ("build", "render", "test"))
    if executable is None:
        raise BuildError("the scenes are exported by a Blender; there is none")
    build()
    command: list[str | Path] = [virtual_environment("bench"), "-m", "tests.bench.claims", "--seeds", str(seeds)]
    run([*command, "--glimmer", COMMAND, "--blender", executable], env=host_environment(BUILD / "profile", executable))


@dataclass(frozen=True)
class CheckOptions:
    quick: bool
    integrator: str
    only: str | None
    cycles: bool
    report: Path | None


def check(blender: str | None, options: CheckOptions) -> None:
    executable = setup(blender, ("build", "render", "test")) if options.cycles else None
    if options.cycles and executable is None:
        raise BuildError("--cycles needs a Blender, in which Cycles runs")
    install_packages(wanted_packages(("build", "test"), None))
    build()
    words = ["--quick"] if options.quick else []
    words += ["--integrator", options.integrator] if options.integrator != "path" else []
    words += ["--only", options.only] if options.only is not None else []
    said = ["python3", "build.py", "check", *words, *(["--cycles"] if options.cycles else [])]
    command: list[str | Path] = [virtual_environment("test"), "-m", "tests.check", *words]
    command += ["--cycles", executable] if executable is not None else []
    command += ["--report", options.report] if options.report is not None else []
    run([*command, "--said", shlex.join(said)], env=own_python_first(executable))


def virtual_environment_of_farm() -> None:
    install_packages(["python3-venv", "ca-certificates"])
    virtual_environment("farm")


def farm(words: Sequence[str]) -> None:
    """One frame over many machines: `build/bin/glimmer farm`, and before it what that needs."""
    if {"-h", "--help"} & set(words):
        farm_command.arguments("build.py farm").print_help()
        return
    install_packages(wanted_packages(("build",), None))
    virtual_environment_of_farm()
    build()
    status = subprocess.run([str(COMMAND), "farm", *words], check=False).returncode
    if status != 0:
        sys.exit(status)


def addon_version() -> str:
    found = re.search(r'^version\s*=\s*"([^"]+)"', (ADDON / "blender_manifest.toml").read_text(), re.MULTILINE)
    if not found:
        raise BuildError(f"{ADDON / 'blender_manifest.toml'}: no version")
    return found.group(1)


def package() -> Path:
    """One zip that installs as an add-on (3.4 on) and as an extension (4.2 on). The same files give the same bytes."""
    install_packages(wanted_packages(("engine",), None))
    build(target="glimmer")
    files = {
        f"glimmer/{path.relative_to(ADDON).as_posix()}": path
        for path in ADDON.rglob("*")
        if path.is_file() and "__pycache__" not in path.parts and path.suffix != ".pyc" and path.parent != ADDON / "lib"
    }
    files["glimmer/LICENSE"] = ROOT / "LICENSE"
    files["glimmer/lib/libglimmer.so"] = LIBRARY
    files["glimmer/lib/LICENSE.embree"] = BUILD / "embree" / "LICENSE.txt"
    target = BUILD / "dist" / f"glimmer-{addon_version()}-linux-{platform.machine()}.zip"
    target.parent.mkdir(parents=True, exist_ok=True)
    partial = target.with_suffix(".partial")
    with zipfile.ZipFile(partial, "w", zipfile.ZIP_DEFLATED) as archive:
        for name in sorted(files):
            entry = zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0))
            entry.external_attr = 0o644 << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(entry, files[name].read_bytes())
    partial.replace(target)
    say(str(target))
    return target


def clean() -> None:
    shutil.rmtree(BUILD, ignore_errors=True)


# ---- The command line --------------------------------------------------------------------------------------------


def arguments() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="build.py",
        description="Sets up, builds, renders, tests and packages Glimmer.",
        epilog="Start with `python3 build.py render`: it installs what is missing, builds and renders a picture.\n"
        "Everything it makes stands under build/. `build.py COMMAND --help` tells more.",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    commands = parser.add_subparsers(dest="command", metavar="COMMAND", required=True)
    with_blender = argparse.ArgumentParser(add_help=False)
    with_blender.add_argument(
        "--blender",
        metavar="PATH",
        help="the Blender to use (default: the one on PATH, else Debian's, else the bpy wheel); "
        "`render` and `compare` also take the python of an environment with a bpy module",
    )

    def command(name: str, text: str, blender: bool = False) -> argparse.ArgumentParser:
        return commands.add_parser(name, help=text, description=text, parents=[with_blender] if blender else [])

    item = command("setup", "Install what building and rendering need, and is missing (apt).", blender=True)
    item.add_argument("--test", action="store_true", help="also what `test` and `lint` need")
    item.add_argument("--farm", action="store_true", help="also what `build/bin/glimmer farm` needs: Dask")
    item = command("build", "Compile the engine; leaves build/bin/glimmer and build/lib/libglimmer.so.")
    item.add_argument("--preset", default="release", choices=("release", "debug", "asan", "tsan", "fuzz"))
    quick = QuickLook()
    item = command(
        "render",
        "Render a .blend with Glimmer in Blender; writes a PNG and an EXR. A file that is named is rendered with its "
        f"own settings. Without one it is a quick look at {DEFAULT_SCENE.relative_to(ROOT)}: {quick.resolution} "
        f"percent of its size and {quick.samples} samples a pixel, or as many as {quick.seconds / 60:g} minutes allow.",
        blender=True,
    )
    item.add_argument("scene", nargs="?", type=Path, metavar="FILE.blend", help="rendered with its own settings")
    item.add_argument(
        "--full",
        action="store_true",
        help="glimmervoid as its file has it, the picture that README.md shows: a quarter of an hour on two cores",
    )
    item.add_argument(
        "-o",
        "--output",
        type=Path,
        metavar="STEM",
        help="of STEM.png and STEM.exr (default: build/renders/SCENE)",
    )
    item.add_argument("--samples", type=int, metavar="N", help="samples a pixel, in place of those above")
    item.add_argument("--resolution", type=int, metavar="PERCENT", help="of the file's resolution, 1 to 100")
    item.add_argument("--frame", type=int, metavar="N", help="in place of the file's current frame")
    item = command("test", "Run the test suite.", blender=True)
    item.add_argument("--full", action="store_true", help="also the long tests, marked `full`")
    item.add_argument("extra", nargs="*", metavar="-- ARGUMENT", help="handed to pytest, as in `test -- -k sphere`")
    item = command(
        "bench",
        "Measure error against run time, ours and Cycles', and write a page on it. Finished runs are kept under "
        "build/bench/runs, so that the same command goes on where it was broken off.",
        blender=True,
    )
    item.add_argument("--quick", action="store_true", help="a smaller picture and fewer repetitions: five minutes")
    item.add_argument("--no-cycles", action="store_true", help="leave Cycles out")
    item.add_argument("--scenes", metavar="NAME,...", help="some of its scenes (default: all six)")
    item.add_argument(
        "--tuning",
        metavar="NAME",
        help="instead, vary one constant of engine/src/integrator/vpl/tuning.h and print variance x CPU time",
    )
    item.add_argument(
        "--peers",
        type=lambda text: text.split(","),
        default=[],
        metavar="NAME,...",
        help="also mitsuba, luxcore or both, fetched from PyPI into build/venv; may take an hour",
    )
    item.add_argument(
        "-o", "--output", type=Path, metavar="FOLDER", help="for the page and its plot (default: build/bench)"
    )
    item = command(
        "compare",
        "Render a .blend by Cycles and by Glimmer; write a page with both pictures, where they differ beyond noise, "
        "and what Glimmer says of it.",
        blender=True,
    )
    item.add_argument("scene", type=Path, metavar="FILE.blend", help="its scripts are not run")
    item.add_argument("--width", type=int, default=240, metavar="PIXELS", help="of the pictures (default: 240)")
    item.add_argument("--samples", type=int, default=64, metavar="N", help="samples a pixel of each (default: 64)")
    item.add_argument("--timeout", type=int, default=3600, metavar="SECONDS", help="for each engine (default: 3600)")
    item.add_argument(
        "--step-rate",
        type=float,
        metavar="RATE",
        help="of Cycles in volumes that vary, 0.01 for its shortest steps (default: the file's)",
    )
    item.add_argument(
        "--single",
        action="store_true",
        help="Cycles renders no objects and faces that lie on others: in Cycles they shade each other",
    )
    item.add_argument("-o", "--output", type=Path, metavar="FOLDER", help="(default: build/compare/FILE)")
    item = command(
        "claims",
        "Render three scenes many times; print what renders say of their error beside the error that they made. "
        "Finished ones are kept under build/bench/claims.",
        blender=True,
    )
    item.add_argument("--seeds", type=int, default=64, metavar="N", help="so many renders of each (default: 64)")
    item = command(
        "check", "Render stiff and extreme scenes whose pictures are known by a formula; print a table.", True
    )
    item.add_argument("--quick", action="store_true", help="the short tier, which the tests run too")
    item.add_argument("--integrator", choices=("path", "baseline"), default="path")
    item.add_argument("--only", metavar="TEXT", help="the cases whose name holds it")
    item.add_argument("--cycles", action="store_true", help="the cases that Cycles can express, in both")
    item.add_argument(
        "--report",
        type=Path,
        metavar="FOLDER",
        help="also write check.md and check.json there; extremes.md of --cycles",
    )
    item = commands.add_parser(
        "farm",
        help="Render one frame by many machines, or be one of them: `glimmer farm`, and before it what that needs.",
        add_help=False,
        prefix_chars="\0",  # its words are the package's, options and all
    )
    item.add_argument("words", nargs="*")
    command("lint", "Check style, types and compiler warnings: ruff, mypy, clang-format, -Werror.")
    command("package", "Make the add-on's zip, with the library inside; prints its path.")
    command("clean", "Remove build/.")
    return parser


def positive(parser: argparse.ArgumentParser, name: str, value: int | None, most: int) -> None:
    if value is not None and not 1 <= value <= most:
        parser.error(f"--{name} {value}: must be from 1 to {most}")


def main(argv: Sequence[str]) -> int:
    parser = arguments()
    given = parser.parse_args(argv)
    try:
        if given.command == "setup":
            setup(given.blender, ("build", "render", "test") if given.test else ("build", "render"))
            if given.test:
                newest_host()
            if given.farm:
                virtual_environment_of_farm()
        elif given.command == "build":
            install_packages(wanted_packages(("build",), None))
            build(given.preset)
        elif given.command == "render":
            positive(parser, "samples", given.samples, 1 << 30)
            positive(parser, "resolution", given.resolution, 100)
            output = given.output.absolute() if given.output else None
            scene = given.scene.absolute() if given.scene else None
            render(
                given.blender,
                RenderOptions(scene, output, given.samples, given.resolution, given.frame, given.full),
            )
        elif given.command == "test":
            test(given.blender, given.full, given.extra)
        elif given.command == "compare":
            positive(parser, "width", given.width, 1 << 15)
            positive(parser, "samples", given.samples, 1 << 20)
            output = given.output.absolute() if given.output else None
            scene = given.scene.absolute()
            if given.step_rate is not None and not 0.01 <= given.step_rate <= 100.0:
                parser.error(f"--step-rate {given.step_rate:g}: must be from 0.01 to 100")
            sizes = given.width, given.samples, given.timeout
            compare(given.blender, CompareOptions(scene, *sizes, given.step_rate, given.single, output))
        elif given.command == "claims":
            claims(given.blender, given.seeds)
        elif given.command == "bench":
            output = given.output.absolute() if given.output else None
            unknown = sorted(set(given.peers) - set(PEERS))
            if unknown:
                parser.error(f"--peers {', '.join(unknown)}: must be of {', '.join(PEERS)}")
            bench(
                given.blender,
                BenchOptions(given.quick, not given.no_cycles, given.scenes, given.peers, output, given.tuning),
            )
        elif given.command == "check":
            report = given.report.absolute() if given.report else None
            check(given.blender, CheckOptions(given.quick, given.integrator, given.only, given.cycles, report))
        elif given.command == "farm":
            farm(given.words)
        elif given.command == "lint":
            lint()
        elif given.command == "package":
            package()
        elif given.command == "clean":
            clean()
    except BuildError as error:
        sys.stderr.write(f"build.py: {error}\n")
        return 1
    except KeyboardInterrupt:
        return 130
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
