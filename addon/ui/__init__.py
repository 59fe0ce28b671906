# SPDX-License-Identifier: GPL-3.0-or-later
"""The panels: Blender's own that apply to us, and ours."""

from . import (
    add_menu,
    camera,
    compatible,
    differences,
    header,
    last_render,
    light,
    material,
    motion,
    noise,
    object,
    preferences,
    render,
    sampling,
    simplify,
    view_layer,
    visibility,
    world,
)

# Panels stand in the order in which they are registered.
_PARTS = (
    compatible,
    sampling,
    differences,
    render,
    motion,
    simplify,
    noise,
    last_render,
    view_layer,
    object,
    camera,
    light,
    material,
    world,
    visibility,
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
