// SPDX-License-Identifier: GPL-3.0-or-later
#include "plot/error_curve_plot.h"

#include "film/error.h"
#include "plot/log_axis.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>

namespace glimmer {
namespace {

using Align = Canvas::Align;
using Points = std::vector<glimmer_curve_point>;

constexpr int kWide = 600;            ///< pixels from which on there is room for a title and a legend
constexpr double kTextHeight = 15;    ///< pixels that a line of text takes
constexpr double kLineWidth = 2.2;    ///< of the curve, in pixels
constexpr double kDiscRadius = 3.6;   ///< of its points
constexpr double kGuideWidth = 1.3;   ///< of the guide
constexpr double kLeastValue = 1e-30; ///< values beyond this and its inverse are drawn there

/// The colours of a style and those between them.
struct Inks {
    explicit Inks(const PlotStyle &style)
        : text(style.text), soft(mix(style.background, style.text, 0.7f)),
          grid(mix(style.background, style.text, 0.12f)), frame(mix(style.background, style.text, 0.5f)),
          line(style.line), band(mix(style.background, style.line, 0.3f)), guide(style.guide) {}

    static Rgb mix(const Rgb &a, const Rgb &b, float t) { return a * (1 - t) + b * t; }

    Rgb text, soft, grid, frame, line, band, guide;
};

std::string format(const char *pattern, double value) {
    char text[32];
    std::snprintf(text, sizeof text, pattern, value);
    return text;
}

std::string tick_text(double value) {
    return format(value >= 0.9999e-3 && value < 0.9999e5 ? "%.6g" : "%.0e", value);
}

/// The points that logarithms can show, and of them what lies within the least and the largest value.
Points plottable(ErrorCurvePoints points) {
    const auto shown = [](double value) { return std::clamp(value, kLeastValue, 1 / kLeastValue); };
    Points out;
    for (glimmer_curve_point p : points)
        if (std::isfinite(p.seconds) && p.seconds > 0 && std::isfinite(p.relmse) && p.relmse > 0) {
            p.seconds = shown(p.seconds);
            p.relmse = shown(p.relmse);
            if (std::isfinite(p.relmse_low) && std::isfinite(p.relmse_high)) {
                p.relmse_low = shown(p.relmse_low);
                p.relmse_high = shown(p.relmse_high);
            }
            out.push_back(p);
        }
    return out;
}

bool has_interval(const glimmer_curve_point &p) {
    return std::isfinite(p.relmse_low) && std::isfinite(p.relmse_high);
}

class Plot {
  public:
    Plot(const Points &points, int width, int height, const PlotStyle &style)
        : points_(points), inks_(style), canvas_(width, height, style.background) {}

    Canvas draw() {
        const bool wide = canvas_.width() >= kWide;
        if (wide)
            canvas_.text(canvas_.width() / 2.0, 22, "Error against run time", Align::center, inks_.text);
        if (points_.empty()) {
            canvas_.text(canvas_.width() / 2.0, canvas_.height() / 2.0,
                         wide ? "no estimate of the error: fewer than 2 samples, or a black picture"
                              : "no estimate of the error",
                         Align::center, inks_.soft);
            return std::move(canvas_);
        }
        fit_axes(wide);
        draw_band();
        draw_axes();
        draw_guide();
        draw_curve();
        if (wide) {
            draw_legend();
            draw_last_point();
        }
        return std::move(canvas_);
    }

  private:
    void fit_axes(bool wide) {
        double x_low = points_[0].seconds, x_high = x_low, least = points_[0].relmse, most = least;
        for (const glimmer_curve_point &p : points_) {
            x_low = std::min(x_low, p.seconds);
            x_high = std::max(x_high, p.seconds);
            least = std::min(least, p.relmse);
            most = std::max(most, p.relmse);
        }
        // An interval that reaches far beyond the curve, or down to nothing, may leave the picture.
        double y_low = least, y_high = most;
        for (const glimmer_curve_point &p : points_)
            if (has_interval(p)) {
                y_low = std::min(y_low, p.relmse_low > least / 100 ? p.relmse_low : least);
                y_high = std::max(y_high, std::min(p.relmse_high, most * 100));
            }
        const double top = wide ? 70 : 2.4 * kTextHeight, bottom = canvas_.height() - (wide ? 70 : 3.6 * kTextHeight);
        y_ = LogAxis::around(y_low, y_high, bottom, top);
        int labels = 0;
        for (const double value : y_.ticks(kTickHeight))
            labels = std::max(labels, Canvas::text_width(tick_text(value)));
        x_ = LogAxis::around(x_low, x_high, labels + (wide ? 40 : 18), canvas_.width() - (wide ? 30 : 14));
    }

