// SPDX-License-Identifier: GPL-3.0-or-later
// The curve of the error, as a table and as a plot.
#include "api/handles.h"
#include "plot/error_curve_plot.h"

using namespace glimmer;

namespace {

thread_local std::string last_table;

ErrorCurvePoints checked_points(const glimmer_curve_point *points, size_t count) {
    if (!points && count)
        fail_argument("error curve: the points are null");
    return {points, count};
}

Rgb checked_color(const float (&color)[3], const char *what) {
    for (const float value : color)
        check_range(double(value), 0, 1, std::string("plot: ") + what);
    return {color[0], color[1], color[2]};
}

} // namespace

extern "C" {

glimmer_result glimmer_error_curve_table(const glimmer_curve_point *points, size_t count, const char **table) {
    return guarded([&] {
        const ErrorCurvePoints checked = checked_points(points, count);
        if (!table)
            fail_argument("error curve: the output is null");
        last_table = error_curve_table(checked);
        *table = last_table.c_str();
    });
}

void glimmer_plot_init(glimmer_plot_desc *desc) {
    if (!desc)
        return;
    *desc = {sizeof *desc, 960, 600, {1, 1, 1}, {0.13f, 0.14f, 0.18f}, {0.13f, 0.33f, 0.68f}, {0.85f, 0.45f, 0.20f}};
}

glimmer_result glimmer_plot_error_curve(const glimmer_curve_point *points, size_t count, const glimmer_plot_desc *desc,
                                        uint8_t *rgb, size_t byte_count) {
    return guarded([&] {
        glimmer_plot_desc defaults;
        glimmer_plot_init(&defaults);
        const glimmer_plot_desc d = checked_desc(desc, defaults, "plot");
        check_range(d.width, 200, 8192, "plot: width");
        check_range(d.height, 200, 8192, "plot: height");
        const PlotStyle style{checked_color(d.background, "background"), checked_color(d.text, "text"),
                              checked_color(d.line, "line"), checked_color(d.guide, "guide")};
        const ErrorCurvePoints checked = checked_points(points, count);
        if (const size_t needed = size_t(3) * d.width * d.height; !rgb || byte_count != needed)
            fail_argument("plot: " + (rgb ? std::to_string(byte_count) + " bytes" : std::string("the output is null")) +
                          "; allowed: " + std::to_string(needed) + " bytes");
        plot_error_curve(checked, int(d.width), int(d.height), style).store(rgb);
    });
}
}
