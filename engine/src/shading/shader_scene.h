// SPDX-License-Identifier: GPL-3.0-or-later
// Everything of a scene that shader programs look at, and the materials that they are for.
#pragma once

#include "film/sample.h"
#include "geometry/accel.h"
#include "light/varying_emission.h"
#include "shading/closure_arena.h"
#include "shading/material_tree.h"
#include "shading/program.h"
#include "shading/shading.h"
#include "shading/shading_point.h"

#include <map>
#include <memory>
#include <optional>

namespace glimmer {

/// A material of which programs give something.
struct VaryingMaterial {
    uint32_t root = 0;                 ///< of ShaderScene::nodes
    std::vector<uint32_t> programs;    ///< that it needs
    std::vector<uint32_t> first_value; ///< by program: where its outputs stand among those of all `programs`
    uint32_t value_count = 0;
    std::optional<ParameterBinding> normal;
    bool shines = false; ///< somewhere, for all that is known
};

/// Whether a node of a material shines by itself, for all that is known of its programs.
bool may_shine(const MaterialDescription &node, std::span<const ParameterBinding> bindings);

/// Sets an object's space by the linear part of its matrix to the world.
void set_axes(ObjectFrame &frame, const Linear &to_world);
/// `rest`: what has no place.
ObjectFrame frame_of(const Instance &instance, const Vec3d &origin, ObjectFrame rest = {});
/// The scene's number of every name of an attribute that programs ask for.
using AttributeNumbers = std::map<std::string, uint32_t>;
/// Numbers the names, by which programs look them up from now on.
AttributeNumbers number_attributes(std::span<const std::shared_ptr<Program>> programs);
std::vector<AttributeView> views_of(std::span<const MeshAttribute> attributes, const AttributeNumbers &names);

/// What a lamp's light is multiplied by, and the space that its program knows as the object's.
struct LampProfile {
    ParameterBinding output;
    ObjectFrame frame;
};

class ShaderScene : public VaryingEmission {
  public:
    std::vector<MaterialDescription> nodes;              ///< without their bindings
    std::vector<std::vector<ParameterBinding>> bindings; ///< by node
    std::vector<std::shared_ptr<const Program>> programs;
    std::vector<VaryingMaterial> materials;
    std::vector<uint32_t> varying_of; ///< by material of the scene: of `materials`; kNone: it does not vary
    Vec3d origin;
    const Accel *geometry = nullptr;
    CameraFrame camera;
    float pixel_width = 0;                                ///< of a pixel at depth 1, or anywhere
    std::vector<ObjectFrame> frames;                      ///< by instance
    std::vector<std::vector<AttributeView>> attributes;   ///< by object, by number of a name
    std::vector<uint32_t> instance_numbers;               ///< by instance: which of its object's it is
    std::vector<std::vector<MeshAttribute>> of_instances; ///< by object: what its instances have
    std::vector<std::vector<uint32_t>> object_materials;  ///< by object: the material of each slot
    std::vector<uint32_t> sphere_materials;               ///< by sphere
    std::vector<std::vector<ParameterBinding>> aovs;      ///< by material, see MaterialDescription; empty: none has any
    std::optional<ParameterBinding> sky;                  ///< the radiance of the environment
    std::vector<LampProfile> lamps;                       ///< by light of the description

    /// Prepares a material of the scene that varies. Throws Error where it has too many parts.
    void add(uint32_t material);

    /// The closures of a place, written into the arena; the shading normal may turn. `emission`: what it sends to
    /// view.wo.
    [[gnu::noinline]] Shading shade(uint32_t varying, Interaction &surface, const View &view,
                                    ClosureArena &arena) const;

    /// Adds what the material gives to the AOV passes at a place. Only where `aovs` is not empty.
    void write_aovs(uint32_t material, const Interaction &surface, const View &view, std::span<AovValue> out) const;

    Rgb of_triangle(uint32_t instance, uint32_t primitive, Vec2f uv, const Vec3f &wo) const override;
    Rgb of_sphere(uint32_t sphere, const Vec3f &normal, const Vec3f &wo) const override;
    Rgb of_sky(const Vec3f &direction, uint8_t ray, bool sun_disc) const override;
    Rgb of_lamp(uint32_t profile, const LampPlace &place) const override;

    /// The mean radiance of a triangle or sphere over a few places, seen along its normal: it guides choices alone.
    /// side: places along an edge of the triangle.
    Rgb mean_of_triangle(uint32_t instance, uint32_t primitive, int side) const;
    Rgb mean_of_sphere(uint32_t sphere) const;
    /// About the mean of a lamp's profile, at a distance of 1.
    float mean_of_lamp(uint32_t profile) const;

  private:
    struct Place {
        ShaderGlobals globals;
        ObjectFrame own; ///< of what is no instance that keeps still
    };
    float pixel_at(const Vec3f &from_camera) const;
    void set_place(Place &place, const Interaction &surface, const View &view) const;
    /// What the programs of a material give at a place.
    std::span<const Vec3f> evaluate(const VaryingMaterial &material, const Interaction &surface,
                                    const View &view) const;
    /// Light that an output gives: what is no number or negative is dark.
    Rgb light_of(const ParameterBinding &output, const ShaderGlobals &globals) const;
    Rgb emission(uint32_t varying, const Interaction &surface, const View &view) const;
    Interaction on_triangle(uint32_t instance, uint32_t primitive, Vec2f uv) const;
};

} // namespace glimmer
