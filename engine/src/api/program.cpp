// SPDX-License-Identifier: GPL-3.0-or-later
// Textures and shader programs.
#include "api/handles.h"
#include "shading/material_schema.h"
#include "shading/ops.h"

#include <string_view>

using namespace glimmer;

namespace {

void check_color_output(const SceneDescription &s, uint32_t program, uint32_t output, const std::string &what) {
    if (program >= s.programs.size())
        fail_argument(what + ": program " + std::to_string(program) + " was not added");
    const Program &p = *s.programs[program];
    if (output >= p.output_count() || p.is_number(output))
        fail_argument(what + ": output " + std::to_string(output) + " of program \"" + p.name +
                      "\" is none, or a number; allowed: a colour");
}

std::shared_ptr<const Texture> make_texture(const glimmer_texture_desc &d) {
    const std::string what = label_of("texture", d.name);
    check_range(d.width, 1, 65536, what + ": width");
    check_range(d.height, 1, 65536, what + ": height");
    check_range(d.channels, 1, 4, what + ": channels");
    if (d.format != GLIMMER_TEXEL_UINT8 && d.format != GLIMMER_TEXEL_FLOAT32)
        fail_argument(what + ": format is " + std::to_string(int(d.format)) + "; allowed: uint8 (0), float32 (1)");
    if (!d.pixels)
        fail_argument(what + ": pixels is null");
    auto texture = std::make_shared<Texture>();
    texture->width = d.width;
    texture->height = d.height;
    texture->channels = d.channels;
    texture->srgb = d.srgb != 0;
    const size_t count = size_t(d.width) * d.height * d.channels;
    if (d.format == GLIMMER_TEXEL_UINT8) {
        const auto *values = static_cast<const uint8_t *>(d.pixels);
        texture->bytes.assign(values, values + count);
        return texture;
    }
    const auto *values = static_cast<const float *>(d.pixels);
    for (size_t i = 0; i < count; ++i)
        if (!std::isfinite(values[i]))
            fail_argument(what + ": the pixel at x " + std::to_string(i / d.channels % d.width) + ", y " +
                          std::to_string(i / d.channels / d.width) + " is not finite");
    texture->floats.assign(values, values + count);
    return texture;
}

/// "aov_1" is 0; nothing where the key is not of an AOV.
std::optional<uint32_t> aov_of(const char *key) {
    for (uint32_t i = 0; key && i < GLIMMER_MAX_AOVS; ++i)
        if (key == "aov_" + std::to_string(i + 1))
            return i;
    return std::nullopt;
}

/// The row of a parameter of the material, or kNormal.
uint32_t find_row(const char *key, const MaterialDescription &material, bool is_number, const std::string &what) {
    const std::string_view wanted = key ? key : "";
    std::string known;
    const auto consider = [&](const char *name, bool number) {
        if (wanted == name) {
            if (number != is_number)
                fail_argument(what + ": " + name + " is a " + (number ? "number" : "colour or vector") +
                              ", the output is not");
            return true;
        }
        known += (known.empty() ? "" : ", ") + std::string(name);
        return false;
    };
    for (uint32_t i = 0; i < kParameters.size(); ++i) {
        const glimmer_parameter_info_t &info = kParameters[i].info;
        const bool of_a_body = material.type == MaterialType::glass && std::string_view(info.key) == "ior";
        if (kParameters[i].type == material.type && !of_a_body &&
            (info.kind == GLIMMER_NUMBER || info.kind == GLIMMER_COLOR) &&
            consider(info.key, info.kind == GLIMMER_NUMBER))
            return i;
    }
    const bool has_normal = material.type != MaterialType::light && material.type != MaterialType::null;
    if (has_normal && consider("normal", false))
        return ParameterBinding::kNormal;
    if (has_normal && consider("bumped_normal", false))
        return ParameterBinding::kBumpedNormal;
    if (has_normal && consider("bumped_normal_cubic", false))
        return ParameterBinding::kBumpedNormalCubic;
    std::string message = what + ": \"";
    message += wanted;
    message += "\" cannot vary; allowed: ";
    message += known.empty() ? "nothing" : known;
    fail_argument(message);
}

} // namespace

