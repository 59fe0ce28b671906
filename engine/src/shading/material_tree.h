// SPDX-License-Identifier: GPL-3.0-or-later
// Mixes of materials, flattened into weighted lobes: once where nothing varies, at every shading point else.
#pragma once

#include "bsdf/bsdf.h"
#include "shading/material_description.h"

#include <span>
#include <vector>

namespace glimmer {

/// The sum of a tree's leaves.
struct FlatMaterial {
    std::vector<WeightedLobe> lobes; ///< their probabilities are not set
    Rgb emission;
    Rgb transparency;  ///< what goes straight through
    float holdout = 0; ///< see Shading
};

/// The index of the body that a surface with these lobes bounds; 0: it bounds none.
float interior_ior(std::span<const WeightedLobe> lobes);

/// What programs give of materials at a shading point: of program p, output o is values[first[p] + o].
struct ProgramOutputs {
    std::span<const Vec3f> values;
    std::span<const uint32_t> first;
    std::span<const std::vector<ParameterBinding>> bindings; ///< by material

    const Vec3f &operator()(const ParameterBinding &b) const { return values[first[b.program] + b.output]; }
};

/// nodes: of all materials; mixes and sums name others of them. outputs: null where nothing varies. What `out` held
/// before is forgotten, and its room is used.
void flatten(std::span<const MaterialDescription> nodes, uint32_t index, const ProgramOutputs *outputs,
             FlatMaterial &out);

/// Whether the material is made of others.
inline bool has_parts(const MaterialDescription &m) {
    return m.type == MaterialType::mix || m.type == MaterialType::add || m.type == MaterialType::layer;
}

/// Whether the material or one of its parts is another one at each place: a program gives something of it, or it has a
/// tangent.
bool varies(std::span<const MaterialDescription> nodes, uint32_t index);

} // namespace glimmer
