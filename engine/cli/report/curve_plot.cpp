// SPDX-License-Identifier: GPL-3.0-or-later
#include "curve_plot.h"

#include "canvas.h"
#include "text.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace glimmer {
namespace {

constexpr int kWidth = 960, kHeight = 600;
constexpr double kLeft = 100, kRight = 930, kTop = 70, kBottom = 530;
constexpr Ink kText{0.13f, 0.14f, 0.18f}, kSoft{0.42f, 0.44f, 0.50f}, kGrid{0.90f, 0.91f, 0.93f},
    kFrame{0.55f, 0.57f, 0.62f};
constexpr Ink kLine{0.13f, 0.33f, 0.68f}, kBand{0.80f, 0.87f, 0.96f}, kGuide{0.85f, 0.45f, 0.20f};

/// A logarithmic axis: values from `low` to `high` (both > 0) onto pixels.
struct LogAxis {
    double low, high, begin, end;

    double operator()(double value) const {
        return begin + (end - begin) * std::log(value / low) / std::log(high / low);
    }
    double value_at(double pixel) const { return low * std::pow(high / low, (pixel - begin) / (end - begin)); }

    /// 1, 2 and 5 times the powers of ten; these powers alone, or each third and so on, where that would be too many.
    std::vector<double> ticks() const {
        const int first = int(std::floor(std::log10(low))), last = int(std::ceil(std::log10(high)));
        const bool fine = std::log10(high / low) < 2.5;
        const int step = std::max(1, (last - first) / 7);
        std::vector<double> result;
        for (int exponent = first; exponent <= last; ++exponent)
            for (const double digit : {1.0, 2.0, 5.0})
                if (const double value = digit * std::pow(10, exponent);
                    (digit == 1 ? (exponent - first) % step == 0 : fine) && value >= low * (1 - 1e-9) &&
                    value <= high * (1 + 1e-9))
                    result.push_back(value);
        return result;
    }
};

/// Room around the values, and at least a decade, so that there are ticks.
LogAxis fit(double low, double high, double begin, double end) {
    low /= 1.3;
    high *= 1.3;
    if (const double widen = std::sqrt(10 * low / high); widen > 1) {
        low /= widen;
        high *= widen;
    }
    return {low, high, begin, end};
}

std::string tick_text(double value) {
    char text[32];
    std::snprintf(text, sizeof text, value >= 1e-3 && value < 1e5 ? "%.6g" : "%.0e", value);
    return text;
}

void draw_axes(Canvas &canvas, const LogAxis &x, const LogAxis &y) {
    for (const double value : x.ticks()) {
        canvas.line(x(value), kTop, x(value), kBottom, 1, kGrid);
        canvas.line(x(value), kBottom, x(value), kBottom + 5, 1, kFrame);
        canvas.text(x(value), kBottom + 18, tick_text(value), 15, Canvas::Align::Center, kText);
    }
    for (const double value : y.ticks()) {
        canvas.line(kLeft, y(value), kRight, y(value), 1, kGrid);
        canvas.line(kLeft - 5, y(value), kLeft, y(value), 1, kFrame);
        canvas.text(kLeft - 10, y(value), tick_text(value), 15, Canvas::Align::Right, kText);
    }
    canvas.line(kLeft, kBottom, kRight, kBottom, 1.2, kFrame);
    canvas.line(kLeft, kTop, kLeft, kBottom, 1.2, kFrame);
    canvas.text((kLeft + kRight) / 2, kHeight - 20, "render time in seconds", 16, Canvas::Align::Center, kText);
    canvas.text(kLeft - 60, kTop - 22, "relMSE", 16, Canvas::Align::Left, kText);
}

/// Between low and high of neighbouring points, straight in the logarithms as the line is.
void draw_band(Canvas &canvas, const std::vector<CurvePoint> &curve, const LogAxis &x, const LogAxis &y) {
    for (size_t i = 0; i + 1 < curve.size(); ++i) {
        const CurvePoint &a = curve[i], &b = curve[i + 1];
        if (!a.low || !a.high || !b.low || !b.high)
            continue;
        const auto clamped = [&](double value) { return y(std::clamp(value, y.low, y.high)); };
        const double x0 = x(a.seconds), x1 = x(b.seconds);
        for (int column = int(std::ceil(x0)); column < x1; ++column) {
            const double t = (column - x0) / (x1 - x0);
            canvas.column(column, std::lerp(clamped(*a.high), clamped(*b.high), t),
                          std::lerp(clamped(*a.low), clamped(*b.low), t), kBand);
        }
    }
}

/// Through the last point, down as 1/time: what independent samples do.
void draw_guide(Canvas &canvas, const CurvePoint &last, const LogAxis &x, const LogAxis &y) {
    constexpr int dash = 9, gap = 7;
    for (double pixel = kLeft; pixel + dash < kRight; pixel += dash + gap) {
        const auto height = [&](double at) { return y(last.relmse * last.seconds / x.value_at(at)); };
        if (const double y0 = height(pixel), y1 = height(pixel + dash); y0 >= kTop && y1 <= kBottom)
            canvas.line(pixel, y0, pixel + dash, y1, 1.3, kGuide);
    }
}

void draw_legend(Canvas &canvas, double confidence) {
    const double x = kRight - 205, y = kTop + 22;
    canvas.line(x, y, x + 30, y, 2.2, kLine);
    canvas.disc(x + 15, y, 3.6, kLine);
    canvas.text(x + 40, y, "error of the picture", 15, Canvas::Align::Left, kText);
    for (int column = int(x); column < int(x + 30); ++column)
        canvas.column(column, y + 18, y + 32, kBand);
    canvas.text(x + 40, y + 25, number_text(100 * confidence) + " % interval", 15, Canvas::Align::Left, kText);
    canvas.line(x, y + 50, x + 12, y + 50, 1.3, kGuide);
    canvas.line(x + 18, y + 50, x + 30, y + 50, 1.3, kGuide);
    canvas.text(x + 40, y + 50, "falling as 1 / time", 15, Canvas::Align::Left, kText);
}

void draw_curve(Canvas &canvas, const std::vector<CurvePoint> &curve, double confidence) {
    double x_low = curve[0].seconds, x_high = x_low, y_low = curve[0].relmse, y_high = y_low;
    for (const CurvePoint &point : curve) {
        x_low = std::min(x_low, point.seconds);
        x_high = std::max(x_high, point.seconds);
        y_low = std::min({y_low, point.relmse, point.low && *point.low > 0 ? *point.low : point.relmse});
        y_high = std::max({y_high, point.relmse, point.high.value_or(point.relmse)});
    }
    // An interval that reaches far beyond the curve may leave the picture.
    y_high = std::min(y_high, 100 * std::max_element(curve.begin(), curve.end(), [](const auto &a, const auto &b) {
                                        return a.relmse < b.relmse;
                                    })->relmse);
    const LogAxis x = fit(x_low, x_high, kLeft, kRight), y = fit(y_low, y_high, kBottom, kTop);
    draw_band(canvas, curve, x, y);
    draw_axes(canvas, x, y);
    draw_guide(canvas, curve.back(), x, y);
    for (size_t i = 0; i + 1 < curve.size(); ++i)
        canvas.line(x(curve[i].seconds), y(curve[i].relmse), x(curve[i + 1].seconds), y(curve[i + 1].relmse), 2.2,
                    kLine);
    for (const CurvePoint &point : curve)
        canvas.disc(x(point.seconds), y(point.relmse), 3.6, kLine);
    draw_legend(canvas, confidence);
    const CurvePoint &last = curve.back();
    char text[128];
    std::snprintf(text, sizeof text, "%.0f samples a pixel in %.3g s: relMSE %.3g", last.spp, last.seconds,
                  last.relmse);
    canvas.text(kRight, kTop - 22, text, 15, Canvas::Align::Right, kSoft);
}

} // namespace

std::string plot_font() {
    return Canvas::font();
}

void write_curve_plot(const std::vector<CurvePoint> &all, double confidence, const std::filesystem::path &path) {
    std::vector<CurvePoint> curve;
    std::copy_if(all.begin(), all.end(), std::back_inserter(curve),
                 [](const CurvePoint &point) { return point.seconds > 0 && point.relmse > 0; });
    Canvas canvas(kWidth, kHeight);
    canvas.text((kLeft + kRight) / 2, 22, "Error against run time", 19, Canvas::Align::Center, kText);
    if (curve.empty())
        canvas.text(kWidth / 2, kHeight / 2, "no estimate of the error: fewer than 2 samples, or a black picture", 17,
                    Canvas::Align::Center, kSoft);
    else
        draw_curve(canvas, curve, confidence);
    canvas.write(path);
}

} // namespace glimmer
