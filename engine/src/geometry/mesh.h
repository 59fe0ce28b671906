// SPDX-License-Identifier: GPL-3.0-or-later
// A triangle mesh about its own centre, shared by any number of instances and scenes, with the BVH that rays need.
#pragma once

#include "geometry/embree.h"
#include "glimmer.h"
#include "math/affine.h"
#include "math/vec.h"

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace glimmer {

/// Values that shader programs ask for by name.
struct MeshAttribute {
    std::string name;
    glimmer_attribute_domain domain = GLIMMER_PER_CORNER;
    uint8_t components = 3;
    std::vector<float> values;
};

class Mesh {
  public:
    Mesh() = default;
    Mesh(const Mesh &) = delete;
    Mesh &operator=(const Mesh &) = delete;

    std::string name;
    Vec3d center;                ///< float64 centre of the bounds: `vertices` are relative to it
    std::vector<Vec3f> vertices; ///< one more than there are: Embree reads 16 bytes at the last
    std::vector<Vec3f> normals;  ///< empty: flat
    std::vector<Vec2f> uvs;      ///< empty: none
    std::vector<std::array<uint32_t, 3>> triangles;
    std::vector<uint16_t> slots; ///< empty: all 0
    std::vector<MeshAttribute> attributes;
    float radius = 0; ///< largest |coordinate| of a vertex, about the centre
    uint16_t slot_count = 1;

    uint16_t slot(uint32_t triangle) const { return slots.empty() ? uint16_t(0) : slots[triangle]; }
    /// Its arrays and, once built, its BVH.
    size_t bytes() const;

    /// The Embree scene of this mesh, built at the first call for a device and kept until one for another. Throws
    /// Error.
    Bvh bvh(const std::shared_ptr<const EmbreeDevice> &device) const;

    /// Whether it has an inside: every edge has as many triangles on either side, and the normals point outward. Found
    /// out at the first call.
    bool is_closed() const;

  private:
    mutable std::mutex mutex_; ///< of everything below
    mutable std::optional<bool> closed_;
    mutable std::shared_ptr<const EmbreeDevice> device_;
    mutable Bvh bvh_;
    mutable size_t bvh_bytes_ = 0;
};

} // namespace glimmer
