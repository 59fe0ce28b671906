# SPDX-License-Identifier: GPL-3.0-or-later
"""The live parameters of a hexagon field, on its object: `Object.glimmer_field`, made from the table of parameters."""

import math
from typing import Any

import bpy

from ..callbacks import of_group_and
from .parameters import Control, FieldParameters, controls


def read(group: Any) -> FieldParameters:
    """The parameters that a property group holds. Blender keeps float32, which may round past a limit: cut it off
    again.
    """
    values = {}
    for name, control in controls():
        value = getattr(group, name)
        if not isinstance(value, (str, bool, int, float)):
            value = tuple(value)
        numeric = not control.choices and not isinstance(value, (bool, tuple))
        values[name] = value if not numeric else min(max(value, control.minimum), control.maximum)
    return FieldParameters(**values)


def write(group: Any, parameters: FieldParameters) -> None:
    """Sets all parameters of a field and rebuilds it once."""
    enabled, group.enabled = group.enabled, False
    for name, _ in controls():
        setattr(group, name, getattr(parameters, name))
    group.enabled = enabled


def _rebuild(group: Any, _context: Any) -> None:
    from . import field

    if group.enabled:
        field.rebuild(group.id_data, read(group))


_changed = of_group_and(_rebuild)


def blender_property(name: str, control: Control, default: Any, update: Any = None) -> Any:
    """A parameter of the table as a bpy.props definition."""
    common: dict[str, Any] = {"name": control.label, "description": control.help, "default": default}
    if not control.animatable:
        common["options"] = set()
    if update is not None:
        common["update"] = update
    if control.choices:
        return bpy.props.EnumProperty(items=control.choices, **common)
    if isinstance(default, bool):
        return bpy.props.BoolProperty(**common)
    if isinstance(default, tuple):
        return bpy.props.FloatVectorProperty(**common, subtype="COLOR", size=3, min=0.0, max=1.0)
    number = type(default)
    limits: dict[str, Any] = {"min": number(control.minimum)}
    if control.maximum < math.inf:
        limits["max"] = number(control.maximum)
    if control.soft_maximum is not None:
        limits["soft_max"] = number(control.soft_maximum)
    if number is int:
        return bpy.props.IntProperty(**common, **limits)
    precision = 3 if control.unit != "ROTATION" else 1
    kind = {"subtype": "PIXEL"} if control.unit == "PIXEL" else {"unit": control.unit}
    return bpy.props.FloatProperty(**common, **limits, **kind, precision=precision)


def field_annotations(update: Any = None) -> dict[str, Any]:
    defaults = FieldParameters()
    return {name: blender_property(name, control, getattr(defaults, name), update) for name, control in controls()}


_OWN_ANNOTATIONS = {
    "enabled": bpy.props.BoolProperty(
        name="Hexagon Field", description="This object is a hexagon field", options={"HIDDEN"}, update=_changed
    ),
    "plate_material": bpy.props.PointerProperty(
        type=bpy.types.Material, name="Plates", description="Of tops, sides and bottoms", update=_changed
    ),
    "bevel_material": bpy.props.PointerProperty(
        type=bpy.types.Material, name="Bevels", description="Of the rounded edges", update=_changed
    ),
    "ground": bpy.props.PointerProperty(
        type=bpy.types.Object,
        name="Ground",
        description="A mesh that plates stand on, as seen from above, or are scattered over; where it is not, no plate"
        " stands",
        poll=of_group_and(lambda _group, obj: obj.type == "MESH" and not obj.glimmer_field.enabled),
        update=_changed,
    ),
    "height_image": bpy.props.PointerProperty(
        type=bpy.types.Image,
        name="Height Image",
        description="Heights that hills stand on: the red of its pixels",
        update=_changed,
    ),
}

GlimmerHexagonField = type(
    "GlimmerHexagonField",
    (bpy.types.PropertyGroup,),
    {"__annotations__": _OWN_ANNOTATIONS | field_annotations(_changed), "__doc__": "Parameters of a hexagon field"},
)


def register() -> None:
    bpy.utils.register_class(GlimmerHexagonField)
    bpy.types.Object.glimmer_field = bpy.props.PointerProperty(type=GlimmerHexagonField, name="Hexagon Field")


def unregister() -> None:
    del bpy.types.Object.glimmer_field
    bpy.utils.unregister_class(GlimmerHexagonField)
