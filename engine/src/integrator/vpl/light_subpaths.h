// SPDX-License-Identifier: GPL-3.0-or-later
// Paths from the lights, shared by all pixels of a pass: they leave vertices wherever medium or a rough surface
// scatters them.
#pragma once

#include "bsdf/bsdf.h"
#include "integrator/integrator.h"
#include "integrator/vpl/splat.h"
#include "medium/interior_stack.h"
#include "scene/scene.h"

#include <vector>

namespace glimmer {

/// Power scattered by the medium at points, as a structure of arrays.
struct MediumVertices {
    bool directed = false; ///< whether directions are kept: medium that scatters evenly has no use for them
    std::vector<float> x, y, z, r, g, b;
    std::vector<float> dx, dy, dz; ///< unit, of flight; empty unless directed
    size_t size() const { return x.size(); }
    void add(const Vec3f &position, const Rgb &power, const Vec3f &direction) {
        x.push_back(position.x), y.push_back(position.y), z.push_back(position.z);
        r.push_back(power.r), g.push_back(power.g), b.push_back(power.b);
        if (directed)
            dx.push_back(direction.x), dy.push_back(direction.y), dz.push_back(direction.z);
    }
    /// Vertex i of others that are directed alike, its power scaled.
    void add(const MediumVertices &others, size_t i, float scale) {
        add(others.position(i), others.power(i) * scale, directed ? others.direction(i) : Vec3f());
    }
    Vec3f direction(size_t i) const { return {dx[i], dy[i], dz[i]}; }
    Vec3f position(size_t i) const { return {x[i], y[i], z[i]}; }
    Rgb power(size_t i) const { return {r[i], g[i], b[i]}; }
};

/// Power that arrives at a surface from a direction.
struct SurfaceVertex {
    Vec3f position, geometric, shading; ///< normals on the side of `incoming`
    Vec3f incoming;                     ///< unit, away from the surface
    float error;
    Rgb power;
    float reflectance;            ///< mean component of power * albedo: what it is worth
    uint32_t instance, primitive; ///< for its shading, when it is picked
    float u, v;
};

struct LightVertices {
    MediumVertices medium;
    std::vector<SurfaceVertex> surface;
    std::vector<Splat> splats;
    bool unfinished = false; ///< a path was broken off: what is missing is a bias
};

/// What of the vertex leaves towards a direction.
struct Connection {
    /// f(incoming, direction) |incoming.ns| / |incoming.ng| * |direction.ng|: the part of the power per solid angle, as
    /// a camera path that arrives from there would count it.
    Rgb factor;
    float bounded = 1; ///< the share of it that a pool may join to points of the medium
};
Connection connect(const SurfaceVertex &v, Bsdf bsdf, const Vec3f &direction);

/// What the camera could see of a point: the importance that light paths are steered by (never their mean). Sum over
/// medium points q on random camera rays of e^(-kappa d) / sqrt(d^2 + l^2), to the power of 3/4: light that wanders in
/// from far away, where few paths are wanted, must not arrive as one vertex that a whole block sees.
class ImportanceMap {
  public:
    ImportanceMap(const Scene &scene, std::vector<Vec3f> points);
    float operator()(const Vec3f &x) const;

  private:
    std::vector<Vec3f> points_;
    float kappa_ = 0, soften_ = 1;
};

/// Fog points on `count` random camera rays of the rectangle of pixels, each from another stratum of the distances at
/// which the medium scatters; none where rays start within glass.
std::vector<Vec3f> sample_visible_points(const Scene &scene, const Rectangle &pixels,
                                         const InteriorStack &around_camera, uint32_t count, Sampler &sampler,
                                         TraceContext &rays);

/// Traces settings.paths light paths; fewer, and of no use, once `stop` is set. The mean over passes of the vertices'
/// power, anywhere, is the power that is scattered there.
LightVertices trace_light_subpaths(const Scene &scene, const ImportanceMap &importance, const VplSettings &settings,
                                   Sampler &sampler, const std::atomic<bool> &stop, TraceContext &rays);

} // namespace glimmer
