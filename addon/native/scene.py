# SPDX-License-Identifier: GPL-3.0-or-later
"""SceneDescription -> a committed scene of the engine."""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from ctypes import byref, c_double, c_float, c_uint32, c_void_p
from dataclasses import fields
from typing import Any

import numpy as np

from ..scene import description as d
from ..scene.problems import EngineWarning, GlimmerError
from ..scene.program import Output
from . import structs
from .library import Library
from .programs import ProgramAdder, attribute_structs
from .structs import CameraType, Filter, Format, LightType, ParameterKind


def _contiguous_floats(array: Any) -> tuple[Any, Format]:
    """As either precision that the engine takes, and which: nothing is copied that fits already."""
    values = np.ascontiguousarray(array)
    if values.dtype == np.float32:
        return values, Format.FLOAT32
    return np.ascontiguousarray(values, np.float64), Format.FLOAT64


def _pointer(array: Any) -> int | None:
    return None if array is None else array.ctypes.data


def _set_projection(desc: structs.CameraDesc, projection: d.Projection) -> None:
    match projection:
        case d.Perspective():
            desc.type, desc.fov_x = CameraType.PERSPECTIVE, projection.fov_x
        case d.Orthographic():
            desc.type, desc.width = CameraType.ORTHOGRAPHIC, projection.width
        case _:
            desc.type = CameraType[projection.TYPE.upper()]
            for item in fields(projection):
                value = getattr(projection, item.name)
                if isinstance(value, tuple):
                    getattr(desc, item.name)[:] = value
                else:
                    setattr(desc, "fisheye_fov" if item.name == "fov" else item.name, value)


def _matrix(array: Any) -> Any:
    return (c_double * 16)(*np.asarray(array, np.float64).reshape(16))


class MeshCache:
    """The engine's meshes by content, kept from one frame to the next while they are in use."""

    def __init__(self, library: Library) -> None:
        self._library = library
        self._handles: dict[bytes, c_void_p] = {}
        self.created = 0  # so far

    def __len__(self) -> int:
        return len(self._handles)

    def get(self, mesh: d.Mesh) -> c_void_p:
        handle = self._handles.get(mesh.digest)
        if handle is None:
            handle = self._handles[mesh.digest] = self._create(mesh)
            self.created += 1
        return handle

    def keep_only(self, meshes: set[bytes]) -> None:
        for digest in [known for known in self._handles if known not in meshes]:
            self._library.free("glimmer_mesh_destroy", self._handles.pop(digest))

    def clear(self) -> None:
        self.keep_only(set())

    def _create(self, mesh: d.Mesh) -> c_void_p:
        desc = self._library.init(structs.MeshDesc)
        vertices, kind = _contiguous_floats(mesh.vertices)
        normals = None if mesh.normals is None else np.ascontiguousarray(mesh.normals, vertices.dtype)
        triangles = np.ascontiguousarray(mesh.triangles, np.uint32)
        slots = None if mesh.slots is None else np.ascontiguousarray(mesh.slots, np.uint16)
        desc.name = mesh.name.encode()
        desc.format = kind
        desc.vertex_count, desc.vertices, desc.normals = len(vertices), _pointer(vertices), _pointer(normals)
        desc.triangle_count, desc.triangles, desc.slots = len(triangles), _pointer(triangles), _pointer(slots)
        attributes, keep = attribute_structs(mesh.attributes)
        desc.attribute_count, desc.attributes = len(attributes), ctypes.addressof(attributes)
        handle = c_void_p()
        self._library.call("glimmer_mesh_create", byref(desc), byref(handle))
        del keep
        return handle


