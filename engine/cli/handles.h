// SPDX-License-Identifier: GPL-3.0-or-later
// The engine's objects as values that free themselves, and its results as exceptions.
#pragma once

#include "errors.h"
#include "glimmer.h"

#include <memory>
#include <string>

namespace glimmer {

template <auto destroy>
struct Destroy {
    template <class T>
    void operator()(T *object) const {
        destroy(object);
    }
};
using MeshHandle = std::unique_ptr<glimmer_mesh, Destroy<glimmer_mesh_destroy>>;
using TextureHandle = std::unique_ptr<glimmer_texture, Destroy<glimmer_texture_destroy>>;
using ImageHandle = std::unique_ptr<glimmer_image, Destroy<glimmer_image_destroy>>;
using SceneHandle = std::unique_ptr<glimmer_scene, Destroy<glimmer_scene_destroy>>;
using RenderHandle = std::unique_ptr<glimmer_render, Destroy<glimmer_render_destroy>>;

/// Throws what the engine says of a failed call, after `where` ("scene.json: objects[2]"): what it refuses is the
/// input's fault, all else is ours.
inline void check(glimmer_result result, const std::string &where) {
    if (result == GLIMMER_OK)
        return;
    std::string what = glimmer_last_error();
    // The engine names the part of the scene that `where` ends with: once is enough.
    const size_t mark = where.rfind(": ");
    const std::string part = (mark == std::string::npos ? where : where.substr(mark + 2)) + ": ";
    if (what.starts_with(part))
        what.erase(0, part.size());
    const std::string message = where + ": " + what;
    if (result == GLIMMER_INVALID_ARGUMENT)
        throw InputError(message);
    throw ResultError(message);
}

} // namespace glimmer
