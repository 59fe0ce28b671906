// SPDX-License-Identifier: GPL-3.0-or-later
// Direct light of what the camera sees first, by resampled importance sampling over the pixel (Talbot, Cline and Egbert
// 2005, "Importance Resampling for Global Illumination"). Bevels narrower than a pixel mirror a light where they happen
// to be turned right: few points of the pixel bring most of its light. So several candidates, each found by a camera
// ray of its own, compete for being lit. One is chosen in proportion to the target function (ris_target.h), and its
// light is divided by the probability of that choice: one term of the sum over the candidates, unbiased whatever the
// target.
#pragma once

#include "camera/camera_sample.h"
#include "integrator/direct/ris_target.h"
#include "integrator/path/path_sample.h"

#include <array>

namespace glimmer {

template <KernelFeatures F>
void PathSample<F>::pixel_ris(ShutterTime time) {
    struct Candidate {
        Ray ray;
        Interaction surface;
        Shading shading;
        Rgb beta;
        Vec2f offset; ///< from the middle of the pixel
        float target;
    };
    std::array<Candidate, tuning::kRisCandidates> candidates;
    const PixelFilter &filter = scene().film.filter;
    uint32_t count = 0;
    float total = 0;
    for (uint32_t i = 0; i < tuning::kRisCandidates; ++i) {
        const Vec2f u = sampler_.stratified_2d(dimension(Dimension::candidate_film, i));
        const Vec2f u_pixel{(float(i % tuning::kRisStrataPerSide) + u.x) / tuning::kRisStrataPerSide,
                            (float(i / tuning::kRisStrataPerSide) + u.y) / tuning::kRisStrataPerSide};
        Candidate &candidate = candidates[count];
        candidate.offset = context_.parts ? Vec2f{filter.sample_folded(u_pixel.x), filter.sample_folded(u_pixel.y)}
                                          : Vec2f{filter.sample(u_pixel.x), filter.sample(u_pixel.y)};
        candidate.ray =
            camera_ray_at(scene(), context_.pixel_x, context_.pixel_y, candidate.offset, sampler_.next_2d(), time).ray;
        const auto hit = intersect(candidate.ray, RayKind::camera);
        if (!hit || (F.visibility && scene().is_holdout(*hit)))
            continue;
        candidate.surface = scene().interaction(candidate.ray, *hit);
        candidate.beta = Rgb(1.0f / tuning::kRisCandidates);
        if constexpr (F.medium)
            if (const Medium *medium = scene().outside())
                candidate.beta *= transmittance(*medium, candidate.ray, hit->t);
        candidate.shading = shade(candidate.surface, candidate.ray);
        const float target =
            ris_target(scene(), candidate.surface, candidate.shading.bsdf, -candidate.ray.direction, sigma_);
        candidate.target = max_component(candidate.beta) * target;
        if (!(candidate.target > 0) || !(candidate.target < kInfinity)) // nothing rough, black, or out of range
            candidate.target = 0;
        total += candidate.target;
        ++count;
    }
    if (count == 0)
        return;
    const DefensiveMixture mixture(total, count, tuning::kRisUniformFraction);
    float left = sampler_.next_1d();
    for (uint32_t i = 0; i < count; ++i) {
        const float probability = mixture.probability(candidates[i].target);
        if (left >= probability && i + 1 < count) {
            left -= probability;
            continue;
        }
        if (context_.parts)
            context_.parts->resampled_at = candidates[i].offset;
        State state;
        state.ray = candidates[i].ray;
        state.beta = candidates[i].beta * (1 / probability);
        light_surface(state, candidates[i].surface, candidates[i].shading);
        return;
    }
}

} // namespace glimmer
