# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders a .blend by Cycles and by Glimmer and writes a page: where the two pictures differ beyond noise, and why.

`python3 build.py compare FILE.blend` runs this as `python -m tests.bench.compare` from the root of the checkout. The
engines run one after the other, each in a process of its own, so that memory and CPU time are each one's own.
"""

import argparse
import html
import json
import re
import subprocess
import sys
import tempfile
import zlib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

ENGINES = ("CYCLES", "GLIMMER")
NAMES = {"CYCLES": "Cycles", "GLIMMER": "Glimmer"}
SEEDS = 6  # renders by each engine; their spread is the noise
BLOCK = 12  # pixels
TOLERANCE = 0.05  # of the display range: what a block may differ and the picture is still the same
SIGMAS = 3.0  # of noise that are taken off a difference
_SCRIPT = Path(__file__).with_name("inside_compare.py")
_STANDS_OUT = 4.0  # by which the page's picture of the difference is multiplied

Values = NDArray[np.floating]


class CompareError(Exception):
    """Why there is no page, in words."""


@dataclass(frozen=True)
class Rendered:
    """By one engine, bottom row first."""

    linear: Values  # (seeds, height, width, 3)
    mean: Values  # (height, width, 3): of the seeds, as shown
    without: Values  # (seeds, height, width, 3): the mean without each of them, as shown
    cpu: float  # seconds of all seeds
    peak_bytes: int  # of Blender's process
    notices: tuple[str, ...]
    version: str


@dataclass(frozen=True)
class Verdict:
    ratio: float  # of the means, Glimmer / Cycles
    least: float  # of the blocks' ratios
    largest: float
    beyond: Values  # (rows, columns, 3): signed difference of each block beyond noise, of the display range
    noise: float  # the median standard error of a block's difference

    @property
    def apart(self) -> int:
        """Blocks that differ by more than the tolerance."""
        return int((np.abs(self.beyond).max(axis=-1) > TOLERANCE).sum())


def blocks_of(pictures: Values, size: int = BLOCK) -> Values:
    """(..., height, width, 3) -> (..., rows, columns, 3) of means; smaller blocks at the far edges."""
    height, width = pictures.shape[-3:-1]
    rows, columns = np.arange(0, height, size), np.arange(0, width, size)
    sums = np.add.reduceat(np.add.reduceat(pictures.astype(np.float64), rows, axis=-3), columns, axis=-2)
    counts = np.diff([*rows, height])[:, None] * np.diff([*columns, width])[None, :]
    return np.asarray(sums / counts[..., None])


def shown_blocks(item: Rendered) -> tuple[Values, Values]:
    """(rows, columns, 3) each: the means of blocks as shown, and their variances, by the jackknife.

    A view transform is no straight line: the mean of noisy pixels that went through it is not what it makes of their
    mean. So it is applied to means of all seeds, and what is left of the noise's effect there is taken off."""
    count = len(item.linear)
    pseudo = count * blocks_of(item.mean) - (count - 1) * blocks_of(item.without)
    return pseudo.mean(axis=0), pseudo.var(axis=0, ddof=1) / count


def judge(cycles: Rendered, glimmer: Rendered) -> Verdict:
    """Blocks are compared as shown, and their ratios in linear light."""
    (first, first_variance), (second, second_variance) = (shown_blocks(item) for item in (cycles, glimmer))
    variance = first_variance + second_variance
    # A few seeds may agree by luck: no block is taken to be quieter than half of the others are.
    error = np.sqrt(np.maximum(variance, np.median(variance)))
    difference = second - first
    beyond = np.sign(difference) * np.maximum(np.abs(difference) - SIGMAS * error, 0.0)
    light = [blocks_of(item.linear).mean(axis=(0, -1)) for item in (cycles, glimmer)]
    floor = 1e-3 * max(float(light[0].mean()), 1e-9)
    ratios = (light[1] + floor) / (light[0] + floor)
    means = [float(item.linear.mean(dtype=np.float64)) for item in (cycles, glimmer)]
    ratio = means[1] / means[0] if means[0] else float("nan")
    return Verdict(ratio, float(ratios.min()), float(ratios.max()), beyond, float(np.median(error)))


