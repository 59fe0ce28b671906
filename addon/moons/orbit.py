# SPDX-License-Identifier: GPL-3.0-or-later
"""`Object.glimmer_orbit`: a Kepler orbit that drives its object's place, by drivers that evaluate without Python.

What drivers read and give each other are custom properties of the object, and the property group is how they are shown:
Blender takes all properties of a group for one another's cause, and would find drivers among them to turn in a circle.
"""

import re
from dataclasses import asdict
from typing import Any

import bpy

from ..callbacks import of_group, of_group_and
from . import kepler
from .kepler import Orbit

_NAMES = ("semi_axis", "eccentricity", "period", "inclination", "node", "periapsis", "phase")
_AXES = ("center_x", "center_y", "center_z")
_DEFAULTS = asdict(Orbit())


def _custom(name: str) -> str:
    return f"glimmer_orbit_{name}"


def _proxy(name: str) -> dict[str, Any]:
    """Of a custom property; to animate it, animate that."""

    def get(group: Any) -> float:
        return float(group.id_data.get(_custom(name), _DEFAULTS[name]))

    def put(group: Any, value: float) -> None:
        group.id_data[_custom(name)] = float(value)
        group.id_data.update_tag()

    return {"get": of_group(get), "set": of_group_and(put), "options": set()}


def _center(group: Any) -> tuple[float, ...]:
    return tuple(float(group.id_data.get(_custom(name), 0.0)) for name in _AXES)


def _set_center(group: Any, center: Any) -> None:
    for name, value in zip(_AXES, center, strict=True):
        group.id_data[_custom(name)] = float(value)
    group.id_data.update_tag()


class GlimmerOrbit(bpy.types.PropertyGroup):
    enabled: bpy.props.BoolProperty(  # type: ignore[valid-type]
        name="Orbit", description="Drivers of this object's location hold it on its orbit", options={"HIDDEN"}
    )
    center: bpy.props.FloatVectorProperty(  # type: ignore[valid-type]
        name="Center",
        description="What the moon orbits, one of the ellipse's foci",
        size=3,
        subtype="TRANSLATION",
        get=of_group(_center),
        set=of_group_and(_set_center),
        options=set(),
    )
    semi_axis: bpy.props.FloatProperty(  # type: ignore[valid-type]
        name="Distance",
        description="Half of the ellipse's long axis, which is the mean distance from the centre",
        min=0.0,
        soft_max=1000.0,
        unit="LENGTH",
        **_proxy("semi_axis"),
    )
    eccentricity: bpy.props.FloatProperty(  # type: ignore[valid-type]
        name="Eccentricity",
        description="0: a circle; towards 1: ever longer, and ever faster where it is near",
        min=0.0,
        max=kepler.MOST_ECCENTRIC,
        **_proxy("eccentricity"),
    )
    period: bpy.props.FloatProperty(  # type: ignore[valid-type]
        name="Period",
        description="Frames for once around",
        min=1e-3,
        soft_min=1.0,
        soft_max=10000.0,
        **_proxy("period"),
    )
    inclination: bpy.props.FloatProperty(  # type: ignore[valid-type]
        name="Inclination",
        description="Of the orbit's plane to the horizontal",
        unit="ROTATION",
        **_proxy("inclination"),
    )
    node: bpy.props.FloatProperty(  # type: ignore[valid-type]
        name="Rising Node",
        description="Where the moon rises through the horizontal plane of the centre, from the x axis",
        unit="ROTATION",
        **_proxy("node"),
    )
    periapsis: bpy.props.FloatProperty(  # type: ignore[valid-type]
        name="Periapsis",
        description="From the rising node to the point nearest to the centre",
        unit="ROTATION",
        **_proxy("periapsis"),
    )
    phase: bpy.props.FloatProperty(  # type: ignore[valid-type]
        name="Phase",
        description="How far around it is at frame 0, from the point nearest to the centre, at an even pace",
        unit="ROTATION",
        **_proxy("phase"),
    )


def read(obj: Any) -> Orbit:
    group = obj.glimmer_orbit
    x, y, z = group.center
    return Orbit((x, y, z), **{name: getattr(group, name) for name in _NAMES})


def put_on_orbit(obj: Any, orbit: Orbit) -> None:
    """Gives the object this orbit, and the drivers where it has none."""
    group = obj.glimmer_orbit
    group.center = orbit.center
    for name in _NAMES:
        setattr(group, name, getattr(orbit, name))
    if not group.enabled:
        for name, expression in zip(kepler.STEPS.values(), kepler.ANOMALIES, strict=True):
            obj[_custom(name)] = 0.0
            _drive(obj, f'["{_custom(name)}"]', -1, expression)
        for index, expression in enumerate(kepler.PLACE):
            _drive(obj, "location", index, expression)
        group.enabled = True
    obj.update_tag()


def take_off_orbit(obj: Any) -> None:
    """It stays where it is."""
    if not obj.glimmer_orbit.enabled:
        return
    place = obj.location.copy()
    for name in kepler.STEPS.values():
        obj.driver_remove(f'["{_custom(name)}"]', -1)
        del obj[_custom(name)]
    for index in range(3):
        obj.driver_remove("location", index)
    obj.glimmer_orbit.enabled = False
    obj.location = place


def _drive(obj: Any, path: str, index: int, expression: str) -> None:
    driver = obj.driver_add(path, index).driver
    driver.type = "SCRIPTED"
    for letter in sorted(set(re.findall(r"\b[a-z]\b", expression))):
        variable = driver.variables.new()
        variable.name, variable.type = letter, "SINGLE_PROP"
        target = variable.targets[0]
        name = kepler.VARIABLES.get(letter) or kepler.STEPS[letter]
        target.id, target.data_path = obj, f'["{_custom(name)}"]'
    driver.expression = expression


def register() -> None:
    bpy.utils.register_class(GlimmerOrbit)
    bpy.types.Object.glimmer_orbit = bpy.props.PointerProperty(type=GlimmerOrbit, name="Orbit")


def unregister() -> None:
    del bpy.types.Object.glimmer_orbit
    bpy.utils.unregister_class(GlimmerOrbit)
