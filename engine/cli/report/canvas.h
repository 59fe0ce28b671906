// SPDX-License-Identifier: GPL-3.0-or-later
// Just enough drawing for a plot: smooth lines, discs, spans and text on white.
#pragma once

#include "image_io.h"

#include <filesystem>
#include <string>
#include <vector>

namespace glimmer {

using Ink = std::array<float, 3>; ///< sRGB, 0 to 1

class Canvas {
  public:
    using Align = TextStyle::Align;

    Canvas(int width, int height);

    /// Coordinates in pixels from the top left; `width` is the line's.
    void line(double x0, double y0, double x1, double y1, double width, const Ink &ink);
    void disc(double x, double y, double radius, const Ink &ink);
    /// One column of pixels from y0 down to y1, with soft ends.
    void column(int x, double y0, double y1, const Ink &ink);
    /// The text's middle height at y.
    void text(double x, double y, const std::string &text, int size, Align align, const Ink &ink);
    /// 8-bit .png. Throws ResultError.
    void write(const std::filesystem::path &path) const;

    /// The name of a font; "" when the system has none.
    static std::string font();

  private:
    void blend(int x, int y, double coverage, const Ink &ink);

    int width_, height_;
    std::vector<float> pixels_; ///< (height, width, 3)
};

} // namespace glimmer