extern "C" {

void glimmer_texture_init(glimmer_texture_desc *desc) {
    if (!desc)
        return;
    *desc = {};
    desc->struct_size = sizeof *desc;
    desc->channels = 3;
}

glimmer_result glimmer_texture_create(const glimmer_texture_desc *desc, glimmer_texture **texture) {
    return guarded([&] {
        glimmer_texture_desc defaults;
        glimmer_texture_init(&defaults);
        const glimmer_texture_desc d = checked_desc(desc, defaults, "texture");
        if (!texture)
            fail_argument("texture: the output is null");
        auto handle = std::make_unique<glimmer_texture>();
        handle->texture = make_texture(d);
        *texture = handle.release();
    });
}

void glimmer_texture_destroy(glimmer_texture *texture) {
    destroy(texture);
}

const glimmer_op_info_t *glimmer_op_info(uint32_t index) {
    return index < kOps.size() ? &kOps[index] : nullptr;
}

void glimmer_program_init(glimmer_program_desc *desc) {
    if (!desc)
        return;
    *desc = {};
    desc->struct_size = sizeof *desc;
}

glimmer_result glimmer_scene_add_program(glimmer_scene *scene, const glimmer_program_desc *desc, uint32_t *program) {
    return guarded([&] {
        SceneDescription &s = open_scene(scene);
        glimmer_program_desc defaults;
        glimmer_program_init(&defaults);
        const glimmer_program_desc d = checked_desc(desc, defaults, "program");
        const std::string what = label_of("program", d.name);
        if (d.texture_count > Program::kMostResources)
            fail_argument(what + ": textures are " + std::to_string(d.texture_count) + "; allowed: up to " +
                          std::to_string(Program::kMostResources));
        if (d.texture_count && !d.textures)
            fail_argument(what + ": textures are null");
        std::vector<std::shared_ptr<const Texture>> textures;
        for (size_t i = 0; i < d.texture_count; ++i)
            textures.push_back(checked(d.textures[i], "texture").texture);
        if (!program)
            fail_argument(what + ": the output is null");
        s.programs.push_back(std::make_shared<Program>(d, std::move(textures)));
        *program = uint32_t(s.programs.size() - 1);
    });
}

glimmer_result glimmer_scene_bind(glimmer_scene *scene, uint32_t material, const char *key, uint32_t program,
                                  uint32_t output) {
    return guarded([&] {
        SceneDescription &s = open_scene(scene);
        if (material >= s.materials.size())
            fail_argument("bind: material " + std::to_string(material) + " was not added");
        MaterialDescription &m = s.materials[material];
        const std::string what = label_of("material", m.label.c_str());
        if (program >= s.programs.size())
            fail_argument(what + ": program " + std::to_string(program) + " was not added");
        if (output >= s.programs[program]->output_count())
            fail_argument(what + ": output " + std::to_string(output) + " of " +
                          std::to_string(s.programs[program]->output_count()) + " of its program");
        if (const auto aov = aov_of(key)) {
            for (const ParameterBinding &known : m.aovs)
                if (known.row == *aov)
                    fail_argument(what + ": " + key + " is bound twice");
            m.aovs.push_back({*aov, program, output});
            return;
        }
        const uint32_t row = find_row(key, m, s.programs[program]->is_number(output), what);
        for (const ParameterBinding &known : m.bindings)
            if (known.row == row)
                fail_argument(what + ": " + key + " is bound twice");
        m.bindings.push_back({row, program, output});
    });
}

glimmer_result glimmer_scene_bind_environment(glimmer_scene *scene, uint32_t program, uint32_t output) {
    return guarded([&] {
        SceneDescription &s = open_scene(scene);
        check_color_output(s, program, output, "environment");
        s.sky = ParameterBinding{ParameterBinding::kNormal, program, output};
    });
}

glimmer_result glimmer_scene_bind_light(glimmer_scene *scene, uint32_t light, uint32_t program, uint32_t output,
                                        const double to_world[16]) {
    return guarded([&] {
        SceneDescription &s = open_scene(scene);
        if (light >= s.lights.size())
            fail_argument("bind: light " + std::to_string(light) + " was not added");
        LightDescription &l = s.lights[light];
        const std::string what = label_of("light", l.label.c_str());
        check_color_output(s, program, output, what);
        if (!to_world)
            fail_argument(what + ": to_world is null");
        check_affine(to_world, what + ": to_world");
        if (const double size = affine_from_rows(to_world).linear.determinant(); !(std::abs(size) > 0))
            fail_argument(what + ": to_world has no inverse");
        l.profile = ParameterBinding{ParameterBinding::kNormal, program, output};
        l.profile_space = affine_from_rows(to_world);
    });
}

glimmer_result glimmer_scene_bind_sun(glimmer_scene *scene, const double direction[3], double angle) {
    return guarded([&] {
        SceneDescription &s = open_scene(scene);
        if (!s.sky)
            fail_argument("sun: the environment is bound to no program");
        if (!direction)
            fail_argument("sun: direction is null");
        const Vec3d travels(direction[0], direction[1], direction[2]);
        const double size = length(travels);
        if (!(size > 0) || !std::isfinite(size))
            fail_argument("sun: direction is 0 or not finite");
        if (!(angle > 0 && angle <= 180))
            fail_argument("sun: angle is " + std::to_string(angle) + "; allowed: above 0, up to 180");
        s.sky_sun = SkySunDescription{travels, angle};
    });
}
}
