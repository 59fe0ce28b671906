// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrator/vpl/connection.h"

#include "integrator/shading_frame.h"
#include "integrator/vpl/bounded_fraction.h"

namespace glimmer {

Connection connect(const SurfaceVertex &vertex, const Bsdf &bsdf, const Vec3f &direction) {
    const bool beyond = vertex.both_sides && dot(direction, vertex.geometric) < 0;
    const Vec3f shading = beyond ? -vertex.shading : vertex.shading;
    const Vec3f geometric = beyond ? -vertex.geometric : vertex.geometric;
    const float cosine = dot(direction, geometric);
    if (!(cosine > 0))
        return {};
    const Frame frame(normal_towards(shading, geometric, direction, bsdf, true));
    const Vec3f incoming = frame.to_local(vertex.incoming), outgoing = frame.to_local(direction);
    if (!(beyond ? incoming.z < 0 : incoming.z > 0) || !(outgoing.z > 0))
        return {};
    const Rgb f_cos = eval(bsdf, outgoing, incoming);
    return {f_cos * (cosine / dot(vertex.incoming, vertex.geometric)),
            bounded_fraction(f_cos, outgoing.z, std::abs(incoming.z))};
}

} // namespace glimmer
