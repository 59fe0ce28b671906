// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrator/registry.h"

#include "integrator/path/path_integrator.h"

namespace glimmer {

namespace {

/// What each integrator from the third on has switched off.
constexpr std::array kWithout{
    &EstimatorFlags::split,
    &EstimatorFlags::all_lights,
    &EstimatorFlags::emitter_rays,
    &EstimatorFlags::branch,
    &EstimatorFlags::guided_choice,
    &EstimatorFlags::equiangular,
    &EstimatorFlags::deep_equiangular,
    &EstimatorFlags::late_roulette,
    &EstimatorFlags::pixel_ris,
    &EstimatorFlags::light_vertices,
    &EstimatorFlags::reconstruction,
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

std::optional<uint32_t> find_integrator(std::string_view name) {
    for (uint32_t i = 0; i < kIntegrators.size(); ++i)
        if (name == kIntegrators[i].name || (kIntegrators[i].former_name && name == kIntegrators[i].former_name))
            return i;
    return std::nullopt;
}

std::string renamed_integrator(std::string_view name) {
    const auto index = find_integrator(name);
    if (!index || name == kIntegrators[*index].name)
        return {};
    return "integrator \"" + std::string(name) + "\" is now called \"" + kIntegrators[*index].name + "\"";
}

std::unique_ptr<const Integrator> make_integrator(uint32_t index, const Scene &scene, const DepthLimits &limits,
                                                  uint64_t passes, bool full_kernel) {
    return make_path_integrator(scene, limits, flags_of(index), passes, full_kernel);
}

} // namespace glimmer
