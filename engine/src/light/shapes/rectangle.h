// SPDX-License-Identifier: GPL-3.0-or-later
// Directions towards a rectangle, uniform in solid angle.
#pragma once

#include "light/shapes/direction_sample.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace glimmer {

/// Corner minus the point, and the two edges from it (perpendicular to each other, not zero).
struct RectangleShape {
    Vec3d corner, edge_x, edge_y;
};

/// The rectangle seen from a point: Urena, Fajardo and King 2013 ("An Area-Preserving Parametrization for Spherical
/// Rectangles"), in float64. Where it fills so little that the angles cancel (1e-7 sr, also seen edge-on) points are
/// uniform by area.
class SphericalRectangle {
  public:
    explicit SphericalRectangle(const RectangleShape &r) : shape_(r) {
        const double width = length(r.edge_x), height = length(r.edge_y);
        x_ = r.edge_x / width;
        y_ = r.edge_y / height;
        z_ = cross(x_, y_);
        area_ = width * height;
        x0_ = dot(r.corner, x_);
        y0_ = dot(r.corner, y_);
        z0_ = dot(r.corner, z_);
        if (z0_ > 0) {
            z_ = -z_;
            z0_ = -z0_;
        }
        x1_ = x0_ + width;
        y1_ = y0_ + height;
        // Normals of the planes through the point and each edge; the angles between them make the solid angle.
        const Vec3d n0{0, z0_, -y0_}, n1{-z0_, 0, x1_}, n2{0, -z0_, y1_}, n3{z0_, 0, -x0_};
        const double g2 = between(n2, n3), g3 = between(n3, n0);
        b0_ = n0.z / length(n0);
        b1_ = n2.z / length(n2);
        k_ = 2 * kPiDouble - g2 - g3;
        solid_angle_ = between(n0, n1) + between(n1, n2) - k_;
        by_area_ = !(solid_angle_ > 1e-7) || z0_ == 0;
    }

    std::optional<DirectionSample> sample(Vec2f u) const {
        const double ux = static_cast<double>(u.x), uy = static_cast<double>(u.y);
        if (by_area_)
            return direction_to_area_point(shape_.corner + shape_.edge_x * ux + shape_.edge_y * uy, z_, area_);
        // The column x whose left part has the fraction u.x of the solid angle, then y along it.
        const double a = ux * solid_angle_ + k_;
        const double f = (std::cos(a) * b0_ - b1_) / std::sin(a);
        const double c = std::clamp(std::copysign(1 / std::sqrt(f * f + b0_ * b0_), f), -1.0, 1.0);
        const double x = std::clamp(-(c * z0_) / std::sqrt(std::max(1e-300, (1 - c) * (1 + c))), x0_, x1_);
        const double d = std::sqrt(x * x + z0_ * z0_);
        const double h0 = y0_ / std::sqrt(d * d + y0_ * y0_), h1 = y1_ / std::sqrt(d * d + y1_ * y1_);
        const double h = h0 + uy * (h1 - h0);
        const double y = std::clamp(h * d / std::sqrt(std::max(1e-300, (1 - h) * (1 + h))), y0_, y1_);
        const Vec3d p = x_ * x + y_ * y + z_ * z0_;
        const double distance = length(p);
        return DirectionSample{Vec3f(p / distance), static_cast<float>(distance), static_cast<float>(1 / solid_angle_)};
    }

    float pdf(const Vec3f &wi) const {
        const std::optional<Vec3d> p = meet_plane(wi, shape_.corner, z_);
        if (!p)
            return 0;
        const double x = dot(*p, x_), y = dot(*p, y_);
        if (x < x0_ || x > x1_ || y < y0_ || y > y1_)
            return 0;
        if (!by_area_)
            return static_cast<float>(1 / solid_angle_);
        const double d2 = length_squared(*p);
        return static_cast<float>(pdf_area_to_solid_angle(d2, z0_ / std::sqrt(d2), area_));
    }

    double solid_angle() const { return solid_angle_; }

  private:
    /// The inner angle between two planes; acos of a dot product would lose half its digits near 0 and pi.
    static double between(const Vec3d &a, const Vec3d &b) { return std::atan2(length(cross(a, b)), -dot(a, b)); }

    RectangleShape shape_;
    Vec3d x_, y_, z_;
    double x0_, x1_, y0_, y1_, z0_, area_, b0_, b1_, k_, solid_angle_;
    bool by_area_;
};

inline std::optional<DirectionSample> sample_rectangle(const RectangleShape &r, Vec2f u) {
    return SphericalRectangle(r).sample(u);
}
inline float pdf_rectangle(const RectangleShape &r, const Vec3f &wi) {
    return SphericalRectangle(r).pdf(wi);
}

} // namespace glimmer
