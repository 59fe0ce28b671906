# SPDX-License-Identifier: GPL-3.0-or-later
"""Functions for Blender's properties to call (`update`, `items`, `get` and `set`), apart from all that holds bpy.

Blender 4.2 never lets go of a property's function, nor of all that the function's module holds. As a module it frees
itself when nobody holds bpy any more, so with a function that does it never would, and the program that imported bpy
would end with a segmentation fault. What a property is given here holds this module alone, and `forget` empties it.
"""

from collections.abc import Callable
from typing import Any

_functions: list[Callable[..., Any]] = []


def of_group(function: Callable[[Any], Any]) -> Callable[[Any], Any]:
    """For `get`, which is called with the property group."""
    number = len(_functions)
    _functions.append(function)

    def call(group: Any) -> Any:
        return _functions[number](group)

    return call


def of_group_and(function: Callable[[Any, Any], Any]) -> Callable[[Any, Any], Any]:
    """For `set`, which is called with the property group and the value, and for `update` and `items`, which are called
    with the property group and the context.
    """
    number = len(_functions)
    _functions.append(function)

    def call(group: Any, other: Any) -> Any:
        return _functions[number](group, other)

    return call


def forget() -> None:
    """For the end of the process: no property can call anything any more."""
    _functions.clear()
