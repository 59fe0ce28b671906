// SPDX-License-Identifier: GPL-3.0-or-later
#include "exr.h"

#include "atomic_file.h"
#include "errors.h"
#include "image_library.h"
#include "picture_file.h"
#include "text.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfThreading.h>
#include <algorithm>
#include <thread>

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

/// A file in memory: what OpenEXR writes goes back and forth, what we write to the disk is whole.
class Bytes : public Imf::OStream {
  public:
    explicit Bytes(const std::filesystem::path &path) : Imf::OStream(path.c_str()) {}

    void write(const char bytes[], int count) override {
        const auto size = static_cast<size_t>(count);
        bytes_.resize(std::max(bytes_.size(), at_ + size));
        std::copy_n(bytes, size, bytes_.begin() + static_cast<ptrdiff_t>(at_));
        at_ += size;
    }
    uint64_t tellp() override { return at_; }
    void seekp(uint64_t at) override { at_ = at; }

    const std::string &text() const { return bytes_; }

  private:
    std::string bytes_;
    size_t at_ = 0;
};

/// The channels, the whole picture as the display window, its part that is there as the data window, and the facts.
Imf::Header header_of(const Picture &picture) {
    const auto corner = [](uint32_t x, uint32_t y) {
        return Imath::V2i(static_cast<int>(x) - 1, static_cast<int>(y) - 1); // the last pixel, not the one behind it
    };
    const Imath::V2i first(static_cast<int>(picture.window[0]), static_cast<int>(picture.window[1]));
    Imf::Header header(Imath::Box2i(Imath::V2i(0, 0), corner(picture.width, picture.height)),
                       Imath::Box2i(first, corner(picture.window[2], picture.window[3])));
    header.compression() = Imf::ZIP_COMPRESSION;
    header.pixelAspectRatio() = picture.pixel_aspect;
    for (const std::string &channel : picture.channels)
        header.channels().insert(channel, Imf::Channel(Imf::FLOAT));
    const PictureInfo &info = picture.info;
    const auto text = [&](const char *name, const std::string &value) {
        if (!value.empty())
            header.insert(name, Imf::StringAttribute(value));
    };
    text("Software", "Glimmer " + info.version);
    header.insert("glimmer:spp", Imf::IntAttribute(static_cast<int>(info.samples)));
    text("glimmer:seed", joined(info.seeds));
    header.insert("glimmer:seconds", Imf::FloatAttribute(static_cast<float>(info.seconds)));
    text("glimmer:version", info.version);
    text("glimmer:scene", info.scene_hash);
    text("glimmer:integrator", info.integrator);
    text("glimmer:biased_by", joined(info.biased_by));
    return header;
}

void encode(const Picture &picture, Bytes &bytes) {
    const Imf::Header header = header_of(picture);
    const size_t pixel = picture.channels.size() * sizeof(float);
    Imf::FrameBuffer pixels;
    for (size_t i = 0; i < picture.channels.size(); ++i)
        pixels.insert(picture.channels[i], Imf::Slice::Make(Imf::FLOAT, picture.pixels.data() + i, header.dataWindow(),
                                                            pixel, pixel * picture.window_width()));
    const int threads = static_cast<int>(std::thread::hardware_concurrency()); // for its compression
    Imf::setGlobalThreadCount(threads);
    Imf::OutputFile file(bytes, header, threads);
    file.setFrameBuffer(pixels);
    file.writePixels(static_cast<int>(picture.window_height()));
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

// Not by OpenImageIO, whose libraries take longer to load than a small picture to render.
void write_exr(const Picture &picture, const std::filesystem::path &path) {
    Bytes bytes(path);
    try {
        encode(picture, bytes);
    } catch (const std::exception &error) {
        throw ResultError(path.string() + ": cannot be written: " + one_line(error.what()));
    }
    write_file(path, bytes.text());
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
    if (const auto aspect = attribute<float>(header, "PixelAspectRatio"); aspect > 0)
        picture.pixel_aspect = aspect;
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
