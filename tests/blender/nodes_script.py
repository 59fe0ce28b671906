# SPDX-License-Identifier: GPL-3.0-or-later
"""Translates materials, worlds and lamps and writes what came out: nodes_script.py FILE.

Also registers and unregisters the add-on, and looks which panels know it.
"""

import json
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import bpy

sys.path.insert(0, str(Path(__file__).parent))

import inside

glimmer = inside.enable()
from glimmer.export.material import export_material  # noqa: E402 - the add-on's name inside Blender
from glimmer.export.world import export_world  # noqa: E402
from glimmer.scene.problems import Notices  # noqa: E402

RED = (0.8, 0.1, 0.1, 1.0)


class Build:
    """A material under construction: shorter than Blender's own calls."""

    def __init__(self, kind: str = "material") -> None:
        if kind == "material":
            self.owner = bpy.data.materials.new("Test")
            self.output_kind = "ShaderNodeOutputMaterial"
        else:
            self.owner = bpy.data.worlds.new("Test")
            self.output_kind = "ShaderNodeOutputWorld"
        self.owner.use_nodes = True
        self.tree = self.owner.node_tree
        self.tree.nodes.clear()
        self.output = self.tree.nodes.new(self.output_kind)

    def node(self, kind: str, tree: Any = None, **inputs: Any) -> Any:
        result = (tree or self.tree).nodes.new(kind)
        for name, value in inputs.items():
            result.inputs[name.replace("_", " ")].default_value = value
        return result

    def link(self, source: Any, target: Any) -> None:
        target.id_data.links.new(source, target)

    def surface(self, node: Any) -> None:
        self.link(node.outputs[0], self.output.inputs["Surface"])

    def volume(self, node: Any) -> None:
        self.link(node.outputs[0], self.output.inputs["Volume"])


def math_on_color() -> Build:
    """0.5 * 0.5 through a value, two maths nodes, a reroute and a combine."""
    b = Build()
    value = b.node("ShaderNodeValue")
    value.outputs[0].default_value = 0.5
    multiply = b.node("ShaderNodeMath")
    multiply.operation = "MULTIPLY"
    reroute = b.node("NodeReroute")
    combine = b.node("ShaderNodeCombineXYZ", Y=1.0)
    b.link(value.outputs[0], multiply.inputs[0])
    multiply.inputs[1].default_value = 0.5
    b.link(multiply.outputs[0], reroute.inputs[0])
    b.link(reroute.outputs[0], combine.inputs["X"])
    diffuse = b.node("ShaderNodeBsdfDiffuse")
    b.link(combine.outputs[0], diffuse.inputs["Color"])
    b.surface(diffuse)
    return b


def group() -> Build:
    """A shader in a group, with its colour from outside."""
    b = Build()
    inner = bpy.data.node_groups.new("Inner", "ShaderNodeTree")
    if hasattr(inner, "interface"):
        inner.interface.new_socket("Tint", in_out="INPUT", socket_type="NodeSocketColor")
        inner.interface.new_socket("Out", in_out="OUTPUT", socket_type="NodeSocketShader")
    else:
        inner.inputs.new("NodeSocketColor", "Tint")
        inner.outputs.new("NodeSocketShader", "Out")
    entry, leave = b.node("NodeGroupInput", inner), b.node("NodeGroupOutput", inner)
    diffuse = b.node("ShaderNodeBsdfDiffuse", inner)
    b.link(entry.outputs[0], diffuse.inputs["Color"])
    b.link(diffuse.outputs[0], leave.inputs[0])
    outer = b.node("ShaderNodeGroup")
    outer.node_tree = inner
    outer.inputs["Tint"].default_value = RED
    b.surface(outer)
    return b


def muted() -> Build:
    b = Build()
    diffuse, emission = b.node("ShaderNodeBsdfDiffuse", Color=RED), b.node("ShaderNodeEmission")
    add = b.node("ShaderNodeAddShader")
    b.link(diffuse.outputs[0], add.inputs[0])
    b.link(emission.outputs[0], add.inputs[1])
    add.mute = True
    b.surface(add)
    return b


def sum_with_emission() -> Build:
    b = Build()
    diffuse, emission = b.node("ShaderNodeBsdfDiffuse", Color=RED), b.node("ShaderNodeEmission", Strength=3.0)
    add = b.node("ShaderNodeAddShader")
    b.link(diffuse.outputs[0], add.inputs[0])
    b.link(emission.outputs[0], add.inputs[1])
    b.surface(add)
    return b


