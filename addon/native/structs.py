# SPDX-License-Identifier: GPL-3.0-or-later
"""The structs and enumerations of engine/include/glimmer.h, field for field in its order."""

import ctypes
from collections.abc import Iterable
from ctypes import (
    c_char,
    c_char_p,
    c_double,
    c_float,
    c_int,
    c_int64,
    c_size_t,
    c_uint8,
    c_uint16,
    c_uint32,
    c_uint64,
    c_void_p,
)
from enum import IntEnum

ABI_VERSION = 2


class Result(IntEnum):
    OK = 0
    INVALID_ARGUMENT = 1
    INVALID_STATE = 2
    OUT_OF_MEMORY = 3
    UNAVAILABLE = 4
    INTERNAL = 5


class Format(IntEnum):
    FLOAT32 = 0
    FLOAT64 = 1


class ParameterKind(IntEnum):
    NUMBER = 0
    COLOR = 1
    WORD = 2
    MATERIAL = 3


class LightType(IntEnum):
    POINT = 0
    SPOT = 1
    SUN = 2
    AREA = 3


class CameraType(IntEnum):
    PERSPECTIVE, ORTHOGRAPHIC = range(2)
    EQUIRECTANGULAR, FISHEYE_EQUIDISTANT, FISHEYE_EQUISOLID, FISHEYE_POLYNOMIAL = range(2, 6)
    MIRROR_BALL, CUBE_FACE, CYLINDRICAL = range(6, 9)


class Filter(IntEnum):
    BOX = 0
    BLACKMAN_HARRIS = 1


class State(IntEnum):
    READY = 0
    RUNNING = 1
    PAUSED = 2
    FINISHED = 3
    CANCELLED = 4
    FAILED = 5


class MeshDesc(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("name", c_char_p),
        ("format", c_int),
        ("vertex_count", c_size_t),
        ("vertices", c_void_p),
        ("normals", c_void_p),
        ("uvs", c_void_p),
        ("triangle_count", c_size_t),
        ("triangles", c_void_p),
        ("slots", c_void_p),
        ("attribute_count", c_size_t),
        ("attributes", c_void_p),
    ]


class AttributeDomain(IntEnum):
    VERTEX = 0
    CORNER = 1
    FACE = 2
    INSTANCE = 3


class Attribute(ctypes.Structure):
    _fields_ = [("name", c_char_p), ("domain", c_int), ("components", c_uint32), ("values", c_void_p)]


class TextureDesc(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("name", c_char_p),
        ("width", c_uint32),
        ("height", c_uint32),
        ("channels", c_uint32),
        ("format", c_int),
        ("srgb", c_int),
        ("pixels", c_void_p),
    ]


class OpInfo(ctypes.Structure):
    _fields_ = [
        ("name", c_char_p),
        ("modes", c_char_p),
        ("inputs", c_char_p),
        ("output", c_char),
        ("resource", c_char),
    ]


CONSTANT = 0x8000  # added to the number of a constant where an input may be a register


class Instruction(ctypes.Structure):
    _fields_ = [
        ("op", c_uint16),
        ("out", c_uint16),
        ("mode", c_uint8 * 6),
        ("resource", c_uint16),
        ("inputs", c_uint16 * 10),
    ]


class Table(ctypes.Structure):
    _fields_ = [("row_count", c_size_t), ("rows", c_void_p), ("low", c_float), ("high", c_float)]


class ProgramDesc(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("name", c_char_p),
        ("instruction_count", c_size_t),
        ("instructions", c_void_p),
        ("constant_count", c_size_t),
        ("constants", c_void_p),
        ("table_count", c_size_t),
        ("tables", c_void_p),
        ("texture_count", c_size_t),
        ("textures", c_void_p),
        ("attribute_count", c_size_t),
        ("attributes", c_void_p),
        ("output_count", c_size_t),
        ("outputs", c_void_p),
    ]


