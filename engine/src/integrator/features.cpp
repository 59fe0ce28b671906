// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrator/features.h"

namespace glimmer {

Features needed_by(const Scene &scene, const PathOptions &options, bool shares) {
    Features f;
    f.fog = scene.medium.has_value();
    f.fog_walks = f.fog && scene.medium->scatters() && !shares;
    f.surfaces = scene.has_surfaces;
    f.glass = scene.has_glass;
    f.bvh = !scene.accel->without_bvh();
    for (uint32_t i = 0; i < scene.lights.size(); ++i)
        f.other_lights |= !std::holds_alternative<SphereLight>(scene.lights[i]);
    f.switches = !(options == kAllEstimators);
    return f;
}

std::vector<std::string> left_out(const Features &needed) {
    std::vector<std::string> lines;
    for (const FeatureText &f : kFeatureTexts)
        if (!(needed.*f.feature) && *f.left_out)
            lines.emplace_back(f.left_out);
    return lines;
}

} // namespace glimmer
