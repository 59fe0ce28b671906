// SPDX-License-Identifier: GPL-3.0-or-later
#include "picture_file.h"

#include "atomic_file.h"
#include "errors.h"
#include "exr.h"
#include "text.h"

#include <OpenImageIO/imageio.h>
#include <algorithm>
#include <cmath>

namespace glimmer {
namespace {

/// Interleaved R G B alone.
std::vector<float> rgb_of(const Picture &picture) {
    const size_t channels = picture.channels.size();
    std::vector<float> rgb(3 * picture.pixel_count());
    for (size_t i = 0; i < picture.pixel_count(); ++i)
        std::copy_n(picture.pixels.begin() + static_cast<ptrdiff_t>(i * channels), 3,
                    rgb.begin() + static_cast<ptrdiff_t>(3 * i));
    return rgb;
}

void write_with_oiio(const Picture &picture, const std::filesystem::path &path, const std::filesystem::path &target,
                     const char *format) {
    const bool is_png = format == std::string_view("png");
    OIIO::ImageSpec spec(static_cast<int>(picture.window_width()), static_cast<int>(picture.window_height()), 3,
                         is_png ? OIIO::TypeUInt8 : OIIO::TypeFloat);
    spec["oiio:ColorSpace"] = is_png ? "sRGB" : "linear";
    auto rgb = rgb_of(picture);
    const auto output = OIIO::ImageOutput::create(format);
    bool written = output && output->open(path.string(), spec);
    if (is_png) {
        std::vector<uint8_t> bytes(rgb.size());
        std::transform(rgb.begin(), rgb.end(), bytes.begin(), display_value);
        written = written && output->write_image(OIIO::TypeUInt8, bytes.data());
    } else { // RGBE has no sign
        std::transform(rgb.begin(), rgb.end(), rgb.begin(), [](float value) { return std::max(value, 0.0f); });
        written = written && output->write_image(OIIO::TypeFloat, rgb.data());
    }
    if (!written || !output->close())
        throw ResultError(target.string() + ": cannot be written: " + (output ? output->geterror() : OIIO::geterror()));
}

/// Portable float map: "PF", the size, -1 for little-endian, then rows from the bottom up.
void write_pfm(const Picture &picture, const std::filesystem::path &path) {
    std::string bytes =
        "PF\n" + std::to_string(picture.window_width()) + " " + std::to_string(picture.window_height()) + "\n-1.0\n";
    const auto rgb = rgb_of(picture);
    const size_t row = 3 * size_t(picture.window_width());
    for (size_t y = picture.window_height(); y-- > 0;)
        bytes.append(reinterpret_cast<const char *>(rgb.data() + y * row), row * sizeof(float));
    write_file(path, bytes);
}

} // namespace

std::string lower_extension(const std::filesystem::path &path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    return extension;
}

uint8_t display_value(float linear) {
    if (!(linear > 0))
        return 0;
    const float value = std::min(linear, 1.0f);
    const float encoded = value <= 0.0031308f ? 12.92f * value : 1.055f * std::pow(value, 1 / 2.4f) - 0.055f;
    return static_cast<uint8_t>(std::lround(255 * encoded));
}

void write_picture(const Picture &picture, const std::filesystem::path &path) {
    const std::string extension = lower_extension(path);
    if (extension == ".pfm")
        return write_pfm(picture, path);
    AtomicFile file(path);
    if (extension == ".exr")
        write_exr(picture, file.path(), path);
    else
        write_with_oiio(picture, file.path(), path, extension == ".png" ? "png" : "hdr");
    file.commit();
}

} // namespace glimmer
