# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the host of the tests that is not pinned: the newest bpy wheel there is, in the Python that it wants.

Debian 12 has no such Python. Where none is on PATH, it comes from a later Debian: its packages and all that they need,
the C library too, are unpacked into a folder, and a script starts it there by the loader that came along. That takes
neither root nor a chroot nor a container, and changes nothing of the machine. Libraries that the folder lacks (those
of X, say) are the machine's.

Imported by build.py: standard library only.
"""

import os
import re
import shlex
import shutil
import subprocess
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

# Pythons that bpy wheels want or may want next, each with a release of Debian that has it.
RELEASES = {"3.13": "trixie", "3.14": "forky"}
KEYRING = Path("/usr/share/keyrings/debian-archive-keyring.gpg")
MIRROR = "http://deb.debian.org/debian"
SECONDS_OF_A_COMMAND = 600
SECONDS_BETWEEN_LOOKS = 24 * 3600


class UnavailableError(Exception):
    """Why the host cannot be made, in one line."""


@dataclass(frozen=True)
class Wheel:
    """A bpy of the index and the Python that it is for."""

    version: str
    python: str

    def __str__(self) -> str:
        return f"bpy {self.version} in Python {self.python}"


def make(folder: Path, requirements: Path, pip: Sequence[str | Path], say: Callable[[str], None]) -> Path:
    """The host's python in `folder`, made when it is missing and when a newer wheel is there, for which the index is
    asked once a day. `pip` is the command of any pip. Raises UnavailableError; a host that was made once is kept when
    it cannot be renewed.
    """
    python = folder / "venv" / "bin" / "python"
    made = folder / "made"
    known = made.read_text() if made.exists() else ""
    if known and time.time() - made.stat().st_mtime < SECONDS_BETWEEN_LOOKS:
        say(f"The newest Blender: {known}")
        return python
    started = time.monotonic()
    try:
        wheel = newest_wheel(pip)
        if known != str(wheel):
            made.unlink(missing_ok=True)
            install(wheel, folder, requirements)
        made.write_text(str(wheel))
    except UnavailableError as error:
        if not made.exists():
            raise
        say(f"The newest Blender: {known}; whether there is a newer one could not be found out: {error}")
        return python
    say(f"The newest Blender: {wheel}, ready after {time.monotonic() - started:.0f} s")
    return python


def newest_wheel(pip: Sequence[str | Path]) -> Wheel:
    """The newest of the index that any of the Pythons can take."""
    found = []
    reason = ""
    for python in RELEASES:
        words = [*pip, "index", "versions", "bpy", "--python-version", python, "--disable-pip-version-check"]
        try:
            version = re.match(r"bpy \(([\d.]+)\)", output_of(words))
        except UnavailableError as error:  # no network, or no wheel for this Python
            reason = str(error)
            continue
        if version is not None:
            found.append(Wheel(version.group(1), python))
    if not found:
        raise UnavailableError(f"the package index has no bpy for Python {', '.join(RELEASES)} ({reason})")
    return max(found, key=lambda wheel: [int(part) for part in wheel.version.split(".")])


def install(wheel: Wheel, folder: Path, requirements: Path) -> None:
    """A virtual environment with what the requirements name."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    venv = folder / "venv"
    python = venv / "bin" / "python"
    on_path = python_on_path(wheel.python)
    if on_path is not None:
        output_of([on_path, "-m", "venv", venv])
    else:
        debian = unpack_debian(wheel.python, folder / "debian")
        output_of([debian.python, "-m", "venv", "--without-pip", venv])
        wheels = debian.wheels  # ensurepip looks for them in /usr/share
        pip = next(wheels.glob("pip-*.whl")) / "pip"
        output_of([python, pip, "install", "--quiet", "--no-index", "--find-links", wheels, "pip"])
    # Bytecode of what nobody imports would take longer than the rest.
    options = ("--quiet", "--no-compile", "--no-input", "--disable-pip-version-check")
    output_of([python, "-m", "pip", "install", *options, "--requirement", requirements])
    probe = "import bpy, sys; print('VERSION', *bpy.app.version, sep='.')"
    output = output_of([python, "-c", probe])
    if f"VERSION.{wheel.version}" not in output:
        raise UnavailableError(f"{wheel} was to be installed; there is {output.strip()}")


