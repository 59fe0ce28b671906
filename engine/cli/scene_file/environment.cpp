// SPDX-License-Identifier: GPL-3.0-or-later
#include "image_file.h"
#include "parts.h"
#include "text.h"

namespace glimmer {

void read_environment(const Value &value, glimmer_scene *scene, SceneFolder &folder) {
    value.expect_object({"radiance", "image", "strength", "to_world", "visible"});
    if (const auto visible = value.find("visible"))
        check(glimmer_scene_set_environment_visible(scene, read_rays(*visible)), visible->where());
    if (value.has("radiance") == value.has("image"))
        value.fail("needs either radiance or image");
    if (value.has("radiance")) {
        for (const char *key : {"strength", "to_world"})
            if (const auto extra = value.find(key))
                extra->fail("is for an image; a constant radiance has none");
        const Float3 radiance = value.at("radiance").color(kNonNegative);
        check(glimmer_scene_set_environment(scene, radiance.data(), nullptr,
                                            matrix_or_identity(value, "to_world").data()),
              value.where());
        return;
    }
    const Value image_value = value.at("image");
    const auto file = folder.read(image_value);
    const auto data = read_image(file.path, image_value.where() + ": " + in_quotes(file.name));
    glimmer_image *handle = nullptr;
    check(glimmer_image_create(data.width, data.height, 3, data.rgb.data(), &handle), image_value.where());
    const ImageHandle image(handle);
    const Float3 strength = value.has("strength") ? value.at("strength").color(kNonNegative) : Float3{1, 1, 1};
    check(glimmer_scene_set_environment(scene, strength.data(), image.get(),
                                        matrix_or_identity(value, "to_world").data()),
          value.where());
}

} // namespace glimmer
