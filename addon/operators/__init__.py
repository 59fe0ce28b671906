# SPDX-License-Identifier: GPL-3.0-or-later
"""What the user can do beyond rendering."""

from . import export_scene, five_moons_world


def register() -> None:
    export_scene.register()
    five_moons_world.register()


def unregister() -> None:
    five_moons_world.unregister()
    export_scene.unregister()
