// SPDX-License-Identifier: GPL-3.0-or-later
#include "api/calls.h"

#include <array>

namespace glimmer {

void create_mesh(Input &in, Handles &handles) {
    glimmer_mesh_desc desc;
    glimmer_mesh_init(&desc);
    std::array<double, 3 * kMostElements> doubles{}, normals{};
    std::array<float, 3 * kMostElements> floats{};
    std::array<uint32_t, 3 * kMostElements> triangles{};
    std::array<uint16_t, kMostElements> slots{};
    in.fill(doubles.data(), doubles.size());
    in.fill(floats.data(), floats.size());
    desc.name = in.name();
    desc.format = in.ConsumeIntegralInRange<int>(0, 15) ? GLIMMER_FLOAT64 : in.choice<glimmer_format>(1);
    desc.vertex_count = in.ConsumeIntegralInRange<size_t>(0, kMostElements);
    desc.vertices = doubles.data();
    desc.triangle_count = in.ConsumeIntegralInRange<size_t>(0, kMostElements);
    for (uint32_t &vertex : triangles)
        vertex = in.ConsumeIntegralInRange<uint32_t>(0, static_cast<uint32_t>(kMostElements));
    desc.triangles = triangles.data();
    if (in.ConsumeBool()) {
        in.fill(normals.data(), normals.size());
        desc.normals = normals.data();
    }
    if (in.ConsumeBool())
        desc.uvs = doubles.data();
    if (in.ConsumeBool()) {
        for (uint16_t &slot : slots)
            slot = in.ConsumeBool() ? in.ConsumeIntegralInRange<uint16_t>(0, 2) : uint16_t(0xffff);
        desc.slots = slots.data();
    }
    if (desc.format == GLIMMER_FLOAT32)
        desc.vertices = floats.data(), desc.normals = nullptr, desc.uvs = nullptr;
    // Counts that no array has are refused before anyone reads one.
    constexpr std::array<size_t, 3> absurd{size_t(0xffffffff), size_t(1) << 62, SIZE_MAX};
    if (in.ConsumeIntegralInRange<int>(0, 15) == 0)
        (in.ConsumeBool() ? desc.vertex_count : desc.triangle_count) = in.PickValueInArray(absurd);
    in.spoil_size(desc);
    glimmer_mesh *mesh = nullptr;
    handles.keep(glimmer_mesh_create(&desc, &mesh), mesh, handles.meshes);
}

void create_image(Input &in, Handles &handles) {
    std::array<float, 4 * 4 * 4> pixels{};
    for (float &value : pixels)
        value = in.ConsumeBool() ? in.single() : 0.5f;
    glimmer_image *image = nullptr;
    uint32_t width = in.ConsumeIntegralInRange<uint32_t>(0, 4), height = in.ConsumeIntegralInRange<uint32_t>(0, 4);
    if (in.ConsumeIntegralInRange<int>(0, 15) == 0)
        width = 65537, height = in.integer();
    handles.keep(glimmer_image_create(width, height, in.ConsumeIntegralInRange<uint32_t>(2, 5),
                                      in.ConsumeIntegralInRange<int>(0, 15) ? pixels.data() : nullptr, &image),
                 image, handles.images);
}

} // namespace glimmer
