# SPDX-License-Identifier: GPL-3.0-or-later
"""Which of Blender's properties panels draw under Glimmer, and which the exporter reads: panels_script.py FILE.

Panels draw into a layout that notes the properties. The exporter's are the names in its source that are properties of
the types it reads.
"""

import ast
import json
import sys
import traceback
from pathlib import Path
from types import MethodType
from typing import Any

import bpy

sys.path.insert(0, str(Path(__file__).parent))

import inside

glimmer = inside.enable()
ADDON = Path(glimmer.__file__).parent

from glimmer.export.panorama import SETTINGS  # noqa: E402 - the add-on's name inside Blender
from glimmer.export.panorama import settings_of as panorama_settings  # noqa: E402

# Whose properties decide on the picture.
BLENDERS = ("Camera", "Object", "RenderSettings", "Scene", "ViewLayer", "World", "Material")
LIGHTS = ("PointLight", "SpotLight", "SunLight", "AreaLight")
OWNERS = ("dof", "cycles", "cycles_visibility", "mist_settings", "glimmer")  # groups of settings

drawn: set[str] = set()
drawn_by_us: set[str] = set()
errors: list[str] = []
is_ours = [False]  # the panel that is being drawn


def is_setting(item: Any) -> bool:
    """Something to be set, not what Blender knows by itself or a group of settings."""
    if item.identifier in ("rna_type", "name") or item.is_readonly or item.type == "COLLECTION":
        return False
    return item.type != "POINTER" or item.fixed_type.base is not None  # data-blocks are ID's heirs


def settings_of() -> dict[str, set[str]]:
    """The settings of each type, by the name of its RNA."""
    found: dict[str, set[str]] = {}
    for name in (*BLENDERS, *LIGHTS):
        rna = getattr(bpy.types, name).bl_rna
        groups = [rna.properties[owner].fixed_type for owner in OWNERS if owner in rna.properties]
        for kind in (rna, *groups):
            found[kind.identifier] = {item.identifier for item in kind.properties if is_setting(item)}
    return found


def names_in_source(*folders: Path) -> set[str]:
    """Attributes and strings: some are read by getattr."""
    found: set[str] = set()
    for path in (path for folder in folders for path in folder.rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.Attribute):
                found.add(node.attr)
            elif isinstance(node, ast.Constant) and isinstance(node.value, str) and node.value.isidentifier():
                found.add(node.value)
    return found


def note(data: Any, name: str) -> None:
    if data is not None:
        drawn.add(f"{data.bl_rna.identifier}.{name}")
        if is_ours[0]:
            drawn_by_us.add(f"{data.bl_rna.identifier}.{name}")


class Layout:
    """Takes all that a panel does with a layout."""

    def prop(self, data: Any, name: str, *_: Any, **__: Any) -> None:
        note(data, name)

    template_ID = template_curve_mapping = prop  # noqa: N815 - Blender's name

    def prop_search(self, data: Any, name: str, *_: Any, **__: Any) -> None:
        note(data, name)

    def __getattr__(self, _: str) -> Any:
        return lambda *__, **___: self


class Self:
    """In place of a panel, which nobody but Blender can make."""

    def __init__(self, panel: Any) -> None:
        self._panel, self.layout = panel, Layout()

    def __getattr__(self, name: str) -> Any:
        value = getattr(self._panel, name)
        return MethodType(value, self) if callable(value) and not hasattr(value, "__self__") else value


class Context:
    def __init__(self, item: Any) -> None:
        self.object = self.active_object = item
        self.engine = "GLIMMER"
        self.camera = item.data if item.type == "CAMERA" else None
        self.light = item.data if item.type == "LIGHT" else None
        self.mesh = item.data if item.type == "MESH" else None
        self.material = item.active_material
        self.material_slot = None
        self.world = bpy.context.scene.world

    def __getattr__(self, name: str) -> Any:
        return getattr(bpy.context, name)


def scene() -> list[Any]:
    """With what makes panels draw all that they ever do."""
    inside.empty_scene()
    bpy.context.preferences.view.show_developer_ui = True
    thing = inside.ball("Ball", inside.material("ShaderNodeBsdfDiffuse"))
    thing.is_shadow_catcher = True
    instancer = bpy.data.objects.new("Instancer", None)
    bpy.context.scene.collection.objects.link(instancer)
    instancer.instance_type, instancer.instance_collection = "COLLECTION", bpy.data.collections.new("Instanced")
    lamps = [inside.lamp(kind, (0.0, 0.0, 2.0)) for kind in ("POINT", "SPOT", "SUN", "AREA")]
    lamps[1].data.use_square = True
    lamps[3].data.shape = "RECTANGLE"
    lens = bpy.context.scene.camera
    lens.data.dof.aperture_blades, lens.data.sensor_fit = 5, "VERTICAL"
    flat = bpy.data.objects.new("Flat", bpy.data.cameras.new("Flat"))
    flat.data.type = "ORTHO"
    bpy.context.scene.collection.objects.link(flat)
    around = []
    for kind in SETTINGS:
        item = bpy.data.objects.new(kind, bpy.data.cameras.new(kind))
        item.data.type = "PANO"
        try:
            panorama_settings(item.data).panorama_type = kind
        except TypeError:  # this Blender has no such type
            continue
        bpy.context.scene.collection.objects.link(item)
        around.append(item)
    settings = bpy.context.scene
    settings.render.use_multiview = settings.render.film_transparent = True
    settings.render.threads_mode = "FIXED"
    settings.cycles.rolling_shutter_type = "TOP"
    settings.world.cycles.max_bounces = 3
    return [thing, instancer, lens, flat, *around, *lamps]


def draw(panel: Any, context: Context) -> None:
    is_ours[0] = panel.__name__.startswith("GLIMMER_")
    try:
        if not panel.poll.__func__(panel, context) if hasattr(panel, "poll") else False:
            return
        for name in ("draw_header", "draw"):
            if name in dir(panel):
                getattr(panel, name)(Self(panel), context)
    except Exception:  # noqa: BLE001 - Blender's own panels want a window for some things
        if is_ours[0]:
            errors.append(f"{panel.__name__}: {traceback.format_exc()}")


def panels() -> list[Any]:
    found = []
    for panel in bpy.types.Panel.__subclasses__():
        pending = [panel]
        while pending:
            cls = pending.pop()
            pending += cls.__subclasses__()
            engines = getattr(cls, "COMPAT_ENGINES", {"GLIMMER"})
            if getattr(cls, "bl_space_type", "") == "PROPERTIES" and "GLIMMER" in engines and cls.is_registered:
                found.append(cls)
    return found


for thing in scene():
    for panel in panels():
        draw(panel, Context(thing))
settings = {f"{kind}.{name}" for kind, names in settings_of().items() for name in names}
exported = names_in_source(ADDON / "export")
used = names_in_source(*(path for path in ADDON.iterdir() if path.is_dir() and path.name != "ui"))
facts = {
    "drawn": sorted(drawn & settings),
    "drawn_by_us": sorted(drawn_by_us & settings),
    "read": sorted(setting for setting in settings if setting.partition(".")[2] in exported),
    "used": sorted(setting for setting in settings if setting.partition(".")[2] in used),
    "errors": errors,
}
Path(inside.words()[0]).write_text(json.dumps(facts, indent=1))
