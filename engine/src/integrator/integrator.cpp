// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrator/integrator.h"

#include "integrator/path.h"

namespace glimmer {

namespace {

/// What is switched off, from the third of kIntegrators on.
constexpr std::array kWithout{
    &PathOptions::split,
    &PathOptions::all_lights,
    &PathOptions::light_rays,
    &PathOptions::branch,
    &PathOptions::guided_choice,
    &PathOptions::line_lights,
    &PathOptions::deep_line_lights,
    &PathOptions::late_roulette,
    &PathOptions::pixel_points,
    &PathOptions::light_vertices,
};
static_assert(kIntegrators.size() == 2 + kWithout.size());

PathOptions options_of(uint32_t index) {
    if (index == 1)
        return kReportOptions;
    PathOptions options;
    if (index >= 2)
        options.*kWithout[index - 2] = false;
    return options;
}

} // namespace

std::unique_ptr<const Integrator> make_integrator(uint32_t index, const Scene &scene, const DepthLimits &limits,
                                                  bool full_kernel) {
    return make_path_integrator(scene, limits, options_of(index), full_kernel);
}

} // namespace glimmer
