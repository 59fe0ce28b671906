# SPDX-License-Identifier: GPL-3.0-or-later
"""Glimmer for Blender: a path tracer for hazy, moonlit worlds of metal.

Importing this package does not import Blender; registering it does.
"""

bl_info = {
    "name": "Glimmer",
    "author": "The Glimmer project",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "Render properties > Render Engine > Glimmer",
    "description": "A path tracer for hazy, moonlit worlds of metal",
    "category": "Render",
}


def register() -> None:
    from . import registration

    registration.register()


def unregister() -> None:
    from . import registration

    registration.unregister()
