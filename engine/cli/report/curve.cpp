// SPDX-License-Identifier: GPL-3.0-or-later
#include "curve.h"

#include "handles.h"
#include "picture/atomic_file.h"
#include "picture/encode.h"
#include "picture/picture_file.h"

#include <algorithm>
#include <limits>

namespace glimmer {

std::vector<glimmer_curve_point> curve_of(const Report &report) {
    std::vector<glimmer_curve_point> curve;
    if (!report.contains("curve"))
        return curve;
    const auto number = [](const Report &value) {
        return value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
    };
    for (const Report &row : report["curve"])
        if (row.size() == 6 && row[3].is_number())
            curve.push_back(
                {number(row[0]), number(row[1]), number(row[2]), number(row[3]), number(row[4]), number(row[5])});
    return curve;
}

static void write_plot(const std::vector<glimmer_curve_point> &curve, const std::filesystem::path &path) {
    glimmer_plot_desc plot;
    glimmer_plot_init(&plot);
    std::vector<uint8_t> rgb(size_t(3) * plot.width * plot.height);
    check(glimmer_plot_error_curve(curve.data(), curve.size(), &plot, rgb.data(), rgb.size()), path.string());
    std::vector<float> pixels(rgb.size());
    std::ranges::transform(rgb, pixels.begin(), [](uint8_t value) { return float(value) / 255; });
    const int width = int(plot.width), height = int(plot.height);
    write_image({"png", 0, 0, width, height, 1, width, height, {"R", "G", "B"}, "sRGB", {}}, pixels, PixelType::UInt8,
                path);
}

void write_curve(const std::vector<glimmer_curve_point> &curve, const std::filesystem::path &path) {
    if (lower_extension(path) == ".png")
        return write_plot(curve, path);
    const char *table = nullptr;
    check(glimmer_error_curve_table(curve.data(), curve.size(), &table), path.string());
    write_file(path, table);
}

} // namespace glimmer
