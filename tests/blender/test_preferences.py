# SPDX-License-Identifier: GPL-3.0-or-later
"""The preferences and the render properties say which engine is at work, or in one line why none is."""

import json
from pathlib import Path
from typing import Any

import pytest
from hosts import Host

# argv: a file for what is shown. Panels draw into a layout that keeps the texts.
SCRIPT = """
import json, os, sys
from pathlib import Path
from types import SimpleNamespace
import bpy
sys.path.insert(0, {folder!r})
import inside
inside.enable()
from glimmer.native import library, machine
from glimmer.ui.preferences import GlimmerPreferences
from glimmer.ui.sampling import GLIMMER_PT_sampling

class Layout:
    alert = active = use_property_split = use_property_decorate = False
    def __init__(self):
        self.texts = []
    def column(self, **_):
        return self
    row = column
    def prop(self, *_, **__):
        pass
    def label(self, text, icon):
        self.texts.append((text, icon))

def shown(panel):
    layout = Layout()
    panel.draw(SimpleNamespace(layout=layout), bpy.context)
    return [" ".join(text for text, _ in layout.texts), [icon for _, icon in layout.texts if icon != "BLANK1"]]

def both():
    library.load.cache_clear()
    return [shown(GlimmerPreferences), shown(GLIMMER_PT_sampling)]

answers = {{"well": both()}}
out = Path(inside.words()[0])
cpu = machine.CPU_INFO
machine.CPU_INFO = out.with_name("cpuinfo")
machine.CPU_INFO.write_text("model name : Old One\\nflags : sse2 avx\\n")
answers["processor"] = both()
machine.CPU_INFO = cpu
broken = out.with_name("libglimmer.so")
broken.write_bytes(Path(os.environ["GLIMMER_LIBRARY"]).read_bytes()[:100000])
os.environ["GLIMMER_LIBRARY"] = str(broken)
answers["file"] = both()
out.write_text(json.dumps(answers))
"""


@pytest.fixture(scope="module")
def shown(host: Host, tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    folder = tmp_path_factory.mktemp("preferences")
    script = folder / "draw.py"
    script.write_text(SCRIPT.format(folder=str(Path(__file__).parent)))
    host.run_script(script, str(folder / "shown.json"))
    answers: dict[str, Any] = json.loads((folder / "shown.json").read_text())
    return answers


def test_the_preferences_show_which_engine_is_at_work(shown: dict[str, Any]) -> None:
    (text, icons), (render_text, _) = shown["well"]
    for word in ("Glimmer 0.", "GCC ", "Embree 3.13.5", "AVX", "glibc 2.27 or later"):
        assert word in text
    assert icons == ["CHECKMARK"]
    assert render_text == ""


@pytest.mark.parametrize(("kind", "words"), [("processor", "Old One lacks abm"), ("file", "is damaged; install")])
def test_both_say_in_one_line_why_none_is(shown: dict[str, Any], kind: str, words: str) -> None:
    for text, icons in shown[kind]:
        assert words in text
        assert icons == ["ERROR"]
