// SPDX-License-Identifier: GPL-3.0-or-later
// Error against run time, as a table and as a plot.
#pragma once

#include "report.h"

#include <filesystem>
#include <vector>

namespace glimmer {

/// The points of the report whose error is known.
std::vector<glimmer_curve_point> curve_of(const Report &report);

/// A .csv with a line of names, or a .png plot. Throws ResultError.
void write_curve(const std::vector<glimmer_curve_point> &curve, const std::filesystem::path &path);

} // namespace glimmer
