// SPDX-License-Identifier: GPL-3.0-or-later
// The plot of a picture's error against its render time, and the same as a table.
#pragma once

#include "glimmer.h"
#include "plot/canvas.h"

#include <span>

namespace glimmer {

using ErrorCurvePoints = std::span<const glimmer_curve_point>;

struct PlotStyle {
    Rgb background, text, line, guide; ///< sRGB, 0 to 1
};

/// Both axes are logarithmic. The interval is a band; the dashed guide falls from the last point as 1/time does, which
/// is what independent samples do. A wide picture has a title, a legend and the last point in words, too. Points whose
/// error is not known are left out.
Canvas plot_error_curve(ErrorCurvePoints points, int width, int height, const PlotStyle &style);

/// CSV: a line of names, then a line for each point. What is not known is empty.
std::string error_curve_table(ErrorCurvePoints points);

} // namespace glimmer
