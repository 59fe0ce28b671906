// SPDX-License-Identifier: GPL-3.0-or-later
// The handles that a sequence of calls has made, and what every call is held to.
#pragma once

#include "api/input.h"
#include "fuzz.h"
#include "glimmer.h"

#include <algorithm>
#include <string>
#include <vector>

namespace glimmer {

/// A result code that there is, and with a bad one a message.
inline glimmer_result expect(glimmer_result result) {
    require(result >= GLIMMER_OK && result <= GLIMMER_UNAVAILABLE,
            result == GLIMMER_INTERNAL ? std::string("a defect: ") + glimmer_last_error() : "an unknown result");
    if (result != GLIMMER_OK)
        expect_one_line(glimmer_last_error());
    return result;
}

/// Those that are good, to draw from; destroys what is left.
class Handles {
  public:
    explicit Handles(Input &in) : in_(in) {}
    Handles(const Handles &) = delete;
    Handles &operator=(const Handles &) = delete;
    ~Handles() {
        for (auto *render : renders)
            glimmer_render_destroy(render);
        for (auto *scene : scenes)
            glimmer_scene_destroy(scene);
        for (auto *mesh : meshes)
            glimmer_mesh_destroy(mesh);
        for (auto *image : images)
            glimmer_image_destroy(image);
    }

    /// A good one, or now and then null or one of another kind.
    template <class Handle>
    Handle *any(const std::vector<Handle *> &good) {
        if (!good.empty() && in_.ConsumeIntegralInRange<int>(0, 15) != 0)
            return good[in_.ConsumeIntegralInRange<size_t>(0, good.size() - 1)];
        void *foreign = nullptr;
        switch (in_.ConsumeIntegralInRange<int>(0, 4)) {
        case 0:
            foreign = meshes.empty() ? nullptr : meshes.back();
            break;
        case 1:
            foreign = images.empty() ? nullptr : images.back();
            break;
        case 2:
            foreign = scenes.empty() ? nullptr : scenes.back();
            break;
        case 3:
            foreign = renders.empty() ? nullptr : renders.back();
            break;
        default:
            break;
        }
        return static_cast<Handle *>(foreign);
    }
    /// Destroys what `any` gives.
    template <class Handle>
    void destroy(std::vector<Handle *> &good, void (*destroy_one)(Handle *)) {
        Handle *handle = any(good);
        const auto found = std::find(good.begin(), good.end(), handle);
        destroy_one(handle); // a foreign one stays as it is
        if (found != good.end())
            good.erase(found);
    }
    /// What a call that makes handles has given back.
    template <class Handle>
    void keep(glimmer_result result, Handle *handle, std::vector<Handle *> &good) {
        require((expect(result) == GLIMMER_OK) == (handle != nullptr),
                "a handle of a failed call, or none of a good one");
        if (handle)
            good.push_back(handle);
    }

    std::vector<glimmer_mesh *> meshes;
    std::vector<glimmer_image *> images;
    std::vector<glimmer_scene *> scenes;
    std::vector<glimmer_render *> renders;

  private:
    Input &in_;
};

} // namespace glimmer
