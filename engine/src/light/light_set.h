// SPDX-License-Identifier: GPL-3.0-or-later
// All lights of a scene and the choice of one of them.
#pragma once

#include "light/light.h"

#include <vector>

namespace glimmer {

struct LightChoice {
    uint32_t index;
    float probability;
};

/// A triangle of MeshLight::triangles; kNone: none.
struct LightTriangle {
    uint32_t light = kNone, triangle = kNone;
};

class LightSet {
  public:
    /// Up to here choices are made by what each light could bring; beyond, by strength alone.
    static constexpr uint32_t kWeighedLights = 32;

    LightSet() = default;
    /// flags: of each light.
    /// varying: what profiles of lamps are asked of; null: there are none.
    LightSet(std::vector<Light> lights, std::vector<LightFlags> flags, const VaryingEmission *varying = nullptr);

    uint32_t size() const { return uint32_t(lights_.size()); }
    const Light &operator[](uint32_t i) const { return lights_[i]; }
    const LightBound &bound(uint32_t i) const { return bounds_[i]; }
    const LightFlags &flags(uint32_t i) const { return flags_[i]; }

    /// What a lamp's light is multiplied by where it leaves along wo. distance: to what it lights.
    Rgb profile(uint32_t light, const Vec3f &position, const Vec3f &wo, float distance) const {
        const uint32_t profile = flags_[light].profile;
        if (profile == kNone)
            return Rgb(1);
        return varying_->of_lamp(profile, {position, lamp_normal(lights_[light], position, wo), wo, distance});
    }

    /// By index, what an integrator must ask for besides surfaces: the see-through lamps that rays can meet, and the
    /// lights at infinity.
    const std::vector<uint32_t> &intersectable_lamps() const { return intersectable_lamps_; }
    const std::vector<uint32_t> &infinite() const { return infinite_; }
    /// Which light a sphere of the scene is; kNone if none.
    uint32_t of_sphere(uint32_t sphere) const { return sphere < of_sphere_.size() ? of_sphere_[sphere] : kNone; }
    /// Which light and which of its triangles a triangle of an emissive instance is; kNone where it has no area.
    LightTriangle of_triangle(uint32_t instance, uint32_t primitive) const {
        if (mesh_light_ == kNone)
            return {};
        const auto &mesh = std::get<MeshLight>(lights_[mesh_light_]);
        return {mesh_light_, mesh.triangle_of[mesh.first_of_instance[instance] + primitive]};
    }

    /// One light for a point: with probability 0.9 by strength / distance^2 * e^(-sigma distance), else any; so that no
    /// light has probability 0, however small its bound. sigma: the smallest extinction of the channels.
    LightChoice choose(const Vec3f &x, float sigma, float u) const;
    float probability(uint32_t light, const Vec3f &x, float sigma) const;
    /// One light for a segment of medium, by the angle that the segment spans as seen from the light.
    LightChoice choose(const Vec3f &origin, const Vec3f &direction, float t_max, float sigma, float u) const;
    float probability(uint32_t light, const Vec3f &origin, const Vec3f &direction, float t_max, float sigma) const;

    /// About the irradiance that a light could bring to x.
    float importance_at_point(uint32_t light, const Vec3f &x, float sigma) const;

  private:
    /// Notes whose surface in the BVH is which light.
    void claim_surfaces(const SphereLight &light, uint32_t index);
    void claim_surfaces(const MeshLight &light, uint32_t index);

    using Weights = std::array<float, kWeighedLights>;
    float importance_along_segment(uint32_t light, const Vec3f &origin, const Vec3f &direction, float t_max,
                                   float sigma) const;

    std::vector<Light> lights_;
    std::vector<LightBound> bounds_;
    std::vector<LightFlags> flags_;
    const VaryingEmission *varying_ = nullptr;
    std::vector<uint32_t> intersectable_lamps_, infinite_, of_sphere_;
    uint32_t mesh_light_ = kNone;
    AliasTable by_strength_;
};

} // namespace glimmer
