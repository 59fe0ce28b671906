# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes and their options, as functions that build them in a tree and give the socket to show."""

import tempfile
from collections.abc import Callable, Iterator
from functools import partial
from itertools import product
from pathlib import Path
from typing import Any

import bpy
import numpy as np

Build = Callable[[Any], Any]
Case = tuple[str, Build]
Values = dict[Any, Any]
VERSION = bpy.app.version


def make(tree: Any, kind: str, out: int | str = 0, inputs: dict[Any, Any] | None = None, **settings: Any) -> Any:
    """An output of a new node. Inputs by number or identifier: values, or sockets to link; what a version lacks or
    hides is left out."""
    node = tree.nodes.new(kind)
    for name, value in settings.items():
        setattr(node, name, value)
    by_identifier = {socket.identifier: socket for socket in node.inputs}
    for key, value in (inputs or {}).items():
        socket = node.inputs[key] if isinstance(key, int) else by_identifier.get(key)
        if socket is None:
            continue
        if isinstance(value, bpy.types.NodeSocket):
            tree.links.new(value, socket)
        else:
            socket.default_value = value
    if isinstance(out, int):
        return node.outputs[out]
    return {socket.identifier: socket for socket in node.outputs}[out]


def node(kind: str, out: int | str = 0, inputs: dict[Any, Any] | None = None, **settings: Any) -> Build:
    """A node by itself."""

    def build(tree: Any) -> Any:
        return make(tree, kind, out, inputs, **settings)

    return build


def place(tree: Any) -> Any:
    return make(tree, "ShaderNodeTexCoord", "Object")


def moved(tree: Any) -> Any:
    settings = Values({"Location": (0.4, 0.2, 0.1), "Scale": (0.8, 0.7, 0.9)})
    return make(tree, "ShaderNodeMapping", inputs={"Vector": place(tree), **settings})


def along(tree: Any, axis: int = 0) -> Any:
    return make(tree, "ShaderNodeSeparateXYZ", axis, inputs={0: place(tree)})


def nanometres(tree: Any) -> Any:
    inputs = Values({0: along(tree), 1: 160.0, 2: 580.0})
    return make(tree, "ShaderNodeMath", inputs=inputs, operation="MULTIPLY_ADD")


def magic(tree: Any) -> Any:
    return make(tree, "ShaderNodeTexMagic", inputs={"Vector": place(tree), "Scale": 0.5})


def noise(tree: Any) -> Any:
    return make(tree, "ShaderNodeTexNoise", 1, inputs={"Vector": place(tree)})


def enumeration(kind: str, name: str) -> list[str]:
    return [item.identifier for item in getattr(bpy.types, kind).bl_rna.properties[name].enum_items]


def texture(kind: str, out: int | str, inputs: dict[Any, Any], **settings: Any) -> Build:
    """A texture at the object's coordinates, its W along x."""

    def build(tree: Any) -> Any:
        return make(tree, kind, out, inputs={"Vector": place(tree), "W": along(tree), **inputs}, **settings)

    return build


def noises() -> Iterator[Case]:
    inputs = Values({"Scale": 3.0, "Detail": 2.5, "Roughness": 0.6, "Distortion": 0.7})
    fractals = ("MULTIFRACTAL", "RIDGED_MULTIFRACTAL", "HYBRID_MULTIFRACTAL", "HETERO_TERRAIN", "FBM")
    other = Values({"Scale": 3.0, "Detail": 2.3, "Roughness": 0.6, "Lacunarity": 2.2, "Offset": 0.3, "Gain": 1.3})
    for d in ("1D", "2D", "3D", "4D"):
        for out in (0, 1):
            yield f"noise {d} {out}", texture("ShaderNodeTexNoise", out, inputs, noise_dimensions=d)
        for kind in fractals if VERSION >= (4, 1) else ():
            settings = Values({"noise_dimensions": d, "noise_type": kind, "normalize": False})
            yield f"noise {d} {kind}", texture("ShaderNodeTexNoise", 1, other, **settings)
        for kind, detail in product(fractals if VERSION < (4, 1) else (), (0.5, 2.0, 3.3)):
            values: Values = {
                "Scale": 3.0,
                "Detail": detail,
                "Dimension": 1.3,
                "Lacunarity": 2.2,
                "Offset": 0.6,
                "Gain": 1.3,
            }
            settings = Values({"musgrave_dimensions": d, "musgrave_type": kind})
            yield f"musgrave {d} {kind} {detail}", texture("ShaderNodeTexMusgrave", 0, values, **settings)
    yield from gabors() if VERSION >= (4, 3) else ()
    yield "noise without detail", texture("ShaderNodeTexNoise", 0, {"Detail": 0.0})
    for d, out in product(("1D", "2D", "3D", "4D"), (0, 1)):
        yield f"white noise {d} {out}", white_noise(d, out)


