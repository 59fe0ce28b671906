# SPDX-License-Identifier: GPL-3.0-or-later
"""Arguments that are refused, each in one line, and what the command tells of itself."""

import re
from pathlib import Path

import pytest

from tests.engine.command.pictures import AOV_CHANNELS
from tests.engine.scenes import furnace, run_glimmer, write_scene

pytestmark = pytest.mark.usefixtures("glimmer_command")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ([], "glimmer: the scene file is missing"),
        (["scene.json"], "glimmer: -o OUT is missing; .exr, .png, .pfm and .hdr are allowed"),
        (["scene.json", "-o"], "glimmer: "),
        (["scene.json", "-o", "out.jpg"], '-o: "out.jpg" does not end in .exr, .png, .pfm or .hdr'),
        (["scene.json", "-o", "nowhere/out.exr"], '-o: "nowhere/out.exr": no such folder'),
        (["scene.json", "-o", "folder.exr"], '-o: "folder.exr" is a folder; a file is allowed'),
        (["scene.json", "-o", "out.exr", "--sppp", "4"], "glimmer: The following argument"),
        (["scene.json", "-o", "out.exr", "other.json"], "glimmer: The following argument was not expected: other.json"),
        (["scene.json", "-o", "out.exr", "--spp", "0"], '--spp: "0" is not an integer from 1 to 2147483647'),
        (["scene.json", "-o", "out.exr", "--spp=-4"], '--spp: "-4" is not an integer from 1 to 2147483647'),
        (["scene.json", "-o", "out.exr", "--spp", "4.5"], '--spp: "4.5" is not an integer from 1 to 2147483647'),
        (["scene.json", "-o", "out.exr", "--spp", "4x"], '--spp: "4x" is not an integer from 1 to 2147483647'),
        (["scene.json", "-o", "out.exr", "--spp", ""], '--spp: "" is not an integer from 1 to 2147483647'),
        (["scene.json", "-o", "out.exr", "--time", "0"], '--time: "0" is not a number above 0'),
        (["scene.json", "-o", "out.exr", "--time", "nan"], '--time: "nan" is not a number above 0'),
        (["scene.json", "-o", "out.exr", "--time", "inf"], '--time: "inf" is not a number above 0'),
        (["scene.json", "-o", "out.exr", "--error", "small"], '--error: "small" is not a number above 0'),
        (["scene.json", "-o", "out.exr", "--seed=-1"], '--seed: "-1" is not an integer from 0 to 18446744073709551615'),
        (["scene.json", "-o", "out.exr", "--threads", "0"], '--threads: "0" is not an integer from 1 to 4096'),
        (["scene.json", "-o", "out.exr", "--tile", "0"], '--tile: "0" is not an integer from 1 to 65536'),
        (
            ["scene.json", "-o", "out.exr", "--integrator", "p"],
            '--integrator: "p" is not an integrator; integrators are "path"',
        ),
        (["scene.json", "-o", "out.exr", "--aov", "depth,x"], '--aov: "x" is not an AOV; see glimmer --list-aovs'),
        (["scene.json", "-o", "out.exr", "--aov", "depth,"], '--aov: "" is not an AOV'),
        (["scene.json", "-o", "out.png", "--aov", "depth"], '--aov: "out.png" has no layers; only .exr has'),
        (["scene.json", "-o", "out.exr", "--report", "r.txt"], '--report: "r.txt" does not end in .json'),
        (["scene.json", "-o", "out.exr", "--curve", "c.pdf"], '--curve: "c.pdf" does not end in .csv or .png'),
        (["scene.json", "-o", "out.exr", "--checkpoint", "x/c"], '--checkpoint: "x/c": no such folder'),
        (
            ["scene.json", "-o", "out.exr", "--checkpoint-interval", "5"],
            "--checkpoint-interval: there is no --checkpoint FILE to save to",
        ),
        (
            ["scene.json", "-o", "out.exr", "--checkpoint", "c", "--checkpoint-interval", "0"],
            '--checkpoint-interval: "0" is not a number above 0',
        ),
        (["scene.json", "-o", "a.png", "--curve", "./a.png"], 'glimmer: "./a.png" is named twice'),
        (["scene.json", "-o", "out.exr", "--report", "scene.json"], 'glimmer: "scene.json" is named twice'),
        (["gone.json", "-o", "out.exr"], "gone.json: no such file"),
        (["merge"], "glimmer: "),
        (["merge", "a.exr", "-o", "c.exr"], 'merge: "a.exr" is one picture; two or more can be merged'),
        (["merge", "a.exr", "b.exr"], "glimmer: --output is required"),
        (["merge", "a.exr", "b.exr", "-o", "c.png"], '-o: "c.png" does not end in .exr'),
        (["merge", "a.exr", "b.exr", "-o", "c.exr"], "a.exr: no such file"),
        (["merge", "scene.json", "b.exr", "-o", "c.exr"], "scene.json: is not an .exr file"),
    ],
    ids=lambda value: " ".join(value) if isinstance(value, list) else "",
)
def test_bad_arguments(arguments: list[str], message: str, tmp_path: Path) -> None:
    write_scene(tmp_path, furnace())
    (tmp_path / "folder.exr").mkdir()
    before = sorted(tmp_path.iterdir())
    done = run_glimmer(*arguments, cwd=tmp_path)
    assert done.returncode == 1, done.stderr
    assert done.stderr.startswith(message)
    assert done.stderr.count("\n") == 1 and done.stderr.endswith("\n") and done.stdout == ""
    assert sorted(tmp_path.iterdir()) == before, "a failed run left files"


def test_information() -> None:
    version = run_glimmer("--version")
    assert version.returncode == 0 and re.fullmatch(r"glimmer \d+\.\d+\.\d+\n", version.stdout)
    usage = run_glimmer("--help")
    options = "--spp --time --error --integrator --seed --threads --tile --aov --checkpoint --checkpoint-interval"
    options += " --report --curve --quiet"
    assert usage.returncode == 0 and all(option in usage.stdout for option in options.split())
    assert "PICTURE A.exr B.exr ..." in run_glimmer("merge", "--help").stdout
    integrators = run_glimmer("--list-integrators").stdout.splitlines()
    names = [line.split()[0] for line in integrators]
    assert names[:2] == ["path", "baseline"] and all(name.startswith("path-no-") for name in names[2:])
    aovs = run_glimmer("--list-aovs").stdout.splitlines()
    assert [line.split()[0] for line in aovs] == list(AOV_CHANNELS)
