// SPDX-License-Identifier: GPL-3.0-or-later
#include "curve.h"

#include "curve_plot.h"
#include "picture/atomic_file.h"
#include "picture/picture_file.h"
#include "text.h"

namespace glimmer {

std::vector<CurvePoint> curve_of(const Report &report) {
    std::vector<CurvePoint> curve;
    if (!report.contains("curve"))
        return curve;
    const auto optional_number = [](const Report &value) {
        return value.is_number() ? std::optional(value.get<double>()) : std::nullopt;
    };
    for (const Report &row : report["curve"])
        if (row.size() == 6 && row[3].is_number())
            curve.push_back({row[0].get<double>(), row[1].get<double>(), row[2].get<double>(), row[3].get<double>(),
                             optional_number(row[4]), optional_number(row[5])});
    return curve;
}

void expect_plottable(const std::filesystem::path &path) {
    if (lower_extension(path) == ".png" && plot_font().empty())
        throw InputError("--curve: no font to label a plot with; install fonts-dejavu-core, or write a .csv");
}

void write_curve(const std::vector<CurvePoint> &curve, double confidence, const std::filesystem::path &path) {
    if (lower_extension(path) == ".png")
        return write_curve_plot(curve, confidence, path);
    std::string table = "seconds,cpu_seconds,spp,relmse,low,high\n";
    const auto cell = [](const std::optional<double> &value) { return value ? number_text(*value) : ""; };
    for (const CurvePoint &point : curve)
        table += number_text(point.seconds) + "," + number_text(point.cpu_seconds) + "," + number_text(point.spp) +
                 "," + number_text(point.relmse) + "," + cell(point.low) + "," + cell(point.high) + "\n";
    write_file(path, table);
}

} // namespace glimmer
