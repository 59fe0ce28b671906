// SPDX-License-Identifier: GPL-3.0-or-later
// The report of a render as JSON: see SCENE_FORMAT.md, --report, for its keys.
#pragma once

#include "film/film.h"
#include "integrator/registry.h"
#include "render/error_curve.h"
#include "render/render_settings.h"
#include "render/sample_faults.h"
#include "scene/scene.h"

#include <string>

namespace glimmer {

/// What a report tells, as it was at one moment. The objects live in the session.
struct ReportInput {
    const Scene &scene;
    const Integrator &integrator;
    const RenderSettings &settings;
    const glimmer_progress &progress;
    const ErrorCurve &curve;
    const SampleFaults &faults;
    std::optional<std::array<uint64_t, 2>> samples_taken; ///< fewest and most; of an adaptive film alone
};

std::string report_json(const ReportInput &input);

} // namespace glimmer
