// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh.h"

#include <algorithm>

namespace glimmer {

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

} // namespace glimmer
