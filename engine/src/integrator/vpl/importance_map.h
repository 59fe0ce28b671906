// SPDX-License-Identifier: GPL-3.0-or-later
// The importance map that steers light subpaths (docs/method.md, section 6).
#pragma once

#include "scene/scene.h"

#include <vector>

namespace glimmer {

/// An estimate, up to a constant factor, of what light at a point can bring to the picture. It steers the weight window
/// and never changes the mean. With gather points q:
///     I(x) = (sum_q e^(-kappa |x - q|) / sqrt(|x - q|^2 + l^2))^(3/4).
/// The power below 1 keeps light from wandering in from far away, where few subpaths are wanted, as one heavy vertex
/// that a whole block sees.
class ImportanceMap {
  public:
    ImportanceMap(const Scene &scene, const std::vector<Vec3f> &gather_points);
    float operator()(const Vec3f &x) const;

  private:
    std::vector<float> x_, y_, z_; ///< of the points; repeated until they fill registers
    float kappa_ = 0, softening2_ = 1;
};

} // namespace glimmer
