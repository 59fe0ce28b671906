// SPDX-License-Identifier: GPL-3.0-or-later
// Stands in for Embree's builders of high quality and of dynamic scenes, which the engine never asks for and which take
// as long to compile as half of the rest. Whoever asks for them gets an error of Embree's, not a crash.
#include "kernels/common/builder.h"
#include "kernels/common/isa.h"
#include "kernels/common/scene.h"

namespace embree::isa {

[[noreturn]] static Builder *not_built() {
    throw_RTCError(RTC_ERROR_UNSUPPORTED_CPU, "this builder was left out (engine/embree/CMakeLists.txt)");
}

#define NOT_BUILT(name, ...)                                                                                           \
    Builder *name(void *, Scene *, __VA_ARGS__) {                                                                      \
        return not_built();                                                                                            \
    }
NOT_BUILT(BVH4Triangle4SceneBuilderFastSpatialSAH, size_t)
NOT_BUILT(BVH4Triangle4vSceneBuilderFastSpatialSAH, size_t)
NOT_BUILT(BVH4Triangle4iSceneBuilderFastSpatialSAH, size_t)
NOT_BUILT(BVH8Triangle4SceneBuilderFastSpatialSAH, size_t)
NOT_BUILT(BVH8Triangle4vSceneBuilderFastSpatialSAH, size_t)
NOT_BUILT(BVH4BuilderTwoLevelTriangle4MeshSAH, bool)
NOT_BUILT(BVH4BuilderTwoLevelTriangle4vMeshSAH, bool)
NOT_BUILT(BVH4BuilderTwoLevelTriangle4iMeshSAH, bool)
NOT_BUILT(BVH4BuilderTwoLevelVirtualSAH, bool)
NOT_BUILT(BVH4BuilderTwoLevelInstanceSAH, Geometry::GTypeMask, bool)
NOT_BUILT(BVH8BuilderTwoLevelTriangle4MeshSAH, bool)
NOT_BUILT(BVH8BuilderTwoLevelTriangle4vMeshSAH, bool)
NOT_BUILT(BVH8BuilderTwoLevelTriangle4iMeshSAH, bool)
NOT_BUILT(BVH8BuilderTwoLevelVirtualSAH, bool)
NOT_BUILT(BVH8BuilderTwoLevelInstanceSAH, Geometry::GTypeMask, bool)
#undef NOT_BUILT

} // namespace embree::isa
