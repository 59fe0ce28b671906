// SPDX-License-Identifier: GPL-3.0-or-later
// Light that enters a body and leaves it elsewhere, after a random walk within (Chiang, Kutz, Burley 2016, "Practical
// and Controllable Subsurface Scattering for Production Path Tracing"). The lobe knows how light enters and what the
// body is filled with; the walk itself, and the diffuse lobe by which it leaves, are the integrator's
// (integrator/subsurface_walk.h). So light sampling finds nothing here: to the BSDF it is a delta lobe, whose sample is
// the direction into the body.
#pragma once

#include "bsdf/dielectric.h"
#include "bsdf/fresnel.h"
#include "bsdf/sample.h"
#include "sampling/warp.h"

#include <cstdint>
#include <optional>

namespace glimmer {

/// What the radius means.
enum class SubsurfaceModel : uint8_t {
    random_walk,  ///< the mean free path
    fixed_radius, ///< 4 pi mean free paths, reduced by the anisotropy
    skin          ///< of a diffusion dipole: the distance over which light spreads, whatever its colour
};
/// How light enters.
enum class SubsurfaceEntry : uint8_t {
    refracted, ///< by facets of GGX
    diffuse,   ///< by cosine
    both       ///< half by each
};
enum class SubsurfaceBoundary : uint8_t {
    lambert, ///< passes all
    burley   ///< Disney's: less at grazing angles, in and out
};

struct Subsurface {
    Rgb albedo;   ///< of a half-space
    Rgb radius;   ///< > 0, lengths
    Rgb color{1}; ///< factor of all of it
    float anisotropy = 0;
    float ior = 1.4f;
    float alpha = 1; ///< GGX width of the facets
    SubsurfaceModel model = SubsurfaceModel::random_walk;
    SubsurfaceEntry entry = SubsurfaceEntry::refracted;
    SubsurfaceBoundary boundary = SubsurfaceBoundary::lambert;
};

/// Below this a channel's light does not wander; it is diffuse where it enters.
inline constexpr float kLeastSubsurfaceRadius = 1e-8f;

/// What the body is filled with.
struct SubsurfaceMedium {
    Rgb sigma_t;
    Rgb alpha;   ///< albedo of single scattering
    Rgb weight;  ///< of the light that enters, so that a half-space has the lobe's albedo
    float g = 0; ///< mean cosine
};
SubsurfaceMedium subsurface_medium(const Subsurface &lobe);

inline Rgb eval(const Subsurface &, const Vec3f &, const Vec3f &) {
    return {};
}
inline float pdf(const Subsurface &, const Vec3f &, const Vec3f &) {
    return 0;
}
inline std::optional<BsdfSample> sample(const Subsurface &lobe, const Vec3f &wo, Vec2f u) {
    bool is_diffuse = lobe.entry == SubsurfaceEntry::diffuse;
    if (lobe.entry == SubsurfaceEntry::both) {
        is_diffuse = u.x < 0.5f;
        u.x = is_diffuse ? 2 * u.x : 2 * u.x - 1;
    }
    Vec3f wi;
    if (is_diffuse) {
        wi = -sample_cosine_hemisphere(u);
    } else { // the normals that wo sees, each with all of its light
        const Vec3f h = sample_visible_normal(wo, lobe.alpha, u);
        const auto refracted = refract(wo, h, lobe.ior);
        if (!refracted)
            return std::nullopt;
        wi = normalize(*refracted);
    }
    if (!(wi.z < 0))
        return std::nullopt;
    const float entering = lobe.boundary == SubsurfaceBoundary::burley ? 1 - 0.5f * schlick_weight(wo.z) : 1.0f;
    return BsdfSample{wi, lobe.color * entering, 1, true, true};
}
inline bool is_specular(const Subsurface &) {
    return true;
}
inline Rgb albedo(const Subsurface &lobe) {
    return lobe.albedo * lobe.color;
}
/// Of the light that leaves.
inline float max_value(const Subsurface &lobe) {
    return max_component(albedo(lobe)) / kPi;
}

} // namespace glimmer
