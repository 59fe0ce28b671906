# SPDX-License-Identifier: GPL-3.0-or-later
"""What the user can do beyond rendering."""

from . import export_scene


def register() -> None:
    export_scene.register()


def unregister() -> None:
    export_scene.unregister()
