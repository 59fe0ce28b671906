// SPDX-License-Identifier: GPL-3.0-or-later
// Image files as an interface of plain values. libglimmer_image.so implements it with OpenImageIO,
// which brings some 250 shared libraries along: the command opens it for the first image (cli/image_library.h).
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <variant>
#include <vector>

namespace glimmer {

using ImageAttribute = std::variant<int, float, std::string>;

/// What an image file says beside its pixels.
struct ImageHeader {
    std::string format;                   ///< as OpenImageIO names it: "openexr", "png", "hdr", ...
    int x = 0, y = 0;                     ///< top left corner of the part that is there, in the whole image
    int width = 0, height = 0, depth = 1; ///< of that part
    int full_width = 0, full_height = 0;  ///< of the whole image
    std::vector<std::string> channels;
    std::string color_space; ///< "linear", "sRGB", "Rec709", "Gamma2.2", ...; empty: not known
    std::map<std::string, ImageAttribute> attributes;
};

/// How a file stores a channel of a pixel.
enum class PixelType { UInt8, Float };

/// An image file that is open for reading.
class ImageReader {
  public:
    virtual ~ImageReader() = default;
    virtual const ImageHeader &header() const = 0;
    /// The first channels of all pixels: (height, width, channels), top row first, 8-bit values as 0 to 1, colours not
    /// multiplied by an alpha that the file keeps apart. Throws std::runtime_error with OpenImageIO's words.
    virtual std::vector<float> read(int channels) = 0;
};

class ImageIo {
  public:
    virtual ~ImageIo() = default;

    /// Any format that OpenImageIO reads. Throws std::runtime_error with OpenImageIO's words.
    virtual std::unique_ptr<ImageReader> open(const std::string &path) const = 0;

    /// The bytes of a file of header.format. pixels: (height, width, channels), top row first; 0 to 1 become 0 to 255
    /// where bytes are stored. Throws std::runtime_error with OpenImageIO's words.
    virtual std::vector<uint8_t> encode(const ImageHeader &header, const std::vector<float> &pixels,
                                        PixelType type) const = 0;

    /// Undoes the transfer curve of a colour space as ImageHeader names it; an unnamed one is taken as linear. False:
    /// the space is not known, and the values are as they were.
    virtual bool to_linear(const std::string &color_space, std::vector<float> &values) const = 0;
};

/// To be raised with every change of this file: a command refuses the library of another build.
constexpr uint32_t kImageIoVersion = 2;

/// The library's one function, "glimmer_image_io"; null for another version than its own. What it gives lives for ever.
using ImageIoEntry = const ImageIo *(*)(uint32_t version);

} // namespace glimmer
