# SPDX-License-Identifier: GPL-3.0-or-later
"""A depsgraph -> SceneDescription: the one way in."""

from __future__ import annotations

import time
from collections.abc import Callable, Hashable, Iterable, Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..film.passes import MOST_AOVS
from ..scene.description import (
    BLACK,
    Add,
    Attribute,
    Camera,
    Film,
    Floats,
    Lamp,
    Light,
    Material,
    Medium,
    Mesh,
    Mix,
    NamedMaterial,
    Null,
    Object,
    Rays,
    RenderSettings,
    SceneDescription,
    Spheres,
)
from ..scene.problems import GlimmerError, Notice, Notices, place
from .bodies import warn_of_bodies_of_glass
from .dense import warn_of_dense_haze
from .doubles import warn_of_doubled_objects
from .geometry_instances import GeometryInstances
from .grids import NO_READER, NoGridsError, box_of, openvdb, read_grids
from .groups import with_groups
from .instance import SHOWN_BY_OTHERS, BulkReader, Placed, dimensions_left, placed_objects, placed_once
from .instance_attributes import instance_attributes, property_of
from .kept import Kept, owners_of
from .light import export_lamp
from .material import Aov, export_material, export_volume, has_aovs
from .mesh import doubled_faces, export_mesh, flattened, turned_faces
from .motion import (
    Motion,
    Recording,
    SetFrame,
    cycles_setting,
    is_still,
    motion_steps,
    moves_as_one,
    read_shutter,
    record,
    smooth_motion,
)
from .points import point_cloud
from .sphere import NotASphereError, read_sphere
from .strands import Strands, curve_strands, particle_strands, tubes
from .translate.image import Images
from .translate.surface import ACTIVE_UV, VOLUME_DENSITY, named
from .visibility import note_differences, shadow_terminator
from .world import export_world, warn_of_black_sky

if TYPE_CHECKING:
    import bpy

# Kinds that show something in Cycles and nothing here.
UNSUPPORTED = {"GPENCIL", "GREASEPENCIL"}


HELD_STILL = "which is not supported; it stands where it is in the middle"


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
    set_frame: SetFrame | None = None,
    kept: Kept | None = None,
) -> Exported:
    """Raises GlimmerError when no picture can be made of the scene.

    view: of the evaluated scene. version: Blender's. readers: see BulkReader. is_shown: of an evaluated object, for
    what the depsgraph does not know (a local view). constants_only: materials do not vary.
    set_frame: evaluates the depsgraph at another moment; without it nothing is blurred by motion.
    kept: of earlier exports of this depsgraph that were blurred by no motion either.
    """
    start = time.perf_counter()
    notices = Notices()
    kept = Kept() if kept is None else kept
    source = _Source(depsgraph, view, version, readers, is_shown, constants_only, kept)
    is_blurred = set_frame is not None and depsgraph.view_layer_eval.use_motion_blur
    shutter = read_shutter(depsgraph.scene_eval, notices) if is_blurred else None
    if shutter is None or set_frame is None:
        description = source.describe(notices)
    else:
        now = depsgraph.scene_eval.frame_current, depsgraph.scene_eval.frame_subframe
        try:
            description = source.describe(notices, record(shutter, source.most_steps(), set_frame, source.look))
        finally:
            set_frame(*now)
    kept.drop_unused()
    return Exported(description, tuple(notices.items), time.perf_counter() - start, _size(description))


def take_notices(
    depsgraph: bpy.types.Depsgraph,
    items: Iterable[bpy.types.Object],
    version: tuple[int, ...],
    images: Images,
    notices: Notices,
) -> None:
    """Only what an export of these evaluated objects would say, without their meshes. Raises nothing."""
    collector = _Collector(depsgraph, version, notices, False, None, Kept())
    collector.reads, collector.images = False, images
    for item in items:
        surface, hair = (placed_once(item, depsgraph.view_layer) for _ in range(2))
        hair.strands = True
        for placed in (surface, hair):
            try:
                collector.add(placed)
            except GlimmerError as error:
                notices.add("", str(error))