def gabors() -> Iterator[Case]:
    for kind, out, anisotropy in product(("2D", "3D"), ("Value", "Phase", "Intensity"), (1.0, 0.4)):
        inputs: Values = {
            "Scale": 1.7,
            "Frequency": 1.3,
            "Anisotropy": anisotropy,
            "Orientation 2D": 0.7,
            "Orientation 3D": (0.3, 0.5, 0.7),
        }
        yield f"gabor {kind} {out} {anisotropy}", texture("ShaderNodeTexGabor", out, inputs, gabor_type=kind)


def white_noise(dimensions: str, out: int) -> Build:
    """Of cells, since it is another at every point."""

    def build(tree: Any) -> Any:
        steps = {0: place(tree), 1: (0.5, 0.5, 0.5)}
        cells = make(tree, "ShaderNodeVectorMath", inputs=steps, operation="SNAP")
        w = make(tree, "ShaderNodeSeparateXYZ", inputs={0: cells})
        inputs = Values({"Vector": cells, "W": w})
        return make(tree, "ShaderNodeTexWhiteNoise", out, inputs=inputs, noise_dimensions=dimensions)

    return build


def voronois() -> Iterator[Case]:
    kind = "ShaderNodeTexVoronoi"
    inputs = Values({"Scale": 2.0, "Randomness": 0.8, "Smoothness": 0.7})
    for d, feature in product(
        ("1D", "2D", "3D", "4D"), ("F1", "F2", "SMOOTH_F1", "DISTANCE_TO_EDGE", "N_SPHERE_RADIUS")
    ):
        outs = {"DISTANCE_TO_EDGE": ["Distance"], "N_SPHERE_RADIUS": ["Radius"]}.get(feature, ["Distance", "Color"])
        if feature in ("F1", "F2", "SMOOTH_F1"):
            outs = outs + (["Position"] if d != "1D" else []) + (["W"] if d in ("1D", "4D") else [])
        for out in outs:
            yield (
                f"voronoi {d} {feature} {out}",
                texture(kind, out, inputs, voronoi_dimensions=d, feature=feature),
            )
        for out in outs[:2] if VERSION >= (4, 0) and feature != "N_SPHERE_RADIUS" else ():
            octaves = Values({"Scale": 1.0, "Detail": 1.4, "Roughness": 0.6, "Lacunarity": 2.1})
            settings = Values({"voronoi_dimensions": d, "feature": feature, "normalize": d != "2D"})
            yield f"voronoi octaves {d} {feature} {out}", texture(kind, out, octaves, **settings)
    for metric, feature in product(("MANHATTAN", "CHEBYCHEV", "MINKOWSKI"), ("F1", "F2", "SMOOTH_F1")):
        values = Values({"Scale": 2.0, "Exponent": 1.7})
        yield f"voronoi {metric} {feature}", texture(kind, 0, values, distance=metric, feature=feature)


