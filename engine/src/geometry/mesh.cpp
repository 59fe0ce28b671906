// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh.h"

namespace glimmer {

Mesh::~Mesh() {
    if (bvh_)
        embree().rtcReleaseScene(bvh_);
}

size_t Mesh::bytes() const {
    return vertices.size() * sizeof(Vec3f) + normals.size() * sizeof(Vec3f) + uvs.size() * sizeof(Vec2f) +
           triangles.size() * sizeof(triangles[0]) + slots.size() * sizeof(uint16_t);
}

RTCScene Mesh::bvh() const {
    std::call_once(built_, [this] {
        const Embree &e = embree();
        RTCScene scene = e.rtcNewScene(e.device);
        e.rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST); // without it rays slip through edges
        RTCGeometry geometry = e.rtcNewGeometry(e.device, RTC_GEOMETRY_TYPE_TRIANGLE);
        e.rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, vertices.data(), 0,
                                     sizeof(Vec3f), vertices.size() - 1);
        e.rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, triangles.data(), 0,
                                     sizeof(triangles[0]), triangles.size());
        e.rtcCommitGeometry(geometry);
        e.rtcAttachGeometryByID(scene, geometry, 0);
        e.rtcReleaseGeometry(geometry);
        e.rtcCommitScene(scene);
        bvh_ = scene;
        e.check(("mesh \"" + name + "\"").c_str());
    });
    return bvh_;
}

} // namespace glimmer
