# SPDX-License-Identifier: GPL-3.0-or-later
"""Haze: a world's even volume, by how far one sees in it. Blender's own nodes hold it, so Cycles renders it too."""


def register() -> None:
    from . import operators, properties

    properties.register()
    operators.register()


def unregister() -> None:
    from . import operators, properties

    operators.unregister()
    properties.unregister()
