# SPDX-License-Identifier: GPL-3.0-or-later
"""A depsgraph -> SceneDescription: the one way in."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ..scene.description import (
    Camera,
    Film,
    Floats,
    Lamp,
    Mesh,
    NamedMaterial,
    Object,
    RenderSettings,
    SceneDescription,
    Spheres,
)
from ..scene.problems import GlimmerError, Notice, Notices, place
from .instance import BulkReader, Placed, placed_objects
from .light import export_lamp
from .material import export_material
from .mesh import export_mesh
from .sphere import NotASphereError, read_sphere
from .translate.image import Images
from .world import export_world, warn_of_black_sky

if TYPE_CHECKING:
    import bpy

SURFACES = {"MESH", "CURVE", "SURFACE", "META", "FONT"}
# Kinds that show something in Cycles and nothing here.
UNSUPPORTED = {"CURVES", "HAIR", "POINTCLOUD", "VOLUME", "GPENCIL", "GREASEPENCIL"}


@dataclass(frozen=True)
class View:
    """What a picture is made of a scene with: the camera's for F12, the region's in a 3D view."""

    film: Film
    camera: Camera
    settings: RenderSettings


@dataclass(frozen=True)
class Exported:
    scene: SceneDescription
    notices: tuple[Notice, ...]
    seconds: float  # of the export
    bytes: int  # of its arrays


def export_scene(
    depsgraph: bpy.types.Depsgraph,
    view: Callable[[bpy.types.Scene, Notices], View],
    version: tuple[int, ...],
    readers: tuple[BulkReader, ...] = (),
    is_shown: Callable[[bpy.types.Object], bool] | None = None,
    constants_only: bool = False,
) -> Exported:
    """Raises GlimmerError when no picture can be made of the scene.

    view: of the evaluated scene. version: Blender's. readers: see BulkReader. is_shown: of an evaluated object, for
    what the depsgraph does not know (a local view). constants_only: materials do not vary, as in a scene file.
    """
    start = time.perf_counter()
    notices = Notices()
    scene = depsgraph.scene_eval
    seen = view(scene, notices)
    collector = _Collector(depsgraph, version, notices, constants_only)
    for placed in placed_objects(depsgraph, readers, is_shown):
        collector.add(placed)
    environment, medium = export_world(scene.world, notices, collector.images, constants_only)
    lights = tuple(collector.lights)
    warn_of_black_sky(scene.world, environment, lights, medium, notices)
    description = SceneDescription(
        film=seen.film,
        camera=seen.camera,
        materials=tuple(collector.materials),
        objects=tuple(collector.objects),
        spheres=tuple(collector.spheres),
        lights=lights,
        environment=environment,
        medium=medium,
        settings=seen.settings,
    )
    return Exported(description, tuple(notices.items), time.perf_counter() - start, _size(description))


def _size(scene: SceneDescription) -> int:
    arrays: list[Any] = [item.instances for item in scene.objects] + [scene.environment.image]
    for mesh in scene.meshes():
        arrays += [mesh.vertices, mesh.triangles, mesh.normals, mesh.slots]
        arrays += [attribute.values for attribute in mesh.attributes]
    for spheres in scene.spheres:
        arrays += [spheres.centers, spheres.radii]
    return sum(array.nbytes for array in arrays if array is not None)


def _rgba(color: Any) -> tuple[float, float, float, float]:
    return float(color[0]), float(color[1]), float(color[2]), float(color[3])


class _Collector:
    def __init__(
        self, depsgraph: bpy.types.Depsgraph, version: tuple[int, ...], notices: Notices, constants_only: bool
    ) -> None:
        self._constants_only = constants_only
        self.objects: list[Object] = []
        self.spheres: list[Spheres] = []
        self.lights: list[Lamp] = []
        self.materials: list[NamedMaterial] = []
        self._depsgraph = depsgraph
        self._version = version
        self._notices = notices
        self._material_numbers: dict[int, int] = {}
        self._override = depsgraph.view_layer_eval.material_override
        self.images = Images()
        self._meshes: dict[tuple[int, int, frozenset[str]], Mesh | None] = {}

    def add(self, placed: Placed) -> None:
        kind = placed.item.type
        if kind in SURFACES:
            self._add_surface(placed)
        elif kind == "LIGHT":
            for matrix in placed.all_matrices():
                lamp = export_lamp(placed.item, matrix, self._version, self._notices)
                if lamp is not None:
                    self.lights.append(lamp)
        elif kind in UNSUPPORTED:
            self._notices.add(place(placed.item.name), f"objects of type {kind.title()} are not supported and left out")

    def _add_surface(self, placed: Placed) -> None:
        item = placed.item
        matrices = placed.all_matrices()
        if not np.isfinite(matrices).all():
            raise GlimmerError(f"Object '{item.name}' stands at a place that is not finite")
        settings = getattr(item.original, "glimmer", None)
        if settings is not None and settings.is_sphere and self._add_spheres(item, matrices):
            return
        if item.type == "MESH" and not item.data.polygons:
            return  # and its materials are nobody's
        slots = [slot.material for slot in item.material_slots] or [None]
        materials = tuple(self._material(material, item.name) for material in slots)
        mesh = self._mesh(item, len(slots), self._attributes(materials))
        if mesh is None:
            return
        many = len(matrices) > 1
        self.objects.append(
            Object(
                name=item.name,
                mesh=mesh,
                materials=materials,
                to_world=np.eye(4) if many else matrices[0],
                instances=matrices if many else None,
                object_index=item.pass_index,
                color=_rgba(item.color),
                random=placed.randoms() if many else float(placed.randoms()[0]),
            )
        )

    def _add_spheres(self, item: bpy.types.Object, matrices: Floats) -> bool:
        """False, and a notice, for what is marked as a sphere and is none."""
        try:
            sphere = read_sphere(item)
            if sphere is None:
                return True
            centers, radii = sphere.placed(matrices)
        except NotASphereError as why:
            self._notices.add(
                place(item.name), f"is marked as an analytic sphere, but {why}; rendered as the mesh that it is"
            )
            return False
        material = item.material_slots[0].material if item.material_slots else None
        if self.materials[self._material(material, item.name)].program is not None:
            # An analytic sphere has no coordinates that textures could go by.
            self._notices.add(
                place(item.name),
                "is marked as an analytic sphere, but its material varies; rendered as the mesh that it is",
            )
            return False
        self.spheres.append(
            Spheres(
                name=item.name,
                centers=centers,
                radii=radii,
                material=self._material(material, item.name),
                object_index=item.pass_index,
            )
        )
        return True

    def _attributes(self, materials: tuple[int, ...]) -> frozenset[str]:
        """The names that the programs of materials ask a mesh for."""
        programs = (self.materials[number].program for number in materials)
        return frozenset(name for program in programs if program is not None for name in program.attributes)

    def _mesh(self, item: bpy.types.Object, slot_count: int, attributes: frozenset[str]) -> Mesh | None:
        key = (item.data.as_pointer(), slot_count, attributes)
        if key not in self._meshes:
            # A copy: triangles and split normals are made in place, and the evaluated mesh belongs to Blender.
            mesh = item.to_mesh()
            try:
                self._meshes[key] = None if mesh is None else export_mesh(mesh, item.data.name, slot_count, attributes)
            except (RuntimeError, ValueError, IndexError) as error:
                raise GlimmerError(f"The mesh of object '{item.name}' cannot be read: {error}") from error
            finally:
                item.to_mesh_clear()
        return self._meshes[key]

    def _material(self, material: bpy.types.Material | None, object_name: str) -> int:
        material = self._override or material
        key = 0 if material is None else material.original.as_pointer()
        if key not in self._material_numbers:
            self._material_numbers[key] = len(self.materials)
            self.materials.append(
                export_material(material, object_name, self._version, self._notices, self.images, self._constants_only)
            )
        return self._material_numbers[key]