class Parameter(ctypes.Structure):
    _fields_ = [
        ("key", c_char_p),
        ("value", c_float * 3),
        ("word", c_char_p),
        ("material", c_uint32),
    ]


class MaterialDesc(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("name", c_char_p),
        ("type", c_char_p),
        ("parameter_count", c_size_t),
        ("parameters", ctypes.POINTER(Parameter)),
    ]


class MediumBinding(ctypes.Structure):
    _fields_ = [("key", c_char_p), ("program", c_uint32), ("output", c_uint32)]


class MediumDesc(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("sigma_a", c_double * 3),
        ("sigma_s", c_double * 3),
        ("g", c_double),
        ("emission", c_double * 3),
        ("binding_count", c_size_t),
        ("bindings", c_void_p),
    ]


class ObjectDesc(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("name", c_char_p),
        ("mesh", c_void_p),
        ("material_count", c_size_t),
        ("materials", c_void_p),
        ("to_world", c_double * 16),
        ("instance_count", c_size_t),
        ("instance_format", c_int),
        ("instances", c_void_p),
        ("object_index", c_uint32),
        ("object_indices", c_void_p),
        ("color", c_float * 4),
        ("random", c_float),
        ("randoms", c_void_p),
        ("motion", c_void_p),
        ("motion_count", c_size_t),
        ("visible", c_uint32),
        ("holdout", c_int),
        ("attribute_count", c_size_t),
        ("attributes", c_void_p),
        ("interior", c_void_p),
        ("matte", c_uint32),
        ("light_group", c_uint32),
        ("shadow_terminator", c_float),
    ]


class SpheresDesc(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("name", c_char_p),
        ("count", c_size_t),
        ("centers", c_void_p),
        ("radius_count", c_size_t),
        ("radii", c_void_p),
        ("material", c_uint32),
        ("object_index", c_uint32),
        ("visible", c_uint32),
        ("holdout", c_int),
        ("interior", c_void_p),
        ("matte", c_uint32),
        ("light_group", c_uint32),
    ]


class LightDesc(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("name", c_char_p),
        ("type", c_int),
        ("color", c_float * 3),
        ("position", c_double * 3),
        ("direction", c_double * 3),
        ("radius", c_double),
        ("angle", c_double),
        ("blend", c_double),
        ("to_world", c_double * 16),
        ("size", c_double * 2),
        ("ellipse", c_int),
        ("visible", c_uint32),
        ("shadows", c_int),
        ("max_bounces", c_uint32),
        ("disk", c_int),
        ("times_cosine", c_int),
        ("spread", c_double),
        ("light_group", c_uint32),
    ]


class CameraDesc(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("to_world", c_double * 16),
        ("fov_x", c_double),
        ("shift", c_double * 2),
        ("lens_radius", c_double),
        ("focus_distance", c_double),
        ("clip_start", c_double),
        ("clip_end", c_double),
        ("type", c_int),
        ("width", c_double),
        ("motion", c_void_p),
        ("motion_count", c_size_t),
        ("window", c_double * 4),
        ("longitude", c_double * 2),
        ("latitude", c_double * 2),
        ("elevation", c_double * 2),
        ("fisheye_fov", c_double),
        ("focal_length", c_double),
        ("polynomial", c_double * 5),
        ("stereo_offset", c_double),
        ("stereo_convergence", c_double),
        ("stereo_merge", c_double * 2),
        ("aperture_blades", c_uint32),
        ("aperture_rotation", c_double),
        ("aperture_ratio", c_double),
    ]


class FilmDesc(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("width", c_uint32),
        ("height", c_uint32),
        ("crop", c_uint32 * 4),
        ("filter", c_int),
        ("filter_width", c_float),
        ("exposure", c_float),
        ("transparent", c_int),
        ("transparent_glass", c_float),
        ("mist_start", c_float),
        ("mist_depth", c_float),
        ("mist_falloff", c_float),
        ("occlusion_distance", c_float),
        ("pixel_aspect", c_float),
    ]


