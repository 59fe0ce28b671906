// SPDX-License-Identifier: GPL-3.0-or-later
#include "parts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace glimmer {
namespace {

Double3 cross(const Double3 &a, const Double3 &b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double length(const Double3 &a) {
    return std::hypot(a[0], a[1], a[2]);
}
Double3 normalized(const Double3 &a) {
    const double factor = 1 / length(a);
    return {a[0] * factor, a[1] * factor, a[2] * factor};
}

/// Rigid, looking along its -z at the target.
Matrix look_at(const Value &camera) {
    const auto origin = camera.at("origin").numbers<3>(), target = camera.at("target").numbers<3>();
    const Double3 up = camera.has("up") ? camera.at("up").direction() : Double3{0, 0, 1};
    const Double3 backward{origin[0] - target[0], origin[1] - target[1], origin[2] - target[2]};
    if (length(backward) == 0 || !std::isfinite(length(backward)))
        camera.at("target").fail("the target is where the origin is; the camera needs a direction");
    const Double3 z = normalized(backward), side = cross(normalized(up), z);
    // 1e-6 of a radian is where float64 still gives the side to nine digits.
    if (length(side) < 1e-6)
        camera.fail("up is parallel to the direction of view; give another up");
    const Double3 x = normalized(side), y = cross(z, x);
    return {x[0], y[0], z[0], origin[0], x[1], y[1], z[1], origin[1], x[2], y[2], z[2], origin[2], 0, 0, 0, 1};
}

void read_clip(const Value &clip, glimmer_camera_desc &desc) {
    clip.expect_size(2);
    const bool in_front = desc.type != GLIMMER_ORTHOGRAPHIC;
    clip.for_each([&, is_start = true](const Value &end) mutable {
        if (std::exchange(is_start, false))
            desc.clip_start = end.number(in_front ? kNonNegative : kAny);
        else
            desc.clip_end = end.json().is_null() ? std::numeric_limits<double>::infinity()
                                                 : end.number(in_front ? kPositive : kAny);
    });
    if (desc.clip_start >= desc.clip_end)
        clip.fail(clip.json().dump() + " is not [start, end] with start < end (or null for no end)");
}

/// The keys of each type besides those of all.
std::vector<std::string_view> keys_of(glimmer_camera_type type) {
    switch (type) {
    case GLIMMER_PERSPECTIVE:
        return {"fov_x", "shift"};
    case GLIMMER_ORTHOGRAPHIC:
        return {"width", "shift"};
    case GLIMMER_EQUIRECTANGULAR:
        return {"window", "longitude", "latitude"};
    case GLIMMER_CYLINDRICAL:
        return {"window", "longitude", "elevation"};
    case GLIMMER_FISHEYE_EQUIDISTANT:
        return {"window", "fov"};
    case GLIMMER_FISHEYE_EQUISOLID:
        return {"window", "fov", "focal_length"};
    case GLIMMER_FISHEYE_POLYNOMIAL:
        return {"window", "fov", "polynomial"};
    default:
        return {"window"};
    }
}

template <size_t n>
void read_numbers(const Value &value, const char *key, double (&out)[n]) {
    if (const auto found = value.find(key)) {
        const auto numbers = found->numbers<n>();
        std::copy(numbers.begin(), numbers.end(), out);
    }
}

void read_stereo(const Value &stereo, glimmer_camera_desc &desc) {
    stereo.expect_object({"offset", "convergence", "merge"});
    desc.stereo_offset = stereo.at("offset").number();
    if (const auto distance = stereo.find("convergence"))
        desc.stereo_convergence = distance->number(kPositive);
    read_numbers(stereo, "merge", desc.stereo_merge);
}

void read_aperture(const Value &aperture, glimmer_camera_desc &desc) {
    aperture.expect_object({"blades", "rotation", "ratio"});
    if (const auto blades = aperture.find("blades"))
        desc.aperture_blades = uint32_t(blades->integer(0, 1024));
    if (const auto rotation = aperture.find("rotation"))
        desc.aperture_rotation = rotation->number();
    if (const auto ratio = aperture.find("ratio"))
        desc.aperture_ratio = ratio->number(kPositive);
}

void read_panorama(const Value &value, glimmer_camera_desc &desc) {
    read_numbers(value, "window", desc.window);
    read_numbers(value, "longitude", desc.longitude);
    read_numbers(value, "latitude", desc.latitude);
    read_numbers(value, "elevation", desc.elevation);
    if (const auto fov = value.find("fov"))
        desc.fisheye_fov = fov->number(kPositive);
    if (desc.type == GLIMMER_FISHEYE_EQUISOLID)
        desc.focal_length = value.at("focal_length").number(kPositive);
    if (desc.type == GLIMMER_FISHEYE_POLYNOMIAL) {
        value.at("polynomial");
        read_numbers(value, "polynomial", desc.polynomial);
    }
}

} // namespace

void read_camera(const Value &value, glimmer_scene *scene) {
    constexpr std::string_view names[] = {
        "perspective",        "orthographic", "equirectangular", "fisheye_equidistant", "fisheye_equisolid",
        "fisheye_polynomial", "mirror_ball",  "cube_face",       "cylindrical"}; // in the order of the types
    glimmer_camera_desc desc;
    glimmer_camera_init(&desc);
    value.expect_table();
    if (const auto type = value.find("type"))
        desc.type = glimmer_camera_type(one_of(*type, "a camera type", "camera types", names));
    std::vector<std::string_view> keys{"type",        "origin",         "target", "up",     "to_world",
                                       "lens_radius", "focus_distance", "clip",   "motion", "aperture"};
    if (desc.type != GLIMMER_ORTHOGRAPHIC)
        keys.push_back("stereo");
    const std::vector<std::string_view> own = keys_of(desc.type);
    keys.insert(keys.end(), own.begin(), own.end());
    value.expect_object(keys);
    const bool has_matrix = value.has("to_world"), moves = value.has("motion");
    const bool looks_at = value.has("origin") || value.has("target") || value.has("up");
    if (int(has_matrix) + int(looks_at) + int(moves) != 1)
        value.fail("needs either origin and target (and up), or to_world, or motion");
    const std::vector<double> motion = read_motion(value);
    if (moves) {
        desc.motion = motion.data();
        desc.motion_count = motion.size() / 16;
    } else {
        const Matrix to_world = has_matrix ? value.at("to_world").matrix() : look_at(value);
        std::copy(to_world.begin(), to_world.end(), desc.to_world);
    }
    if (desc.type == GLIMMER_PERSPECTIVE)
        desc.fov_x = value.at("fov_x").number({.low = 0, .high = 180, .open_low = true, .open_high = true});
    else if (desc.type == GLIMMER_ORTHOGRAPHIC)
        desc.width = value.at("width").number(kPositive);
    else
        read_panorama(value, desc);
    read_numbers(value, "shift", desc.shift);
    if (const auto stereo = value.find("stereo"))
        read_stereo(*stereo, desc);
    if (const auto radius = value.find("lens_radius"))
        desc.lens_radius = radius->number(kNonNegative);
    if (const auto distance = value.find("focus_distance"))
        desc.focus_distance = distance->number(kPositive);
    else if (desc.lens_radius > 0)
        value.fail("a lens_radius above 0 needs a focus_distance");
    if (const auto aperture = value.find("aperture"))
        read_aperture(*aperture, desc);
    if (const auto clip = value.find("clip"))
        read_clip(*clip, desc);
    check(glimmer_scene_set_camera(scene, &desc), value.where());
}

} // namespace glimmer
