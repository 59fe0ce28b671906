// SPDX-License-Identifier: GPL-3.0-or-later
// What a shader program may ask about the place that it is evaluated at.
#pragma once

#include "camera/panorama.h"
#include "math/vec.h"
#include "shading/arrival.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>

namespace glimmer {

enum class AttributeDomain : uint8_t { vertex, corner, face, instance };

/// An attribute of a mesh or of its instances: rows of one to four floats.
struct AttributeView {
    const float *values = nullptr; ///< null: there is none of this name, and reads give 0
    uint8_t components = 3;
    AttributeDomain domain = AttributeDomain::corner;
};

/// An object's own space, and what a program may know of the object.
struct ObjectFrame {
    std::array<Vec3f, 3> to_world{Vec3f{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}; ///< rows of the linear part
    std::array<Vec3f, 3> to_object{Vec3f{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    Vec3f location;
    Rgb color{1};
    float alpha = 1, index = 0, random = 0;
};

/// World to camera (x right, y up, z forward) and to the picture.
struct CameraFrame {
    std::array<Vec3f, 3> to_camera{Vec3f{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    Vec3f position;
    bool orthographic = false;
    float half_width = 1, aspect = 1; ///< half the picture's width, at depth 1 or, if orthographic, anywhere
    Vec2f shift;
    std::optional<Panorama> panorama; ///< then half_width is 1/2, and there is no shift

    /// The axes of panoramas are as in Cycles: forward, left, up; a mirror ball's right, back, up.
    void set_panorama(const Panorama &kind) {
        panorama = kind;
        const auto [right, up, forward] = to_camera;
        to_camera = is_ball() ? std::array{right, -forward, up} : std::array{forward, -right, up};
    }
    /// From these to right, up, forward.
    Vec3f in_panorama(const Vec3f &p) const { return is_ball() ? Vec3f(p.x, p.z, -p.y) : Vec3f(-p.y, p.z, p.x); }
    bool is_ball() const { return panorama->type == PanoramaType::mirror_ball; }
};

struct ShaderGlobals {
    Vec3f position;            ///< in the world
    Vec3f normal, true_normal; ///< unit, on the viewer's side
    Vec3f incoming;            ///< unit, to the viewer
    Vec3f object_position;
    Vec3f dpdx, dpdy;   ///< two tangents as long as the picture's pixels are apart here
    float u = 0, v = 0; ///< barycentrics of vertices 1 and 2
    Vec2f dudx, dudy;   ///< changes of (u, v) along dpdx and dpdy
    bool backfacing = false;
    uint32_t triangle = 0;
    const std::array<uint32_t, 3> *vertices = nullptr; ///< of the triangle; null: no mesh
    std::span<const AttributeView> attributes;         ///< by the scene's numbers of names
    const Vec3f *vertex_normals = nullptr;             ///< null: flat
    const Vec3f *vertex_positions = nullptr;           ///< in the object's space, about some origin
    uint32_t instance = 0;                             ///< of its object
    const ObjectFrame *object = nullptr;               ///< null: a sky
    const CameraFrame *camera = nullptr;
    float material_index = 0;
    Arrival arrival;
    bool sun_disc = false; ///< of a sky: its sun is asked for, too
};

} // namespace glimmer
