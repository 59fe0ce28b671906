// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene_file.h"

#include "parts.h"
#include "text.h"

namespace glimmer {

LoadedScene load_scene(const std::filesystem::path &path) {
    const std::string file = path.string();
    const Json json = parse_json(read_file(path, file), file);
    const Value root(json, file);
    SceneFolder folder(path);
    LoadedScene loaded;

    if (!json.is_object())
        root.refuse("a scene, which is an object {...}");
    root.at("glimmer").integer(1, 1); // before unknown keys: a later version may have more of them
    root.expect_object({"glimmer", "film", "camera", "textures", "programs", "materials", "meshes", "objects",
                        "spheres", "lights", "environment", "medium", "render"});
    glimmer_scene *handle = nullptr;
    check(glimmer_scene_create(&handle), file);
    loaded.scene.reset(handle);

    loaded.film = read_film(root.at("film"), handle);
    read_camera(root.at("camera"), handle);
    Textures textures;
    if (const auto value = root.find("textures"))
        textures = read_textures(*value, folder);
    Programs programs;
    if (const auto value = root.find("programs"))
        programs = read_programs(*value, textures, handle, folder);
    Materials materials;
    if (const auto value = root.find("materials"))
        materials = read_materials(*value, programs, handle);
    Meshes meshes;
    if (const auto value = root.find("meshes"))
        meshes = read_meshes(*value, folder);
    if (const auto value = root.find("objects"))
        value->for_each([&](const Value &object) { read_object(object, handle, programs, materials, meshes, folder); });
    if (const auto value = root.find("spheres"))
        value->for_each([&](const Value &spheres) { read_spheres(spheres, handle, programs, materials, folder); });
    if (const auto value = root.find("lights")) {
        uint32_t number = 0;
        value->for_each([&](const Value &light) { read_light(light, number++, programs, handle); });
    }
    if (const auto value = root.find("environment"))
        read_environment(*value, programs, handle, folder);
    if (const auto value = root.find("medium"))
        read_medium(*value, handle);
    if (const auto value = root.find("render"))
        loaded.limits = read_depth_limits(*value);

    for (const std::string &name : meshes.names)
        if (!meshes.entries.at(name).used)
            loaded.left_out.push_back("mesh " + in_quotes(name) + ": no object uses it");
    loaded.hash = folder.content_hash(json);
    return loaded;
}

} // namespace glimmer