def texture() -> Build:
    b = Build()
    image = bpy.data.images.new("Chequers", 2, 1, float_buffer=True)
    image.pixels.foreach_set([0.0, 0.5, 1.0, 1.0, 1.0, 0.5, 0.0, 1.0])
    picture = b.node("ShaderNodeTexImage")
    picture.image = image
    diffuse = b.node("ShaderNodeBsdfDiffuse")
    b.link(picture.outputs["Color"], diffuse.inputs["Color"])
    b.surface(diffuse)
    return b


def procedural() -> Build:
    b = Build()
    b.owner.diffuse_color = (0.25, 0.5, 0.75, 1.0)
    diffuse = b.node("ShaderNodeBsdfDiffuse", Color=RED)
    b.link(b.node("ShaderNodeTexNoise").outputs["Color"], diffuse.inputs["Color"])
    b.surface(diffuse)
    return b


def unknown_shader() -> Build:
    b = Build()
    b.surface(b.node("ShaderNodeBsdfHair", Color=RED))
    return b


def leaf() -> Build:
    """A leaf's nodes: diffuse and translucent, with a hole where alpha says so."""
    b = Build()
    diffuse, translucent = b.node("ShaderNodeBsdfDiffuse", Color=RED), b.node("ShaderNodeBsdfTranslucent", Color=RED)
    add, hole, mix = b.node("ShaderNodeAddShader"), b.node("ShaderNodeBsdfTransparent"), b.node("ShaderNodeMixShader")
    b.link(diffuse.outputs[0], add.inputs[0])
    b.link(translucent.outputs[0], add.inputs[1])
    mix.inputs[0].default_value = 0.25
    b.link(add.outputs[0], mix.inputs[1])
    b.link(hole.outputs[0], mix.inputs[2])
    b.surface(mix)
    return b


def shader(kind: str, **inputs: Any) -> Callable[[], Build]:
    def build() -> Build:
        b = Build()
        node = b.node(kind, **inputs)
        if hasattr(node, "distribution"):
            node.distribution = "GGX"
        b.surface(node)
        return b

    return build


def principled(**inputs: Any) -> Callable[[], Build]:
    def build() -> Build:
        b = Build()
        shader = b.node("ShaderNodeBsdfPrincipled")
        for name, value in inputs.items():
            for candidate in name.split("__or__"):
                socket = shader.inputs.get(candidate.replace("_", " "))
                if socket is not None:
                    socket.default_value = value
                    break
            else:
                raise KeyError(name)
        b.surface(shader)
        return b

    return build


def nothing() -> Build:
    return Build()


def all_volumes(kind: str = "world") -> Build:
    """Scatter + absorption."""
    b = Build(kind)
    scatter = b.node("ShaderNodeVolumeScatter", Color=(0.5, 1.0, 0.25, 1.0), Density=0.2, Anisotropy=0.5)
    absorption = b.node("ShaderNodeVolumeAbsorption", Color=(0.5, 1.0, 0.25, 1.0), Density=0.1)
    add = b.node("ShaderNodeAddShader")
    b.link(scatter.outputs[0], add.inputs[0])
    b.link(absorption.outputs[0], add.inputs[1])
    b.volume(add)
    return b


def principled_volume(kind: str = "world") -> Build:
    b = Build(kind)
    b.volume(b.node("ShaderNodeVolumePrincipled", Color=(0.5, 0.25, 1.0, 1.0), Density=2.0))
    return b


def shining_volume(kind: str = "world") -> Build:
    """Half a volume that shines, half one of varying density."""
    b = Build(kind)
    shining = b.node("ShaderNodeVolumePrincipled", Density=0.0, Emission_Strength=2.0)
    shining.inputs["Emission Color"].default_value = (0.5, 0.25, 1.0, 1.0)
    varying = b.node("ShaderNodeVolumeScatter", Anisotropy=0.5)
    b.link(b.node("ShaderNodeTexNoise").outputs[0], varying.inputs["Density"])
    mix = b.node("ShaderNodeMixShader")
    b.link(shining.outputs[0], mix.inputs[1])
    b.link(varying.outputs[0], mix.inputs[2])
    b.volume(mix)
    return b


