// SPDX-License-Identifier: GPL-3.0-or-later
#include "encode.h"

#include "atomic_file.h"
#include "errors.h"
#include "image_library.h"
#include "text.h"

namespace glimmer {

void write_image(const ImageHeader &header, const std::vector<float> &pixels, PixelType type,
                 const std::filesystem::path &path) {
    const ImageIo &io = image_io();
    std::vector<uint8_t> bytes;
    try {
        bytes = io.encode(header, pixels, type);
    } catch (const std::runtime_error &error) {
        throw ResultError(path.string() + ": cannot be written: " + one_line(error.what()));
    }
    write_file(path, {reinterpret_cast<const char *>(bytes.data()), bytes.size()});
}

} // namespace glimmer