class NativeScene:
    """A scene of the engine, committed. Close it when its renders are closed."""

    def __init__(self, library: Library, scene: d.SceneDescription, meshes: MeshCache) -> None:
        self.library = library
        self.description = scene
        self.handle = c_void_p()
        self.material_numbers: list[int] = []  # the engine's, of each material of the description
        library.call("glimmer_scene_create", byref(self.handle))
        try:
            self._fill(scene, meshes)
            library.call("glimmer_scene_commit", self.handle, scene.settings.threads)
        except BaseException:
            self.close()
            raise

    def close(self) -> None:
        if self.handle:
            self.library.free("glimmer_scene_destroy", self.handle)
            self.handle = c_void_p()

    def warnings(self) -> list[EngineWarning]:
        return self.library.warnings(self.handle)

    def _fill(self, scene: d.SceneDescription, meshes: MeshCache) -> None:
        self._set_film(scene.film)
        self._set_camera(scene.camera)
        programs = ProgramAdder(self.library, self.handle)
        try:
            adder = _MaterialAdder(self.library, self.handle, programs)
            materials = self.material_numbers = adder.add_all(scene.materials)
            for item in scene.objects:
                self._add_object(item, materials, meshes, programs)
            for spheres in scene.spheres:
                self._add_spheres(spheres, materials, programs)
            for number, lamp in enumerate(scene.lights):
                self._add_lamp(number, lamp, programs)
        finally:
            programs.close()
        self._set_environment(scene.environment)
        if scene.medium is not None:
            medium = scene.medium
            sigma_a, sigma_s = ((c_double * 3)(*sigma) for sigma in medium.constant_sigmas())
            self.library.call("glimmer_scene_set_medium", self.handle, sigma_a, sigma_s, medium.g)
            if medium.falloff is not None:
                height, scale_height = medium.falloff.height, medium.falloff.scale_height
                self.library.call("glimmer_scene_set_medium_falloff", self.handle, height, scale_height)

    def _set_film(self, film: d.Film) -> None:
        desc = self.library.init(structs.FilmDesc)
        desc.width, desc.height = film.width, film.height
        if film.crop is not None:
            desc.crop = (c_uint32 * 4)(*film.crop)
        desc.filter = Filter[film.filter.upper()]
        desc.filter_width = film.filter_width
        desc.exposure = film.exposure
        desc.transparent = film.transparent
        if film.transparent_glass is not None:
            desc.transparent_glass = film.transparent_glass
        desc.occlusion_distance = film.occlusion_distance
        desc.pixel_aspect = film.pixel_aspect
        desc.mist_start, desc.mist_depth, desc.mist_falloff = film.mist.start, film.mist.depth, film.mist.falloff
        self.library.call("glimmer_scene_set_film", self.handle, byref(desc))

    def _set_camera(self, camera: d.Camera) -> None:
        desc = self.library.init(structs.CameraDesc)
        desc.to_world = _matrix(camera.to_world)
        _set_projection(desc, camera.projection)
        desc.shift = (c_double * 2)(*camera.shift)
        desc.lens_radius, desc.focus_distance = camera.lens_radius, camera.focus_distance
        aperture = camera.aperture
        desc.aperture_blades, desc.aperture_rotation, desc.aperture_ratio = (
            aperture.blades,
            aperture.rotation,
            aperture.ratio,
        )
        desc.clip_start, desc.clip_end = camera.clip_start, camera.clip_end
        if camera.stereo is not None:
            desc.stereo_offset, desc.stereo_convergence = camera.stereo.offset, camera.stereo.convergence
            desc.stereo_merge[:] = camera.stereo.merge
        motion = None
        if camera.motion is not None:
            motion = np.ascontiguousarray(camera.motion, np.float64)
            desc.motion_count, desc.motion = len(motion), _pointer(motion)
        self.library.call("glimmer_scene_set_camera", self.handle, byref(desc))

    def _add_object(self, item: d.Object, materials: list[int], meshes: MeshCache, programs: ProgramAdder) -> None:
        desc = self.library.init(structs.ObjectDesc)
        numbers = (c_uint32 * len(item.materials))(*(materials[i] for i in item.materials))
        desc.name = item.name.encode()
        desc.mesh = meshes.get(item.mesh)
        desc.material_count = len(numbers)
        desc.materials = ctypes.cast(numbers, c_void_p)
        desc.to_world = _matrix(item.to_world)
        desc.object_index = item.object_index
        matrices = None
        if item.instances is not None:
            matrices, kind = _contiguous_floats(item.instances[:, :3, :])
            desc.instance_count, desc.instance_format, desc.instances = len(matrices), kind, _pointer(matrices)
        desc.color = item.color
        desc.visible, desc.holdout = int(item.rays), int(item.is_holdout)
        desc.matte, desc.light_group = item.matte, item.light_group
        desc.shadow_terminator = item.shadow_terminator
        randoms = np.ascontiguousarray(item.random, np.float32).reshape(-1)
        desc.random = float(randoms[0])
        if matrices is not None and len(randoms) == len(matrices):
            desc.randoms = _pointer(randoms)
        motion = None
        if item.motion is not None:
            motion = np.ascontiguousarray(item.motion, np.float64)
            desc.motion_count, desc.motion = len(motion), _pointer(motion)
        attributes, keep = attribute_structs(item.attributes)
        desc.attribute_count, desc.attributes = len(attributes), ctypes.addressof(attributes)
        interior, bindings = self._interior(item.interior, programs)
        desc.interior = None if interior is None else ctypes.addressof(interior)
        self.library.call("glimmer_scene_add_object", self.handle, byref(desc))
        del keep, bindings

    def _add_spheres(self, spheres: d.Spheres, materials: list[int], programs: ProgramAdder) -> None:
        desc = self.library.init(structs.SpheresDesc)
        centers = np.ascontiguousarray(spheres.centers, np.float64)
        radii = np.ascontiguousarray(spheres.radii, np.float64)
        desc.name = spheres.name.encode()
        desc.count, desc.centers = len(centers), _pointer(centers)
        desc.radius_count, desc.radii = len(radii), _pointer(radii)
        desc.material = materials[spheres.material]
        desc.object_index = spheres.object_index
        desc.visible, desc.holdout = int(spheres.rays), int(spheres.is_holdout)
        desc.matte, desc.light_group = spheres.matte, spheres.light_group
        interior, bindings = self._interior(spheres.interior, programs)
        desc.interior = None if interior is None else ctypes.addressof(interior)
        self.library.call("glimmer_scene_add_spheres", self.handle, byref(desc))
        del bindings

    def _interior(self, medium: d.Medium | None, programs: ProgramAdder) -> tuple[Any, Any]:
        """The struct, and what it refers to; both must outlive the call that they are for."""
        if medium is None:
            return None, None
        desc = self.library.init(structs.MediumDesc)
        outputs = medium.outputs()
        for key in ("sigma_a", "sigma_s", "g", "emission"):
            if key not in outputs:
                setattr(desc, key, getattr(medium, key))
        bindings = (structs.MediumBinding * len(outputs))()
        if medium.program is not None:
            number = programs.add_once("medium", medium.program)
            for binding, (key, output) in zip(bindings, outputs.items(), strict=True):
                binding.key, binding.program, binding.output = key.encode(), number, output.index
        desc.binding_count, desc.bindings = len(bindings), ctypes.addressof(bindings)
        return desc, bindings

    def _add_lamp(self, number: int, lamp: d.Lamp, programs: ProgramAdder) -> None:
        desc = self.library.init(structs.LightDesc)
        desc.name = lamp.name.encode()
        _LAMP_FILLERS[type(lamp)](desc, lamp)
        desc.visible, desc.shadows = int(lamp.flags.rays), int(lamp.flags.shadows)
        if lamp.flags.max_bounces is not None:
            desc.max_bounces = lamp.flags.max_bounces
        desc.light_group = lamp.flags.light_group
        self.library.call("glimmer_scene_add_light", self.handle, byref(desc))
        if lamp.flags.profile is not None:
            program = programs.add(f"light {lamp.name}", lamp.flags.profile.program)
            to_world = (c_double * 16)(*np.asarray(lamp.flags.profile.to_world, np.float64).ravel())
            self.library.call("glimmer_scene_bind_light", self.handle, number, program, 0, to_world)

    def _set_environment(self, environment: d.Environment) -> None:
        self.library.call("glimmer_scene_set_environment_visible", self.handle, int(environment.rays))
        self.library.call("glimmer_scene_set_environment_light_group", self.handle, environment.light_group)
        if environment.program is not None:
            programs = ProgramAdder(self.library, self.handle)
            try:
                number = programs.add("world", environment.program)
            finally:
                programs.close()
            self.library.call("glimmer_scene_bind_environment", self.handle, number, 0)
            if environment.sun is not None:
                direction = (c_double * 3)(*environment.sun.direction)
                self.library.call("glimmer_scene_bind_sun", self.handle, direction, environment.sun.angle)
            return
        image = c_void_p()
        if environment.image is not None:
            pixels = np.ascontiguousarray(environment.image, np.float32)
            height, width, channels = pixels.shape
            self.library.call("glimmer_image_create", width, height, channels, pixels.ctypes.data, byref(image))
        try:
            color = (c_float * 3)(*environment.radiance)
            to_world = _matrix(environment.to_world)
            self.library.call("glimmer_scene_set_environment", self.handle, color, image, to_world)
        finally:
            self.library.free("glimmer_image_destroy", image)


