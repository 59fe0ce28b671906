// SPDX-License-Identifier: GPL-3.0-or-later
#include "canvas.h"

#include "image_library.h"
#include "picture/encode.h"

#include <algorithm>
#include <cmath>

namespace glimmer {

Canvas::Canvas(int width, int height)
    : width_(width), height_(height), pixels_(3 * static_cast<size_t>(width) * static_cast<size_t>(height), 1.0f) {}

void Canvas::blend(int x, int y, double coverage, const Ink &ink) {
    if (x < 0 || y < 0 || x >= width_ || y >= height_ || !(coverage > 0))
        return;
    const auto alpha = static_cast<float>(std::min(coverage, 1.0));
    float *pixel = pixels_.data() + 3 * (static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x));
    for (size_t c = 0; c < 3; ++c)
        pixel[c] += alpha * (ink[c] - pixel[c]);
}

void Canvas::line(double x0, double y0, double x1, double y1, double width, const Ink &ink) {
    const double margin = width / 2 + 1, dx = x1 - x0, dy = y1 - y0, length_squared = dx * dx + dy * dy;
    for (int y = int(std::min(y0, y1) - margin); y <= int(std::max(y0, y1) + margin); ++y) {
        for (int x = int(std::min(x0, x1) - margin); x <= int(std::max(x0, x1) + margin); ++x) {
            const double px = x + 0.5 - x0, py = y + 0.5 - y0;
            const double t = length_squared > 0 ? std::clamp((px * dx + py * dy) / length_squared, 0.0, 1.0) : 0;
            blend(x, y, width / 2 + 0.5 - std::hypot(px - t * dx, py - t * dy), ink);
        }
    }
}

void Canvas::disc(double x, double y, double radius, const Ink &ink) {
    line(x, y, x, y, 2 * radius, ink);
}

void Canvas::column(int x, double y0, double y1, const Ink &ink) {
    for (int y = int(std::floor(y0)); y <= int(y1); ++y)
        blend(x, y, std::min(y1, y + 1.0) - std::max(y0, double(y)), ink);
}

void Canvas::text(double x, double y, const std::string &text, int size, Align align, const Ink &ink) {
    // On the baseline, a third of the size below the middle: centred by their boxes, "1" and "10e-5" would not line up.
    image_io().draw_text(pixels_, width_, height_, int(std::lround(x)), int(std::lround(y + size * 0.36)), text,
                         {font(), size, ink, align});
}

void Canvas::write(const std::filesystem::path &path) const {
    write_image({"png", 0, 0, width_, height_, 1, width_, height_, {"R", "G", "B"}, "sRGB", {}}, pixels_,
                PixelType::UInt8, path);
}

std::string Canvas::font() {
    static const std::string found = [] {
        for (const char *name :
             {"DejaVuSans", "DejaVu Sans", "NotoSans-Regular", "LiberationSans-Regular", "DroidSans", ""})
            if (image_io().has_font(name))
                return std::string(name);
        return std::string();
    }();
    return found;
}

} // namespace glimmer