def patterns() -> Iterator[Case]:
    for kind, axes in (("BANDS", ("X", "Y", "Z", "DIAGONAL")), ("RINGS", ("X", "Y", "Z", "SPHERICAL"))):
        for axis, profile in product(axes, ("SIN", "SAW", "TRI")):
            settings = Values({"wave_type": kind, f"{kind.lower()}_direction": axis, "wave_profile": profile})
            inputs = Values({"Scale": 0.7, "Phase Offset": 0.3})
            yield f"wave {kind} {axis} {profile}", texture("ShaderNodeTexWave", 0, inputs, **settings)
    distorted = Values({"Scale": 0.7, "Distortion": 2.0, "Detail": 2.5, "Detail Scale": 1.3, "Detail Roughness": 0.6})
    yield "wave distorted", texture("ShaderNodeTexWave", 1, distorted)
    colors = Values({"Color1": (0.2, 0.4, 0.9, 1.0), "Color2": (0.9, 0.1, 0.3, 1.0)})
    for out in (0, 1):
        yield f"checker {out}", texture("ShaderNodeTexChecker", out, {"Scale": 2.3, **colors})
        for kind in enumeration("ShaderNodeTexGradient", "gradient_type"):
            yield f"gradient {kind} {out}", texture("ShaderNodeTexGradient", out, {}, gradient_type=kind)
        bricks: Values = {
            "Scale": 2.0,
            "Mortar": (0.0, 0.5, 0.0, 1.0),
            "Mortar Size": 0.05,
            "Mortar Smooth": 0.3,
            "Bias": 0.1,
        }
        settings = Values({"offset": 0.4, "offset_frequency": 3, "squash": 1.3, "squash_frequency": 2})
        yield f"brick {out}", texture("ShaderNodeTexBrick", out, {**bricks, **colors}, **settings)
    for depth in range(11):
        inputs = Values({"Scale": 1.3, "Distortion": 1.2})
        yield f"magic {depth}", texture("ShaderNodeTexMagic", depth % 2, inputs, turbulence_depth=depth)


def numbers() -> Iterator[Case]:
    for operation, clamp in product(enumeration("ShaderNodeMath", "operation"), (False, True)):

        def math(tree: Any, operation: str = operation, clamp: bool = clamp) -> Any:
            inputs: Values = {
                0: along(tree),
                1: make(tree, "ShaderNodeMath", inputs={0: along(tree, 1), 1: 0.0371}),
                2: 0.4,
            }
            return make(tree, "ShaderNodeMath", inputs=inputs, operation=operation, use_clamp=clamp)

        yield f"math {operation} {clamp}", math
    turned = Values({"Rotation": (0.3, 0.5, 0.7), "Location": (0.1, 0.2, 0.3)})
    for operation in enumeration("ShaderNodeVectorMath", "operation"):

        def vector_math(tree: Any, operation: str = operation) -> Any:
            other = make(tree, "ShaderNodeMapping", inputs={"Vector": place(tree), **turned})
            inputs = Values({0: place(tree), 1: other, 2: (0.3, -0.4, 0.5), "Scale": 0.7})
            out = "Value" if operation in ("DOT_PRODUCT", "LENGTH", "DISTANCE") else "Vector"
            return make(tree, "ShaderNodeVectorMath", out, inputs=inputs, operation=operation)

        yield f"vector math {operation}", vector_math
    for kind in enumeration("ShaderNodeMapping", "vector_type"):
        inputs = Values({**turned, "Scale": (1.5, 0.7, -2.0)})
        yield f"mapping {kind}", texture("ShaderNodeMapping", 0, inputs, vector_type=kind)
    for kind, invert in product(enumeration("ShaderNodeVectorRotate", "rotation_type"), (False, True)):
        inputs = Values({"Center": (0.1, 0.2, 0.3), "Axis": (0.3, 0.5, 0.7), "Angle": 0.8, "Rotation": (0.3, 0.5, 0.7)})
        settings = Values({"rotation_type": kind, "invert": invert})
        yield f"rotate {kind} {invert}", texture("ShaderNodeVectorRotate", 0, inputs, **settings)
    for kind, clamp in product(enumeration("ShaderNodeMapRange", "interpolation_type"), (False, True)):
        settings = Values({"interpolation_type": kind, "clamp": clamp})

        def map_range(tree: Any, settings: dict[str, Any] = settings) -> Any:
            inputs = Values({0: along(tree), 1: -0.5, 2: 1.2, 3: 0.9, 4: -0.3})
            return make(tree, "ShaderNodeMapRange", inputs=inputs, **settings)

        def map_vectors(tree: Any, settings: dict[str, Any] = settings) -> Any:
            inputs: Values = {
                "Vector": place(tree),
                "From_Min_FLOAT3": (-1.0, -0.5, 0.0),
                "From_Max_FLOAT3": (1.0, 0.7, 0.5),
                "To_Min_FLOAT3": (1.0, 0.2, 0.5),
                "To_Max_FLOAT3": (0.0, 0.7, 1.0),
            }
            return make(tree, "ShaderNodeMapRange", "Vector", inputs=inputs, data_type="FLOAT_VECTOR", **settings)

        yield f"map range {kind} {clamp}", map_range
        yield f"map range of vectors {kind} {clamp}", map_vectors
    for kind in ("MINMAX", "RANGE"):

        def clamped(tree: Any, kind: str = kind) -> Any:
            return make(tree, "ShaderNodeClamp", inputs={0: along(tree), 1: 0.6, 2: -0.2}, clamp_type=kind)

        yield f"clamp {kind}", clamped


