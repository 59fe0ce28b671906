// SPDX-License-Identifier: GPL-3.0-or-later
#include "api/calls.h"

#include <cstring>
#include <vector>

namespace glimmer {

void draw_error_curve(Input &in) {
    std::vector<glimmer_curve_point> points(in.ConsumeIntegralInRange<size_t>(0, kMostElements));
    for (glimmer_curve_point &p : points)
        p = {in.number(), in.number(), in.number(), in.number(), in.number(), in.number()};
    const char *table = nullptr;
    if (expect(glimmer_error_curve_table(points.data(), points.size(), &table)) == GLIMMER_OK)
        require(table && std::strchr(table, '\n'), "a table without its line of names");
    glimmer_plot_desc desc;
    glimmer_plot_init(&desc);
    // Every pixel of a plot costs time that finds nothing. Few are large enough for a legend.
    desc.width = in.ConsumeIntegralInRange<int>(0, 31) == 31 ? 620 : in.ConsumeIntegralInRange<uint32_t>(196, 204);
    desc.height = in.ConsumeIntegralInRange<uint32_t>(196, 204);
    if (in.ConsumeIntegralInRange<int>(0, 3) == 0)
        in.fill(desc.line, 3);
    in.spoil_size(desc);
    std::vector<uint8_t> rgb(size_t(3) * desc.width * desc.height);
    expect(glimmer_plot_error_curve(points.data(), points.size(), &desc, rgb.data(), rgb.size()));
}

} // namespace glimmer
