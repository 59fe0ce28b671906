// SPDX-License-Identifier: GPL-3.0-or-later
// Limits on the length of paths.
#pragma once

#include <cstdint>
#include <limits>

namespace glimmer {

/// Most scattering vertices of a path. A limit is a bias; by default there is none.
struct DepthLimits {
    uint32_t depth = std::numeric_limits<uint32_t>::max();   ///< vertices on surfaces and in the medium
    uint32_t scatter = std::numeric_limits<uint32_t>::max(); ///< vertices in the medium alone

    bool operator==(const DepthLimits &) const = default;
};

} // namespace glimmer