@dataclass(frozen=True)
class _Source:
    """What export_scene() is given; everything is read as it is at the moment."""

    depsgraph: bpy.types.Depsgraph
    view: Callable[[bpy.types.Scene, Notices], View]
    version: tuple[int, ...]
    readers: tuple[BulkReader, ...]
    is_shown: Callable[[bpy.types.Object], bool] | None
    constants_only: bool
    kept: Kept

    def placed(self, kept: Kept) -> Iterator[Placed]:
        return placed_objects(self.depsgraph, self.readers, kept, self.is_shown)

    def look(self) -> tuple[dict[Hashable, Floats], Camera]:
        """Where everything and the camera stand, at a moment of which nothing is kept."""
        places = {ident: matrices for placed in self.placed(Kept()) for ident, matrices in placed.by_id()}
        return places, self.view(self.depsgraph.scene_eval, Notices()).camera

    def most_steps(self) -> int:
        """The intervals of the motion that is asked for the finest; all others are powers of 2 too."""
        camera = self.depsgraph.scene_eval.camera
        of_camera = 0 if camera is None else motion_steps(camera)
        return max([2, of_camera, *(motion_steps(placed.item, placed.instancer) for placed in self.placed(Kept()))])

    def describe(self, notices: Notices, recording: Recording | None = None) -> SceneDescription:
        scene = self.depsgraph.scene_eval
        seen = self.view(scene, notices)
        camera = seen.camera
        if recording is not None:
            camera = _moving_camera(camera, scene.camera, recording, notices)
        collector = _Collector(self.depsgraph, self.version, notices, self.constants_only, recording, self.kept)
        if "uv" in seen.settings.passes:
            collector.shown_attributes = frozenset([ACTIVE_UV])
        if any(name.startswith("aov_") for name in seen.settings.passes):
            layer = self.depsgraph.view_layer_eval
            world = scene.world
            if world is not None and world.use_nodes and world.node_tree is not None and has_aovs(world.node_tree):
                notices.add(f"world '{world.name}'", "AOV outputs of worlds are not supported; they are left out")
            collector.aovs = tuple(Aov(aov.name, aov.type == "COLOR") for aov in layer.aovs)[:MOST_AOVS]
        for placed in self.placed(self.kept):
            collector.add(placed)
        world = scene.world if self.depsgraph.view_layer_eval.use_sky else None
        environment, medium = export_world(world, notices, collector.images, self.constants_only)
        lights = tuple(collector.lights)
        if medium is not None and medium.falloff is not None and collector.has_interiors():
            notices.add(
                f"world '{scene.world.name}'",
                "haze that thins out with height is not supported beside volumes of objects; it is left out",
            )
            medium = None
        something_shines = any(shines(item.material) for item in collector.materials)
        warn_of_black_sky(world, environment, lights, medium, notices, something_shines)
        described = SceneDescription(
            film=seen.film,
            camera=camera,
            materials=tuple(collector.materials),
            objects=tuple(collector.objects),
            spheres=tuple(collector.spheres),
            lights=lights,
            environment=environment,
            medium=medium,
            settings=seen.settings,
        )
        warn_of_doubled_objects(described.objects, notices)
        if scene.world is not None:
            warn_of_dense_haze(described, scene.world.name, notices)
        warn_of_bodies_of_glass(described, scene.world.name if scene.world is not None else "", notices)
        return with_groups(described, self.depsgraph)


def _moving_camera(camera: Camera, item: bpy.types.Object | None, recording: Recording, notices: Notices) -> Camera:
    steps = 2 if item is None else motion_steps(item)
    if steps == 0:
        return camera
    seen = recording.cameras_of(steps)
    if any(c.projection != camera.projection for c in seen):
        notices.add(
            "" if item is None else place(item.name),
            "the camera's lens changes while the shutter is open; it is that of the middle all the time",
        )
    matrices = np.array([c.to_world for c in seen])
    if is_still(matrices):
        return camera
    return replace(camera, motion=smooth_motion(matrices[:, None], recording.shutter)[:, 0])


