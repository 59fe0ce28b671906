// SPDX-License-Identifier: GPL-3.0-or-later
// The plot of error against run time.
#pragma once

#include "curve.h"

namespace glimmer {

/// The name of a font that text can be drawn with; "" when there is none.
std::string plot_font();

/// Both axes logarithmic; the interval is a band, the dashed line falls as 1/time does. Throws ResultError.
void write_curve_plot(const std::vector<CurvePoint> &curve, double confidence, const std::filesystem::path &path);

} // namespace glimmer
