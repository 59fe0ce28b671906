// SPDX-License-Identifier: GPL-3.0-or-later
// Light leaving its source: where light paths start.
#pragma once

#include "light/light.h"

namespace glimmer {

/// A ray that carries `power` away from a light, in the sense that the mean over samples of power, spread along the
/// rays, is the light's own. t_max: how far it is that light's (the inside of a see-through ball).
struct Emission {
    Ray ray;
    Rgb power;
};

/// For finite lights; nothing for the sun and the environment. `inwards`: the light is a sphere around all that is to
/// be seen.
std::optional<Emission> sample_emission(const Light &light, bool inwards, Vec2f u_position, Vec2f u_direction,
                                        float u_choice);

} // namespace glimmer