def colors() -> Iterator[Case]:
    for mode, clamp in product(enumeration("ShaderNodeMixRGB", "blend_type"), (False, True)):

        def mix_rgb(tree: Any, mode: str = mode, clamp: bool = clamp) -> Any:
            inputs = Values({0: 0.7, 1: magic(tree), 2: noise(tree)})
            return make(tree, "ShaderNodeMixRGB", inputs=inputs, blend_type=mode, use_clamp=clamp)

        yield f"mix colours {mode} {clamp}", mix_rgb
    for kind, clamp, factor in product(("FLOAT", "VECTOR", "RGBA"), (False, True), ("UNIFORM", "NON_UNIFORM")):

        def mix(tree: Any, kind: str = kind, clamp: bool = clamp, factor: str = factor) -> Any:
            end = {"FLOAT": "Float", "VECTOR": "Vector", "RGBA": "Color"}[kind]
            inputs = Values({f"A_{end}": magic(tree), f"B_{end}": noise(tree)})
            factors = Values({"Factor_Float": along(tree), "Factor_Vector": place(tree)})
            settings = Values({"data_type": kind, "clamp_factor": clamp, "factor_mode": factor})
            return make(tree, "ShaderNodeMix", f"Result_{end}", inputs={**inputs, **factors}, **settings)

        yield f"mix {kind} {clamp} {factor}", mix
    for name, kind, values in (
        ("hue", "ShaderNodeHueSaturation", {"Hue": 0.7, "Saturation": 1.3, "Value": 0.8, "Fac": 0.9, "Color": magic}),
        ("bright", "ShaderNodeBrightContrast", {0: magic, 1: 0.2, 2: 0.7}),
        ("gamma", "ShaderNodeGamma", {0: magic, 1: 2.2}),
        ("invert", "ShaderNodeInvert", {0: 0.8, 1: magic}),
        ("grey", "ShaderNodeRGBToBW", {0: magic}),
        ("wavelength", "ShaderNodeWavelength", {0: nanometres}),
        ("a colour as a number", "ShaderNodeMath", {0: magic, 1: 0.0}),
        ("a vector as a number", "ShaderNodeMath", {0: place, 1: 0.0}),
        ("normal", "ShaderNodeNormal", {0: place}),
    ):

        def built(tree: Any, kind: str = kind, values: dict[Any, Any] = values) -> Any:
            inputs = Values({key: value(tree) if callable(value) else value for key, value in values.items()})
            return make(tree, kind, 1 if kind == "ShaderNodeNormal" else 0, inputs=inputs)

        yield name, built
    for mode in ("RGB", "HSV", "HSL"):

        def separate(tree: Any, mode: str = mode) -> Any:
            node = make(tree, "ShaderNodeSeparateColor", inputs={0: magic(tree)}, mode=mode).node
            return make(tree, "ShaderNodeCombineXYZ", inputs={i: node.outputs[i] for i in range(3)})

        def combine(tree: Any, mode: str = mode) -> Any:
            inputs = Values({i: along(tree, i) for i in range(3)})
            return make(tree, "ShaderNodeCombineColor", inputs=inputs, mode=mode)

        yield f"separate {mode}", separate
        yield f"combine {mode}", combine
    yield from ramps_and_curves()


