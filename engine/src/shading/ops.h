// SPDX-License-Identifier: GPL-3.0-or-later
// The operations of shader programs: one table of names, modes, inputs and outputs, which the C API's check, the scene
// file and the tests go by.
#pragma once

#include "glimmer.h"

#include <array>
#include <cstdint>

namespace glimmer {

/// In the order of kOps.
enum class Op : uint16_t {
    // Arithmetic
    math,
    vector_math,
    dot,
    distance,
    combine,
    separate,
    luminance,
    average,
    splat,
    map_range,
    vector_map_range,
    clamp,
    mix_number,
    mix_vector,
    mapping,
    vector_rotate,
    vector_transform,
    // Colour
    blend,
    convert,
    hue_saturation,
    bright_contrast,
    gamma,
    invert,
    ramp,
    ramp_alpha,
    curves,
    curve,
    // Textures
    noise,
    noise_color,
    musgrave,
    voronoi,
    voronoi_color,
    voronoi_w,
    white_noise,
    white_noise_color,
    wave,
    checker,
    gradient,
    magic,
    brick,
    gabor,
    grid,
    image,
    image_alpha,
    // The surface
    geometry,
    geometry_number,
    attribute,
    attribute_alpha,
    fresnel,
    layer_weight,
    bump,
    normal_map,
    tangent,
    wireframe,
    count
};

/// modes: fields parted by '|', the words of each by ' '. inputs: a letter each, n a number, v a vector or colour.
/// resource: t a table, i an image, a an attribute, - nothing.
inline constexpr std::array<glimmer_op_info_t, size_t(Op::count)> kOps{{
    {"math",
     "add subtract multiply divide multiply_add power logarithm sqrt inverse_sqrt absolute exponent minimum maximum "
     "less_than greater_than sign compare smooth_min smooth_max round floor ceil trunc fraction modulo floored_modulo "
     "wrap snap pingpong sine cosine tangent arcsine arccosine arctangent arctan2 sinh cosh tanh radians "
     "degrees|free clamped",
     "nnn", 'n', '-'},
    {"vector_math",
     "add subtract multiply divide multiply_add cross_product project reflect refract faceforward scale normalize "
     "absolute minimum maximum floor ceil fraction modulo wrap snap sine cosine tangent power sign round",
     "vvvn", 'v', '-'},
    {"dot", "", "vv", 'n', '-'},
    {"distance", "", "vv", 'n', '-'},
    {"combine", "", "nnn", 'v', '-'},
    {"separate", "x y z", "v", 'n', '-'},
    {"luminance", "", "v", 'n', '-'},
    {"average", "", "v", 'n', '-'},
    {"splat", "", "n", 'v', '-'},
    {"map_range", "linear stepped smoothstep smootherstep|free clamped", "nnnnnn", 'n', '-'},
    {"vector_map_range", "linear stepped smoothstep smootherstep|free clamped", "vvvvvv", 'v', '-'},
    {"clamp", "minmax range", "nnn", 'n', '-'},
    {"mix_number", "", "nnn", 'n', '-'},
    {"mix_vector", "", "vvv", 'v', '-'},
    {"mapping", "point texture vector normal", "vvvv", 'v', '-'},
    {"vector_rotate", "axis_angle x_axis y_axis z_axis euler|forward inverse", "vvvnv", 'v', '-'},
    {"vector_transform", "vector point normal|world object camera|world object camera", "v", 'v', '-'},
    {"blend",
     "mix darken multiply burn lighten screen dodge add overlay soft_light linear_light difference exclusion subtract "
     "divide hue saturation color value|free clamped",
     "nvv", 'v', '-'},
    {"convert", "rgb_to_hsv hsv_to_rgb rgb_to_hsl hsl_to_rgb", "v", 'v', '-'},
    {"hue_saturation", "", "nnnnv", 'v', '-'},
    {"bright_contrast", "", "vnn", 'v', '-'},
    {"gamma", "", "vn", 'v', '-'},
    {"invert", "", "nv", 'v', '-'},
    {"ramp", "linear constant", "n", 'v', 't'},
    {"ramp_alpha", "linear constant", "n", 'n', 't'},
    {"curves", "hold extrapolate", "nv", 'v', 't'},
    {"curve", "hold extrapolate", "nn", 'n', 't'},
    {"noise", "1d 2d 3d 4d|fbm multifractal hybrid ridged hetero|raw normalized|from_4 before_4", "vnnnnnnn", 'n', '-'},
    {"noise_color", "1d 2d 3d 4d|fbm multifractal hybrid ridged hetero|raw normalized|from_4 before_4", "vnnnnnnn", 'v',
     '-'},
    {"musgrave", "1d 2d 3d 4d|fbm multifractal hybrid ridged hetero", "vnnnnnn", 'n', '-'},
    {"voronoi",
     "1d 2d 3d 4d|f1 f2 smooth_f1 distance_to_edge sphere_radius|euclidean manhattan chebychev minkowski|raw "
     "normalized|lookup3 pcg",
     "vnnnnnnnn", 'n', '-'},
    {"voronoi_color",
     "1d 2d 3d 4d|f1 f2 smooth_f1|euclidean manhattan chebychev minkowski|raw normalized|lookup3 pcg|color position",
     "vnnnnnnnn", 'v', '-'},
    {"voronoi_w", "1d 2d 3d 4d|f1 f2 smooth_f1|euclidean manhattan chebychev minkowski|raw normalized|lookup3 pcg",
     "vnnnnnnnn", 'n', '-'},
    {"white_noise", "1d 2d 3d 4d", "vn", 'n', '-'},
    {"white_noise_color", "1d 2d 3d 4d", "vn", 'v', '-'},
    {"wave", "bands rings|x y z diagonal|sine saw triangle|from_4 before_4", "vnnnnn", 'n', '-'},
    {"checker", "", "v", 'n', '-'},
    {"gradient", "linear quadratic easing diagonal spherical quadratic_sphere radial", "v", 'n', '-'},
    {"magic", "0 1 2 3 4 5 6 7 8 9 10", "vnn", 'v', '-'},
    {"brick", "", "vnnnnnvv", 'v', '-'},
    {"gabor", "2d 3d|value phase intensity", "vnnnv", 'n', '-'},
    {"grid", "linear closest", "vv", 'v', 'i'},
    {"image",
     "flat box sphere tube equirectangular mirror_ball|linear closest cubic|repeat extend clip mirror|as_is straight",
     "vn", 'v', 'i'},
    {"image_alpha",
     "flat box sphere tube equirectangular mirror_ball|linear closest cubic|repeat extend clip mirror|as_is straight",
     "vn", 'n', 'i'},
    {"geometry",
     "position normal true_normal incoming parametric object_position object_normal camera window reflection "
     "object_location object_color|center dx dy",
     "n", 'v', '-'},
    {"geometry_number",
     "backfacing object_alpha object_index material_index object_random view_z view_distance camera_ray shadow_ray "
     "diffuse_ray glossy_ray singular_ray reflection_ray transmission_ray ray_length ray_depth volume_scatter_ray "
     "sun_disc",
     "", 'n', '-'},
    {"attribute", "center dx dy", "n", 'v', 'a'},
    {"attribute_alpha", "center dx dy", "n", 'n', 'a'},
    {"fresnel", "", "nv", 'n', '-'},
    {"layer_weight", "fresnel facing", "nv", 'n', '-'},
    {"bump", "", "nnnnnvn", 'v', '-'},
    {"normal_map", "tangent object world blender_object blender_world", "nv", 'v', 'a'},
    {"tangent", "", "v", 'v', '-'},
    {"wireframe", "world pixels", "n", 'n', '-'},
}};

} // namespace glimmer
