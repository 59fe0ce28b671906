// SPDX-License-Identifier: GPL-3.0-or-later
#include "plot/canvas.h"

#include "plot/glyphs.h"

#include <algorithm>
#include <cmath>

namespace glimmer {

Canvas::Canvas(int width, int height, const Rgb &background)
    : width_(width), height_(height), pixels_(size_t(width) * size_t(height), background) {}

void Canvas::blend(int x, int y, double coverage, const Rgb &color) {
    if (x < 0 || y < 0 || x >= width_ || y >= height_ || !(coverage > 0))
        return;
    Rgb &pixel = pixels_[size_t(y) * size_t(width_) + size_t(x)];
    const float alpha = float(std::min(coverage, 1.0));
    pixel = pixel * (1 - alpha) + color * alpha;
}

void Canvas::line(double x0, double y0, double x1, double y1, double line_width, const Rgb &color) {
    const double margin = line_width / 2 + 1, dx = x1 - x0, dy = y1 - y0, length_squared = dx * dx + dy * dy;
    const auto first = [&](double a, double b) { return int(std::max(std::min(a, b) - margin, 0.0)); };
    const auto last = [&](double a, double b, int size) { return int(std::min(std::max(a, b) + margin, size - 1.0)); };
    for (int y = first(y0, y1); y <= last(y0, y1, height_); ++y) {
        for (int x = first(x0, x1); x <= last(x0, x1, width_); ++x) {
            const double px = x + 0.5 - x0, py = y + 0.5 - y0;
            const double t = length_squared > 0 ? std::clamp((px * dx + py * dy) / length_squared, 0.0, 1.0) : 0;
            blend(x, y, line_width / 2 + 0.5 - std::hypot(px - t * dx, py - t * dy), color);
        }
    }
}

void Canvas::disc(double x, double y, double radius, const Rgb &color) {
    line(x, y, x, y, 2 * radius, color);
}

void Canvas::column(int x, double y0, double y1, const Rgb &color) {
    y0 = std::max(y0, 0.0);
    y1 = std::min(y1, double(height_));
    for (int y = int(y0); y < y1; ++y)
        blend(x, y, std::min(y1, y + 1.0) - std::max(y0, double(y)), color);
}

int Canvas::text_width(const std::string &text) {
    int width = 0;
    for (const char c : text)
        width += glyph(c).advance;
    return width;
}

void Canvas::text(double x, double y, const std::string &text, Align align, const Rgb &color) {
    const int width = text_width(text), baseline = int(std::lround(y + kCapitalHeight / 2.0));
    int origin = int(std::lround(align == Align::left ? x : align == Align::center ? x - width / 2.0 : x - width));
    for (const char c : text) {
        const Glyph &g = glyph(c);
        for (int row = 0; row < g.height; ++row)
            for (int column = 0; column < g.width; ++column) {
                const char digit = g.coverage[row * g.width + column];
                const int level = digit <= '9' ? digit - '0' : digit - 'a' + 10;
                blend(origin + g.left + column, baseline - g.top + row, level / 15.0, color);
            }
        origin += g.advance;
    }
}

void Canvas::store(uint8_t *rgb) const {
    for (const Rgb &pixel : pixels_)
        for (const float value : {pixel.r, pixel.g, pixel.b})
            *rgb++ = uint8_t(std::lround(255 * std::clamp(value, 0.0f, 1.0f)));
}

} // namespace glimmer
