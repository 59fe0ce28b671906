// SPDX-License-Identifier: GPL-3.0-or-later
#include "plot/error_curve_plot.h"

#include <cmath>
#include <cstdio>

namespace glimmer {

std::string error_curve_table(ErrorCurvePoints points) {
    std::string table = "seconds,cpu_seconds,spp,relmse,low,high\n";
    for (const glimmer_curve_point &p : points) {
        const char *separator = "";
        for (const double value : {p.seconds, p.cpu_seconds, p.samples, p.relmse, p.relmse_low, p.relmse_high}) {
            char text[32] = "";
            if (std::isfinite(value))
                std::snprintf(text, sizeof text, "%.9g", value); // as in the report
            table += separator;
            table += text;
            separator = ",";
        }
        table += '\n';
    }
    return table;
}

} // namespace glimmer
