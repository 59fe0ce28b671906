// SPDX-License-Identifier: GPL-3.0-or-later
// Distances along a segment of medium, in proportion to the light that one lamp would scatter there if nothing stood in
// its way.
#pragma once

#include "light/equiangular_nodes_simd.h"
#include "math/vec.h"
#include "medium/medium.h"

#include <array>
#include <optional>

namespace glimmer {

struct DistanceSample {
    float t;   ///< along the segment
    float pdf; ///< per length
};

/// A piecewise linear density over 16 nodes that are nearly uniform in the equiangular angle about the light (Kulla and
/// Fajardo 2012), with values from the light's unoccluded single-scattering source and the transmittance both ways;
/// beyond 9 mean free paths past the nearest way an exponential tail. Positive wherever the source is. Built anew for
/// every segment and light.
///
/// The variable is x = tan(angle / 2): s = h 2x / (1 - x^2) for the distance s from the foot of the light on the line.
/// It follows the angle within a factor of 2 and needs neither tan nor atan; in float64, so that a segment far from the
/// light keeps its digits.
class EquiangularTable {
  public:
    /// The segment starts at `origin` (unit direction), and ends at t_max (may be infinite). The light is bounded by a
    /// sphere.
    EquiangularTable(const Medium &medium, const Vec3f &origin, const Vec3f &direction, float t_max,
                     const Vec3f &center, float radius);

    DistanceSample sample(float u) const;
    float pdf(float t) const;

  private:
    static constexpr int kNodes = int(kTableNodes);
    double t_foot_, h_;                    // of the light on the line; softened distance to it
    double x_first_, x_step_, per_step_;   // nodes in x; 1 / x_step_
    std::array<float, kNodes> density_;    // per x, up to the common factor
    std::array<float, kNodes> cumulative_; // integral up to each node
    float total_ = 0;                      // with the tail
    float t_cut_ = 0, t_end_ = 0;          // the tail runs from t_cut to t_end
    float tail_ = 0, tail_rate_ = 0;       // mass; decay per length
};

} // namespace glimmer