def ramps_and_curves() -> Iterator[Case]:
    modes = [("RGB", kind) for kind in ("LINEAR", "CONSTANT", "EASE", "B_SPLINE", "CARDINAL")]
    for (mode, kind), out in product([*modes, ("HSV", "EASE"), ("HSL", "EASE")], (0, 1)):

        def ramp(tree: Any, mode: str = mode, kind: str = kind, out: int = out) -> Any:
            socket = make(tree, "ShaderNodeValToRGB", out, inputs={0: along(tree)})
            colors = socket.node.color_ramp
            colors.interpolation, colors.color_mode = kind, mode
            colors.elements.new(0.4).color = (0.9, 0.2, 0.1, 0.3)
            colors.elements[0].color, colors.elements[0].position = (0.1, 0.3, 0.8, 1.0), 0.1
            return socket

        yield f"ramp {mode} {kind} {out}", ramp
    for kind, extend in product(("RGB", "Vector", "Float"), ("HORIZONTAL", "EXTRAPOLATED")):

        def curve(tree: Any, kind: str = kind, extend: str = extend) -> Any:
            name = f"ShaderNode{kind}Curve"
            inputs = Values({0: 0.8, 1: along(tree) if kind == "Float" else place(tree)})
            socket = make(tree, name, inputs=inputs)
            mapping = socket.node.mapping
            mapping.extend = extend
            for i, line in enumerate(mapping.curves):
                line.points.new(0.3, 0.6 - 0.1 * i)
            mapping.update()
            return socket

        yield f"curve {kind} {extend}", curve


def new_image(name: str, as_float: bool, alpha: bool, space: str, mode: str = "STRAIGHT") -> Any:
    image = bpy.data.images.new(name, 7, 5, alpha=alpha, float_buffer=as_float)
    image.colorspace_settings.name = space
    pixels = np.random.default_rng(1).random((5, 7, 4)).astype(np.float32)
    if not alpha:
        pixels[..., 3] = 1.0
    image.pixels.foreach_set(pixels.reshape(-1))
    image.update()
    image.pack()
    image.alpha_mode = mode
    return image


def images() -> Iterator[Case]:
    linear = "Linear Rec.709" if VERSION >= (4, 0) else "Linear"
    made = {
        "bytes": new_image("bytes", False, False, "sRGB"),
        "floats": new_image("floats", True, False, linear),
        "data": new_image("data", False, False, "Non-Color"),
        "straight": new_image("straight", False, True, "sRGB"),
        "packed": new_image("packed", False, True, "sRGB", "CHANNEL_PACKED"),
        "premultiplied": new_image("premultiplied", False, True, "sRGB", "PREMUL"),
        "none": new_image("none", False, True, "sRGB", "NONE"),
        "floats with alpha": new_image("floats with alpha", True, True, linear),
    }
    kind = "ShaderNodeTexImage"

    def image(name: str, out: int = 0, **settings: Any) -> Build:
        def build(tree: Any) -> Any:
            return make(tree, kind, out, inputs={"Vector": moved(tree)}, image=made[name], **settings)

        return build

    for name in made:
        for interpolation in ("Linear", "Closest", "Cubic"):
            yield f"image {name} {interpolation}", image(name, interpolation=interpolation)
        if name in ("bytes", "floats", "data"):
            continue
        yield f"image {name} alpha", image(name, 1)

        def over_black(tree: Any, name: str = name) -> Any:
            socket = image(name)(tree)
            inputs = Values({0: socket.node.outputs[1], 1: (0.0, 0.0, 0.0, 1.0), 2: socket})
            return make(tree, "ShaderNodeMixRGB", inputs=inputs)

        yield f"image {name} over black", over_black
    extensions = ("EXTEND", "CLIP", "MIRROR") if VERSION >= (3, 5) else ("EXTEND", "CLIP")
    for extension, interpolation in product(extensions, ("Linear", "Closest", "Cubic")):
        settings = Values({"extension": extension, "interpolation": interpolation})
        yield f"image {extension} {interpolation}", image("floats", **settings)
    for projection, blend in (("BOX", 0.0), ("BOX", 0.3), ("SPHERE", 0.0), ("TUBE", 0.0)):
        settings = Values({"projection": projection, "projection_blend": blend})
        yield f"image {projection} {blend}", image("bytes", **settings)
    for projection in ("EQUIRECTANGULAR", "MIRROR_BALL"):

        def environment(tree: Any, projection: str = projection) -> Any:
            settings = Values({"image": made["bytes"], "projection": projection})
            return make(tree, "ShaderNodeTexEnvironment", inputs={"Vector": place(tree)}, **settings)

        yield f"environment {projection}", environment
    yield from files()
    yield "image by the UV map", node(kind, image=made["bytes"])


