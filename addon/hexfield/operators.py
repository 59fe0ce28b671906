# SPDX-License-Identifier: GPL-3.0-or-later
"""Add > Mesh > Glimmer Hexagon Field."""

from typing import Any

import bpy

from . import field, properties
from .layout import check
from .panel import draw_parameters
from .parameters import SECTIONS


class GLIMMER_OT_add_hexagon_field(bpy.types.Operator):
    """Add hills of bevelled hexagonal plates, as instances; its parameters stay live in the object's data properties"""

    bl_idname = "glimmer.add_hexagon_field"
    bl_label = "Glimmer Hexagon Field"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: Any) -> bool:
        return context.mode == "OBJECT"

    def draw(self, _context: Any) -> None:
        self.layout.use_property_split = True
        for section in SECTIONS:
            self.layout.label(text=section)
            draw_parameters(self.layout, self, section)

    def execute(self, context: Any) -> set[str]:
        parameters = properties.read(self)
        try:
            check(parameters)
        except ValueError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        materials = default_materials()
        obj = field.create("Hexagon Field", parameters, *materials, collection=context.collection)
        obj.location = context.scene.cursor.location
        for other in context.selected_objects:
            other.select_set(False)
        obj.select_set(True)
        context.view_layer.objects.active = obj
        return {"FINISHED"}


GLIMMER_OT_add_hexagon_field.__annotations__ = properties.field_annotations()


def default_materials() -> tuple[Any, Any]:
    """Brushed plates with polished bevels: the file's own of those names, or new ones."""
    return (
        bpy.data.materials.get("Glimmer Plate") or metal("Glimmer Plate", (0.55, 0.56, 0.6), 0.45),
        bpy.data.materials.get("Glimmer Bevel") or metal("Glimmer Bevel", (0.7, 0.7, 0.72), 0.25),
    )


def metal(name: str, color: tuple[float, float, float], roughness: float) -> Any:
    material = bpy.data.materials.new(name)
    if bpy.app.version < (5, 0):  # from then on always
        material.use_nodes = True
    shader = next(node for node in material.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
    shader.inputs["Base Color"].default_value = (*color, 1.0)
    shader.inputs["Metallic"].default_value = 1.0
    shader.inputs["Roughness"].default_value = roughness
    material.diffuse_color = (*color, 1.0)
    material.metallic, material.roughness = 1.0, roughness
    return material


def _draw_menu(self: Any, _context: Any) -> None:
    self.layout.operator(GLIMMER_OT_add_hexagon_field.bl_idname, icon="MOD_ARRAY")


def register() -> None:
    bpy.utils.register_class(GLIMMER_OT_add_hexagon_field)
    bpy.types.VIEW3D_MT_mesh_add.append(_draw_menu)


def unregister() -> None:
    bpy.types.VIEW3D_MT_mesh_add.remove(_draw_menu)
    bpy.utils.unregister_class(GLIMMER_OT_add_hexagon_field)
