// SPDX-License-Identifier: GPL-3.0-or-later
// The light straight from lights on what the camera sees first. Bevels narrower than a pixel mirror a moon where they
// happen to lie right: few points of the pixel bring most of its light. So several points compete, each seen by its own
// camera ray, and one is lit, chosen by the light expected there (Talbot, Cline, Egbert 2005, "Importance Resampling
// for Global Illumination"): as one term of their sum, divided by the probability of being it, whatever is expected.
#pragma once

#include "camera/camera_sample.h"
#include "integrator/direct/ris_target.h"
#include "integrator/path/path_sample.h"

#include <array>

namespace glimmer {

template <KernelFeatures F>
void PathSample<F>::pixel_ris() {
    struct Seen {
        Ray ray;
        Interaction surface;
        Shading shading;
        Rgb beta;
        float expected;
    };
    std::array<Seen, kRisCandidates> points;
    uint32_t count = 0;
    float total = 0;
    for (uint32_t i = 0; i < kRisCandidates; ++i) {
        const Vec2f u = sampler_.stratified_2d(dimension(Dimension::candidate_film, i));
        const Vec2f u_pixel{(float(i % kRisStrataPerSide) + u.x) / kRisStrataPerSide,
                            (float(i / kRisStrataPerSide) + u.y) / kRisStrataPerSide};
        Seen &point = points[count];
        point.ray = sample_camera_ray(scene(), context_.pixel_x, context_.pixel_y, u_pixel, sampler_.next_2d()).ray;
        const auto hit = intersect(point.ray);
        if (!hit)
            continue;
        point.surface = scene().interaction(point.ray, *hit);
        point.beta = Rgb(1.0f / kRisCandidates);
        if constexpr (F.medium)
            point.beta *= transmittance(scene().outside(), point.ray, hit->t);
        point.shading = shade(point.surface, point.ray);
        const float expected = ris_target(scene(), point.surface, point.shading.bsdf, -point.ray.direction, sigma_);
        point.expected = max_component(point.beta) * expected;
        if (!(point.expected > 0) || !(point.expected < kInfinity)) // nothing rough, or black
            point.expected = 0;
        total += point.expected;
        ++count;
    }
    if (count == 0)
        return;
    const float even = (total > 0 ? kRisUniformFraction : 1.0f) / float(count),
                scale = total > 0 ? (1 - kRisUniformFraction) / total : 0.0f;
    float left = sampler_.next_1d();
    for (uint32_t i = 0; i < count; ++i) {
        const float probability = even + scale * points[i].expected;
        if (left >= probability && i + 1 < count) {
            left -= probability;
            continue;
        }
        State state;
        state.ray = points[i].ray;
        state.beta = points[i].beta * (1 / probability);
        light_surface(state, points[i].surface, points[i].shading);
        return;
    }
}

} // namespace glimmer