def _size(scene: SceneDescription) -> int:
    arrays: list[Any] = [item.instances for item in scene.objects] + [scene.environment.image]
    for mesh in scene.meshes():
        arrays += [mesh.vertices, mesh.triangles, mesh.normals, mesh.slots]
        arrays += [attribute.values for attribute in mesh.attributes]
    for spheres in scene.spheres:
        arrays += [spheres.centers, spheres.radii]
    return sum(array.nbytes for array in arrays if array is not None)


def shines(material: Material) -> bool:
    """Or may, for all that is known of its programs."""
    if isinstance(material, Light) or getattr(material, "emission", BLACK) != BLACK:
        return True
    return isinstance(material, (Mix, Add)) and (shines(material.a) or shines(material.b))


def _rgba(color: Any) -> tuple[float, float, float, float]:
    return float(color[0]), float(color[1]), float(color[2]), float(color[3])


def _slots(item: bpy.types.Object) -> list[bpy.types.Material | None]:
    """The materials of an object's slots, one at least."""
    return [slot.material for slot in item.material_slots] or [None]


def _of_some(attributes: tuple[Attribute, ...], chosen: Any) -> tuple[Attribute, ...]:
    """Of some of the instances."""
    return tuple(replace(item, values=item.values[chosen]) for item in attributes)


@dataclass(frozen=True, eq=False)
class Places:
    """Where an object stands: n times."""

    matrices: Floats  # (n, 4, 4)
    ranks: NDArray[np.intp]  # (n,), what scales of 0 leave of three
    randoms: Floats  # (n,), 0 to 1


