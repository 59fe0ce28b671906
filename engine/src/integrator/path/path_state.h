// SPDX-License-Identifier: GPL-3.0-or-later
// A camera path on its way along one segment, and what light sampling could have done at the vertex where the segment
// began. Stacks of paths are copied a lot, so the parts that a kernel has no use for take no room.
#pragma once

#include "geometry/ray.h"
#include "integrator/path/kernel_features.h"
#include "math/vec.h"
#include "medium/interior_stack.h"
#include "shading/arrival.h"

#include <type_traits>

namespace glimmer {

/// Stands in for a part of the state that a kernel has no use for; the number keeps two of them apart.
template <int>
struct Absent {};
/// Stands in for the interior stack where a scene has no dielectrics: a path is never within one.
struct NoInterior {
    static constexpr bool empty() { return true; }
    static const Medium *medium(const Medium *outside) { return outside; }
};

/// What sampled the direction of a segment.
enum class ScatterKind : uint8_t {
    specular, ///< the camera, a mirror or a dielectric: light sampling cannot sample the same
    surface,  ///< the BSDF at `position`
    medium    ///< the phase function at `position`, which was itself sampled on a segment
};

/// The segment in the medium on which the last scattering point was sampled, and how.
struct PreviousSegment {
    Vec3f origin, direction;
    float end = 0;          ///< its length
    float distance = 0;     ///< of the scattering point from the origin
    float distance_pdf = 0; ///< per length, roulette included
    float survival = 1;     ///< the probability that roulette let the path go on from there
};

/// The vertex where the path's segment began, as multiple importance sampling needs it when the segment meets a light.
template <KernelFeatures F>
struct PreviousVertex {
    ScatterKind kind = ScatterKind::specular;
    bool several_lights = false; ///< light sampling there was for all lights, or for several choices, not for one
    bool along_segment = false;  ///< medium: light was sampled along `segment`, not at `position`
    float pdf = 0;               ///< of the direction, per solid angle
    Vec3f position;
    [[no_unique_address]] std::conditional_t<F.medium_walks, PreviousSegment, Absent<0>> segment; ///< medium alone
};

/// What a path scattered at first, mirrors and dielectrics aside: it decides which AOVs its light counts for.
enum class PathClass : uint8_t { none, surface, medium };

/// What becomes of the emission that a segment meets.
enum class EmissionMode : uint8_t {
    mis,  ///< it counts with its weight against light sampling
    skip, ///< it does not count: other samples bring all of it
    only  ///< nothing else of the segment counts: the path ends there
};

/// What the passes of PassSample ask of a path.
struct PassState {
    /// Of its first vertex: the part of the light that came through lobes that reflect diffusely or otherwise; the rest
    /// was transmitted.
    Rgb diffuse, glossy;
    bool in_medium = false;       ///< the first vertex is in a medium
    bool sees_environment = true; ///< as the camera does: nothing but transparent surfaces lies between
};

template <KernelFeatures F>
struct PathState {
    Ray ray;
    Rgb beta{1}; ///< throughput
    /// The factor of beta that roulette ignores (etaScale of pbrt): absorption before the first scattering, and the
    /// choice between branches.
    float rr_scale = 1;
    [[no_unique_address]] std::conditional_t<F.meets_lights(), PreviousVertex<F>, Absent<1>> previous;
    uint32_t depth = 0;   ///< scattering vertices so far
    uint32_t scatter = 0; ///< those in the medium
    PathClass path_class = PathClass::none;
    [[no_unique_address]] std::conditional_t<F.visibility, RayKind, Absent<3>> kind{}; ///< the camera's at first
    [[no_unique_address]] std::conditional_t<F.passes, PassState, Absent<4>> passes{};
    EmissionMode emission_mode = EmissionMode::mis;
    uint32_t depth_since_first = 0; ///< vertices from the one that decided path_class on
    uint32_t specular_depth = 0;    ///< mirrors and dielectrics in a row up to here
    using Interior = std::conditional_t<F.transmission, InteriorStack, NoInterior>;
    [[no_unique_address]] Interior interior;
    /// Lengths since the last vertex, on segments that ended at a surface which the path went straight through.
    [[no_unique_address]] std::conditional_t<F.transparency, float, Absent<2>> passed{};
    float passed_length() const {
        if constexpr (F.transparency)
            return passed;
        else
            return 0;
    }

    /// Finite on a compensation ray (vpl_gather.inl): it brings what the bounded connections of its first point leave
    /// out, so the next vertex counts no farther from there than this, in the medium and on a surface.
    float medium_compensation_radius = kInfinity, surface_compensation_radius = kInfinity;
    bool compensates() const { return F.medium && medium_compensation_radius < kInfinity; }
    uint8_t ray_flags = kCameraRay; ///< RayFlags: what shader programs know of the segment
    bool splatted = false; ///< a compensation ray for which splats bring the part that no light vertex stands for

    /// The camera's own ray up to the first surface: what its numbers are stratified for.
    bool is_camera_segment() const { return depth == 0 && passed_length() == 0; }
    /// Whether the camera sees the segment, directly or by way of mirrors and dielectrics alone.
    bool seen_directly() const { return path_class == PathClass::none; }
};

} // namespace glimmer
