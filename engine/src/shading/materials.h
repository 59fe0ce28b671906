// SPDX-License-Identifier: GPL-3.0-or-later
// The seam between a surface that a ray met and the light that it sends back: all materials of a scene, and how a point
// of one is shaded.
#pragma once

#include "bsdf/bsdf.h"
#include "shading/closure_arena.h"
#include "shading/material.h"
#include "shading/shading_point.h"

#include <vector>

namespace glimmer {

/// A point of a material.
struct Shading {
    Bsdf bsdf; ///< stands in the scene or in the arena that it was shaded into
    Rgb emission;
    Rgb transparency;       ///< the part of light that goes straight through, as if there were no surface
    float interior_ior = 0; ///< of the body that the surface bounds; 0: none
};

/// What depth, normals and indices show is the surface behind it.
inline bool is_mostly_seen_through(const Shading &shading) {
    return max_component(shading.transparency) > 0.5f;
}

class Materials {
  public:
    /// lobes: of a material that does not vary, their probabilities set.
    void add(Material material, std::span<const WeightedLobe> lobes);

    size_t size() const { return materials_.size(); }
    const Material &operator[](uint32_t material) const { return materials_[material]; }
    const MaterialBounds &bounds(uint32_t material) const { return materials_[material].bounds; }
    size_t bytes() const { return lobes_.size() * sizeof(WeightedLobe); }

    /// What the surface is made of as it is seen from view.wo. A material that does not vary gives the lobes that stand
    /// in the scene and leaves the arena alone; another one writes its own into it, and may turn the shading normal.
    Shading shade(Interaction &surface, const View &view, ClosureArena &arena) const {
        static_cast<void>(view), static_cast<void>(arena);
        const Material &m = materials_[surface.material];
        return {Bsdf(lobes_.data() + m.lobe_begin, m.lobe_count), m.emission, m.transparency, m.interior_ior};
    }

  private:
    std::vector<Material> materials_;
    std::vector<WeightedLobe> lobes_; ///< of all materials that do not vary
};

} // namespace glimmer
