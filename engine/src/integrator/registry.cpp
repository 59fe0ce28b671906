// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrator/registry.h"

#include "integrator/path/path_integrator.h"

namespace glimmer {

namespace {

/// What each integrator from the third on has switched off.
constexpr std::array kWithout{
    &EstimatorFlags::split,
    &EstimatorFlags::all_lights,
    &EstimatorFlags::light_rays,
    &EstimatorFlags::branch,
    &EstimatorFlags::guided_choice,
    &EstimatorFlags::segment_lights,
    &EstimatorFlags::deep_segment_lights,
    &EstimatorFlags::late_roulette,
    &EstimatorFlags::pixel_points,
    &EstimatorFlags::light_vertices,
};
static_assert(kIntegrators.size() == 2 + kWithout.size());

EstimatorFlags flags_of(uint32_t index) {
    if (index == 1)
        return kBaselineFlags;
    EstimatorFlags flags;
    if (index >= 2)
        flags.*kWithout[index - 2] = false;
    return flags;
}

} // namespace

std::unique_ptr<const Integrator> make_integrator(uint32_t index, const Scene &scene, const DepthLimits &limits,
                                                  bool full_kernel) {
    return make_path_integrator(scene, limits, flags_of(index), full_kernel);
}

} // namespace glimmer
