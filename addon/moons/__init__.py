# SPDX-License-Identifier: GPL-3.0-or-later
"""Moons: opaque shining spheres. Glimmer traces them as true spheres, Cycles as the fine meshes that they are."""


def register() -> None:
    from . import operators, orbit, panel, properties

    properties.register()
    orbit.register()
    operators.register()
    panel.register()


def unregister() -> None:
    from . import operators, orbit, panel, properties

    panel.unregister()
    operators.unregister()
    orbit.unregister()
    properties.unregister()