def pass_bits(numbers: Iterable[int]) -> tuple[int, int]:
    """RenderDesc's passes and passes_above."""
    bits = 0
    for number in numbers:
        bits |= 1 << number
    return bits & 0xFFFFFFFF, bits >> 32


class RenderDesc(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("integrator", c_char_p),
        ("samples", c_uint64),
        ("seconds", c_double),
        ("target_error", c_double),
        ("seed", c_uint64),
        ("threads", c_uint32),
        ("tile_size", c_uint32),
        ("max_depth", c_int64),
        ("max_scatter", c_int64),
        ("passes", c_uint32),
        ("adaptive", c_int),
        ("full_kernel", c_int),
        ("passes_above", c_uint32),
        ("independent_pixels", c_int),
    ]


class ProgressDesc(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("state", c_int),
        ("samples", c_uint64),
        ("fraction", c_double),
        ("seconds", c_double),
        ("seconds_left", c_double),
        ("cpu_seconds", c_double),
        ("relmse", c_double),
        ("relmse_low", c_double),
        ("relmse_high", c_double),
        ("rays", c_uint64),
        ("peak_bytes", c_uint64),
        ("invalid_samples", c_uint64),
        ("version", c_uint64),
        ("heavy_tails", c_int),
        ("largest_x", c_uint32),
        ("largest_y", c_uint32),
        ("largest_share", c_double),
        ("rate", c_double),
        ("rate_low", c_double),
        ("rate_high", c_double),
        ("seconds_to_half", c_double),
        ("seconds_to_target", c_double),
    ]


class TileDesc(ctypes.Structure):
    _fields_ = [
        ("x", c_uint32),
        ("y", c_uint32),
        ("width", c_uint32),
        ("height", c_uint32),
        ("samples", c_uint64),
    ]


class PassInfo(ctypes.Structure):
    _fields_ = [("name", c_char_p), ("channels", c_char_p), ("help", c_char_p), ("rule", c_int)]


class MaterialInfo(ctypes.Structure):
    _fields_ = [("type", c_char_p), ("mixable", c_int), ("help", c_char_p)]


class ParameterInfo(ctypes.Structure):
    _fields_ = [
        ("type", c_char_p),
        ("key", c_char_p),
        ("kind", c_int),
        ("required", c_int),
        ("alternative", c_uint32),
        ("low", c_double),
        ("high", c_double),
        ("above_low", c_int),
        ("value", c_float),
        ("words", c_char_p),
        ("noun", c_char_p),
        ("help", c_char_p),
    ]


class IntegratorInfo(ctypes.Structure):
    _fields_ = [("name", c_char_p), ("help", c_char_p), ("former_name", c_char_p)]


class CurvePoint(ctypes.Structure):
    _fields_ = [
        ("seconds", c_double),
        ("cpu_seconds", c_double),
        ("samples", c_double),
        ("relmse", c_double),
        ("relmse_low", c_double),
        ("relmse_high", c_double),
    ]


class PlotDesc(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("width", c_uint32),
        ("height", c_uint32),
        ("background", c_float * 3),
        ("text", c_float * 3),
        ("line", c_float * 3),
        ("guide", c_float * 3),
    ]


# Each description and the function of the library that fills it and says how large the library believes it to be.
INITIALISERS: dict[str, type[ctypes.Structure]] = {
    "glimmer_mesh_init": MeshDesc,
    "glimmer_texture_init": TextureDesc,
    "glimmer_program_init": ProgramDesc,
    "glimmer_material_init": MaterialDesc,
    "glimmer_medium_init": MediumDesc,
    "glimmer_object_init": ObjectDesc,
    "glimmer_spheres_init": SpheresDesc,
    "glimmer_light_init": LightDesc,
    "glimmer_camera_init": CameraDesc,
    "glimmer_film_init": FilmDesc,
    "glimmer_render_init": RenderDesc,
    "glimmer_progress_init": ProgressDesc,
    "glimmer_plot_init": PlotDesc,
}
