# SPDX-License-Identifier: GPL-3.0-or-later
"""Moons: opaque shining spheres. Glimmer traces them as true spheres, Cycles as the fine meshes that they are."""


def register() -> None:
    from . import operators, panel, properties

    properties.register()
    operators.register()
    panel.register()


def unregister() -> None:
    from . import operators, panel, properties

    panel.unregister()
    operators.unregister()
    properties.unregister()
