// SPDX-License-Identifier: GPL-3.0-or-later
// Embree, reached only through this table of function pointers. Blender carries its own libembree and libtbb; a library
// linked the usual way binds to those and crashes or silently finds no hits, so ours is opened privately (RTLD_LOCAL |
// RTLD_DEEPBIND).
#pragma once

#include <embree3/rtcore.h>

namespace glimmer {

#define GLIMMER_EMBREE_FUNCTIONS(X)                                                                                    \
    X(rtcNewDevice)                                                                                                    \
    X(rtcGetDeviceError)                                                                                               \
    X(rtcGetDeviceProperty)                                                                                            \
    X(rtcNewScene)                                                                                                     \
    X(rtcReleaseScene)                                                                                                 \
    X(rtcSetSceneFlags)                                                                                                \
    X(rtcCommitScene)                                                                                                  \
    X(rtcNewGeometry)                                                                                                  \
    X(rtcReleaseGeometry)                                                                                              \
    X(rtcCommitGeometry)                                                                                               \
    X(rtcAttachGeometryByID)                                                                                           \
    X(rtcSetSharedGeometryBuffer)                                                                                      \
    X(rtcSetGeometryInstancedScene)                                                                                    \
    X(rtcSetGeometryTransform)                                                                                         \
    X(rtcSetGeometryUserPrimitiveCount)                                                                                \
    X(rtcSetGeometryUserData)                                                                                          \
    X(rtcSetGeometryBoundsFunction)                                                                                    \
    X(rtcSetGeometryIntersectFunction)                                                                                 \
    X(rtcSetGeometryOccludedFunction)                                                                                  \
    X(rtcIntersect1)                                                                                                   \
    X(rtcOccluded1)

struct Embree {
#define GLIMMER_DECLARE(name) decltype(&::name) name;
    GLIMMER_EMBREE_FUNCTIONS(GLIMMER_DECLARE)
#undef GLIMMER_DECLARE
    RTCDevice device;

    /// Throws Error when Embree reported a fault since the last check; `what` says what was being built.
    void check(const char *what) const;
};

/// The table and its device, opened at the first call and kept until the process ends (its worker threads may outlive
/// any scene). Throws Error(GLIMMER_UNAVAILABLE) when Embree is missing or of another version than the headers.
const Embree &embree();

} // namespace glimmer
