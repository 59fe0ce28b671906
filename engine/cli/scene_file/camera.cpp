// SPDX-License-Identifier: GPL-3.0-or-later
#include "parts.h"

#include <algorithm>
#include <cmath>
#include <limits>

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
    const bool perspective = desc.type == GLIMMER_PERSPECTIVE;
    clip.for_each([&, is_start = true](const Value &end) mutable {
        if (std::exchange(is_start, false))
            desc.clip_start = end.number(perspective ? kNonNegative : kAny);
        else
            desc.clip_end = end.json().is_null() ? std::numeric_limits<double>::infinity()
                                                 : end.number(perspective ? kPositive : kAny);
    });
    if (desc.clip_start >= desc.clip_end)
        clip.fail(clip.json().dump() + " is not [start, end] with start < end (or null for no end)");
}

} // namespace

void read_camera(const Value &value, glimmer_scene *scene) {
    constexpr std::string_view names[] = {"perspective", "orthographic"};
    constexpr glimmer_camera_type types[] = {GLIMMER_PERSPECTIVE, GLIMMER_ORTHOGRAPHIC};
    glimmer_camera_desc desc;
    glimmer_camera_init(&desc);
    value.expect_table();
    if (const auto type = value.find("type"))
        desc.type = types[one_of(*type, "a camera type", "camera types", names)];
    const bool perspective = desc.type == GLIMMER_PERSPECTIVE;
    value.expect_object({"type", "origin", "target", "up", "to_world", perspective ? "fov_x" : "width", "shift",
                         "lens_radius", "focus_distance", "clip", "motion"});
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
    if (perspective)
        desc.fov_x = value.at("fov_x").number({.low = 0, .high = 180, .open_low = true, .open_high = true});
    else
        desc.width = value.at("width").number(kPositive);
    if (const auto shift = value.find("shift")) {
        const auto numbers = shift->numbers<2>();
        std::copy(numbers.begin(), numbers.end(), desc.shift);
    }
    if (const auto radius = value.find("lens_radius"))
        desc.lens_radius = radius->number(kNonNegative);
    if (const auto distance = value.find("focus_distance"))
        desc.focus_distance = distance->number(kPositive);
    else if (desc.lens_radius > 0)
        value.fail("a lens_radius above 0 needs a focus_distance");
    if (const auto clip = value.find("clip"))
        read_clip(*clip, desc);
    check(glimmer_scene_set_camera(scene, &desc), value.where());
}

} // namespace glimmer
