// SPDX-License-Identifier: GPL-3.0-or-later
// Embree, linked into the engine's libraries and hidden there: Blender carries its own libembree, and a library that
// met that one would crash or silently find no hits.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <embree3/rtcore.h>
#include <memory>
#include <type_traits>

namespace glimmer {

/// What BVHs are built with, and what counts their memory. BVHs of one device alone can be joined in a scene.
class EmbreeDevice {
  public:
    /// threads: the most that build (0: all). Throws Error(GLIMMER_UNAVAILABLE) on a processor that Embree was not
    /// built for.
    explicit EmbreeDevice(uint32_t threads);
    ~EmbreeDevice();
    EmbreeDevice(const EmbreeDevice &) = delete;
    EmbreeDevice &operator=(const EmbreeDevice &) = delete;

    RTCDevice handle() const { return device_; }
    uint32_t threads() const { return threads_; }
    /// That the scenes of this device hold now.
    size_t bytes() const { return size_t(std::max<ptrdiff_t>(bytes_, 0)); }
    /// Throws Error when Embree reported a fault on this thread since the last check; `what` says what was being built.
    void check(const char *what) const;

  private:
    RTCDevice device_ = nullptr;
    uint32_t threads_;
    mutable std::atomic<ptrdiff_t> bytes_{0};
};

/// A scene of Embree's; shared, for Embree frees it when nobody uses it.
using Bvh = std::shared_ptr<std::remove_pointer_t<RTCScene>>;
Bvh new_bvh(const EmbreeDevice &device);

/// The device for so many threads: one for all scenes, until a commit asks for another number. Embree gives each as
/// many as the largest that still has scenes.
std::shared_ptr<const EmbreeDevice> embree_device(uint32_t threads);

} // namespace glimmer
