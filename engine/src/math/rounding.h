// SPDX-License-Identifier: GPL-3.0-or-later
// Bounds on what float32 loses, u = 2^-24 being one rounding. Rays start and end that far from the surfaces they must
// not meet.
#pragma once

namespace glimmer {

/// Relative error of a hit: of its position against the terms it is made of, or of its distance along a unit direction,
/// by this engine's arithmetic or Embree's. Derived: eight roundings in a row, 8 u.
inline constexpr float kHitRounding = 0x1p-21f;

/// Relative error of a point that was sampled on a surface, against the largest coordinate that went into it. Derived:
/// 16 u, more than the sample's own arithmetic and one transform take.
inline constexpr float kSampledPointRounding = 0x1p-20f;

} // namespace glimmer