def height_haze(kind: str = "world") -> Build:
    """Density .02 at a height of 3, thinner by e every 4, by the world's position: e^((3 - z) / 4) times."""
    b = Build(kind)
    apart = b.node("ShaderNodeSeparateXYZ")
    b.link(b.node("ShaderNodeNewGeometry").outputs["Position"], apart.inputs[0])
    below, over, power, density = (b.node("ShaderNodeMath") for _ in range(4))
    below.operation, over.operation, power.operation, density.operation = "SUBTRACT", "DIVIDE", "POWER", "MULTIPLY"
    below.inputs[0].default_value, over.inputs[1].default_value = 3.0, 4.0
    power.inputs[0].default_value, density.inputs[1].default_value = 2.718281828, 0.02
    b.link(apart.outputs[2], below.inputs[1])
    b.link(below.outputs[0], over.inputs[0])
    b.link(over.outputs[0], power.inputs[1])
    b.link(power.outputs[0], density.inputs[0])
    scatter = b.node("ShaderNodeVolumeScatter", Color=(0.5, 1.0, 0.25, 1.0), Anisotropy=0.5)
    b.link(density.outputs[0], scatter.inputs["Density"])
    b.volume(scatter)
    return b


def varying_volume(kind: str = "material") -> Build:
    """All of a Principled Volume that may vary, by generated coordinates."""
    b = Build(kind)
    place = b.node("ShaderNodeTexCoord").outputs["Generated"]
    volume = b.node("ShaderNodeVolumePrincipled", Blackbody_Intensity=0.5)
    for name in ("Color", "Density", "Anisotropy", "Absorption Color", "Emission Strength", "Emission Color"):
        b.link(place, volume.inputs[name])
    b.link(place, volume.inputs["Temperature"])
    b.volume(volume)
    return b


def coefficients() -> Build:
    b = Build("world")
    values = {"Absorption_Coefficients": (0.1, 0.2, 0.3), "Scatter_Coefficients": (0.4, 0.5, 0.6), "Anisotropy": -0.3}
    b.volume(b.node("ShaderNodeVolumeCoefficients", **values))
    return b


def background() -> Build:
    b = Build("world")
    b.surface(b.node("ShaderNodeBackground", Color=(0.1, 0.2, 0.3, 1.0), Strength=2.0))
    return b


def sky() -> Build:
    b = Build("world")
    b.owner.color = (0.3, 0.2, 0.1)
    node = b.node("ShaderNodeBackground", Strength=2.0)
    b.link(b.node("ShaderNodeTexSky").outputs[0], node.inputs["Color"])
    b.surface(node)
    return b


MATERIALS: dict[str, Callable[[], Build]] = {
    "math_on_color": math_on_color,
    "group": group,
    "muted": muted,
    "sum_with_emission": sum_with_emission,
    "texture": texture,
    "procedural": procedural,
    "unknown_shader": unknown_shader,
    "nothing": nothing,
    "leaf": leaf,
    "rough_glass": shader("ShaderNodeBsdfGlass", Color=RED, Roughness=0.5, IOR=1.4),
    "refraction": shader("ShaderNodeBsdfRefraction", Color=RED, Roughness=0.0, IOR=1.4),
    "rough_diffuse": shader("ShaderNodeBsdfDiffuse", Color=RED, Roughness=0.5),
    "alpha": principled(Base_Color=RED, Specular_IOR_Level__or__Specular=0.0, Alpha=0.25),
    "principled_metal": principled(Base_Color=RED, Metallic=1.0, Roughness=0.5),
    "principled_glass": principled(
        Base_Color=(1.0, 1.0, 1.0, 1.0), Roughness=0.0, IOR=1.33, Transmission_Weight__or__Transmission=1.0
    ),
    "principled_diffuse": principled(Base_Color=RED, Specular_IOR_Level__or__Specular=0.0),
    "principled_emission": principled(
        Base_Color=RED,
        Specular_IOR_Level__or__Specular=0.0,
        Emission_Color__or__Emission=(1.0, 0.5, 0.25, 1.0),
        Emission_Strength=4.0,
    ),
    "principled_default": principled(),
    "principled_coat": principled(Metallic=1.0, Coat_Weight__or__Clearcoat=0.5),
}
WORLDS = {
    "all_volumes": all_volumes,
    "principled_volume": principled_volume,
    "shining_volume": shining_volume,
    "height_haze": height_haze,
    "background": background,
    "sky": sky,
}
if hasattr(bpy.types, "ShaderNodeVolumeCoefficients"):
    WORLDS["coefficients"] = coefficients


INTERIORS: dict[str, Callable[[str], Build]] = {
    "all_volumes": all_volumes,
    "principled_volume": principled_volume,
    "shining_volume": shining_volume,
    "varying_volume": varying_volume,
}


