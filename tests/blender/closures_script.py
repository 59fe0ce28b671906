# SPDX-License-Identifier: GPL-3.0-or-later
"""Closures by Cycles and by Glimmer: closures_script.py FILE [WORD...].

A faceted ball on a floor under a sky and a lamp, for each case one input of one shader node away from its default.
Writes for each case, of those whose names hold one of the words: means of blocks of both pictures over a few seeds, and
what the export said. Run by hand it is the audit of all closures: it ends with a table.
"""

import json
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).parent))

import inside
from exact_cycles import set_up_cycles

SIZE, BLOCKS = (48, 40), 4
SEEDS, SAMPLES = 4, 64
OCHRE, RED, BLUE, WHITE = (0.8, 0.5, 0.2, 1.0), (0.9, 0.1, 0.1, 1.0), (0.1, 0.3, 0.9, 1.0), (1.0, 1.0, 1.0, 1.0)
PRINCIPLED = "ShaderNodeBsdfPrincipled"
OLD_NAMES = {
    "Specular IOR Level": "Specular",
    "Coat Weight": "Clearcoat",
    "Coat Roughness": "Clearcoat Roughness",
    "Sheen Weight": "Sheen",
    "Subsurface Weight": "Subsurface",
    "Transmission Weight": "Transmission",
    "Emission Color": "Emission",
}


def scene_of(material: Any) -> Any:
    scene = inside.empty_scene((0.25, 0.3, 0.4))
    inside.plane(material=inside.material("ShaderNodeBsdfDiffuse", Color=(0.5, 0.4, 0.3, 1.0)))
    inside.lamp("AREA", (-2.0, -2.5, 3.5), energy=150.0, shape="RECTANGLE", size=2.0, size_y=1.0)
    ball = inside.ball("Ball", material)
    ball.data.polygons.foreach_set("use_smooth", [False] * len(ball.data.polygons))
    scene.camera.data.angle = 0.42
    scene.camera.location = (0.0, -6.0, 3.0)
    scene.camera.rotation_euler = (1.25, 0.0, 0.0)
    return scene


def shader(kind: str, distribution: str | None = None, **inputs: Any) -> Callable[[], Any]:
    """A material of one node; inputs that this Blender does not know by their new name are tried by their old one."""

    def build() -> Any:
        material = inside.material(kind, distribution)
        node = next(n for n in material.node_tree.nodes if n.type != "OUTPUT_MATERIAL")
        for key, value in inputs.items():
            name = key.replace("_", " ")
            socket = node.inputs.get(name) or node.inputs.get(OLD_NAMES.get(name, ""))
            if socket is None:
                raise LookupError(name)
            socket.default_value = value[0] if isinstance(value, tuple) and socket.type == "VALUE" else value
        return material

    return build


def old_tint() -> Any:
    """Of 3.x, a number; from 4.0 a colour."""
    material = inside.material(PRINCIPLED, Base_Color=RED)
    node = next(n for n in material.node_tree.nodes if n.type != "OUTPUT_MATERIAL")
    socket = node.inputs["Specular Tint"]
    socket.default_value = 1.0 if socket.type == "VALUE" else RED
    return material


def p(**inputs: Any) -> Callable[[], Any]:
    return shader(PRINCIPLED, None, **{"Base_Color": OCHRE, **inputs})


