// SPDX-License-Identifier: GPL-3.0-or-later
#include "picture_file.h"

#include "atomic_file.h"
#include "encode.h"
#include "exr.h"
#include "image_library.h"

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

ImageHeader rgb_header(const Picture &picture, const char *format, const char *color_space) {
    const int width = static_cast<int>(picture.window_width()), height = static_cast<int>(picture.window_height());
    return {format, 0, 0, width, height, 1, width, height, {"R", "G", "B"}, color_space, {}};
}

/// Colours as they are without their alpha, which follows them: what a .png holds.
std::vector<float> rgba_of(const Picture &picture, size_t alpha) {
    const size_t channels = picture.channels.size();
    std::vector<float> rgba(4 * picture.pixel_count());
    for (size_t i = 0; i < picture.pixel_count(); ++i) {
        const float *in = picture.pixels.data() + i * channels;
        const float a = std::clamp(in[alpha], 0.0f, 1.0f);
        for (size_t c = 0; c < 3; ++c)
            rgba[4 * i + c] = float(display_value(a > 0 ? in[c] / a : 0)) / 255;
        rgba[4 * i + 3] = a;
    }
    return rgba;
}

void write_png(const Picture &picture, const std::filesystem::path &path) {
    if (const auto alpha = std::ranges::find(picture.channels, "A"); alpha != picture.channels.end()) {
        ImageHeader header = rgb_header(picture, "png", "sRGB");
        header.channels.emplace_back("A");
        header.attributes["oiio:UnassociatedAlpha"] = 1; // else OpenImageIO divides by it
        return write_image(header, rgba_of(picture, size_t(alpha - picture.channels.begin())), PixelType::UInt8, path);
    }
    auto rgb = rgb_of(picture);
    std::transform(rgb.begin(), rgb.end(), rgb.begin(), [](float value) { return float(display_value(value)) / 255; });
    write_image(rgb_header(picture, "png", "sRGB"), rgb, PixelType::UInt8, path);
}

void write_hdr(const Picture &picture, const std::filesystem::path &path) {
    auto rgb = rgb_of(picture); // RGBE has no sign
    std::transform(rgb.begin(), rgb.end(), rgb.begin(), [](float value) { return std::max(value, 0.0f); });
    write_image(rgb_header(picture, "hdr", "linear"), rgb, PixelType::Float, path);
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

void expect_writable(const std::filesystem::path &path) {
    const std::string extension = lower_extension(path);
    if (extension == ".png" || extension == ".hdr")
        image_io();
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
