# SPDX-License-Identifier: GPL-3.0-or-later
"""The panels: Blender's own that apply to us, and ours."""

from . import (
    add_menu,
    camera,
    compatible,
    differences,
    error,
    header,
    light,
    material,
    motion,
    object,
    preferences,
    render,
    view_layer,
    world,
)

_PARTS = (
    compatible,
    render,
    differences,
    motion,
    error,
    view_layer,
    object,
    camera,
    light,
    material,
    world,
    header,
    add_menu,
    preferences,
)


def register() -> None:
    for part in _PARTS:
        part.register()


def unregister() -> None:
    for part in reversed(_PARTS):
        part.unregister()
