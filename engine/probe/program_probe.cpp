// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/error.h"
#include "probe.h"
#include "shading/program.h"

#include <cstring>
#include <memory>

using namespace glimmer;
using namespace glimmer::probe;

static thread_local std::string message;

/// Null, and a message, for a program that the check refuses.
PROBE Program *probe_program_create(const glimmer_program_desc *desc, const Texture *const *textures) {
    try {
        std::vector<std::shared_ptr<const Texture>> images;
        for (size_t i = 0; i < desc->texture_count; ++i)
            images.push_back(std::make_shared<Texture>(*textures[i]));
        return new Program(*desc, std::move(images));
    } catch (const Error &error) {
        message = error.what();
        return nullptr;
    }
}
PROBE const char *probe_program_message() {
    return message.c_str();
}
PROBE void probe_program_destroy(Program *program) {
    delete program;
}

PROBE Texture *probe_texture_create(uint32_t width, uint32_t height, uint32_t channels, int srgb, int as_floats,
                                    const void *pixels) {
    auto texture = std::make_unique<Texture>();
    texture->width = width;
    texture->height = height;
    texture->channels = channels;
    texture->srgb = srgb != 0;
    const size_t count = size_t(width) * height * channels;
    if (as_floats)
        texture->floats.assign(static_cast<const float *>(pixels), static_cast<const float *>(pixels) + count);
    else
        texture->bytes.assign(static_cast<const uint8_t *>(pixels), static_cast<const uint8_t *>(pixels) + count);
    return texture.release();
}
PROBE void probe_texture_destroy(Texture *texture) {
    delete texture;
}

/// At n places of an object that stands in the world as it is: positions, normals, incoming, attribute [n, 3]; every
/// attribute of the program is the one array. out [n, outputs, 3].
PROBE void probe_program_evaluate(const Program *program, const float *positions, const float *normals,
                                  const float *incoming, const float *attribute, uint64_t n, float *out) {
    const ObjectFrame object;
    const std::array<uint32_t, 3> corners{0, 0, 0};
    std::vector<Vec3f> outputs(program->output_count());
    for (uint64_t i = 0; i < n; ++i) {
        const std::vector<AttributeView> views(program->attribute_names().size(),
                                               {attribute + 3 * i, 3, AttributeDomain::vertex});
        ShaderGlobals g;
        g.position = g.object_position = load3(positions + 3 * i);
        g.normal = g.true_normal = load3(normals + 3 * i);
        g.incoming = load3(incoming + 3 * i);
        g.vertices = &corners;
        g.attributes = views;
        g.object = &object;
        program->evaluate(g, outputs.data());
        for (size_t o = 0; o < outputs.size(); ++o)
            store(out + 3 * (i * outputs.size() + o), outputs[o]);
    }
}

/// Row i of the table of ops; null beyond its end.
PROBE const glimmer_op_info_t *probe_op_info(uint32_t i) {
    return i < kOps.size() ? &kOps[i] : nullptr;
}
