// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrator/path/kernel_features.h"

#include "film/passes.h"

namespace glimmer {

KernelFeatures needed_by(const Scene &scene, const EstimatorFlags &flags, bool shares, uint64_t passes) {
    KernelFeatures f;
    f.medium = scene.medium.has_value();
    f.bounded_media = f.medium && scene.medium->lets_in();
    f.varying_media = f.medium && scene.medium->bounded() && scene.medium->bounded()->varies();
    f.medium_walks = f.medium && scene.medium->scatters() && !shares;
    f.surfaces = scene.has_surfaces;
    f.transmission = scene.has_transmission;
    f.transparency = scene.has_transparency;
    f.subsurface = scene.has_subsurface;
    f.terminators = scene.has_shadow_terminators;
    f.bvh = !scene.accel->without_bvh();
    for (uint32_t i = 0; i < scene.lights.size(); ++i)
        f.other_lights |= !is_emissive_sphere(scene.lights[i]);
    f.visibility = scene.has_visibility;
    EstimatorFlags of_kernel = flags;
    of_kernel.reconstruction = true; // the film's
    f.estimator_flags = !(of_kernel == kAllEstimators);
    f.passes = scene.film.transparent || (passes & kPassesOfMore);
    return f;
}

std::vector<std::string> left_out(const KernelFeatures &needed) {
    std::vector<std::string> lines;
    for (const FeatureText &f : kFeatureTexts)
        if (!(needed.*f.feature) && *f.left_out)
            lines.emplace_back(f.left_out);
    return lines;
}

} // namespace glimmer
