// SPDX-License-Identifier: GPL-3.0-or-later
// A homogeneous medium as functions on sixteen lanes take it.
#pragma once

namespace glimmer {

struct SimdMedium {
    float sigma_r, sigma_g, sigma_b; ///< extinction by channel, per length
    float g;                         ///< of the Henyey-Greenstein phase function
    bool monochromatic;              ///< only sigma_r is read
};

} // namespace glimmer
