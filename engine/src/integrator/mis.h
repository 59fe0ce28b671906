// SPDX-License-Identifier: GPL-3.0-or-later
// Multiple importance sampling (Veach and Guibas 1995).
#pragma once

namespace glimmer {

/// The balance heuristic's weight of technique a against b, as 1 / (1 + b/a): densities may be infinite or 0 one at a
/// time without becoming NaN. 1 where b is 0.
inline float balance(float a, float b) {
    if (b == 0)
        return 1;
    return 1 / (1 + b / a);
}

} // namespace glimmer
