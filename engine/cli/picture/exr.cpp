// SPDX-License-Identifier: GPL-3.0-or-later
#include "exr.h"

#include "encode.h"
#include "errors.h"
#include "image_library.h"
#include "picture_file.h"
#include "text.h"

#include <algorithm>

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

/// The attribute's value; T() where it is missing or of another type.
template <class T>
T attribute(const ImageHeader &header, const char *name) {
    const auto found = header.attributes.find(name);
    const T *value = found == header.attributes.end() ? nullptr : std::get_if<T>(&found->second);
    return value == nullptr ? T() : *value;
}

PictureInfo info_of(const ImageHeader &header) {
    return {static_cast<uint64_t>(std::max(attribute<int>(header, "glimmer:spp"), 0)),
            split(attribute<std::string>(header, "glimmer:seed")),
            double(attribute<float>(header, "glimmer:seconds")),
            attribute<std::string>(header, "glimmer:version"),
            attribute<std::string>(header, "glimmer:scene"),
            attribute<std::string>(header, "glimmer:integrator"),
            split(attribute<std::string>(header, "glimmer:biased_by"))};
}

/// Null: no file of this format.
std::unique_ptr<ImageReader> open_exr(const std::filesystem::path &path) {
    const ImageIo &io = image_io();
    try {
        auto reader = io.open(path.string());
        return reader->header().format == "openexr" ? std::move(reader) : nullptr;
    } catch (const std::runtime_error &) {
        return nullptr;
    }
}

} // namespace

void write_exr(const Picture &picture, const std::filesystem::path &path) {
    const PictureInfo &info = picture.info;
    const ImageHeader header{"openexr",
                             static_cast<int>(picture.window[0]),
                             static_cast<int>(picture.window[1]),
                             static_cast<int>(picture.window_width()),
                             static_cast<int>(picture.window_height()),
                             1,
                             static_cast<int>(picture.width),
                             static_cast<int>(picture.height),
                             picture.channels,
                             "linear",
                             {{"compression", "zip"},
                              {"Software", "Glimmer " + info.version},
                              {"glimmer:spp", static_cast<int>(info.samples)},
                              {"glimmer:seed", joined(info.seeds)},
                              {"glimmer:seconds", static_cast<float>(info.seconds)},
                              {"glimmer:version", info.version},
                              {"glimmer:scene", info.scene_hash},
                              {"glimmer:integrator", info.integrator},
                              {"glimmer:biased_by", joined(info.biased_by)}}};
    write_image(header, picture.pixels, PixelType::Float, path);
}

Picture read_picture(const std::filesystem::path &path) {
    const std::string name = path.string();
    const auto fail = [&](const std::string &what) { throw InputError(name + ": " + what); };
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error))
        fail("no such file");
    const auto reader = open_exr(path);
    if (!reader)
        fail("is not an .exr file");
    const ImageHeader &header = reader->header();
    Picture picture;
    picture.info = info_of(header);
    if (picture.info.samples == 0 || picture.info.scene_hash.empty() || picture.info.seeds.empty())
        fail("was not written by glimmer: it has no glimmer:spp, glimmer:seed or glimmer:scene");
    picture.width = static_cast<uint32_t>(header.full_width);
    picture.height = static_cast<uint32_t>(header.full_height);
    picture.window = {static_cast<uint32_t>(header.x), static_cast<uint32_t>(header.y),
                      static_cast<uint32_t>(header.x + header.width), static_cast<uint32_t>(header.y + header.height)};
    picture.channels = header.channels;
    try {
        picture.pixels = reader->read(static_cast<int>(header.channels.size()));
    } catch (const std::runtime_error &damage) {
        fail("is damaged: " + one_line(damage.what()));
    }
    return picture;
}

} // namespace glimmer
