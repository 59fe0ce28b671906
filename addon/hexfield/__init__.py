# SPDX-License-Identifier: GPL-3.0-or-later
"""Hexagon fields: thousands of bevelled plates on hills, as instances that every engine and the viewport show.

    FieldParameters -> layout.lay_out, plate.make_plate (numpy) -> field.rebuild (Blender) -> export.export_instances

What imports bpy is imported by register(), so that layout and plates work without Blender.
"""


def register() -> None:
    from . import handlers, operators, panel, presets, properties

    properties.register()
    operators.register()
    presets.register()
    panel.register()
    handlers.register()


def unregister() -> None:
    from . import handlers, operators, panel, presets, properties

    handlers.unregister()
    panel.unregister()
    presets.unregister()
    operators.unregister()
    properties.unregister()
