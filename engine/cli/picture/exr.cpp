// SPDX-License-Identifier: GPL-3.0-or-later
#include "exr.h"

#include "encode.h"
#include "errors.h"
#include "picture_file.h"
#include "text.h"

#include <OpenImageIO/imageio.h>

namespace glimmer {
namespace {

std::string joined(const std::vector<std::string> &texts) {
    std::string result;
    for (const std::string &text : texts)
        result += (result.empty() ? "" : ", ") + text;
    return result;
}

std::vector<std::string> split(const std::string &text) {
    std::vector<std::string> result;
    for (size_t at = 0; at < text.size();) {
        const size_t end = std::min(text.find(", ", at), text.size());
        result.push_back(text.substr(at, end - at));
        at = end + 2;
    }
    return result;
}

} // namespace

void write_exr(const Picture &picture, const std::filesystem::path &path) {
    OIIO::ImageSpec spec(static_cast<int>(picture.window_width()), static_cast<int>(picture.window_height()),
                         static_cast<int>(picture.channels.size()), OIIO::TypeFloat);
    spec.channelnames = picture.channels;
    spec.x = static_cast<int>(picture.window[0]);
    spec.y = static_cast<int>(picture.window[1]);
    spec.full_width = static_cast<int>(picture.width);
    spec.full_height = static_cast<int>(picture.height);
    const PictureInfo &info = picture.info;
    spec["oiio:ColorSpace"] = "linear";
    spec["compression"] = "zip";
    spec["Software"] = "Glimmer " + info.version;
    spec["glimmer:spp"] = static_cast<int>(info.samples);
    spec["glimmer:seed"] = joined(info.seeds);
    spec["glimmer:seconds"] = static_cast<float>(info.seconds);
    spec["glimmer:version"] = info.version;
    spec["glimmer:scene"] = info.scene_hash;
    spec["glimmer:integrator"] = info.integrator;
    spec["glimmer:biased_by"] = joined(info.biased_by);
    write_image(spec, OIIO::TypeFloat, picture.pixels.data(), "openexr", path);
}

Picture read_picture(const std::filesystem::path &path) {
    const std::string name = path.string();
    const auto fail = [&](const std::string &what) { throw InputError(name + ": " + what); };
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error))
        fail("no such file");
    const auto input = OIIO::ImageInput::open(name);
    if (!input || input->format_name() != std::string_view("openexr"))
        fail("is not an .exr file");
    const OIIO::ImageSpec &spec = input->spec();
    Picture picture;
    PictureInfo &info = picture.info;
    info.samples = static_cast<uint64_t>(std::max(spec.get_int_attribute("glimmer:spp"), 0));
    info.scene_hash = spec.get_string_attribute("glimmer:scene");
    info.seeds = split(spec.get_string_attribute("glimmer:seed"));
    if (info.samples == 0 || info.scene_hash.empty() || info.seeds.empty())
        fail("was not written by glimmer: it has no glimmer:spp, glimmer:seed or glimmer:scene");
    info.seconds = double(spec.get_float_attribute("glimmer:seconds"));
    info.version = spec.get_string_attribute("glimmer:version");
    info.integrator = spec.get_string_attribute("glimmer:integrator");
    info.biased_by = split(spec.get_string_attribute("glimmer:biased_by"));
    picture.width = static_cast<uint32_t>(spec.full_width);
    picture.height = static_cast<uint32_t>(spec.full_height);
    picture.window = {static_cast<uint32_t>(spec.x), static_cast<uint32_t>(spec.y),
                      static_cast<uint32_t>(spec.x + spec.width), static_cast<uint32_t>(spec.y + spec.height)};
    picture.channels = spec.channelnames;
    picture.pixels.resize(picture.pixel_count() * picture.channels.size());
    if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeFloat, picture.pixels.data()))
        fail("is damaged: " + input->geterror());
    return picture;
}

} // namespace glimmer
