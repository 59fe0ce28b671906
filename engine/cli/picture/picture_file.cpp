// SPDX-License-Identifier: GPL-3.0-or-later
#include "picture_file.h"

#include "atomic_file.h"
#include "encode.h"
#include "exr.h"

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

OIIO::ImageSpec rgb_spec(const Picture &picture, OIIO::TypeDesc type, const char *color_space) {
    OIIO::ImageSpec spec(static_cast<int>(picture.window_width()), static_cast<int>(picture.window_height()), 3, type);
    spec["oiio:ColorSpace"] = color_space;
    return spec;
}

void write_png(const Picture &picture, const std::filesystem::path &path) {
    const auto rgb = rgb_of(picture);
    std::vector<uint8_t> bytes(rgb.size());
    std::transform(rgb.begin(), rgb.end(), bytes.begin(), display_value);
    write_image(rgb_spec(picture, OIIO::TypeUInt8, "sRGB"), OIIO::TypeUInt8, bytes.data(), "png", path);
}

void write_hdr(const Picture &picture, const std::filesystem::path &path) {
    auto rgb = rgb_of(picture); // RGBE has no sign
    std::transform(rgb.begin(), rgb.end(), rgb.begin(), [](float value) { return std::max(value, 0.0f); });
    write_image(rgb_spec(picture, OIIO::TypeFloat, "linear"), OIIO::TypeFloat, rgb.data(), "hdr", path);
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
    if (extension == ".exr")
        write_exr(picture, path);
    else if (extension == ".png")
        write_png(picture, path);
    else if (extension == ".hdr")
        write_hdr(picture, path);
    else
        write_pfm(picture, path);
}

} // namespace glimmer
