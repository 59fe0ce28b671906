// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/embree.h"

#include "base/error.h"

#include <mutex>
#include <string>

namespace glimmer {

/// That a device could not be made.
[[noreturn]] static void fail_device(RTCError error) {
    if (error == RTC_ERROR_UNSUPPORTED_CPU)
        throw Error(GLIMMER_UNAVAILABLE, "Embree does not support this processor");
    // Also of an unknown error: the scheduler's threads, which it cannot start then.
    if (error == RTC_ERROR_OUT_OF_MEMORY || error == RTC_ERROR_UNKNOWN)
        throw Error(GLIMMER_OUT_OF_MEMORY, "out of memory, or of threads, while starting Embree");
    throw Error(GLIMMER_INTERNAL, "Embree could not make a device: its error " + std::to_string(int(error)));
}

EmbreeDevice::EmbreeDevice(uint32_t threads) : threads_(threads) {
    const std::string config = threads ? "threads=" + std::to_string(threads) : "";
    device_ = rtcNewDevice(config.c_str());
    if (!device_)
        fail_device(rtcGetDeviceError(nullptr));
    const auto count = [](void *bytes, ssize_t change, bool) {
        *static_cast<std::atomic<ptrdiff_t> *>(bytes) += change;
        return true; // go on
    };
    rtcSetDeviceMemoryMonitorFunction(device_, count, &bytes_);
}

EmbreeDevice::~EmbreeDevice() {
    rtcReleaseDevice(device_);
}

void EmbreeDevice::check(const char *what) const {
    switch (rtcGetDeviceError(device_)) {
    case RTC_ERROR_NONE:
        return;
    case RTC_ERROR_OUT_OF_MEMORY:
        throw Error(GLIMMER_OUT_OF_MEMORY, std::string("out of memory while building ") + what);
    default:
        throw Error(GLIMMER_INTERNAL, std::string("Embree failed while building ") + what);
    }
}

Bvh new_bvh(const EmbreeDevice &device) {
    const RTCScene scene = rtcNewScene(device.handle());
    if (!scene)
        device.check("a scene");
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST); // without it rays slip through edges
    return {scene, [](RTCScene s) { rtcReleaseScene(s); }};
}

std::shared_ptr<const EmbreeDevice> embree_device(uint32_t threads) {
    static std::mutex mutex;
    // Never destroyed: at the end of the process Embree's own statics may be gone before ours.
    static auto &current = *new std::shared_ptr<const EmbreeDevice>;
    const std::lock_guard lock(mutex);
    if (!current || current->threads() != threads) {
        current.reset(); // first, so that a smaller number is not raised to the one before
        current = std::make_shared<const EmbreeDevice>(threads);
    }
    return current;
}

} // namespace glimmer
