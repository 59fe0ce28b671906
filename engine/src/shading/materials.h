// SPDX-License-Identifier: GPL-3.0-or-later
// The seam between a surface that a ray met and the light that it sends back: all materials of a scene, and how a point
// of one is shaded.
#pragma once

#include "bsdf/bsdf.h"
#include "shading/closure_arena.h"
#include "shading/material.h"
#include "shading/shader_scene.h"
#include "shading/shading_point.h"

#include <memory>
#include <vector>

namespace glimmer {

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
        const Material &m = materials_[surface.material];
        if (m.varying != Material::kConstant) [[unlikely]]
            return shaders->shade(m.varying, surface, view, arena);
        return {Bsdf(lobes_.data() + m.lobe_begin, m.lobe_count), m.emission, m.transparency, m.interior_ior,
                m.holdout};
    }

    /// Known to all that ask for shading; null: nothing varies.
    std::shared_ptr<ShaderScene> shaders;
    /// From now on programs give something of the material. bounds: for all that they may give.
    void set_varying(uint32_t material, uint32_t varying, const MaterialBounds &bounds, float interior_ior);
    /// The mean emission of a material that varies, as plans see it.
    void set_mean_emission(uint32_t material, const Rgb &emission) { materials_[material].bounds.emission = emission; }

  private:
    std::vector<Material> materials_;
    std::vector<WeightedLobe> lobes_; ///< of all materials that do not vary
};

} // namespace glimmer
