# SPDX-License-Identifier: GPL-3.0-or-later
"""What the README and the pages beside it tell people to type works."""

import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

import build

ROOT = Path(__file__).resolve().parent.parent
README = ROOT / "README.md"
PAGES = (README, *sorted(ROOT.glob("engine/docs/*.md")), *sorted(ROOT.glob("addon/docs/*.md")))


def blocks_of(page: Path) -> list[tuple[str, str]]:
    return re.findall(r"^```(\w+)\n(.*?)^```$", page.read_text(), re.MULTILINE | re.DOTALL)


BLOCKS = [block for page in PAGES for block in blocks_of(page)]


def words_of(line: str) -> list[str]:
    return shlex.split(re.sub(r"(^|\s)#.*", "", line))  # shlex itself takes a # inside a word for a comment


def commands() -> list[list[str]]:
    lines = [line for language, text in BLOCKS if language == "sh" for line in text.splitlines()]
    return [words for line in lines if (words := words_of(line))]


def commands_of(program: str) -> list[list[str]]:
    return [words for words in commands() if words[0] == program]


def test_the_first_screen_has_exactly_the_two_commands() -> None:
    language, text = blocks_of(README)[0]
    assert language == "sh"
    readme = README.read_text()
    assert readme[: readme.index(text)].count("\n") < 20
    assert [words_of(line) for line in text.splitlines()] == [
        ["python3", "build.py", "render"],
        ["python3", "build.py", "test"],
    ]


def test_the_readme_is_short() -> None:
    assert len(README.read_text().splitlines()) < 120


def test_every_command_is_of_a_kind_that_a_test_here_tries() -> None:
    assert {words[0] for words in commands()} == {"python3", "build/bin/glimmer", "blender", "cc"}


@pytest.mark.parametrize("words", commands_of("python3"), ids=shlex.join)
def test_build_py_takes_the_arguments(words: list[str]) -> None:
    assert words[1] == "build.py"
    build.arguments().parse_args(words[2:])


@pytest.mark.parametrize("words", commands_of("build/bin/glimmer"), ids=shlex.join)
def test_the_command_line_does_what_it_says(words: list[str], glimmer_command: Path, tmp_path: Path) -> None:
    arguments = [str(ROOT / word) if word.startswith("engine/") else word for word in words[1:]]
    if "--spp" in words:
        arguments[arguments.index("--spp") + 1] = "4"
    command = [str(glimmer_command), *arguments]
    result = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False, timeout=280)
    assert result.returncode == 0, result.stderr
    for option in ("-o", "--report", "--curve"):
        if option in words:
            assert (tmp_path / words[words.index(option) + 1]).stat().st_size > 0


@pytest.mark.parametrize("words", commands_of("cc"), ids=shlex.join)
def test_the_c_example_compiles_and_runs(words: list[str], library_dir: Path, tmp_path: Path) -> None:
    assert library_dir.is_dir()
    (tmp_path / "engine").symlink_to(ROOT / "engine")
    (tmp_path / "build").mkdir()
    (tmp_path / "build" / "lib").symlink_to(library_dir)
    result = subprocess.run(
        shlex.join(words).replace("'&&'", "&&"),
        shell=True,
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
        timeout=120,
    )
    assert result.returncode == 0, result.stderr
    assert (tmp_path / "render.pfm").stat().st_size > 0


@pytest.mark.parametrize("words", commands_of("blender"), ids=shlex.join)
def test_blender_renders_headless(words: list[str], blender: Path, tmp_path: Path) -> None:
    picture = tmp_path / "frame_"
    smaller = "import bpy; s = bpy.context.scene; s.render.resolution_percentage = 5; s.glimmer.samples = 1"
    changed = [f"{picture}####" if word.startswith("//") else word for word in words[1:]]
    changed = [str(ROOT / word) if word.startswith("blend_scenes/") else word for word in changed]
    assert changed[-2:] == ["-f", "1"]
    command = [str(blender), *changed[:-2], "--python-exit-code", "1", "--python-expr", smaller, *changed[-2:]]
    env = build.host_environment(tmp_path / "profile", blender)
    result = subprocess.run(command, env=env, capture_output=True, text=True, check=False, timeout=280)
    assert result.returncode == 0, result.stdout[-3000:] + result.stderr[-3000:]
    assert (tmp_path / "frame_0001.png").read_bytes().startswith(b"\x89PNG")


def test_the_python_example_runs(library_dir: Path) -> None:
    """The other one, of farm.md, has tests/farm/test_command.py."""
    examples = [text for language, text in blocks_of(ROOT / "engine" / "docs" / "embedding.md") if language == "python"]
    assert len(examples) == 1 and len([language for language, _ in BLOCKS if language == "python"]) == 2
    env = {**os.environ, "GLIMMER_LIBRARY": str(library_dir / "libglimmer.so")}
    command = [sys.executable, "-c", examples[0]]
    result = subprocess.run(command, cwd=ROOT, env=env, capture_output=True, text=True, check=False, timeout=60)
    assert result.returncode == 0, result.stderr
    assert result.stdout.strip()


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_every_file_that_is_named_exists(page: Path) -> None:
    text = page.read_text()
    links = re.findall(r"\]\(([^)#:]+)", text)
    paths = re.findall(r"`((?:engine|addon|blend_scenes|tests|\.ci)/[\w./]*)`", text)
    assert links or paths or page != README
    assert [link for link in links if not (page.parent / link).exists()] == []
    assert [path for path in paths if not (ROOT / path).exists()] == []
