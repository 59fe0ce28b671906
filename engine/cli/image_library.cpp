// SPDX-License-Identifier: GPL-3.0-or-later
#include "image_library.h"

#include "errors.h"
#include "glimmer.h"
#include "text.h"

#include <dlfcn.h>
#include <filesystem>

namespace glimmer {
namespace {

constexpr const char *kName = "libglimmer_image.so";

/// By its whole path, as sanitizers that wrap dlopen do not look where the command's RUNPATH points.
std::filesystem::path library_path() {
    Dl_info engine{};
    if (dladdr(reinterpret_cast<const void *>(&glimmer_version), &engine) == 0 || engine.dli_fname == nullptr)
        return kName;
    return (std::filesystem::path(engine.dli_fname).parent_path() / kName).lexically_normal();
}

const ImageIo &open_library() {
    const std::filesystem::path path = library_path();
    const auto fail = [](const std::string &why) {
        throw ResultError("images can be neither read nor written: " + one_line(why) +
                          "; `python3 build.py build` makes that library and installs what it needs");
    };
    // Not RTLD_NOW: it would look up every function of some 250 libraries.
    void *library = dlopen(path.c_str(), RTLD_LAZY | RTLD_LOCAL);
    if (library == nullptr)
        fail(dlerror());
    const auto entry = reinterpret_cast<ImageIoEntry>(dlsym(library, "glimmer_image_io"));
    const ImageIo *io = entry == nullptr ? nullptr : entry(kImageIoVersion);
    if (io == nullptr)
        fail(path.string() + " is of another version than this command");
    return *io;
}

} // namespace

const ImageIo &image_io() {
    static const ImageIo &library = open_library();
    return library;
}

} // namespace glimmer
