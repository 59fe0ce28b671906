# SPDX-License-Identifier: GPL-3.0-or-later
"""Every shader node of this Blender, what Glimmer makes of it, and how many cases of it are compared with Cycles:
node_list_script.py FILE."""

import json
import sys
from collections import Counter
from pathlib import Path
from typing import Any

import bpy

sys.path.insert(0, str(Path(__file__).parent))

import inside
import shading_cases

# What a tree is made of but shows no value of its own, and what belongs to other renderers.
ELSEWHERE = ("ShaderNodeGroup", "ShaderNodeCustomGroup", "ShaderNodeTree", "ShaderNodeOutputLineStyle")


def compared() -> Counter[str]:
    """Cases by the node whose output they show, or that they are named after."""
    counts: Counter[str] = Counter()
    for family in shading_cases.FAMILIES.values():
        for _, build in family():
            tree = bpy.data.materials.new("case").node_tree or material_tree()
            if not any(node.bl_idname == "ShaderNodeOutputMaterial" for node in tree.nodes):
                tree.nodes.new("ShaderNodeOutputMaterial")
            build(tree)
            counts.update({node.bl_idname for node in tree.nodes})
    return counts


def material_tree() -> Any:
    material = bpy.data.materials.new("case")
    material.use_nodes = True
    material.node_tree.nodes.clear()
    return material.node_tree


def main() -> None:
    out = Path(inside.words()[0])
    inside.enable()
    from glimmer.export import fold, material, nodes

    counts = compared()
    tree = material_tree()
    found: dict[str, dict[str, Any]] = {}
    for name in dir(bpy.types):
        if not name.startswith("ShaderNode") or name in ELSEWHERE:
            continue
        try:
            node = tree.nodes.new(name)
        except RuntimeError:
            continue
        kinds = {socket.type for socket in node.outputs}
        if not kinds:
            continue
        if "SHADER" in kinds:
            known = name in material._SHADERS or name.startswith("ShaderNodeVolume") or name == "ShaderNodeBackground"
            state = "shader" if known else "told"
        else:
            known = name in nodes._OPERATIONS or name in fold.FOLDS or name.endswith("Displacement")
            state = "value" if known else "told"
        found[name] = {"label": node.bl_label, "state": state, "cases": counts[name]}
    out.write_text(json.dumps(found))


if __name__ == "__main__":
    main()
