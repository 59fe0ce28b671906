# SPDX-License-Identifier: GPL-3.0-or-later
"""Submits the frames of a .blend to OpenCue: opencue_job.py FILE.blend OUTPUT FRAMES.

Needs OpenCue's packages opencue-pyoutline and opencue-pycue, and packaging; and CUEBOT_HOSTS, as all of its tools do.
FILE and OUTPUT must mean the same on every machine. OUTPUT is Blender's: /shows/demo/frame_####.
"""

import argparse
import shlex
import sys
from pathlib import PurePosixPath

import outline
import outline.cuerun
from outline.modules.shell import Shell


def frame_command(blender: str, addon: str, file: str, output: str, picture_format: str) -> str:
    """The command of one frame; OpenCue puts the frame's number in the place of #IFRAME#."""
    words = [blender, "-b", "--addons", addon, file, "-E", "GLIMMER", "-o", output, "-F", picture_format]
    return f"{shlex.join(words)} -f #IFRAME#"


def job(given: argparse.Namespace) -> outline.Outline:
    result = outline.Outline(given.name or PurePosixPath(given.file).stem, shot=given.shot, show=given.show)
    command = frame_command(given.blender, given.addon, given.file, given.output, given.format)
    # One frame a task: a failed task is then a failed frame, and its status tells which.
    layer = Shell("frames", command=command, range=given.frames, chunk=1, service="blender")
    layer.set_arg("cores", given.cores)
    layer.set_arg("threadable", True)
    result.add_layer(layer)
    return result


def main() -> None:
    parser = argparse.ArgumentParser(description="Submits the frames of a .blend, rendered by Glimmer, to OpenCue.")
    parser.add_argument("file", metavar="FILE.blend")
    parser.add_argument("output", metavar="OUTPUT", help="of Blender's -o, as /shows/demo/frame_####")
    parser.add_argument("frames", metavar="FRAMES", help="as 1-100 or 1,5,9-20")
    parser.add_argument("--name", help="of the job (default: the file's)")
    parser.add_argument("--show", default="testing")
    parser.add_argument("--shot", default="default")
    parser.add_argument(
        "--cores", type=int, default=4, help="that a frame asks for; it uses all it is given (default: 4)"
    )
    parser.add_argument("--format", default="OPEN_EXR_MULTILAYER", help="as of Blender's -F")
    parser.add_argument("--blender", default="blender")
    parser.add_argument("--addon", default="glimmer", help="bl_ext.user_default.glimmer where it is an extension")
    parser.add_argument("--print", action="store_true", help="print the job's specification in place of submitting it")
    given = parser.parse_args()
    launcher = outline.cuerun.OutlineLauncher(job(given))
    if given.print:
        sys.stdout.write(launcher.serialize(use_pycuerun=False) + "\n")
    else:
        launcher.launch(use_pycuerun=False)


if __name__ == "__main__":
    main()
