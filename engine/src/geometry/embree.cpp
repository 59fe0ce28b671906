// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/embree.h"

#include "api/error.h"

#include <dlfcn.h>

namespace glimmer {

namespace {

constexpr const char *kLibrary = "libembree3.so.3";

Embree open_embree() {
#if defined(GLIMMER_SANITIZED)
    constexpr int flags = RTLD_NOW | RTLD_LOCAL; // sanitizers intercept symbols, which DEEPBIND forbids
#else
    constexpr int flags = RTLD_NOW | RTLD_LOCAL | RTLD_DEEPBIND;
#endif
    void *library = dlopen(kLibrary, flags);
    if (!library)
        throw Error(GLIMMER_UNAVAILABLE,
                    std::string("Embree 3.13 could not be loaded (Debian: apt install libembree3-3): ") + dlerror());
    Embree e{};
#define GLIMMER_LOAD(name)                                                                                             \
    e.name = reinterpret_cast<decltype(e.name)>(dlsym(library, #name));                                                \
    if (!e.name)                                                                                                       \
        throw Error(GLIMMER_UNAVAILABLE, std::string(kLibrary) + " has no function " #name);
    GLIMMER_EMBREE_FUNCTIONS(GLIMMER_LOAD)
#undef GLIMMER_LOAD
    e.device = e.rtcNewDevice(nullptr);
    if (!e.device)
        throw Error(GLIMMER_UNAVAILABLE, "Embree could not make a device on this processor");
    const auto major = e.rtcGetDeviceProperty(e.device, RTC_DEVICE_PROPERTY_VERSION_MAJOR);
    const auto minor = e.rtcGetDeviceProperty(e.device, RTC_DEVICE_PROPERTY_VERSION_MINOR);
    if (major != RTC_VERSION_MAJOR || minor < RTC_VERSION_MINOR)
        throw Error(GLIMMER_UNAVAILABLE, "Embree " + std::to_string(major) + "." + std::to_string(minor) +
                                             " was found; the engine was built for " RTC_VERSION_STRING);
    return e;
}

} // namespace

void Embree::check(const char *what) const {
    switch (rtcGetDeviceError(device)) {
    case RTC_ERROR_NONE:
        return;
    case RTC_ERROR_OUT_OF_MEMORY:
        throw Error(GLIMMER_OUT_OF_MEMORY, std::string("out of memory while building ") + what);
    default:
        throw Error(GLIMMER_INTERNAL, std::string("Embree failed while building ") + what);
    }
}

const Embree &embree() {
    static const Embree table = open_embree();
    return table;
}

} // namespace glimmer
