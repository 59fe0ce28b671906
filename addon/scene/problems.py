# SPDX-License-Identifier: GPL-3.0-or-later
"""What can go wrong between a Blender scene and a picture, in the words that a user reads."""

import traceback
from dataclasses import dataclass, field


class GlimmerError(Exception):
    """No picture can be made. The message is one line: what is wrong, where, and what is allowed."""


def describe(error: Exception) -> str:
    """One line for the user. A defect of ours leaves its trace in the log too."""
    if isinstance(error, GlimmerError):
        return str(error)
    traceback.print_exception(error)
    last = traceback.extract_tb(error.__traceback__)[-1]
    return (
        f"a defect of the add-on, please report it: {type(error).__name__}: {error} ({last.name}, line {last.lineno})"
    )


@dataclass(frozen=True)
class EngineWarning:
    """Something that the engine warns of."""

    code: str  # for programs: the words may change
    text: str


ENDLESS_FOG = "endless_fog"  # the engine's code, and that of the notice which says the same with names


@dataclass(frozen=True)
class Notice:
    """Something of the scene that is rendered in another way than it was written, and how."""

    where: str  # "material 'Red' of object 'Moon', node 'Noise Texture'": the parts that apply
    what: str
    code: str = ""  # where a program looks for it

    def __str__(self) -> str:
        return f"{self.where}: {self.what}" if self.where else self.what


def place(object_name: str = "", material: str = "") -> str:
    """The words for a place in a Blender scene: a material first, since that is what one edits."""
    if object_name and material:
        return f"material '{material}' of object '{object_name}'"
    return f"material '{material}'" if material else f"object '{object_name}'" if object_name else ""


@dataclass
class Notices:
    """Collects notices, each once, in the order in which they came."""

    items: list[Notice] = field(default_factory=list)
    _seen: set[Notice] = field(default_factory=set)

    def add(self, where: str, what: str, code: str = "") -> None:
        notice = Notice(where, what, code)
        if notice not in self._seen:
            self._seen.add(notice)
            self.items.append(notice)
