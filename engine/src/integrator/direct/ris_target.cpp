// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrator/direct/ris_target.h"

#include "integrator/direct/tuning.h"

#include <algorithm>
#include <cmath>

namespace glimmer {

namespace {

/// f cos of a lobe towards a light: a sphere in the direction `to` whose angular radius has this sine.
float towards(const Conductor &lobe, const Vec3f &wo, const Vec3f &to, float sine) {
    const Vec3f mirrored(-wo.x, -wo.y, wo.z);
    const float along = dot(mirrored, to), cosine = std::sqrt(1 - sine * sine);
    Vec3f wi = mirrored;
    if (along < cosine) {
        const Vec3f aside = mirrored - to * along;
        wi = to * cosine + aside * (sine / std::max(length(aside), 1e-6f));
    }
    wi.z = std::max(wi.z, tuning::kLeastTargetCosine);
    const float a2 = lobe.alpha * lobe.alpha, width = a2 / (a2 + tuning::kLightWidthInLobe2 * sine * sine);
    return mean_component(albedo(lobe)) * ggx_d(half_vector(wo, wi), lobe.alpha) *
           ggx_visibility(wo, wi, lobe.alpha, Masking::Smith) * wi.z * width;
}

float towards(const WeightedLobe &l, const Vec3f &wo, const Vec3f &to, float sine) {
    if (is_specular(l.lobe))
        return 0;
    if (const auto *metal = std::get_if<Conductor>(&l.lobe))
        return l.weight * towards(*metal, wo, to, sine);
    if (const auto *brushed = std::get_if<Brushed>(&l.lobe))
        return l.weight * towards(brushed->metal, wo, to, sine);
    return l.weight * mean_component(albedo(l.lobe)) * std::max(to.z, tuning::kLightAboveHorizon * sine) / kPi;
}

} // namespace

float ris_target(const Scene &scene, const Interaction &surface, const Bsdf &bsdf, const Vec3f &wo, float sigma) {
    if (is_specular(bsdf))
        return 0;
    const float side = std::copysign(1.0f, dot(wo, surface.geometric_normal));
    const Frame frame(surface.shading_normal * side);
    Vec3f wo_local = frame.to_local(wo);
    wo_local.z = std::max(wo_local.z, tuning::kLeastTargetCosine);
    float sum = 0;
    for (uint32_t i = 0; i < scene.lights.size(); ++i) {
        const LightBound &b = scene.lights.bound(i);
        const float irradiance = scene.lights.importance_at_point(i, surface.position, sigma);
        if (b.infinite) {
            sum += irradiance * mean_component(albedo(bsdf)) / kPi;
            continue;
        }
        const Vec3f way = b.center - surface.position;
        const float distance = std::max(length(way), b.radius), sine = distance > 0 ? b.radius / distance : 1;
        const Vec3f to = frame.to_local(way / std::max(distance, 1e-30f));
        if (to.z < -sine)
            continue;
        for (const WeightedLobe &l : bsdf)
            sum += irradiance * towards(l, wo_local, to, sine);
    }
    return sum;
}

} // namespace glimmer
