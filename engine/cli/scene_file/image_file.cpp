// SPDX-License-Identifier: GPL-3.0-or-later
#include "image_file.h"

#include "errors.h"
#include "text.h"

#include <OpenImageIO/color.h>
#include <OpenImageIO/imageio.h>
#include <OpenImageIO/strutil.h>
#include <cmath>

namespace glimmer {
namespace {

/// Undoes the transfer curve of a colour space as OpenImageIO names it; false: not known.
bool to_linear(const std::string &space, std::vector<float> &values) {
    if (space.empty() || OIIO::Strutil::iequals(space, "linear") || OIIO::Strutil::iequals(space, "scene_linear"))
        return true;
    if (OIIO::Strutil::iequals(space, "sRGB")) {
        for (float &value : values)
            value = OIIO::sRGB_to_linear(value);
        return true;
    }
    if (OIIO::Strutil::iequals(space, "Rec709")) {
        for (float &value : values)
            value = OIIO::Rec709_to_linear(value);
        return true;
    }
    float gamma = 0;
    OIIO::string_view rest(space);
    if (OIIO::Strutil::parse_prefix(rest, "Gamma") || OIIO::Strutil::parse_prefix(rest, "GammaCorrected"))
        OIIO::Strutil::parse_float(rest, gamma);
    if (!(gamma > 0))
        return false;
    for (float &value : values)
        value = std::pow(std::max(value, 0.0f), gamma);
    return true;
}

} // namespace

ImageData read_image(const std::filesystem::path &path, const std::string &name) {
    const auto fail = [&](const std::string &what) { throw InputError(name + ": " + what); };
    const auto complain = [&](const std::string &message) {
        fail("is not an image that can be read: " + one_line(message));
    };
    // The colours as they are stored, not multiplied by the alpha that we ignore.
    OIIO::ImageSpec config;
    config["oiio:UnassociatedAlpha"] = 1;
    const auto input = OIIO::ImageInput::open(path.string(), &config);
    if (!input)
        complain(OIIO::geterror());
    const OIIO::ImageSpec &spec = input->spec();
    if (spec.width < 1 || spec.height < 1 || spec.width > 65536 || spec.height > 65536 || spec.depth > 1)
        fail("has " + std::to_string(spec.width) + " x " + std::to_string(spec.height) + " x " +
             std::to_string(spec.depth) + " pixels; up to 65536 x 65536 x 1 are allowed");
    if (spec.nchannels < 1)
        fail("has no channels");
    const int channels = spec.nchannels < 3 ? 1 : 3;
    const auto pixel_count = static_cast<size_t>(spec.width) * static_cast<size_t>(spec.height);
    std::vector<float> values(pixel_count * static_cast<size_t>(channels));
    if (!input->read_image(0, 0, 0, channels, OIIO::TypeFloat, values.data()))
        complain(input->geterror());
    const std::string space = spec.get_string_attribute("oiio:ColorSpace");
    if (!to_linear(space, values))
        fail("has the colour space " + in_quotes(space) + "; linear, sRGB, Rec709 and plain gammas are allowed");
    for (size_t i = 0; i < values.size(); ++i) {
        if (!(values[i] >= 0) || std::isinf(values[i])) {
            const size_t pixel = i / static_cast<size_t>(channels), width = static_cast<size_t>(spec.width);
            fail("pixel (" + std::to_string(pixel % width) + ", " + std::to_string(pixel / width) + ") is " +
                 number_text(double(values[i])) + "; finite numbers of 0 or more are allowed");
        }
    }
    ImageData image{static_cast<uint32_t>(spec.width), static_cast<uint32_t>(spec.height), {}};
    if (channels == 3) {
        image.rgb = std::move(values);
        return image;
    }
    image.rgb.reserve(3 * pixel_count);
    for (const float value : values)
        image.rgb.insert(image.rgb.end(), {value, value, value});
    return image;
}

} // namespace glimmer