def _fill_point(desc: Any, lamp: d.PointLight) -> None:
    desc.type = LightType.POINT
    desc.color, desc.position, desc.radius = lamp.intensity, lamp.position, lamp.radius
    desc.disk = int(lamp.is_disk)


def _fill_spot(desc: Any, lamp: d.SpotLight) -> None:
    desc.type = LightType.SPOT
    desc.color, desc.position, desc.radius = lamp.intensity, lamp.position, lamp.radius
    desc.direction, desc.angle, desc.blend = lamp.direction, lamp.angle, lamp.blend
    desc.disk, desc.times_cosine = int(lamp.is_disk), int(lamp.times_cosine)


def _fill_sun(desc: Any, lamp: d.SunLight) -> None:
    desc.type = LightType.SUN
    desc.color, desc.direction, desc.angle = lamp.irradiance, lamp.direction, lamp.angle
    desc.disk = int(lamp.is_tangent)


def _fill_area(desc: Any, lamp: d.AreaLight) -> None:
    desc.type = LightType.AREA
    desc.color, desc.to_world = lamp.radiance, _matrix(lamp.to_world)
    desc.size, desc.ellipse, desc.spread = lamp.size, int(lamp.ellipse), lamp.spread


_LAMP_FILLERS: dict[type, Callable[[Any, Any], None]] = {
    d.PointLight: _fill_point,
    d.SpotLight: _fill_spot,
    d.SunLight: _fill_sun,
    d.AreaLight: _fill_area,
}


