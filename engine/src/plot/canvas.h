// SPDX-License-Identifier: GPL-3.0-or-later
// Just enough drawing for a plot: smooth lines, discs, spans and text.
#pragma once

#include "math/vec.h"

#include <cstdint>
#include <string>
#include <vector>

namespace glimmer {

/// Coordinates are pixels from the top left corner; colours are sRGB, 0 to 1. What lies outside is not drawn.
class Canvas {
  public:
    enum class Align { left, center, right };

    Canvas(int width, int height, const Rgb &background);

    int width() const { return width_; }
    int height() const { return height_; }

    void line(double x0, double y0, double x1, double y1, double line_width, const Rgb &color);
    void disc(double x, double y, double radius, const Rgb &color);
    /// One column of pixels from y0 down to y1, with soft ends.
    void column(int x, double y0, double y1, const Rgb &color);
    /// Digits and capitals are centred at y; x is where the text begins, has its middle or ends.
    void text(double x, double y, const std::string &text, Align align, const Rgb &color);
    static int text_width(const std::string &text);

    /// (height, width, 3), top row first.
    void store(uint8_t *rgb) const;

  private:
    void blend(int x, int y, double coverage, const Rgb &color);

    int width_, height_;
    std::vector<Rgb> pixels_;
};

} // namespace glimmer
