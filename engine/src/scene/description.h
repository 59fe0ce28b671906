// SPDX-License-Identifier: GPL-3.0-or-later
// What a caller has added to a scene, checked but not yet built: plain data in float64, world coordinates.
#pragma once

#include "geometry/mesh.h"
#include "geometry/ray.h"
#include "glimmer.h"
#include "math/affine.h"
#include "shading/material_description.h"
#include "shading/medium_programs.h"
#include "shading/program.h"

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace glimmer {

struct Image {
    uint32_t width = 0, height = 0;
    std::vector<Rgb> pixels; ///< top row first
};

struct MediumDescription {
    Vec3d sigma_a, sigma_s;
    double g = 0;
    Vec3d emission;
    std::vector<MediumBinding> bindings; ///< what programs give in place of these
};

/// Of the medium that fills all space: what it is at a height, and by how much of it it thins out by e.
struct FalloffDescription {
    double height = 0, scale_height = 1;
};

struct ObjectDescription {
    std::string name;
    std::shared_ptr<const Mesh> mesh;
    std::vector<uint32_t> materials; ///< one a slot
    std::vector<Affine> instances;
    std::vector<uint32_t> object_indices; ///< one an instance, or one for all
    Rgb color{1};
    float opacity = 1;
    std::vector<float> randoms; ///< one an instance, or one for all
    /// The instances at moments evenly spaced from when the shutter opens to when it closes; none: they are still.
    std::vector<std::vector<Affine>> motion;
    bool moves() const { return !motion.empty(); }
    RayMask visible = kEveryRay;
    bool holdout = false;
    float shadow_terminator = 0;
    std::vector<MeshAttribute> attributes; ///< a row an instance
    std::optional<MediumDescription> interior;
    uint32_t matte = 0;
    uint8_t light_group = 0; ///< 0: none
};

struct SpheresDescription {
    std::string name;
    std::vector<Vec3d> centers;
    std::vector<double> radii; ///< one each, or one for all
    uint32_t material = 0;
    uint32_t object_index = 0;
    RayMask visible = kEveryRay;
    bool holdout = false;
    std::optional<MediumDescription> interior;
    uint32_t matte = 0;
    uint8_t light_group = 0;
};

struct EnvironmentDescription {
    Rgb color;
    std::shared_ptr<const Image> image;
    Linear to_world;
};

/// The sun of a sky that a program gives.
struct SkySunDescription {
    Vec3d travels;    ///< the light's direction
    double angle = 0; ///< full, in degrees
};

/// A plain value once its strings have been copied out.
struct LightDescription : glimmer_light_desc {
    std::string label;
    std::optional<ParameterBinding> profile;
    Affine profile_space; ///< the program's object space, to the world
};

struct SceneDescription {
    std::vector<std::shared_ptr<Program>> programs;
    std::vector<MaterialDescription> materials;
    std::vector<ObjectDescription> objects;
    std::vector<SpheresDescription> spheres;
    std::vector<LightDescription> lights;
    std::optional<EnvironmentDescription> environment;
    std::optional<ParameterBinding> sky; ///< the program that gives the environment's radiance
    RayMask environment_visible = kEveryRay;
    uint8_t environment_light_group = 0;
    std::optional<SkySunDescription> sky_sun;
    std::optional<MediumDescription> medium;
    std::optional<FalloffDescription> medium_falloff;
    std::optional<glimmer_camera_desc> camera;
    std::vector<Affine> camera_motion; ///< at moments evenly spaced over the shutter, in place of to_world
    std::optional<glimmer_film_desc> film;
};

} // namespace glimmer