def python_on_path(version: str) -> str | None:
    """A Python of this version that can make virtual environments, if PATH has one that runs."""
    python = shutil.which(f"python{version}")
    if python is None:
        return None
    result = subprocess.run([python, "-c", "import venv, ensurepip"], capture_output=True, check=False)
    return python if result.returncode == 0 else None


@dataclass(frozen=True)
class DebianPython:
    python: Path
    wheels: Path  # folder with that of pip


def unpack_debian(version: str, folder: Path) -> DebianPython:
    """Python `version` of a later Debian, below `folder`."""
    if shutil.which("apt-get") is None:
        raise UnavailableError(f"there is no Python {version} on PATH, and no apt to get one from Debian")
    root, apt = folder / "root", folder / "apt"
    for part in ("lists/partial", "archives/partial"):
        (apt / part).mkdir(parents=True)
    (apt / "status").touch()  # as if nothing was installed: everything that Python needs is fetched
    signed = f"[signed-by={KEYRING}] " if KEYRING.exists() else ""
    (apt / "sources.list").write_text(f"deb {signed}{mirror()} {RELEASES[version]} main\n")
    options: dict[str, str | Path] = {
        "Dir::State": apt,
        "Dir::State::status": apt / "status",
        "Dir::Cache": apt,
        "Dir::Etc::sourcelist": apt / "sources.list",
        "Dir::Etc::sourceparts": "/dev/null",
        "Dir::Etc::preferences": "/dev/null",
        "Dir::Etc::preferencesparts": "/dev/null",
        "APT::Sandbox::User": "",  # which might not be able to enter our folder
        "Acquire::Languages": "none",
        "Acquire::Retries": "3",
    }
    command = ["apt-get", "--quiet", *(f"--option={name}={value}" for name, value in options.items())]
    output_of([*command, "--error-on=any", "update"])
    output_of([*command, "--yes", "--no-install-recommends", "--download-only", "install", f"python{version}-venv"])
    for package in sorted((apt / "archives").glob("*.deb")):
        output_of(["dpkg-deb", "--extract", package, root])
    shutil.rmtree(apt)
    return DebianPython(starter(root, version), root / "usr" / "share" / "python-wheels")


def starter(root: Path, version: str) -> Path:
    """A script beside the Python that runs it on the libraries of `root`. Python takes the script for itself, and so
    finds its modules, and itself for the processes that it starts.
    """
    library = next(root.glob("usr/lib/*/libc.so.6")).parent
    loader = next(library.glob("ld-linux*.so.*"))
    program = root / "usr" / "bin" / f"python{version}"
    script = program.with_name("python")
    words = [shlex.quote(str(path)) for path in (loader, library, program)]
    script.write_text('#!/bin/sh\nexec {} --argv0 "$0" --library-path {} {} "$@"\n'.format(*words))
    script.chmod(0o755)
    return script


def mirror() -> str:
    """The mirror of Debian that this machine uses."""
    words = ["apt-get", "indextargets", "--format", "$(ORIGIN) $(CODENAME) $(REPO_URI)", "Created-By: Packages"]
    lines = subprocess.run(words, capture_output=True, text=True, check=False).stdout.splitlines()
    found = [line.split()[2] for line in lines if re.match(r"Debian [a-z]+ \S", line)]  # not bookworm-updates
    return found[0] if found else MIRROR


def output_of(command: Sequence[str | Path]) -> str:
    words = [str(word) for word in command]
    env = {**os.environ, "DEBIAN_FRONTEND": "noninteractive"}
    try:
        result = subprocess.run(
            words, env=env, capture_output=True, text=True, check=False, timeout=SECONDS_OF_A_COMMAND
        )
    except (OSError, subprocess.TimeoutExpired) as error:
        raise UnavailableError(str(error)) from None
    if result.returncode != 0:
        lines = [line.strip() for line in (result.stdout + result.stderr).splitlines() if line.strip()]
        told = [line for line in lines if re.match(r"(E|ERROR|\w*Error): ?", line)] or lines
        raise UnavailableError(f"{told[-1] if told else 'no word'} (from: {shlex.join(words)[:200]})")
    return result.stdout
