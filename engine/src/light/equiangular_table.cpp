// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/equiangular_table.h"

#include <cmath>

namespace glimmer {

namespace {

constexpr double kReach = 9; // optical depth past the shortest way at which the table ends and the tail begins

} // namespace

EquiangularTable::EquiangularTable(const Medium &medium, const Vec3f &origin, const Vec3f &direction, float t_max,
                                   const Vec3f &center, float radius) {
    const Vec3d to_center = Vec3d(center) - Vec3d(origin);
    const Vec3d along(direction);
    t_foot_ = dot(to_center, along);
    const double h2 = length_squared(cross(to_center, along));
    const double distance = length(to_center), r = double(radius);
    // Softened by the light's size; never zero, so that a ray through a point light keeps a density.
    h_ = std::sqrt(h2 + 0.25 * r * r + 1e-12 * distance * distance + 1e-30);

    // The path by way of t is at least t - a + |x(t) - c|, which is shortest at t = 0 and grows by at most 2 t.
    // The channel that goes on longest decides, of those that scatter at all.
    const float least = medium.least_scattering_extinction();
    const double sigma_tail = least < kInfinity ? double(least) : 0;
    double cut = std::isfinite(t_max) ? double(t_max) : kInfinity;
    if (sigma_tail > 0) {
        // t + |c - o - t d| = distance + reach has one root t >= 0 (an ellipse about origin and centre).
        const double length_cut = distance + kReach / sigma_tail;
        const double root = (length_cut * length_cut - distance * distance) / (2 * (length_cut - t_foot_));
        cut = std::min(cut, root);
    }
    t_cut_ = float(cut);
    t_end_ = t_max;

    const auto to_x = [&](double t) {
        const double s = t - t_foot_;
        return s / (h_ + std::sqrt(h_ * h_ + s * s));
    };
    x_first_ = to_x(0);
    x_step_ = (to_x(double(t_cut_)) - x_first_) / (kNodes - 1);

    const TableShape shape{t_foot_, h_, h2, r, distance, cut, x_first_, x_step_};
    const float last = equiangular_nodes(medium.simd_view(), shape, density_.data());
    per_step_ = 1 / x_step_;
    std::array<float, kNodes> area;
    for (size_t i = 1; i < kNodes; ++i)
        area[i] = (density_[i - 1] + density_[i]) * float(0.5 * x_step_);
    cumulative_[0] = 0;
    for (size_t i = 1; i < kNodes; ++i)
        cumulative_[i] = cumulative_[i - 1] + area[i];
    total_ = cumulative_[kNodes - 1];
    if (t_end_ > t_cut_ && sigma_tail > 0) {
        tail_rate_ = float(sigma_tail);
        tail_ = std::max(last, 1e-30f) / (tail_rate_ * float(h_)) * -std::expm1(-tail_rate_ * (t_end_ - t_cut_));
        total_ += tail_;
    }
}

DistanceSample EquiangularTable::sample(float u) const {
    const float target = u * total_;
    if (target >= cumulative_[kNodes - 1] && tail_ > 0) {
        const float v = std::min((target - cumulative_[kNodes - 1]) / tail_, 1 - 0x1p-24f);
        const float range = -std::expm1(-tail_rate_ * (t_end_ - t_cut_));
        const float t = std::min(t_cut_ - std::log1p(-v * range) / tail_rate_, t_end_);
        return {t, pdf(t)};
    }
    size_t i = 0;
    for (size_t k = 1; k < kNodes - 1; ++k)
        i += target >= cumulative_[k] ? 1 : 0;
    // Invert the quadratic a f + (b - a) f^2 / 2 = m in the stable form.
    const float a = density_[i], b = density_[i + 1];
    const float m = std::max(target - cumulative_[i], 0.0f) * float(per_step_);
    const float f = std::clamp(2 * m / (a + std::sqrt(std::max(a * a + 2 * (b - a) * m, 0.0f))), 0.0f, 1.0f);
    const double x = x_first_ + x_step_ * (double(i) + double(f));
    const double one_minus_x2 = (1 - x) * (1 + x);
    const float t = std::clamp(float(t_foot_ + h_ * 2 * x / one_minus_x2), 0.0f, t_cut_);
    return {t, pdf(t)};
}

float EquiangularTable::pdf(float t) const {
    if (t > t_cut_) {
        const float range = -std::expm1(-tail_rate_ * (t_end_ - t_cut_));
        return tail_ / total_ * tail_rate_ * std::exp(-tail_rate_ * (t - t_cut_)) / range;
    }
    const double s = double(t) - t_foot_, d2 = h_ * h_ + s * s;
    const double x = s / (h_ + std::sqrt(d2));
    const double position = std::clamp((x - x_first_) * per_step_, 0.0, double(kNodes - 1));
    const size_t i = std::min(size_t(position), size_t(kNodes - 2));
    const float f = float(position - double(i));
    const double dx_ds = (1 + x * x) * h_ / (2 * d2);
    return (density_[i] + (density_[i + 1] - density_[i]) * f) * float(dx_ds) / total_;
}

} // namespace glimmer
