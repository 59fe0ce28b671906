// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrator/vpl/connection.h"

#include "integrator/shading_frame.h"
#include "integrator/vpl/bounded_fraction.h"

namespace glimmer {

Connection connect(const SurfaceVertex &vertex, Bsdf bsdf, const Vec3f &direction) {
    const float cosine = dot(direction, vertex.geometric);
    if (!(cosine > 0))
        return {};
    const Frame frame(is_above_horizon(vertex.shading, direction) ? vertex.shading : vertex.geometric);
    const Vec3f incoming = frame.to_local(vertex.incoming), outgoing = frame.to_local(direction);
    if (!(incoming.z > 0) || !(outgoing.z > 0))
        return {};
    const Rgb f_cos = eval(bsdf, outgoing, incoming);
    return {f_cos * (cosine / dot(vertex.incoming, vertex.geometric)), bounded_fraction(f_cos, outgoing.z, incoming.z)};
}

} // namespace glimmer
