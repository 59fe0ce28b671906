// SPDX-License-Identifier: GPL-3.0-or-later
// How long Russian roulette spares a path: until its throughput has fallen to one part in so many. To end it early
// saves little, since the camera's ray, its medium and its direct light are paid for already; and of those that would
// have come to something bright the few that are left are the brighter.
#pragma once

namespace glimmer {

/// At surfaces, and where the medium between them is joined to the light vertices. Variance at equal cost, of roulette
/// from the start: .90 on glimmervoid and .87 without its medium, .74 for smooth metal in medium, .92 for metals and
/// glass under a sky, .45 and .43 in diffuse rooms of albedo .8 and .3. With 2 or 4 it is about the same; with 16 next
/// to nothing is left of the gain on metal.
inline constexpr float kRouletteScaleAtSurfaces = 3;

/// Where the medium that the camera sees is joined to the light vertices, and along the short rays that start there:
/// .59 for moons in medium, .90 in thick medium, .82 on a rough field. With 4 or 16 about the same.
inline constexpr float kRouletteScaleAtGathers = 8;

/// Paths that walk through medium by themselves are not spared: in thick medium of albedo .99 they would be a hundred
/// scatterings longer, for 1.15 of the variance at equal cost with 2 and 1.6 with 8. (In thin medium 2 would give .7.)
inline constexpr float kRouletteScaleInMedium = 1;

} // namespace glimmer
