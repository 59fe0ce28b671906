// SPDX-License-Identifier: GPL-3.0-or-later
#include "encode.h"

#include "atomic_file.h"
#include "errors.h"

#include <OpenImageIO/filesystem.h>

namespace glimmer {

void write_image(const OIIO::ImageSpec &spec, OIIO::TypeDesc type, const void *pixels, const char *format,
                 const std::filesystem::path &path) {
    OIIO::Filesystem::IOVecOutput memory;
    const auto output = OIIO::ImageOutput::create(format);
    const bool written = output && output->set_ioproxy(&memory) && output->open(path.string(), spec) &&
                         output->write_image(type, pixels) && output->close();
    if (!written)
        throw ResultError(path.string() + ": cannot be written: " + (output ? output->geterror() : OIIO::geterror()));
    const auto &bytes = memory.buffer();
    write_file(path, {reinterpret_cast<const char *>(bytes.data()), bytes.size()});
}

} // namespace glimmer
