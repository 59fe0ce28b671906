// SPDX-License-Identifier: GPL-3.0-or-later
// The report of a render: the engine's JSON with what only the command knows.
#pragma once

#include "handles.h"

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace glimmer {

using Report = nlohmann::ordered_json;

/// The engine's report; `load` seconds are ours, `build` seconds too where the engine gives none; what the reader left
/// out stands before what the engine did.
Report make_report(glimmer_render *render, double load_seconds, double build_seconds,
                   const std::vector<std::string> &left_out);

/// A list of texts of the report.
std::vector<std::string> report_texts(const Report &report, const char *key);

} // namespace glimmer
