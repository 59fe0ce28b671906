# SPDX-License-Identifier: GPL-3.0-or-later
"""Image and Environment Texture: pixels are read once and handed to the engine as Blender keeps them."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from ...scene.program import Op, Texture
from ..color_space import DATA_SPACES, SRGB, is_known, to_linear
from ..fold import read_image, stored_pixels
from ..kept import Kept
from .values import Triple, Value, math, number, op, triple, vector_math

if TYPE_CHECKING:
    from ..nodes import Nodes
    from ..sockets import Source

Read = TypeVar("Read")

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

LayerProperty = Callable[[str], tuple[float, float, float, float]]


class Images:
    """The images of one export, each read once, and what else nodes know of the scene: its frame, and the property of a
    name of its view layer."""

    def __init__(self, frame: int = 1, layer_property: LayerProperty | None = None, kept: Kept | None = None) -> None:
        self.frame = frame
        self.asks_others = False  # set where something was asked for that belongs to no material
        self._layer_property: LayerProperty = layer_property or (lambda name: (0.0, 0.0, 0.0, 0.0))
        self._kept = kept or Kept()
        self._textures: dict[tuple[object, ...], Texture] = {}

    def layer_property(self, name: str) -> tuple[float, float, float, float]:
        self.asks_others = True
        return self._layer_property(name)

    def place_of(self, item: Any) -> NDArray[np.float64]:
        """(4, 4), of another object in the world."""
        self.asks_others = True
        return np.array(item.matrix_world, np.float64)

    def texture(self, image: Any) -> Texture:
        """Raises ValueError for an image without pixels."""
        self.asks_others = True
        key = (image.as_pointer(), image.alpha_mode in ("CHANNEL_PACKED", "NONE"))
        if key not in self._textures:
            self._textures[key] = self._read_once("images", image, lambda: _read(image))
        return self._textures[key]

    def _read_once(self, kind: str, image: Any, read: Callable[[], Read]) -> Read:
        if image.source != "FILE" or image.is_dirty:  # Blender tells of no stroke of a brush
            return read()
        return self._kept.get(kind, (image.as_pointer(),), _state(image), read)

    def file_of(self, image: Any, path: str) -> Texture:
        """A frame or tile, a file of its own, with the settings of the image that it belongs to. Raises ValueError or
        RuntimeError."""
        import bpy

        self.asks_others = True
        key = (image.as_pointer(), image.alpha_mode, path)
        if key not in self._textures:
            if not Path(path).is_file():
                raise ValueError(f"has no file {Path(path).name}")
            part = bpy.data.images.load(path, check_existing=False)
            try:
                part.colorspace_settings.name = image.colorspace_settings.name
                part.alpha_mode = image.alpha_mode
                self._textures[key] = _read(part)
            finally:
                bpy.data.images.remove(part)
        return self._textures[key]

    def light(self, image: Any) -> Any:
        """(height, width, 3) of finite linear light that is not negative, top row first; raises as `texture`."""

        def read() -> Any:
            pixels = read_image(image)[::-1, :, :3]
            return np.ascontiguousarray(np.maximum(np.nan_to_num(pixels), 0.0), np.float32)

        self.asks_others = True
        return self._read_once("skies", image, read)


def _state(image: Any) -> tuple[object, ...]:
    """Another one where its pixels may be others, of an image that nobody paints on."""
    try:
        changed = Path(_path(image)).stat().st_mtime_ns
    except OSError:
        changed = 0
    packed = 0 if image.packed_file is None else image.packed_file.size
    settings = image.alpha_mode, image.colorspace_settings.name
    return image.name_full, image.filepath, changed, packed, tuple(image.size), settings


def _read(image: Any) -> Texture:
    pixels = stored_pixels(image)
    channels = image.channels
    space = image.colorspace_settings.name
    has_alpha = channels in (2, 4)
    if has_alpha and image.alpha_mode == "NONE":
        pixels[..., -1] = 1.0
    apart = has_alpha and is_alpha_apart(image)
    off = apart and _is_association_off(image)
    if image.is_float:
        pixels = np.nan_to_num(pixels)
        if off and image.alpha_mode == "STRAIGHT":
            pixels[..., :-1] *= pixels[..., -1:]
        return Texture(image.name, _without_alpha(pixels))
    if not is_known(space):
        return Texture(
            image.name, _without_alpha(_linear(pixels, space, apart and not (off and image.alpha_mode == "PREMUL")))
        )
    encoded = np.round(pixels * 255.0).astype(np.uint8)
    if apart and not (off and image.alpha_mode == "PREMUL"):
        # In whole numbers, as Blender keeps them.
        encoded[..., :-1] = encoded[..., :-1].astype(np.uint16) * encoded[..., -1:] // 255
    return Texture(image.name, _without_alpha(encoded), srgb=space == SRGB)


def _linear(pixels: Any, space: str, is_straight: bool) -> Any:
    """is_straight: colours are still to be multiplied by their alpha."""
    channels = pixels.shape[2]
    colors = pixels[..., :3] if channels >= 3 else np.repeat(pixels[..., :1], 3, axis=2)
    linear = to_linear(colors, space)
    if channels not in (2, 4):
        return linear
    alpha = pixels[..., -1:]
    return np.concatenate([linear * alpha if is_straight else linear, alpha], axis=2)


def _is_association_off(image: Any) -> bool:
    """From 5.1 on Cycles takes packed and generated bytes of premultiplied alpha for multiplied, which in memory they
    are not, and multiplies floats of straight alpha, which in memory are multiplied, once more."""
    import bpy

    return bpy.app.version >= (5, 1) and (image.packed_file is not None or image.source in ("GENERATED", "VIEWER"))


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
            return _tiles(nodes, source)
        texture = _texture_of(nodes, node)
    except (ValueError, RuntimeError) as error:
        name = "" if image is None else f"image '{image.name}' "
        nodes.notice(node, f"{name}{error}; shown in magenta, as in Cycles")
        return (1.0,) if wants_alpha else MISSING
    is_environment = node.bl_idname == "ShaderNodeTexEnvironment"
    place: Triple = nodes.texture_place(source, "direction" if is_environment else "uv")
    return _lookup(nodes, source, texture, place)


def _texture_of(nodes: Nodes, node: Any) -> Texture:
    image = node.image
    if image.source == "MOVIE":
        nodes.notice(node, f"movie '{image.name}' is shown by the frame that Blender holds of it")
    if image.source == "SEQUENCE":
        return nodes.images.file_of(image, frame_path(_path(image), frame_number(node.image_user, nodes.frame)))
    return nodes.images.texture(image)


def _lookup(nodes: Nodes, source: Source, texture: Texture, place: Triple) -> Op:
    node = source.node
    straight = _is_alpha_used(node) and is_alpha_apart(node.image)
    modes = (
        PROJECTIONS[node.projection],
        INTERPOLATIONS[node.interpolation],
        EXTENSIONS[getattr(node, "extension", "REPEAT")],
        "straight" if straight else "as_is",
    )
    blend = float(getattr(node, "projection_blend", 0.0))
    name = "image_alpha" if source.output.identifier == "Alpha" else "image"
    return op(name, place, blend, modes=modes, resource=texture)


def _path(image: Any) -> str:
    import bpy

    return str(bpy.path.abspath(image.filepath, library=image.library))


def frame_number(user: Any, frame: int) -> int:
    """Of a sequence's file at a frame of the scene, by the settings of an image's user."""
    number = frame - user.frame_start + 1
    if user.use_cyclic and user.frame_duration > 0:
        number = (number - 1) % user.frame_duration + 1
    return min(max(number, 0), user.frame_duration) + int(user.frame_offset)


def frame_path(path: str, number: int) -> str:
    """The path with its last digits, before the suffix, replaced by a number of as many."""
    file = Path(path)
    found = re.search(r"(\d+)(\D*)$", file.stem)
    if found is None:
        return path
    digits = f"{number:0{len(found.group(1))}d}"
    return str(file.with_name(f"{file.stem[: found.start()]}{digits}{found.group(2)}{file.suffix}"))


def tile_path(path: str, number: int) -> str:
    u, v = (number - 1001) % 10, (number - 1001) // 10
    return path.replace("<UDIM>", str(number)).replace("<UVTILE>", f"u{u + 1}_v{v + 1}")


def _tiles(nodes: Nodes, source: Source) -> Value:
    """Each square of texture space has a file of its own; where there is none, it is magenta."""
    image = source.node.image
    place = nodes.texture_place(source, "uv")
    wants_alpha = source.output.identifier == "Alpha"
    color: Value = (1.0,) if wants_alpha else MISSING
    # Towards 0: the first tile shows once more on the other side of either axis.
    column, row = (math("trunc", op("separate", place, modes=(axis,))) for axis in "xy")
    cell = op("combine", column, row, 0.0)
    for tile in image.tiles:
        u, v = float((tile.number - 1001) % 10), float((tile.number - 1001) // 10)
        try:
            texture = nodes.images.file_of(image, tile_path(_path(image), tile.number))
        except (ValueError, RuntimeError) as error:
            nodes.notice(source.node, f"image '{image.name}' {error}; shown in magenta, as in Cycles")
            continue
        found = _lookup(nodes, source, texture, vector_math("subtract", place, (u, v, 0.0)))
        inside = math("less_than", op("distance", cell, (u, v, 0.0)), 0.5)
        if wants_alpha:
            color = op("mix_number", inside, number(color), found)
        else:
            color = op("blend", inside, triple(color), found, modes=("mix", "free"))
    return color


def _is_alpha_used(node: Any) -> bool:
    socket = node.outputs.get("Alpha")
    return socket is not None and socket.is_linked
