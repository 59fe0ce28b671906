// SPDX-License-Identifier: GPL-3.0-or-later
// What a caller should know of a scene or of settings that are rendered all the same.
#pragma once

#include "glimmer.h"

#include <array>
#include <string>

namespace glimmer {

/// The code is for programs, the text for people; it may be worded better at any time.
struct Warning {
    glimmer_warning_code code;
    std::string text;
};

/// By code, as in reports.
inline constexpr std::array kWarningNames{
    "renamed_integrator", "flat_instance", "folding_motion", "shining_motion", "endless_fog", "no_light",
};
static_assert(kWarningNames.size() == GLIMMER_WARNING_COUNT);

} // namespace glimmer
