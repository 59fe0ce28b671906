// SPDX-License-Identifier: GPL-3.0-or-later
// The parts of a scene file, one function and one source file each. All read what stands at a value, check it, and hand
// it to the engine's scene; they throw InputError with the place of what is wrong.
#pragma once

#include "handles.h"
#include "scene_file.h"
#include "scene_folder.h"
#include "value.h"

#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

namespace glimmer {

/// The materials by name; the engine numbers them in the order of the file, parts of a mix before the mix.
struct Materials {
    std::vector<std::string> names;
    std::unordered_map<std::string, uint32_t> indices;

    /// The material that a value names, or the error that lists them.
    uint32_t find(const Value &name) const;
};

struct Mesh {
    MeshHandle handle;
    size_t slot_count = 1; ///< 1 + the highest slot of its triangles
    bool used = false;
};

struct Meshes {
    std::vector<std::string> names;
    std::unordered_map<std::string, Mesh> entries;

    Mesh &find(const Value &name);
};

struct Textures {
    std::vector<std::string> names;
    std::unordered_map<std::string, TextureHandle> handles;

    glimmer_texture *find(const Value &name) const;
};

/// An output of a program, in place of a number, colour or vector.
struct Binding {
    uint32_t program, output;
};

struct Programs {
    std::vector<std::string> names;
    std::unordered_map<std::string, uint32_t> numbers;

    Binding read_binding(const Value &value) const;
};

/// Whether a value is {"program": ...}.
bool is_binding(const Value &value);

Film read_film(const Value &film, glimmer_scene *scene);
void read_camera(const Value &camera, glimmer_scene *scene);
Textures read_textures(const Value &textures, SceneFolder &folder);
Programs read_programs(const Value &programs, const Textures &textures, glimmer_scene *scene, SceneFolder &folder);
Materials read_materials(const Value &materials, const Programs &programs, glimmer_scene *scene);
Meshes read_meshes(const Value &meshes, SceneFolder &folder);
void read_object(const Value &object, glimmer_scene *scene, const Programs &programs, const Materials &materials,
                 Meshes &meshes, SceneFolder &folder);
void read_spheres(const Value &spheres, glimmer_scene *scene, const Programs &programs, const Materials &materials,
                  SceneFolder &folder);
void read_light(const Value &light, uint32_t number, const Programs &programs, glimmer_scene *scene);
void read_environment(const Value &environment, const Programs &programs, glimmer_scene *scene, SceneFolder &folder);
void read_medium(const Value &medium, glimmer_scene *scene);
/// What an object, or a group of spheres, is filled with, and what the description refers to.
struct Interior {
    glimmer_medium_desc desc;
    std::vector<glimmer_medium_binding> bindings;
};
std::optional<Interior> read_interior(const Value &owner, const Programs &programs);
DepthLimits read_depth_limits(const Value &render);

/// What stands at "motion", row by row and one matrix after another; empty where there is none.
std::vector<double> read_motion(const Value &value);

/// The number at "light_group"; 0, none, where there is none.
uint32_t read_light_group(const Value &owner);

/// A list of kinds of rays, as a set of glimmer_ray.
uint32_t read_rays(const Value &list);

/// What objects and spheres have in common: the index, what sees them, and what they are filled with. The description
/// refers to `interior`, which must outlive it.
template <class Description>
void read_body(const Value &value, const std::optional<Interior> &interior, Description &desc) {
    if (const auto index = value.find("index"))
        desc.object_index = static_cast<uint32_t>(index->integer(0, UINT32_MAX));
    if (const auto visible = value.find("visible"))
        desc.visible = read_rays(*visible);
    if (const auto holdout = value.find("holdout"))
        desc.holdout = holdout->boolean();
    if (const auto matte = value.find("matte"))
        desc.matte = static_cast<uint32_t>(matte->integer(0, 1 << 24));
    desc.light_group = read_light_group(value);
    if (interior)
        desc.interior = &interior->desc;
}

/// The matrix at a key, or the identity.
Matrix matrix_or_identity(const Value &value, std::string_view key);

} // namespace glimmer
