# SPDX-License-Identifier: GPL-3.0-or-later
"""What the user can do beyond rendering."""

from . import export_scene, five_moons_world, sampling_presets

_PARTS = (export_scene, five_moons_world, sampling_presets)


def register() -> None:
    for part in _PARTS:
        part.register()


def unregister() -> None:
    for part in reversed(_PARTS):
        part.unregister()
