// SPDX-License-Identifier: GPL-3.0-or-later
#include "image_file.h"

#include "errors.h"
#include "image_library.h"
#include "text.h"

#include <cmath>

namespace glimmer {

ImageData read_image(const std::filesystem::path &path, const std::string &name) {
    const auto fail = [&](const std::string &what) { throw InputError(name + ": " + what); };
    const auto tried = [&](const auto &read) {
        try {
            return read();
        } catch (const std::runtime_error &error) {
            throw InputError(name + ": is not an image that can be read: " + one_line(error.what()));
        }
    };
    const ImageIo &io = image_io();
    const auto reader = tried([&] { return io.open(path.string()); });
    const ImageHeader &header = reader->header();
    if (header.width < 1 || header.height < 1 || header.width > 65536 || header.height > 65536 || header.depth > 1)
        fail("has " + std::to_string(header.width) + " x " + std::to_string(header.height) + " x " +
             std::to_string(header.depth) + " pixels; up to 65536 x 65536 x 1 are allowed");
    if (header.channels.empty())
        fail("has no channels");
    const int channels = header.channels.size() < 3 ? 1 : 3;
    auto values = tried([&] { return reader->read(channels); });
    if (!io.to_linear(header.color_space, values))
        fail("has the colour space " + in_quotes(header.color_space) +
             "; linear, sRGB, Rec709 and plain gammas are allowed");
    for (size_t i = 0; i < values.size(); ++i) {
        if (!(values[i] >= 0) || std::isinf(values[i])) {
            const size_t pixel = i / static_cast<size_t>(channels), width = static_cast<size_t>(header.width);
            fail("pixel (" + std::to_string(pixel % width) + ", " + std::to_string(pixel / width) + ") is " +
                 number_text(double(values[i])) + "; finite numbers of 0 or more are allowed");
        }
    }
    ImageData image{static_cast<uint32_t>(header.width), static_cast<uint32_t>(header.height), {}};
    if (channels == 3) {
        image.rgb = std::move(values);
        return image;
    }
    image.rgb.reserve(3 * values.size());
    for (const float value : values)
        image.rgb.insert(image.rgb.end(), {value, value, value});
    return image;
}

} // namespace glimmer