def files() -> Iterator[Case]:
    """Images of several files: tiles, of which one is missing, and frames."""
    folder = Path(tempfile.mkdtemp())
    for number in (1, 2, 3, 1001, 1002):
        image = bpy.data.images.new(str(number), 3, 2)
        image.pixels.foreach_set(np.random.default_rng(number).random(24).astype(np.float32))
        image.filepath_raw, image.file_format = str(folder / f"part.{number:04d}.png"), "PNG"
        image.save()
    tiles = bpy.data.images.load(str(folder / "part.1001.png"))
    tiles.source, tiles.filepath = "TILED", str(folder / "part.<UDIM>.png")
    tiles.tiles.new(1002)
    frames = bpy.data.images.load(str(folder / "part.0001.png"))
    frames.source = "SEQUENCE"

    def tiled(tree: Any) -> Any:
        return make(tree, "ShaderNodeTexImage", inputs={"Vector": moved(tree)}, image=tiles, interpolation="Closest")

    def sequence(tree: Any, start: int, cyclic: bool) -> Any:
        socket = make(tree, "ShaderNodeTexImage", inputs={"Vector": moved(tree)}, image=frames)
        user = socket.node.image_user
        user.frame_start, user.frame_offset, user.frame_duration, user.use_cyclic = start, 0, 3, cyclic
        user.use_auto_refresh = True
        return socket

    yield "image of tiles Closest", tiled
    for start, cyclic in ((1, False), (0, False), (-2, False), (-3, True)):
        yield f"image of frames {start} {cyclic}", partial(sequence, start=start, cyclic=cyclic)


def surfaces() -> Iterator[Case]:
    for out in ("Generated", "Normal", "UV", "Object", "Camera", "Window", "Reflection"):
        yield f"coordinates {out}", node("ShaderNodeTexCoord", out)
    for out in (
        "Position",
        "Normal",
        "True Normal",
        "Incoming",
        "Parametric",
        "Backfacing",
        "Tangent",
        "Random Per Island",
    ):
        yield f"geometry {out}", node("ShaderNodeNewGeometry", out)
    for out in ("Location", "Color", "Alpha", "Object Index", "Material Index", "Random"):
        yield f"object {out}", node("ShaderNodeObjectInfo", out)
    for out in ("View Vector", "View Z Depth", "View Distance"):
        yield f"camera {out}", node("ShaderNodeCameraData", out)
    for out in ("Is Camera Ray", "Is Shadow Ray", "Is Glossy Ray", "Ray Depth"):
        yield f"ray {out}", node("ShaderNodeLightPath", out)
    for in_pixels in (False, True):
        size = 3.0 if in_pixels else 0.3
        yield f"wireframe {in_pixels}", node("ShaderNodeWireframe", inputs={0: size}, use_pixel_size=in_pixels)
    yield "uv map", node("ShaderNodeUVMap", uv_map="UVMap")
    yield "attribute of the uv map", node("ShaderNodeAttribute", 1, attribute_name="UVMap")
    yield "fresnel", node("ShaderNodeFresnel", inputs={0: 1.4})
    for out in ("Fresnel", "Facing"):
        yield f"layer weight {out}", node("ShaderNodeLayerWeight", out, inputs={0: 0.3})
    for axis in ("X", "Y", "Z"):
        yield f"tangent {axis}", node("ShaderNodeTangent", axis=axis)
    for kind, source, target in product(
        ("VECTOR", "POINT", "NORMAL"), ("WORLD", "OBJECT", "CAMERA"), ("WORLD", "OBJECT", "CAMERA")
    ):

        def transform(tree: Any, kind: str = kind, source: str = source, target: str = target) -> Any:
            settings = Values({"vector_type": kind, "convert_from": source, "convert_to": target})
            return make(tree, "ShaderNodeVectorTransform", inputs={"Vector": (0.3, -0.2, 0.9)}, **settings)

        yield f"transform {kind} {source} {target}", transform
    for space in enumeration("ShaderNodeNormalMap", "space"):

        def normal_map(tree: Any, space: str = space) -> Any:
            return make(tree, "ShaderNodeNormalMap", inputs={0: 0.8, 1: (0.6, 0.3, 0.9, 1.0)}, space=space)

        yield f"normal map {space}", normal_map
    for invert in (False, True):

        def bump(tree: Any, invert: bool = invert) -> Any:
            height = make(tree, "ShaderNodeTexWave", 1, inputs={"Vector": place(tree), "Scale": 0.2})
            inputs = Values({"Strength": 0.7, "Distance": 0.3, "Height": height})
            return make(tree, "ShaderNodeBump", inputs=inputs, invert=invert)

        yield f"bump {invert}", bump
    yield from displacements()


