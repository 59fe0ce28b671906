# SPDX-License-Identifier: GPL-3.0-or-later

import textwrap

import bpy

from .compatible import ENGINE


class GlimmerPanel:
    """A panel of the properties editor that shows when Glimmer is the engine."""

    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    COMPAT_ENGINES = {ENGINE}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return context.engine == ENGINE


def wrapped(text: str, context: bpy.types.Context) -> list[str]:
    """Lines of a text, as long as the region is wide."""
    width = 400.0
    if context.region is not None:
        width = context.region.width / context.preferences.system.ui_scale
    return textwrap.wrap(text, max(int(width - 75) // 7, 16))  # beside the tabs and an icon


def draw_wrapped(layout: bpy.types.UILayout, context: bpy.types.Context, text: str, icon: str) -> None:
    column = layout.column(align=True)
    column.alert = icon == "ERROR"
    for index, line in enumerate(wrapped(text, context)):
        column.label(text=line, icon="BLANK1" if index else icon)


def limit_row(layout: bpy.types.UILayout, settings: bpy.types.bpy_struct, switch: str, value: str) -> None:
    """A limit, and before it whether there is one."""
    row = layout.row(align=True, heading=settings.bl_rna.properties[value].name)
    row.prop(settings, switch, text="")
    field = row.row(align=True)
    field.active = getattr(settings, switch)
    field.prop(settings, value, text="")


def draw_node_input(layout: bpy.types.UILayout, tree: bpy.types.NodeTree, name: str) -> None:
    """An input of the output node, with the nodes behind it, as Blender's own material panels show it."""
    output = tree.get_output_node("CYCLES")
    socket = None if output is None else output.inputs.get(name)
    if socket is None:
        layout.label(text="No output node")
        return
    layout.template_node_view(tree, output, socket)
