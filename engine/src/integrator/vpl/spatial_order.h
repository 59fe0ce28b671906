// SPDX-License-Identifier: GPL-3.0-or-later
// Light vertices in the order of a space-filling curve (docs/method.md, section 7): neighbours in the list are
// neighbours in space, so that a systematic draw from it is stratified.
#pragma once

#include "integrator/vpl/light_vertices.h"

namespace glimmer {

/// Sorts the vertices in the medium and those on surfaces along a Morton curve each.
void sort_in_space(LightVertices &vertices);

} // namespace glimmer
