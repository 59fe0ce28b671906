# SPDX-License-Identifier: GPL-3.0-or-later
"""Whole worlds from presets, the panel that directs them, and camera helpers."""


def register() -> None:
    from . import cameras, operators, panel

    operators.register()
    cameras.register()
    panel.register()


def unregister() -> None:
    from . import cameras, operators, panel

    panel.unregister()
    cameras.unregister()
    operators.unregister()