def png(pixels: Values) -> bytes:
    """(height, width, 3) of 0 to 1, top row first."""
    rows = np.round(np.clip(pixels, 0.0, 1.0) * 255.0).astype(np.uint8)
    height, width = rows.shape[:2]

    def chunk(kind: bytes, data: bytes) -> bytes:
        return len(data).to_bytes(4, "big") + kind + data + zlib.crc32(kind + data).to_bytes(4, "big")

    header = width.to_bytes(4, "big") + height.to_bytes(4, "big") + bytes([8, 2, 0, 0, 0])
    lines = b"".join(b"\0" + row.tobytes() for row in rows)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(lines)) + chunk(b"IEND", b"")


def difference_picture(verdict: Verdict, height: int, width: int) -> Values:
    """Grey where the engines agree within noise; red where Glimmer is brighter, blue where Cycles is."""
    signed = verdict.beyond.mean(axis=-1).repeat(BLOCK, axis=0).repeat(BLOCK, axis=1)[:height, :width]
    amount = np.clip(_STANDS_OUT * np.abs(signed), 0.0, 1.0)
    target = np.where(signed[..., None] > 0.0, [0.9, 0.1, 0.1], [0.1, 0.2, 0.9])
    return np.asarray((0.5 + amount[..., None] * (target - 0.5))[::-1])


def verdict_line(verdict: Verdict) -> str:
    count = verdict.beyond.shape[0] * verdict.beyond.shape[1]
    same = "the same picture" if verdict.apart == 0 else f"{verdict.apart} of {count} blocks differ"
    ratios = f"ratio of the means {verdict.ratio:.3f}, of the blocks {verdict.least:.2f} to {verdict.largest:.2f}"
    return f"{same}; {ratios}"


