# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials of plates that take colour, roughness and patina from each plate's own attributes, in every engine."""

from typing import Any

import bpy

from . import node_group

_MARK = "glimmer_plate_look"


def default_materials() -> tuple[Any, Any]:
    """Brushed plates with polished bevels: the file's own, or new ones."""
    return _metal("Glimmer Plate", 1.0), _metal("Glimmer Bevel", 0.6)


def _metal(name: str, polish: float) -> Any:
    """polish: by what a plate's roughness is multiplied."""
    for known in bpy.data.materials:
        if known.library is None and known.get(_MARK) == name:
            return known
    material = bpy.data.materials.new(name)
    material[_MARK] = name
    if bpy.app.version < (5, 0):  # from then on always
        material.use_nodes = True
    tree = material.node_tree
    shader = next(node for node in tree.nodes if node.type == "BSDF_PRINCIPLED")
    color, roughness, patina = (
        _attribute(tree, attribute, shader.location.x - 500, shader.location.y - 180 * row)
        for row, attribute in enumerate((node_group.COLOR, node_group.ROUGHNESS, node_group.PATINA))
    )
    tree.links.new(color.outputs["Color"], shader.inputs["Base Color"])
    rough, bare = (_math(tree, kind, shader.location.x - 250, color.location.y) for kind in ("MULTIPLY", "SUBTRACT"))
    rough.inputs[1].default_value, bare.inputs[0].default_value = polish, 1.0
    rough.location.y, bare.location.y = roughness.location.y, patina.location.y
    tree.links.new(roughness.outputs["Fac"], rough.inputs[0])
    tree.links.new(rough.outputs[0], shader.inputs["Roughness"])
    tree.links.new(patina.outputs["Fac"], bare.inputs[1])  # what has patina is metal no more
    tree.links.new(bare.outputs[0], shader.inputs["Metallic"])
    material.diffuse_color = (0.56, 0.57, 0.6, 1.0)
    material.metallic, material.roughness = 1.0, 0.35 * polish
    return material


def _attribute(tree: Any, name: str, x: float, y: float) -> Any:
    node = tree.nodes.new("ShaderNodeAttribute")
    node.attribute_type, node.attribute_name, node.label = "INSTANCER", name, name
    node.location = x, y
    return node


def _math(tree: Any, operation: str, x: float, y: float) -> Any:
    node = tree.nodes.new("ShaderNodeMath")
    node.operation = operation
    node.location = x, y
    return node