def displacements() -> Iterator[Case]:
    """Displacement, of which emission sees the normal."""
    for kind, space in (
        ("Displacement", "OBJECT"),
        ("Displacement", "WORLD"),
        ("VectorDisplacement", "TANGENT"),
        ("VectorDisplacement", "OBJECT"),
        ("VectorDisplacement", "WORLD"),
    ):

        def displaced(tree: Any, kind: str = kind, space: str = space) -> Any:
            wave = make(tree, "ShaderNodeTexWave", 1, inputs={"Vector": place(tree), "Scale": 0.2})
            value: Any = wave if kind == "Displacement" else place(tree)
            inputs = Values({0: value, "Midlevel": 0.2, "Scale": 0.3})
            moved_by = make(tree, f"ShaderNode{kind}", inputs=inputs, space=space)
            output = next(node for node in tree.nodes if node.bl_idname == "ShaderNodeOutputMaterial")
            tree.links.new(moved_by, output.inputs["Displacement"])
            return make(tree, "ShaderNodeNewGeometry", "Normal")

        yield f"{kind} {space}", displaced


def skies() -> Iterator[Case]:
    kind = "ShaderNodeTexSky"
    dust = "dust_density" if VERSION < (5, 0) else "aerosol_density"
    for model in enumeration(kind, "sky_type"):
        if model in ("PREETHAM", "HOSEK_WILKIE"):
            variants = [
                Values({"sun_direction": (0.3, 0.5, 0.6), "turbidity": 2.2}),
                Values({"sun_direction": (-0.7, 0.1, 0.2), "turbidity": 4.5, "ground_albedo": 0.8}),
            ]
        else:
            large = Values({"sun_disc": True, "sun_size": 0.4, "sun_intensity": 0.02})
            thick = Values({dust: 3.0, "air_density": 1.5, "ozone_density": 2.0, "altitude": 2000.0})
            variants = [
                Values({"sun_disc": False, "sun_elevation": 0.26, "sun_rotation": 0.7}),
                Values({**large, **thick, "sun_elevation": 0.6, "sun_rotation": 4.0}),
                Values({**large, "sun_elevation": 0.1, "sun_rotation": -1.0}),
            ]
        for number, settings in enumerate(variants):

            def sky(tree: Any, settings: dict[str, Any] = settings, model: str = model) -> Any:
                direction = make(tree, "ShaderNodeVectorMath", inputs={0: moved(tree)}, operation="NORMALIZE")
                return make(tree, kind, inputs={"Vector": direction}, sky_type=model, **settings)

            yield f"sky {model} {number}", sky


FAMILIES: dict[str, Callable[[], list[Case]]] = {
    "noises": lambda: list(noises()),
    "voronois": lambda: list(voronois()),
    "patterns": lambda: list(patterns()),
    "numbers": lambda: list(numbers()),
    "colors": lambda: list(colors()),
    "images": lambda: list(images()),
    "surfaces": lambda: list(surfaces()),
    "skies": lambda: list(skies()),
}