def page(file: Path, rendered: dict[str, Rendered], verdict: Verdict, said: str) -> str:
    cycles, glimmer = rendered["CYCLES"], rendered["GLIMMER"]
    figures = "".join(
        f'<figure><img src="{name}.png" alt="{title}"><figcaption>{title}</figcaption></figure>\n'
        for name, title in (("CYCLES", "Cycles"), ("GLIMMER", "Glimmer"), ("difference", "Difference beyond noise"))
    )
    rows = "".join(
        f"<tr><td>{NAMES[engine]}</td><td>{item.linear.mean():.5g}</td><td>{item.cpu:.1f}</td>"
        f"<td>{item.peak_bytes / 2**20:.0f}</td></tr>\n"
        for engine, item in rendered.items()
    )
    notices = "".join(f"<li>{html.escape(line)}</li>\n" for line in (*cycles.notices, *glimmer.notices))
    title = html.escape(file.name)
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<title>{title}: Glimmer beside Cycles</title>
<style>
body {{ font-family: sans-serif; max-width: 80em; margin: 2em auto; }}
figure {{ display: inline-block; margin: 0 1em 1em 0; }}
img {{ image-rendering: pixelated; width: 25em; }}
td, th {{ padding: 0 1em; text-align: right; }}
</style>
</head>
<body>
<h1>{title}</h1>
<p>{html.escape(verdict_line(verdict))}.</p>
{figures}
<table>
<tr><th>Engine</th><th>Mean</th><th>CPU seconds</th><th>Memory, MB</th></tr>
{rows}</table>
<h2>What is known of differences</h2>
<ul>
{notices or "<li>nothing</li>"}</ul>
<h2>How</h2>
<p>Made by <code>{html.escape(said)}</code> with Blender {html.escape(cycles.version)}. {len(cycles.linear)} renders by
each engine, whose CPU seconds are added up; memory is the peak of Blender's process. Cycles with many bounces, without
clamping, denoiser, adaptive sampling and compositor. Blocks of {BLOCK} pixels are compared as the file's view
transform shows them; {SIGMAS:g} standard errors of their difference count as noise (their median is
{verdict.noise:.2g}), and a block differs where more than {TOLERANCE:.0%} of the display's range is left. Red: Glimmer
is brighter; blue: Cycles.</p>
</body>
</html>
"""


def reason(result: subprocess.CompletedProcess[str], told: Path, file: str) -> str:
    """Why Blender made none: in its own words, or how it ended."""
    if told.exists():
        return told.read_text()
    saved_by = blend_version(Path(file))
    by = f" ({Path(file).name} was saved by Blender {saved_by})" if saved_by else ""
    last = (result.stdout + result.stderr)[-1500:]
    return f"Blender ended with status {result.returncode}{by}. Its last words:\n{last}"


def blend_version(file: Path) -> str:
    """Of the Blender that saved a file that is not compressed, as "3.4"; "" where the file does not say."""
    with file.open("rb") as stream:
        found = re.match(rb"BLENDER[-_][vV](\d)(\d\d)|BLENDER\d\d-\d\dv(\d\d)(\d\d)", stream.read(17))
    if not found:
        return ""
    major, minor = (part for part in found.groups() if part is not None)
    return f"{int(major)}.{int(minor)}"


def render(command: Sequence[str], engine: str, job: dict[str, Any], timeout: float) -> Rendered:
    folder = Path(job["folder"])
    path = folder / "job.json"
    path.write_text(json.dumps({**job, "engine": engine}))
    words = [*command, str(_SCRIPT), "--", str(path)]
    try:
        result = subprocess.run(words, capture_output=True, text=True, errors="replace", timeout=timeout, check=False)
    except subprocess.TimeoutExpired:
        raise CompareError(f"{NAMES[engine]} was not done after {timeout:g} s") from None
    if result.returncode != 0:
        raise CompareError(f"{NAMES[engine]} made no picture: {reason(result, folder / f'{engine}.txt', job['file'])}")
    told = json.loads((folder / f"{engine}.json").read_text())
    with np.load(folder / f"{engine}.npz") as arrays:
        linear, mean, without = arrays["linear"], arrays["mean"], arrays["without"]
    return Rendered(linear, mean, without, told["cpu"], told["peak_bytes"], tuple(told["notices"]), told["version"])


@dataclass(frozen=True)
class Options:
    width: int  # pixels
    samples: int  # a pixel, which the renders share
    step_rate: float | None = None  # of Cycles in volumes; None: the file's
    single: bool = False  # Cycles renders no objects and faces that lie on others


def compare(command: Sequence[str], file: Path, options: Options, output: Path, said: str, timeout: float) -> str:
    """Returns the verdict in a line."""
    output.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as scratch:
        job = {
            "file": str(file),
            "width": options.width,
            "samples": max(options.samples // SEEDS, 1),
            "seeds": SEEDS,
            "step_rate": options.step_rate,
            "single": options.single,
            "folder": scratch,
        }
        rendered = {engine: render(command, engine, job, timeout) for engine in ENGINES}
        for engine in ENGINES:
            (output / f"{engine}.png").write_bytes((Path(scratch) / f"{engine}.png").read_bytes())
    verdict = judge(rendered["CYCLES"], rendered["GLIMMER"])
    height, width = rendered["CYCLES"].linear.shape[1:3]
    (output / "difference.png").write_bytes(png(difference_picture(verdict, height, width)))
    (output / "index.html").write_text(page(file, rendered, verdict, said), encoding="utf-8")
    return verdict_line(verdict)


def main(argv: Sequence[str]) -> int:
    parser = argparse.ArgumentParser(prog="python -m tests.bench.compare", description=__doc__)
    parser.add_argument("file", type=Path)
    parser.add_argument("--width", type=int, required=True)
    parser.add_argument("--samples", type=int, required=True)
    parser.add_argument("--step-rate", type=float, help="of Cycles in volumes (default: the file's)")
    parser.add_argument("--single", action="store_true", help="Cycles renders nothing that lies on something else")
    parser.add_argument("--timeout", type=float, required=True, help="seconds for each engine")
    parser.add_argument("--output", type=Path, required=True, metavar="FOLDER")
    parser.add_argument("--said", required=True, metavar="COMMAND", help="how the user started this, for the page")
    parser.add_argument("host", nargs="+", help="the command that runs a script inside Blender, up to the script")
    given = parser.parse_args(argv)
    try:
        options = Options(given.width, given.samples, given.step_rate, given.single)
        line = compare(given.host, given.file, options, given.output, given.said, given.timeout)
    except CompareError as error:
        sys.stderr.write(f"compare: {error}\n")
        return 1
    sys.stdout.write(f"{given.file.name}: {line}\n{given.output / 'index.html'}\n")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
