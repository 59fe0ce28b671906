// SPDX-License-Identifier: GPL-3.0-or-later
// All that Glimmer asks of OpenImageIO.
#include "image_io.h"

#include <OpenImageIO/color.h>
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <OpenImageIO/strutil.h>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace glimmer {
namespace {

ImageHeader header_of(const OIIO::ImageInput &input) {
    const OIIO::ImageSpec &spec = input.spec();
    ImageHeader header{input.format_name(),
                       spec.x,
                       spec.y,
                       spec.width,
                       spec.height,
                       spec.depth,
                       spec.full_width,
                       spec.full_height,
                       spec.channelnames,
                       spec.get_string_attribute("oiio:ColorSpace"),
                       {}};
    for (const OIIO::ParamValue &value : spec.extra_attribs) {
        if (value.type() == OIIO::TypeInt)
            header.attributes[value.name().string()] = value.get_int();
        else if (value.type() == OIIO::TypeFloat)
            header.attributes[value.name().string()] = value.get_float();
        else if (value.type() == OIIO::TypeString)
            header.attributes[value.name().string()] = value.get_string();
    }
    return header;
}

OIIO::ImageSpec spec_of(const ImageHeader &header, PixelType type) {
    OIIO::ImageSpec spec(header.width, header.height, static_cast<int>(header.channels.size()),
                         type == PixelType::UInt8 ? OIIO::TypeUInt8 : OIIO::TypeFloat);
    spec.channelnames = header.channels;
    spec.x = header.x;
    spec.y = header.y;
    spec.full_width = header.full_width;
    spec.full_height = header.full_height;
    spec["oiio:ColorSpace"] = header.color_space;
    for (const auto &[name, attribute] : header.attributes)
        std::visit([&, &key = name](const auto &value) { spec[key] = value; }, attribute);
    return spec;
}

class OiioReader : public ImageReader {
  public:
    explicit OiioReader(std::unique_ptr<OIIO::ImageInput> input)
        : input_(std::move(input)), header_(header_of(*input_)) {}

    const ImageHeader &header() const override { return header_; }

    std::vector<float> read(int channels) override {
        std::vector<float> pixels(static_cast<size_t>(header_.width) * static_cast<size_t>(header_.height) *
                                  static_cast<size_t>(channels));
        if (!input_->read_image(0, 0, 0, channels, OIIO::TypeFloat, pixels.data()))
            throw std::runtime_error(input_->geterror());
        return pixels;
    }

  private:
    std::unique_ptr<OIIO::ImageInput> input_;
    ImageHeader header_;
};

/// "Gamma2.2" and its like; 0 for all else.
float gamma_of(const std::string &color_space) {
    float gamma = 0;
    OIIO::string_view rest(color_space);
    if (OIIO::Strutil::parse_prefix(rest, "Gamma") || OIIO::Strutil::parse_prefix(rest, "GammaCorrected"))
        OIIO::Strutil::parse_float(rest, gamma);
    return gamma;
}

class Oiio : public ImageIo {
  public:
    std::unique_ptr<ImageReader> open(const std::string &path) const override {
        OIIO::ImageSpec config;
        config["oiio:UnassociatedAlpha"] = 1; // else OpenImageIO multiplies by it
        auto input = OIIO::ImageInput::open(path, &config);
        if (!input)
            throw std::runtime_error(OIIO::geterror());
        return std::make_unique<OiioReader>(std::move(input));
    }

    std::vector<uint8_t> encode(const ImageHeader &header, const std::vector<float> &pixels,
                                PixelType type) const override {
        std::vector<uint8_t> bytes;
        OIIO::Filesystem::IOVecOutput memory(bytes);
        const OIIO::ImageSpec spec = spec_of(header, type);
        const auto output = OIIO::ImageOutput::create(header.format);
        const bool written = output && output->set_ioproxy(&memory) && output->open("picture." + header.format, spec) &&
                             output->write_image(OIIO::TypeFloat, pixels.data()) && output->close();
        if (!written)
            throw std::runtime_error(output ? output->geterror() : OIIO::geterror());
        return bytes;
    }

    bool to_linear(const std::string &color_space, std::vector<float> &values) const override {
        using OIIO::Strutil::iequals;
        const auto apply = [&](auto curve) {
            std::transform(values.begin(), values.end(), values.begin(), curve);
            return true;
        };
        if (color_space.empty() || iequals(color_space, "linear") || iequals(color_space, "scene_linear"))
            return true;
        if (iequals(color_space, "sRGB"))
            return apply([](float value) { return OIIO::sRGB_to_linear(value); });
        if (iequals(color_space, "Rec709"))
            return apply([](float value) { return OIIO::Rec709_to_linear(value); });
        const float gamma = gamma_of(color_space);
        return gamma > 0 && apply([gamma](float value) { return std::pow(std::max(value, 0.0f), gamma); });
    }
};

} // namespace
} // namespace glimmer

extern "C" __attribute__((visibility("default"))) const glimmer::ImageIo *glimmer_image_io(uint32_t version) {
    static const glimmer::Oiio library;
    return version == glimmer::kImageIoVersion ? &library : nullptr;
}
