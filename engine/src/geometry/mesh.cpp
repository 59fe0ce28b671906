// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

namespace glimmer {

namespace {

/// By vertex: the first of those at its place, of which meshes have several where normals or coordinates differ.
std::vector<uint32_t> first_at_place(const std::vector<Vec3f> &vertices) {
    const auto place = [&](uint32_t v) { return std::array{vertices[v].x, vertices[v].y, vertices[v].z}; };
    std::vector<uint32_t> sorted(vertices.size()), first(vertices.size());
    std::iota(sorted.begin(), sorted.end(), 0u);
    std::ranges::sort(sorted, {}, place);
    for (size_t i = 0; i < sorted.size(); ++i)
        first[sorted[i]] = i > 0 && place(sorted[i - 1]) == place(sorted[i]) ? first[sorted[i - 1]] : sorted[i];
    return first;
}

bool encloses_volume(const Mesh &mesh) {
    const std::vector<uint32_t> place = first_at_place(mesh.vertices);
    using Edge = std::pair<uint32_t, uint32_t>;
    std::vector<Edge> forth, back; // edges from a lower number to a higher, by the way that their triangles go
    double volume = 0;             // 6 times, signed
    for (const auto &t : mesh.triangles) {
        const std::array<uint32_t, 3> corners{place[t[0]], place[t[1]], place[t[2]]};
        for (size_t k = 0; k < 3; ++k) {
            const auto [low, high] = std::minmax(corners[k], corners[(k + 1) % 3]);
            if (low != high)
                (corners[k] == low ? forth : back).emplace_back(low, high);
        }
        volume += dot(Vec3d(mesh.vertices[t[0]]), cross(Vec3d(mesh.vertices[t[1]]), Vec3d(mesh.vertices[t[2]])));
    }
    std::ranges::sort(forth);
    std::ranges::sort(back);
    return volume > 0 && forth == back;
}

} // namespace

size_t Mesh::bytes() const {
    const std::lock_guard lock(mutex_);
    size_t of_attributes = 0;
    for (const MeshAttribute &a : attributes)
        of_attributes += a.values.size() * sizeof(float);
    return of_attributes + vertices.size() * sizeof(Vec3f) + normals.size() * sizeof(Vec3f) +
           uvs.size() * sizeof(Vec2f) + triangles.size() * sizeof(triangles[0]) + slots.size() * sizeof(uint16_t) +
           bvh_bytes_;
}

Bvh Mesh::bvh(const std::shared_ptr<const EmbreeDevice> &device) const {
    const std::lock_guard lock(mutex_);
    if (bvh_ && device_ == device)
        return bvh_;
    bvh_ = nullptr;
    const size_t before = device->bytes();
    const Bvh built = new_bvh(*device);
    RTCGeometry geometry = rtcNewGeometry(device->handle(), RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, vertices.data(), 0,
                               sizeof(Vec3f), vertices.size() - 1);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, triangles.data(), 0,
                               sizeof(triangles[0]), triangles.size());
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(built.get(), geometry, 0);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(built.get());
    device->check(("mesh \"" + name + "\"").c_str());
    // Of a build on another thread meanwhile a part is counted here: the sum over meshes stays about right.
    bvh_bytes_ = std::max(device->bytes(), before) - before;
    device_ = device;
    return bvh_ = built;
}

bool Mesh::is_closed() const {
    const std::lock_guard lock(mutex_);
    if (!closed_)
        closed_ = encloses_volume(*this);
    return *closed_;
}

} // namespace glimmer