class _Collector:
    def __init__(
        self,
        depsgraph: bpy.types.Depsgraph,
        version: tuple[int, ...],
        notices: Notices,
        constants_only: bool,
        recording: Recording | None,
        kept: Kept,
    ) -> None:
        self._recording = recording
        self._kept = kept
        self._constants_only = constants_only
        self.reads = True  # what takes time; else the notices alone are wanted
        self.shown_attributes: frozenset[str] = frozenset()  # of meshes, that passes show
        self.aovs: tuple[Aov, ...] = ()  # that passes show
        self.objects: list[Object] = []
        self.spheres: list[Spheres] = []
        self.lights: list[Lamp] = []
        self.materials: list[NamedMaterial] = []
        self._depsgraph = depsgraph
        self._version = version
        self._notices = notices
        self._material_numbers: dict[tuple[int, bool], int] = {}
        self._override = depsgraph.view_layer_eval.material_override
        scene = depsgraph.scene_eval
        owners = (depsgraph.view_layer_eval, scene, scene.world)
        self.images = Images(scene.frame_current, lambda name: property_of(owners, name), kept)
        self._made = GeometryInstances(depsgraph)
        self._meshes: dict[tuple[int, int, frozenset[str]], Mesh | None] = {}
        self._null: int | None = None

    def add(self, placed: Placed) -> None:
        kind = placed.item.type
        note_differences(placed.item, self._depsgraph.scene_eval, self._notices)
        if kind != "LIGHT" and not placed.visibility.rays:
            return  # and it shines no more either
        if not self._is_in_layer(placed):
            return
        if placed.strands:
            self._add_hair(placed)
        elif kind == "MESH" or (kind in SHOWN_BY_OTHERS and not self.reads):
            self._add_surface(placed)
        elif kind == "CURVES":
            self._add_curves(placed)
        elif kind == "POINTCLOUD":
            self._add_points(placed)
        elif kind == "VOLUME":
            self._add_volume(placed)
        elif kind == "LIGHT":
            if self._motion(placed) is not None:
                self._notices.add(place(placed.name), f"a lamp that moves while the shutter is open, {HELD_STILL}")
            rays = placed.visibility.rays
            for matrix in placed.all_matrices():
                lamp = export_lamp(placed.item, matrix, rays, self._version, self._notices, self.images)
                if lamp is not None:
                    self.lights.append(lamp)
        elif kind in UNSUPPORTED:
            self._notices.add(place(placed.name), f"objects of type {kind.title()} are not supported and left out")

    def _places(self, placed: Placed) -> Places:
        if not placed.ids or any(np.ndim(part) == 2 for part in placed.matrices):
            return self._read_places(placed)
        # The arrays of a bulk read, which are the same ones as long as they are kept.
        parts = tuple(placed.matrices)
        key = placed.item.name, tuple(map(id, parts))
        return self._kept.get("arranged", (), key, lambda: (parts, self._read_places(placed)))[1]

    def _read_places(self, placed: Placed) -> Places:
        matrices = self._matrices(placed)
        return Places(matrices, dimensions_left(matrices), placed.randoms())

    def _is_in_layer(self, placed: Placed) -> bool:
        """A view layer may leave out all surfaces, all hair or all volume objects."""
        layer, kind = self._depsgraph.view_layer_eval, placed.item.type
        if placed.strands or kind == "CURVES":
            return bool(layer.use_strand)
        if kind == "VOLUME":
            return bool(layer.use_volumes)
        return bool(layer.use_solid) or kind in ("LIGHT", "POINTCLOUD")

    def _matrices(self, placed: Placed) -> Floats:
        matrices = placed.all_matrices()
        if not np.isfinite(matrices).all():
            raise GlimmerError(f"Object '{placed.name}' stands at a place that is not finite")
        return matrices

    def _add_surface(self, placed: Placed) -> None:
        item = placed.item
        places = self._places(placed)
        settings = getattr(item.original, "glimmer", None)
        if self.reads and settings is not None and settings.is_sphere and self._add_spheres(placed, places.matrices):
            return
        if self.reads and not item.data.polygons:
            return  # and its materials are nobody's
        slots = _slots(item)
        materials = tuple(self._material(material, placed.name) for material in slots)
        mesh = self._mesh(item, len(slots), self._attributes(materials) | self.shown_attributes)
        if mesh is not None:
            self._add_object(placed, places, mesh, materials)

    def _add_object(self, placed: Placed, places: Places, mesh: Mesh, materials: tuple[int, ...]) -> None:
        """Those whose scale is 0 along an axis are meshes of their own: the engine's instances have an inverse."""
        matrices, dimensions, randoms = places.matrices, places.ranks, places.randoms
        attributes = instance_attributes(placed, self._attributes(materials), self._made, self._notices)
        solid, flat = dimensions == 3, dimensions == 2
        if flat.any():
            self._notices.add(
                place(placed.name), "is flattened by a scale of 0; it is lit like a flat face, black in Cycles"
            )
        self._note_deformation(placed.item)
        motion = self._motion(placed)
        if motion is not None and any(shines(self.materials[number].material) for number in materials):
            self._notices.add(place(placed.name), f"shines and moves while the shutter is open, {HELD_STILL}")
            motion = None
        if motion is not None:
            moving = motion.moving & solid
            if moving.sum() < motion.moving.sum():
                self._notices.add(place(placed.name), f"is flat and moves while the shutter is open, {HELD_STILL}")
            part = self._part(placed, mesh, materials)
            part = replace(part, attributes=_of_some(attributes, moving))
            self._add_moving(part, matrices[moving], randoms[moving], motion.steps[:, solid[motion.moving]])
            solid &= ~moving
        for i in np.flatnonzero(flat):
            part = self._part(placed, flattened(mesh, matrices[i]), materials)
            part = replace(part, attributes=_of_some(attributes, [i]))
            self._add_placed(part, np.eye(4)[None], randoms[[i]])
        if solid.any():
            if not solid.all():
                matrices, randoms, attributes = matrices[solid], randoms[solid], _of_some(attributes, solid)
            part = replace(self._part(placed, mesh, materials), attributes=attributes)
            self._add_placed(part, matrices, randoms)

    def _add_placed(self, part: Object, matrices: Floats, randoms: Floats) -> None:
        if len(matrices) > 1:
            self.objects.append(replace(part, instances=matrices, random=randoms))
        else:
            self.objects.append(replace(part, to_world=matrices[0], random=float(randoms[0])))

    def _part(self, placed: Placed, mesh: Mesh, materials: tuple[int, ...]) -> Object:
        """Without a place."""
        item, rays = placed.item, placed.visibility.rays
        if not any(self.materials[number].casts_shadows for number in materials):
            rays &= ~Rays.SHADOW
        return Object(
            name=item.name,
            mesh=mesh,
            materials=materials,
            object_index=item.pass_index,
            color=_rgba(item.color),
            rays=rays,
            is_holdout=placed.visibility.is_holdout,
            interior=self._interior(item, materials),
            shadow_terminator=shadow_terminator(item) if mesh.normals is not None else 0.0,
        )

    def _add_moving(self, part: Object, middle: Floats, randoms: Floats, steps: Floats) -> None:
        """middle: (n, 4, 4), steps: (steps, n, 4, 4). Each becomes an object of its own, unless all move as one."""
        assert self._recording is not None
        if len(middle) > 1 and (as_one := moves_as_one(steps, middle)) is not None:
            motion = smooth_motion(as_one[:, None], self._recording.shutter)[:, 0]
            self.objects.append(replace(part, instances=middle, motion=motion, random=randoms))
            return
        smooth = smooth_motion(steps, self._recording.shutter)
        for i, random in enumerate(randoms):
            own = _of_some(part.attributes, [i])
            self.objects.append(replace(part, motion=smooth[:, i], random=float(random), attributes=own))

    def _motion(self, placed: Placed) -> Motion | None:
        """None where nothing moves."""
        if self._recording is None:
            return None
        motion, is_always_there = self._recording.motion_of(placed)
        if not is_always_there:
            self._notices.add(
                place(placed.name),
                "appears or vanishes while the shutter is open; it is there all the time, and still",
            )
        return motion

    def _note_deformation(self, item: bpy.types.Object) -> None:
        """Whether a modifier or a shape key may change the mesh while the shutter is open, as Cycles asks."""
        if (
            self._recording is not None
            and motion_steps(item)
            and cycles_setting(item, "use_deform_motion", True)
            and item.original.is_deform_modified(self._depsgraph.scene, "RENDER")
        ):
            self._notices.add(
                place(item.name),
                "may change its shape while the shutter is open; it has that of the middle all the time",
            )

    def _add_hair(self, placed: Placed) -> None:
        """Of an object's particle systems."""
        item = placed.item
        if item.type != "MESH" or not any(system.settings.type == "HAIR" for system in item.particle_systems):
            return
        slots, is_final = _slots(item), self._depsgraph.mode == "RENDER"
        numbers = [self._material(material, item.name) for material in slots]
        if not self.reads:
            return
        attributes = self._attributes(tuple(numbers))
        found = self._kept.get(
            "hair", owners_of(item), attributes, lambda: list(particle_strands(item, is_final, attributes))
        )
        for strands in found:
            material = numbers[min(strands.slot, len(numbers) - 1)]
            self._add_tubes(placed, strands, material)

    def _add_curves(self, placed: Placed) -> None:
        material = self._material(_slots(placed.item)[0], placed.item.name)
        item, attributes = placed.item, self._attributes((material,))
        if not self.reads:
            return
        strands = self._kept.get("curves", owners_of(item), attributes, lambda: curve_strands(item.data, attributes))
        if strands is not None:
            self._add_tubes(placed, strands, material)

    def _add_tubes(self, placed: Placed, strands: Strands, material: int) -> None:
        name = placed.item.name
        for missing in sorted(self._attributes((material,)) - {key for key, _ in strands.values + strands.along}):
            what = missing.removeprefix(named(""))
            self._notices.add(place(name), f"its material asks for '{what}', which hair has not here; it is 0")
        key = name, id(strands)
        found = self._kept.get("tubes", owners_of(placed.item), key, lambda: (strands, tubes(name, strands)))[1]
        if found.kept < 1.0:
            self._notices.add(
                place(name), f"too much hair: {found.kept:.1%} of its strands are rendered, so much the wider"
            )
        if found.each > 1:
            self._notices.add(place(name), f"too much hair: one in {found.each} of its strands' points is rendered")
        self._add_object(placed, self._places(placed), found.mesh, (material,))

    def _add_points(self, placed: Placed) -> None:
        """The points of a cloud are spheres."""
        item, cloud = placed.item, placed.item.data
        if not len(cloud.points):
            return
        if self._motion(placed) is not None:
            self._notices.add(place(item.name), f"points that move while the shutter is open, {HELD_STILL}")
        nothing = np.zeros((0, 3)), np.zeros(0)
        points, radii = (
            self._kept.get("points", owners_of(item), None, lambda: point_cloud(cloud)) if self.reads else nothing
        )
        matrices = self._matrices(placed)
        material = self._material(_slots(item)[0], item.name)
        scales = np.linalg.norm(matrices[:, :3, :3], axis=1)
        if (np.ptp(scales, axis=1) > 1e-3 * scales.max(axis=1)).any():
            self._notices.add(place(item.name), "its points are scaled unevenly; they are rendered as round spheres")
        if self.materials[material].program is not None:
            self._notices.add(
                place(item.name),
                "textures on the points of clouds are not supported; a constant is used in their place",
            )
            material = self._material(_slots(item)[0], item.name, constants_only=True)
        centers = np.einsum("mij,nj->mni", matrices[:, :3, :3], points) + matrices[:, None, :3, 3]
        self.spheres.append(
            Spheres(
                name=item.name,
                centers=centers.reshape(-1, 3),
                radii=(scales.mean(axis=1)[:, None] * radii).reshape(-1),
                material=material,
                object_index=item.pass_index,
                rays=placed.visibility.rays,
                is_holdout=placed.visibility.is_holdout,
            )
        )

    def _add_volume(self, placed: Placed) -> None:
        """A box about the grids of a volume object, filled by them."""
        item, where = placed.item, place(placed.name)
        material = self._override or _slots(item)[0]
        if not self.reads:
            if openvdb() is None:
                self._notices.add(where, f"its volume is left out, since {NO_READER}")
            return
        try:
            grids = self._kept.get("grids", owners_of(item), None, lambda: read_grids(item.data))
        except NoGridsError as why:
            self._notices.add(where, f"its volume is left out, since {why}")
            return
        if not grids or material is None:
            return
        medium = export_volume(
            material, grids, place(item.name, material.name), self._version, self._notices, self.images
        )
        if medium is None:
            return
        if self._motion(placed) is not None:
            self._notices.add(where, f"moves while the shutter is open, {HELD_STILL}")
        matrices = self._matrices(placed)
        factors = np.ones(len(matrices))
        if item.data.render.space == "OBJECT":  # it stays as opaque as it is in a size of 1
            factors = 1.0 / np.maximum(np.linalg.norm(matrices[:, :3, :3].sum(axis=2), axis=1) / 3.0**0.5, 1e-30)
        attributes = (Attribute(VOLUME_DENSITY, "instance", factors.astype(np.float32)[:, None]),)
        part = self._part(placed, box_of(grids, item.name), (self._null_material(),))
        self._add_placed(replace(part, attributes=attributes, interior=medium), matrices, placed.randoms())

    def _null_material(self) -> int:
        """The number of one that is not there."""
        if self._null is None:
            self._null = len(self.materials)
            self.materials.append(NamedMaterial("nothing", Null()))
        return self._null

    def has_interiors(self) -> bool:
        return any(item.interior for item in self.objects) or any(item.interior for item in self.spheres)

    def _interior(self, item: bpy.types.Object, materials: tuple[int, ...]) -> Medium | None:
        """What the object is filled with."""
        media = [self.materials[number].volume for number in dict.fromkeys(materials)]
        found = [medium for medium in media if medium is not None]
        if not found:
            return None
        where = place(item.name)
        if any(m.type == "FLUID" and m.fluid_type == "DOMAIN" for m in item.modifiers):
            self._notices.add(where, "smoke and fire are not supported; the domain is left empty")
            return None
        if len(set(media)) > 1:
            self._notices.add(where, "has materials of several volumes; it is filled with the first one throughout")
        return found[0]

    def _add_spheres(self, placed: Placed, matrices: Floats) -> bool:
        """False, and a notice, for what is marked as a sphere and is none."""
        item = placed.item
        try:
            sphere = self._kept.get("spheres", owners_of(item), None, lambda: read_sphere(item))
            if sphere is None:
                return True
            centers, radii = sphere.placed(matrices)
        except NotASphereError as why:
            self._notices.add(
                place(item.name), f"is marked as an analytic sphere, but {why}; rendered as the mesh that it is"
            )
            return False
        material = item.material_slots[0].material if item.material_slots else None
        own = self.materials[self._material(material, item.name)]
        if own.program is not None or (own.volume is not None and own.volume.program is not None):
            # An analytic sphere has no coordinates that textures could go by.
            self._notices.add(
                place(item.name),
                "is marked as an analytic sphere, but its material varies; rendered as the mesh that it is",
            )
            return False
        if self._motion(placed) is not None:
            if not shines(self.materials[self._material(material, item.name)].material):
                self._notices.add(
                    place(item.name),
                    "is marked as an analytic sphere, but moves while the shutter is open; rendered as the mesh that it"
                    " is",
                )
                return False
            self._notices.add(place(item.name), f"shines and moves while the shutter is open, {HELD_STILL}")
        self.spheres.append(
            Spheres(
                name=item.name,
                centers=centers,
                radii=radii,
                material=self._material(material, item.name),
                object_index=item.pass_index,
                rays=placed.visibility.rays,
                is_holdout=placed.visibility.is_holdout,
                interior=self._interior(item, (self._material(material, item.name),)),
            )
        )
        return True

    def _attributes(self, materials: tuple[int, ...]) -> frozenset[str]:
        """The names that the programs of materials ask a mesh for."""
        programs = [self.materials[number].program for number in materials]
        volumes = (self.materials[number].volume for number in materials)
        programs += [volume.program for volume in volumes if volume is not None]
        return frozenset(name for program in programs if program is not None for name in program.attributes)

    def _mesh(self, item: bpy.types.Object, slot_count: int, attributes: frozenset[str]) -> Mesh | None:
        if not self.reads:
            return None
        key = (item.data.as_pointer(), slot_count, attributes)
        if key not in self._meshes:
            self._meshes[key], told = self._kept.get(
                "meshes", owners_of(item), key, lambda: _read_mesh(item, slot_count, attributes)
            )
            for what in told:
                self._notices.add(place(item.name), what)
        return self._meshes[key]

    def _material(
        self, material: bpy.types.Material | None, object_name: str, constants_only: bool | None = None
    ) -> int:
        """constants_only: not as the export has it for all."""
        constants_only = self._constants_only if constants_only is None else constants_only
        material = self._override or material
        key = (0 if material is None else material.original.as_pointer(), constants_only)
        if key not in self._material_numbers:
            self._material_numbers[key] = len(self.materials)
            owners = (key[0],)
            whose = object_name, constants_only, self.images.frame
            self.images.asks_others = False
            found, notices = self._kept.get(
                "materials",
                owners,
                whose,
                lambda: self._read_material(material, object_name, constants_only),
                lambda: not self.images.asks_others,
            )
            for notice in notices:
                self._notices.add(notice.where, notice.what, notice.code)
            self.materials.append(found)
        return self._material_numbers[key]

    def _read_material(
        self, material: bpy.types.Material | None, object_name: str, constants_only: bool
    ) -> tuple[NamedMaterial, tuple[Notice, ...]]:
        """And what there is to say of it."""
        notices = Notices()
        found = export_material(material, object_name, self._version, notices, self.images, constants_only, self.aovs)
        return found, tuple(notices.items)


def _read_mesh(
    item: bpy.types.Object, slot_count: int, attributes: frozenset[str]
) -> tuple[Mesh | None, tuple[str, ...]]:
    """And what there is to say of it."""
    # A copy: triangles and split normals are made in place, and the evaluated mesh belongs to Blender.
    mesh = item.to_mesh()
    try:
        groups = tuple(group.name for group in item.vertex_groups)
        read = None if mesh is None else export_mesh(mesh, item.data.name, slot_count, attributes, groups)
        if read is None:
            return None, ()
        told = []
        if doubled := doubled_faces(read):
            told.append(f"{doubled} of its faces lie on others, which Cycles shows with dark spots")
        if mesh.has_custom_normals and (turned := turned_faces(read)):
            told.append(f"{turned} of its faces have custom normals that face away from them; those are turned around")
        return read, tuple(told)
    except (RuntimeError, ValueError, IndexError) as error:
        raise GlimmerError(f"The mesh of object '{item.name}' cannot be read: {error}") from error
    finally:
        item.to_mesh_clear()
