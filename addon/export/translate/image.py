# SPDX-License-Identifier: GPL-3.0-or-later
"""Image and Environment Texture: pixels are read once and handed to the engine as Blender keeps them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ...scene.program import Texture
from .values import Triple, Value, op

if TYPE_CHECKING:
    from ..nodes import Nodes, Source

MISSING = (1.0, 0.0, 1.0)  # what Cycles shows where an image cannot be read

PROJECTIONS = {
    "FLAT": "flat",
    "BOX": "box",
    "SPHERE": "sphere",
    "TUBE": "tube",
    "EQUIRECTANGULAR": "equirectangular",
    "MIRROR_BALL": "mirror_ball",
}
INTERPOLATIONS = {"Linear": "linear", "Closest": "closest", "Cubic": "cubic", "Smart": "cubic"}
EXTENSIONS = {"REPEAT": "repeat", "EXTEND": "extend", "CLIP": "clip", "MIRROR": "mirror"}

# Colour spaces whose numbers are no colours, and those whose colours are linear already.
DATA_SPACES = ("Non-Color", "Raw", "Generic Data", "Non-Colour Data")
LINEAR_SPACES = ("Linear", "Linear Rec.709")


class Images:
    """The images of one export, each read once."""

    def __init__(self) -> None:
        self._textures: dict[tuple[int, bool], Texture] = {}

    def texture(self, image: Any) -> Texture:
        """Raises ValueError for an image without pixels."""
        key = (image.as_pointer(), image.alpha_mode in ("CHANNEL_PACKED", "NONE"))
        if key not in self._textures:
            self._textures[key] = _read(image)
        return self._textures[key]


def _read(image: Any) -> Texture:
    width, height = image.size
    channels = image.channels
    if not width or not height or not channels:
        raise ValueError("has no pixels")
    pixels = np.empty(width * height * channels, np.float32)
    image.pixels.foreach_get(pixels)
    pixels = pixels.reshape(height, width, channels)
    is_srgb = not image.is_float and image.colorspace_settings.name not in DATA_SPACES + LINEAR_SPACES
    if channels in (2, 4) and image.alpha_mode == "NONE":
        pixels[..., -1] = 1.0
    if image.is_float:
        return Texture(image.name, _without_alpha(np.nan_to_num(pixels)))
    encoded = np.round(pixels * 255.0).astype(np.uint8)
    if channels in (2, 4) and is_alpha_apart(image):
        # In whole numbers, as Blender keeps them.
        encoded[..., :-1] = encoded[..., :-1].astype(np.uint16) * encoded[..., -1:] // 255
    return Texture(image.name, _without_alpha(encoded), srgb=is_srgb)


def is_alpha_apart(image: Any) -> bool:
    """Whether colours are multiplied by their alpha when they are stored, and may be divided by it again."""
    return image.alpha_mode not in ("CHANNEL_PACKED", "NONE") and image.colorspace_settings.name not in DATA_SPACES


def _without_alpha(pixels: Any) -> Any:
    """The image without an alpha that is 1 everywhere."""
    full = 255 if pixels.dtype == np.uint8 else 1.0
    if pixels.shape[2] in (2, 4) and pixels[..., -1].min() == full:
        return np.ascontiguousarray(pixels[..., :-1])
    return pixels


def image_texture(nodes: Nodes, source: Source) -> Value:
    node = source.node
    wants_alpha = source.output.identifier == "Alpha"
    image = node.image
    try:
        if image is None:
            raise ValueError("has no image")
        if image.source == "TILED":
            nodes.not_translated(source, "an image in tiles (UDIM)")
        texture = nodes.images.texture(image)
    except (ValueError, RuntimeError) as error:
        name = "" if image is None else f"image '{image.name}' "
        nodes.notice(node, f"{name}{error}; shown in magenta, as in Cycles")
        return (1.0,) if wants_alpha else MISSING
    is_environment = node.bl_idname == "ShaderNodeTexEnvironment"
    place: Triple = nodes.texture_place(source, "direction" if is_environment else "uv")
    straight = _is_alpha_used(node) and is_alpha_apart(image)
    modes = (
        PROJECTIONS[node.projection],
        INTERPOLATIONS[node.interpolation],
        EXTENSIONS[getattr(node, "extension", "REPEAT")],
        "straight" if straight else "as_is",
    )
    blend = 0.0 if is_environment else float(node.projection_blend)
    return op("image_alpha" if wants_alpha else "image", place, blend, modes=modes, resource=texture)


def _is_alpha_used(node: Any) -> bool:
    socket = node.outputs.get("Alpha")
    return socket is not None and socket.is_linked