# Given for a number or colour that a program gives: within every parameter's range.
PLACEHOLDER = (0.5, 0.5, 0.5)


class _MaterialAdder:
    """Adds materials, the parts of a mix before the mix itself, and says which of their parameters vary."""

    def __init__(self, library: Library, scene: c_void_p, programs: ProgramAdder) -> None:
        self._library = library
        self._scene = scene
        self._programs = programs
        self._program = 0  # of the material that is being added

    def add_all(self, materials: tuple[d.NamedMaterial, ...]) -> list[int]:
        """The engine's number of each."""
        return [self._add_named(item) for item in materials]

    def _add_named(self, item: d.NamedMaterial) -> int:
        if item.program is not None:
            self._program = self._programs.add(item.name, item.program)
        number = self._add(item.name, item.material)
        if item.normal is not None:
            self._programs.bind(number, item.normal_key, self._program, item.normal.index)
        for slot, output in item.aovs:
            self._programs.bind(number, f"aov_{slot}", self._program, output.index)
        return number

    def _add(self, name: str, material: d.Material) -> int:
        given = d.parameters(material)
        rows = self._library.materials()[material.TYPE]
        parameters = (structs.Parameter * len(given))()
        for out, (key, value) in zip(parameters, given.items(), strict=True):
            if key not in rows:
                raise GlimmerError(f"Material '{name}': the engine's {material.TYPE} has no '{key}'")
            out.key = key.encode()
            if isinstance(value, Output):
                out.value = PLACEHOLDER
            elif isinstance(value, d.Material):
                out.material = self._add(f"{name}.{key}", value)
            else:
                _VALUE_FILLERS[rows[key].kind](out, value)
        desc = self._library.init(structs.MaterialDesc)
        desc.name, desc.type = name.encode(), material.TYPE.encode()
        desc.parameter_count, desc.parameters = len(given), parameters
        number = c_uint32()
        self._library.call("glimmer_scene_add_material", self._scene, byref(desc), byref(number))
        for key, value in given.items():
            if isinstance(value, Output):
                self._programs.bind(number.value, key, self._program, value.index)
        return number.value


def _fill_number(out: Any, value: float) -> None:
    out.value[0] = value


def _fill_color(out: Any, value: d.Rgb) -> None:
    out.value = value


def _fill_word(out: Any, value: str) -> None:
    out.word = value.encode()


_VALUE_FILLERS: dict[ParameterKind, Callable[[Any, Any], None]] = {
    ParameterKind.NUMBER: _fill_number,
    ParameterKind.COLOR: _fill_color,
    ParameterKind.WORD: _fill_word,
}
