// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrator/integrator.h"

#include "integrator/path.h"

namespace glimmer {

std::unique_ptr<const Integrator> make_integrator(uint32_t index, const Scene &scene, const DepthLimits &limits,
                                                  bool full_kernel) {
    return make_path_integrator(scene, limits, index == 0 ? PathOptions{} : kReportOptions, full_kernel);
}

} // namespace glimmer
