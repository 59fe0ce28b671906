// SPDX-License-Identifier: GPL-3.0-or-later
// From a description to a scene, step by step, each in a file of its own. Throws Error with the place of what is wrong.
#pragma once

#include "scene/description.h"
#include "scene/scene.h"

namespace glimmer {

class SceneBuilder {
  public:
    /// threads: the most that build (0: all).
    SceneBuilder(const SceneDescription &description, Scene &scene, uint32_t threads);

    void build_camera_and_film(); // sets the origin: everything after it is relative to the camera
    void build_materials();
    void build_medium();
    void build_geometry();
    void build_lights();
    void build_bounds();
    void list_left_out();

  private:
    void flatten(uint32_t material, float weight, std::vector<WeightedLobe> &lobes, Material &out) const;
    void use(uint32_t material);
    std::shared_ptr<const Mesh> without_absent(const ObjectDescription &object) const;
    void add_sphere_lights(std::vector<Light> &lights) const;
    void add_mesh_light(std::vector<Light> &lights) const;
    void add_lamps(std::vector<Light> &lights);
    void add_environment(std::vector<Light> &lights);

    const SceneDescription &description_;
    Scene &scene_;
    uint32_t threads_;
    Vec3d origin_;
    std::vector<bool> used_; ///< materials that something is made of
    size_t black_lights_ = 0, absent_objects_ = 0;
};

} // namespace glimmer
