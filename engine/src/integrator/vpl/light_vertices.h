// SPDX-License-Identifier: GPL-3.0-or-later
// What the light subpaths of one wave leave behind (docs/method.md, section 3): virtual point lights in the medium and
// on surfaces, and splats on the film.
#pragma once

#include "integrator/depth_limits.h"
#include "integrator/vpl/splat.h"
#include "math/vec.h"

#include <vector>

namespace glimmer {

/// How many scattering vertices a light subpath has up to one of its vertices, that one included (docs/method.md,
/// section 12).
struct VertexDepth {
    uint32_t depth = 0;   ///< on surfaces, specular ones too, and in the medium
    uint32_t scatter = 0; ///< in the medium

    bool fits(const DepthLimits &room) const { return depth <= room.depth && scatter <= room.scatter; }
};

/// Light vertices in the medium, as a structure of arrays of equal size for the SIMD kernels. The power of a vertex is
/// the flux that is scattered there, already multiplied by the albedo.
struct MediumVertices {
    bool directed = false; ///< whether directions are kept; an isotropic medium has no use for them
    bool counted = false;  ///< whether depths are kept; without depth limits there is no use for them
    bool grouped = false;  ///< whether groups are kept; only passes show them
    std::vector<float> x, y, z, r, g, b;
    std::vector<float> dx, dy, dz;  ///< unit, of flight before the scattering; empty unless directed
    std::vector<VertexDepth> depth; ///< empty unless counted
    std::vector<uint8_t> group;     ///< LightFlags::group; empty unless grouped

    size_t size() const { return x.size(); }
    void add(const Vec3f &position, const Rgb &power, const Vec3f &direction, const VertexDepth &vertex_depth,
             uint8_t light_group) {
        x.push_back(position.x), y.push_back(position.y), z.push_back(position.z);
        r.push_back(power.r), g.push_back(power.g), b.push_back(power.b);
        if (directed)
            dx.push_back(direction.x), dy.push_back(direction.y), dz.push_back(direction.z);
        if (counted)
            depth.push_back(vertex_depth);
        if (grouped)
            group.push_back(light_group);
    }
    /// Adds vertex i of `others`, which must be directed, counted and grouped alike, with its power scaled.
    void add(const MediumVertices &others, size_t i, float scale) {
        add(others.position(i), others.power(i) * scale, directed ? others.direction(i) : Vec3f(),
            counted ? others.depth[i] : VertexDepth(), grouped ? others.group[i] : uint8_t(0));
    }
    Vec3f direction(size_t i) const { return {dx[i], dy[i], dz[i]}; }
    Vec3f position(size_t i) const { return {x[i], y[i], z[i]}; }
    Rgb power(size_t i) const { return {r[i], g[i], b[i]}; }
};

/// A light vertex on a surface: flux that arrives there from one direction.
struct SurfaceVertex {
    Vec3f position, geometric, shading; ///< unit normals, on the side of `incoming`
    Vec3f incoming;                     ///< unit, from the surface to where the light comes from
    float error;                        ///< bound on the rounding error of the position, a length
    Rgb power;
    float reflected;              ///< mean component of power * albedo, the worth of the vertex when picks are drawn
    uint32_t instance, primitive; ///< with u, v the place on the surface, from which a pick is shaded
    float u, v;
    float eta;       ///< Bsdf::eta as seen from the side of `incoming`
    bool both_sides; ///< light leaves on the other side as well, into the same medium
    VertexDepth depth;
    uint8_t group; ///< LightFlags::group
};

struct LightVertices {
    MediumVertices medium;
    std::vector<SurfaceVertex> surface;
    std::vector<Splat> splats;
    bool unfinished = false; ///< a subpath was broken off, so that what it would have brought is missing
};

} // namespace glimmer
