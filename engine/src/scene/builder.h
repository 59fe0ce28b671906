// SPDX-License-Identifier: GPL-3.0-or-later
// From a description to a scene, step by step, each in a file of its own. Throws Error with the place of what is wrong.
#pragma once

#include "scene/description.h"
#include "scene/scene.h"

#include <set>

namespace glimmer {

/// The lights, and what is asked of each.
struct LightList {
    std::vector<Light> lights;
    std::vector<LightFlags> flags;

    void add(Light light, const LightFlags &asked) {
        lights.push_back(std::move(light));
        flags.push_back(asked);
    }
};

class SceneBuilder {
  public:
    /// threads: the most that build (0: all).
    SceneBuilder(const SceneDescription &description, Scene &scene, uint32_t threads);

    void build_camera_and_film(); // sets the origin: everything after it is relative to the camera
    void build_materials();
    void build_geometry();
    void build_media();   // after the geometry, which says what encloses them
    void build_shaders(); // materials that vary; before the lights, which look at their emission
    void find_sheets();   // after the materials that vary, some of which may be glass
    void build_lights();
    void build_bounds();
    void list_left_out();

  private:
    ShaderScene *shaders() const; ///< null: nothing varies
    bool shines_varying(uint32_t material) const;
    Rgb mean_for_choice(uint32_t instance, uint32_t triangle, int side) const;
    void add_profiles(ShaderScene &shaders) const;
    void add_attributes_of_instances(ShaderScene &shaders, const AttributeNumbers &names) const;
    void add_sky(LightList &lights);
    void add_sun_of_sky(LightList &lights);
    void add_profile(uint32_t light, LightFlags &flags);
    /// interior: the index of the body that the material bounds, 0 for none.
    MaterialBounds bounds_of_varying(uint32_t material, float &interior) const;
    void use(uint32_t material);
    bool material_may_shine(uint32_t material) const; ///< or a part of it
    void note_flags(const LightFlags &flags, RayMask usual);
    void note_visibility(RayMask visible, bool holdout);
    /// The i-th instance of an object, with its motion, which is added to `motions`. Nothing where it would be too flat
    /// for a ray to be carried there. mesh: the object's, or a part of it.
    std::optional<Instance> place(const ObjectDescription &object, size_t i, const Mesh &mesh,
                                  std::vector<InstanceMotion> &motions);
    bool is_sheet(const ObjectDescription &object, const Mesh &mesh) const;
    bool may_shine_anywhere(const ObjectDescription &object) const;
    /// Notes that the object's instances, or the spheres, enclose a medium.
    void add_boundaries(const ObjectDescription &object);
    void add_boundaries(const SpheresDescription &group);
    uint32_t add_interior(const MediumDescription &medium);
    std::shared_ptr<const VaryingBodies> build_varying_bodies(const std::shared_ptr<const Boundaries> &boundaries,
                                                              const std::vector<uint32_t> &bodies);
    MediumBody medium_body(uint32_t body, const Boundaries &boundaries, const AttributeNumbers &names) const;
    std::unique_ptr<const MajorantGrid> majorants(const MediumPrograms &programs, uint32_t medium, uint32_t body,
                                                  uint32_t cells) const;
    HomogeneousMedium mean_coefficients(const MediumPrograms &programs, const std::vector<uint32_t> &bodies,
                                        uint32_t medium) const;
    HeightHaze height_haze() const;
    CameraFrame camera_frame() const;
    std::shared_ptr<const Mesh> without_absent(const ObjectDescription &object) const;
    void add_sphere_lights(LightList &lights) const;
    void add_mesh_light(LightList &lights) const;
    void add_lamps(LightList &lights);
    void add_environment(LightList &lights);

    const SceneDescription &description_;
    Scene &scene_;
    uint32_t threads_;
    Vec3d origin_;
    /// By instance: where its description stands.
    struct ObjectPlace {
        size_t object, instance;
    };
    std::vector<ObjectPlace> object_places_;
    /// What encloses media: the surfaces, and by surface the number of its medium.
    std::vector<Instance> boundary_instances_;
    std::vector<InstanceMotion> boundary_motions_;
    std::vector<Sphere> boundary_spheres_;
    std::vector<uint32_t> instance_media_, sphere_media_;
    std::vector<ObjectPlace> boundary_places_; ///< by instance
    std::vector<InteriorMedium> media_;
    std::vector<MediumSources> medium_sources_;         ///< by medium
    std::set<std::shared_ptr<const Texture>> textures_; ///< that programs look up
    std::vector<bool> used_;                            ///< materials that something is made of
    size_t black_lights_ = 0, absent_objects_ = 0;
};

} // namespace glimmer