CASES: dict[str, Callable[[], Any]] = {
    "principled": p(),
    **{f"principled roughness {r}": p(Roughness=r) for r in (0.0, 0.2, 0.8, 1.0)},
    **{f"principled metallic {m}": p(Metallic=m) for m in (0.5, 1.0)},
    "principled metallic rough": p(Metallic=1.0, Roughness=0.9),
    **{f"principled specular {s}": p(Specular_IOR_Level=s) for s in (0.0, 1.0)},
    "principled specular tint": old_tint,
    "principled metallic tint": p(Metallic=1.0, Specular_Tint=BLUE),
    "principled ior": p(IOR=2.0),
    "principled anisotropic": p(Metallic=1.0, Anisotropic=0.8),
    "principled anisotropic rotated": p(Metallic=1.0, Anisotropic=0.8, Anisotropic_Rotation=0.25),
    "principled sheen": p(Sheen_Weight=1.0),
    "principled sheen tint": p(Sheen_Weight=1.0, Sheen_Tint=RED),
    "principled sheen rough": p(Sheen_Weight=1.0, Sheen_Roughness=0.2),
    "principled coat": p(Coat_Weight=1.0),
    "principled coat half": p(Coat_Weight=0.5, Roughness=0.9),
    "principled coat rough": p(Coat_Weight=1.0, Coat_Roughness=0.5),
    "principled coat tint": p(Coat_Weight=1.0, Coat_Tint=RED),
    "principled coat ior": p(Coat_Weight=1.0, Coat_IOR=2.0),
    "principled coat metal": p(Coat_Weight=1.0, Metallic=1.0, Roughness=0.4),
    "principled transmission": p(Transmission_Weight=1.0, Roughness=0.0),
    "principled transmission rough": p(Transmission_Weight=1.0, Roughness=0.5),
    "principled transmission half": p(Transmission_Weight=0.5),
    "principled subsurface half": p(Subsurface_Weight=0.5, Subsurface_Radius=(0.1, 0.05, 0.02)),
    "principled subsurface colour": p(Subsurface=0.5, Subsurface_Color=BLUE, Subsurface_Radius=(0.1, 0.05, 0.02)),
    "principled emission": p(Emission_Color=BLUE, Emission_Strength=0.5),
    "principled emission under coat": p(
        Emission_Color=BLUE, Emission_Strength=0.5, Coat_Weight=1.0, Coat_Tint=RED, Coat_IOR=1.8
    ),
    "principled alpha": p(Alpha=0.5),
    "principled thin film": p(Thin_Film_Thickness=400.0),
    "principled metallic thin film": p(Thin_Film_Thickness=400.0, Metallic=1.0),
    "metallic thin film": shader("ShaderNodeBsdfMetallic", "GGX", Thin_Film_Thickness=400.0, Roughness=0.3),
    "glass thin film": shader("ShaderNodeBsdfGlass", "GGX", Thin_Film_Thickness=400.0, Roughness=0.1),
    "glass anisotropic": shader("ShaderNodeBsdfGlass", "GGX", Anisotropy=0.8, Roughness=0.5),
    "principled thin wall": p(Thin_Wall=True, Transmission_Weight=1.0),
    "principled dispersion": p(Transmission_Dispersion_Scale=1.0, Transmission_Weight=1.0, Roughness=0.0),
    "principled transmission roughness": p(Transmission=1.0, Roughness=0.2, Transmission_Roughness=0.5),
    "principled diffuse rough": p(Diffuse_Roughness=1.0, Specular_IOR_Level=0.0),
    **{f"diffuse {r}": shader("ShaderNodeBsdfDiffuse", Color=OCHRE, Roughness=r) for r in (0.0, 0.5, 1.0)},
    **{
        f"glossy {kind} {r}": shader("ShaderNodeBsdfGlossy", kind, Color=OCHRE, Roughness=r)
        for kind in ("GGX", "MULTI_GGX", "BECKMANN", "ASHIKHMIN_SHIRLEY")
        for r in (0.3, 0.8)
    },
    "glossy anisotropic": shader("ShaderNodeBsdfGlossy", "GGX", Color=OCHRE, Roughness=0.5, Anisotropy=0.7),
    "anisotropic": shader("ShaderNodeBsdfAnisotropic", "GGX", Color=OCHRE, Roughness=0.5, Anisotropy=0.7),
    "metallic": shader("ShaderNodeBsdfMetallic", "MULTI_GGX", Base_Color=OCHRE, Edge_Tint=BLUE, Roughness=0.4),
    "glass smooth": shader("ShaderNodeBsdfGlass", Color=OCHRE, Roughness=0.0),
    **{
        f"glass {kind} {r}": shader("ShaderNodeBsdfGlass", kind, Color=OCHRE, Roughness=r)
        for kind in ("GGX", "MULTI_GGX", "BECKMANN")
        for r in (0.3, 0.8)
    },
    **{f"refraction {kind}": shader("ShaderNodeBsdfRefraction", kind, Roughness=0.3) for kind in ("GGX", "BECKMANN")},
    **{
        f"sheen {kind} {r}": shader("ShaderNodeBsdfSheen", kind, Color=OCHRE, Roughness=r)
        for kind in ("MICROFIBER", "ASHIKHMIN")
        for r in (0.2, 0.5, 1.0)
    },
    **{f"velvet {s}": shader("ShaderNodeBsdfVelvet", Color=OCHRE, Sigma=s) for s in (0.2, 1.0)},
    "toon": shader("ShaderNodeBsdfToon", Color=OCHRE),
    "subsurface": shader("ShaderNodeSubsurfaceScattering", Color=OCHRE, Radius=(0.1, 0.05, 0.02), Scale=1.0),
    "hair": shader("ShaderNodeBsdfHair", Color=OCHRE),
    "principled hair": shader("ShaderNodeBsdfHairPrincipled"),
    "portal": shader("ShaderNodeBsdfRayPortal"),
    "translucent": shader("ShaderNodeBsdfTranslucent", Color=OCHRE),
}


