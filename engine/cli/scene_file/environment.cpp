// SPDX-License-Identifier: GPL-3.0-or-later
#include "image_file.h"
#include "parts.h"
#include "text.h"

namespace glimmer {

namespace {

void read_sky(const Value &value, const Value &radiance, const Programs &programs, glimmer_scene *scene) {
    const Binding sky = programs.read_binding(radiance);
    check(glimmer_scene_bind_environment(scene, sky.program, sky.output), radiance.where());
    const auto sun = value.find("sun");
    if (!sun)
        return;
    sun->expect_object({"direction", "angle"});
    const Double3 direction = sun->at("direction").direction();
    const double angle = sun->at("angle").number({.low = 0, .high = 180, .open_low = true});
    check(glimmer_scene_bind_sun(scene, direction.data(), angle), sun->where());
}

} // namespace

void read_environment(const Value &value, const Programs &programs, glimmer_scene *scene, SceneFolder &folder) {
    value.expect_object({"radiance", "image", "strength", "to_world", "sun", "visible", "light_group"});
    check(glimmer_scene_set_environment_light_group(scene, read_light_group(value)), value.where());
    if (const auto visible = value.find("visible"))
        check(glimmer_scene_set_environment_visible(scene, read_rays(*visible)), visible->where());
    if (value.has("radiance") == value.has("image"))
        value.fail("needs either radiance or image");
    if (value.has("radiance")) {
        for (const char *key : {"strength", "to_world"})
            if (const auto extra = value.find(key))
                extra->fail("is for an image; a constant radiance has none");
        if (is_binding(value.at("radiance")))
            return read_sky(value, value.at("radiance"), programs, scene);
        if (const auto sun = value.find("sun"))
            sun->fail("is for a radiance that a program gives");
        const Float3 radiance = value.at("radiance").color(kNonNegative);
        check(glimmer_scene_set_environment(scene, radiance.data(), nullptr,
                                            matrix_or_identity(value, "to_world").data()),
              value.where());
        return;
    }
    if (const auto sun = value.find("sun"))
        sun->fail("is for a radiance that a program gives");
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
