// SPDX-License-Identifier: GPL-3.0-or-later
// Error against run time, as a table and as a plot.
#pragma once

#include "report.h"

#include <filesystem>
#include <optional>
#include <vector>

namespace glimmer {

/// The picture's error at one moment of the render.
struct CurvePoint {
    double seconds, cpu_seconds, spp, relmse;
    std::optional<double> low, high; ///< the interval of relmse
};

/// The points of the report whose error is known.
std::vector<CurvePoint> curve_of(const Report &report);

/// A .csv with a line of names, or a .png plot. Throws ResultError.
void write_curve(const std::vector<CurvePoint> &curve, double confidence, const std::filesystem::path &path);

/// Throws InputError where a plot could not be labelled: found out before the render rather than after it.
void expect_plottable(const std::filesystem::path &path);

} // namespace glimmer