def block_means(path: Path, scene: Any, engine: str, seed: int) -> Any:
    """(blocks, 3)"""
    pixels = inside.picture(path, engine, seed)
    height, width, _ = pixels.shape
    cut = pixels.reshape(height // BLOCKS, BLOCKS, width // BLOCKS, BLOCKS, 3).astype(np.float64)
    return cut.mean(axis=(1, 3))


def compare(out: Path, build: Callable[[], Any]) -> dict[str, Any] | None:
    try:
        material = build()
    except (LookupError, RuntimeError, TypeError):
        return None  # this Blender has no such thing
    scene = scene_of(material)
    scene.render.resolution_x, scene.render.resolution_y = SIZE
    set_up_cycles(scene, samples=SAMPLES)
    scene.glimmer.samples, scene.glimmer.filter = SAMPLES, "BOX"
    means = {
        engine: np.array([block_means(out.with_suffix(".exr"), scene, engine, seed) for seed in range(SEEDS)])
        for engine in ("CYCLES", "GLIMMER")
    }
    from glimmer import reports

    report = reports.last()
    return {**{name: value.tolist() for name, value in means.items()}, "notices": report["export"]["notices"]}


def line(name: str, case: dict[str, Any]) -> str:
    cycles, ours = np.array(case["CYCLES"]), np.array(case["GLIMMER"])
    difference = ours.mean(axis=0) - cycles.mean(axis=0)
    error = np.sqrt((ours.var(axis=0, ddof=1) + cycles.var(axis=0, ddof=1)) / len(ours)) + 1e-4
    ratio = ours.mean(axis=(0, 1, 2)) / cycles.mean(axis=(0, 1, 2))
    relative = difference / cycles.mean(axis=0)
    worst = np.abs(relative).max()
    beyond = (np.abs(difference) / error > 5.0).any(axis=-1).mean()
    told = " | ".join(notice.split(": ", 1)[-1] for notice in case["notices"])
    shown = " ".join(f"{r:.3f}" for r in ratio)
    return f"{name:32} {shown}  worst {worst:6.3f}  beyond noise {beyond:5.1%}  {told}"


def main() -> None:
    out, words = Path(inside.words()[0]), inside.words()[1:]
    inside.enable()
    if not hasattr(bpy.types.Scene, "cycles"):
        bpy.ops.preferences.addon_enable(module="cycles")
    inside.use_format("OPEN_EXR")
    facts = {}
    for name, build in CASES.items():
        if words and not any(word in name for word in words):
            continue
        found = compare(out, build)
        if found is not None:
            facts[name] = found
            sys.stderr.write(line(name, found) + "\n")
    out.write_text(json.dumps(facts))


if __name__ == "__main__":
    main()