    /// Between low and high of neighbouring points, straight in the logarithms as the curve is.
    void draw_band() {
        for (size_t i = 0; i + 1 < points_.size(); ++i) {
            const glimmer_curve_point &a = points_[i], &b = points_[i + 1];
            if (!has_interval(a) || !has_interval(b))
                continue;
            const auto height = [&](double value) { return y_(std::clamp(value, y_.low, y_.high)); };
            const double x0 = x_(a.seconds), x1 = x_(b.seconds);
            for (int column = int(std::ceil(x0)); column < x1; ++column) {
                const double t = (column - x0) / (x1 - x0);
                canvas_.column(column, std::lerp(height(a.relmse_high), height(b.relmse_high), t),
                               std::lerp(height(a.relmse_low), height(b.relmse_low), t), inks_.band);
            }
        }
    }

    void draw_axes() {
        const double left = x_.begin, right = x_.end, bottom = y_.begin, top = y_.end;
        for (const double value : x_.ticks(kTickWidth)) {
            canvas_.line(x_(value), top, x_(value), bottom, 1, inks_.grid);
            canvas_.line(x_(value), bottom, x_(value), bottom + 5, 1, inks_.frame);
            canvas_.text(x_(value), bottom + 16, tick_text(value), Align::center, inks_.text);
        }
        for (const double value : y_.ticks(kTickHeight)) {
            canvas_.line(left, y_(value), right, y_(value), 1, inks_.grid);
            canvas_.line(left - 5, y_(value), left, y_(value), 1, inks_.frame);
            canvas_.text(left - 10, y_(value), tick_text(value), Align::right, inks_.text);
        }
        canvas_.line(left, bottom, right, bottom, 1.2, inks_.frame);
        canvas_.line(left, top, left, bottom, 1.2, inks_.frame);
        canvas_.text((left + right) / 2, canvas_.height() - 14, "render time in seconds", Align::center, inks_.text);
        canvas_.text(std::max(left - 40, 8.0), top - 20, "relMSE", Align::left, inks_.text);
    }

    void draw_guide() {
        constexpr int dash = 9, gap = 7;
        const glimmer_curve_point &last = points_.back();
        const auto height = [&](double x) { return y_(last.relmse * (last.seconds / x_.value_at(x))); };
        for (double x = x_.begin; x + dash < x_.end; x += dash + gap)
            if (height(x) >= y_.end && height(x + dash) <= y_.begin)
                canvas_.line(x, height(x), x + dash, height(x + dash), kGuideWidth, inks_.guide);
    }

    void draw_curve() {
        for (size_t i = 0; i + 1 < points_.size(); ++i)
            canvas_.line(x_(points_[i].seconds), y_(points_[i].relmse), x_(points_[i + 1].seconds),
                         y_(points_[i + 1].relmse), kLineWidth, inks_.line);
        for (const glimmer_curve_point &p : points_)
            canvas_.disc(x_(p.seconds), y_(p.relmse), kDiscRadius, inks_.line);
    }

    void draw_legend() {
        const double x = x_.end - 190, text = x + 40;
        double y = y_.end + 22;
        canvas_.line(x, y, x + 30, y, kLineWidth, inks_.line);
        canvas_.disc(x + 15, y, kDiscRadius, inks_.line);
        canvas_.text(text, y, "error of the picture", Align::left, inks_.text);
        y += 25;
        for (int column = int(x); column < int(x + 30); ++column)
            canvas_.column(column, y - 7, y + 7, inks_.band);
        canvas_.text(text, y, format("%g", 100 * kErrorConfidence) + " % interval", Align::left, inks_.text);
        y += 25;
        canvas_.line(x, y, x + 12, y, kGuideWidth, inks_.guide);
        canvas_.line(x + 18, y, x + 30, y, kGuideWidth, inks_.guide);
        canvas_.text(text, y, "falling as 1 / time", Align::left, inks_.text);
    }

    void draw_last_point() {
        const glimmer_curve_point &last = points_.back();
        canvas_.text(x_.end, y_.end - 20,
                     format("%.0f samples a pixel in ", last.samples) + format("%.3g s: relMSE ", last.seconds) +
                         format("%.3g", last.relmse),
                     Align::right, inks_.soft);
    }

    static constexpr double kTickHeight = 1.6 * kTextHeight, kTickWidth = 4 * kTextHeight;

    const Points &points_;
    const Inks inks_;
    Canvas canvas_;
    LogAxis x_{}, y_{};
};

} // namespace

Canvas plot_error_curve(ErrorCurvePoints points, int width, int height, const PlotStyle &style) {
    const Points shown = plottable(points);
    return Plot(shown, width, height, style).draw();
}

} // namespace glimmer