def described(medium: Any) -> dict[str, Any] | None:
    """Its constants, and the names of what varies."""
    if medium is None:
        return None
    facts = {key: value for key, value in vars(medium).items() if key not in medium.outputs()}
    program, falloff = facts.pop("program"), facts.pop("falloff")
    operations = [] if program is None else [item.op for item in program.instructions]
    return {**facts, "varies": sorted(medium.outputs()), "operations": operations, "falloff": falloff and vars(falloff)}


def translate() -> dict[str, Any]:
    facts: dict[str, Any] = {}
    for name, build in MATERIALS.items():
        notices = Notices()
        found = export_material(build().owner, "Thing", bpy.app.version, notices)
        operations = 0 if found.program is None else len(found.program.instructions)
        facts[name] = {"is": repr(found.material), "operations": operations}
        facts[name]["notices"] = [str(notice) for notice in notices.items]
    for name, filled in INTERIORS.items():
        notices = Notices()
        found = export_material(filled("material").owner, "Thing", bpy.app.version, notices)
        facts["in " + name] = {"is": repr(found.material), "medium": described(found.volume)}
        facts["in " + name]["notices"] = [str(notice) for notice in notices.items]
    for name, build in WORLDS.items():
        notices = Notices()
        environment, medium = export_world(build().owner, notices)
        facts[name] = {
            "radiance": environment.radiance,
            "varies": environment.program is not None,
            "medium": described(medium),
        }
        facts[name]["notices"] = [str(notice) for notice in notices.items]
    return facts


def fog_and_sun() -> list[str]:
    """What a render says of a sun and a sky behind endless fog."""
    from glimmer import reports

    scene = inside.empty_scene((0.5, 0.5, 0.5))
    inside.plane()
    inside.lamp("SUN", (0.0, 0.0, 5.0), energy=1.0)
    tree = scene.world.node_tree
    tree.links.new(tree.nodes.new("ShaderNodeVolumeScatter").outputs[0], tree.nodes["World Output"].inputs["Volume"])
    scene.glimmer.samples = 1
    bpy.ops.render.render()
    report = reports.last()
    lines: list[str] = [*report["export"]["notices"], *report["warnings"]]
    return lines


def marked_as_spheres() -> dict[str, Any]:
    """A cube, an egg and a ball: what a render says of them, what the panel does, and their pictures."""
    from glimmer import reports
    from glimmer.ui.object import why_no_sphere

    inside.empty_scene((0.5, 0.5, 0.5))
    bpy.ops.mesh.primitive_cube_add(size=1.5, location=(0.0, 0.0, 1.0))
    items = {"Cube": bpy.context.object, "Egg": inside.ball("Egg", None, (2.0, 0.0, 1.0), 16)}
    items["Egg"].scale.z = 1.5
    items["Ball"] = inside.ball("Ball", None, (-2.0, 0.0, 1.0), 16)
    facts: dict[str, Any] = {"panel": {}}
    inside.use_format("OPEN_EXR")

    def picture(name: str) -> None:
        inside.render(Path(inside.words()[0]).with_name(name))
        facts[f"{name}_says"] = reports.last()["export"]["notices"]

    picture("unmarked.exr")
    for name, item in items.items():
        item.glimmer.is_sphere = True
        bpy.context.view_layer.objects.active = item
        bpy.context.view_layer.update()
        facts["panel"][name] = why_no_sphere(bpy.context)
    picture("marked.exr")
    items["Ball"].glimmer.is_sphere = False
    picture("without_ball.exr")
    return facts


def registration() -> dict[str, Any]:
    def compatible() -> set[str]:
        return {p.__name__ for p in bpy.types.Panel.__subclasses__() if "GLIMMER" in getattr(p, "COMPAT_ENGINES", ())}

    before = compatible()
    ours = {p.__name__ for p in bpy.types.Panel.__subclasses__() if p.__module__.startswith("glimmer")}
    glimmer.unregister()
    gone = not hasattr(bpy.types.Scene, "glimmer") and not hasattr(bpy.types.Object, "glimmer")
    after = compatible() - ours
    glimmer.register()
    return {"panels": sorted(before), "left": sorted(after), "gone": gone, "again": compatible() == before}


result = {
    "nodes": translate(),
    "fog_and_sun": fog_and_sun(),
    "registration": registration(),
}
result["marked_as_spheres"] = marked_as_spheres()
Path(inside.words()[0]).write_text(json.dumps(result))
