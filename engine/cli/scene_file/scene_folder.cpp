// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene_folder.h"

#include "errors.h"
#include "text.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#define XXH_INLINE_ALL // no library to load
#include <xxhash.h>

namespace glimmer {

namespace fs = std::filesystem;

uint64_t hash_bytes(std::string_view bytes, uint64_t seed) {
    return XXH64(bytes.data(), bytes.size(), seed);
}

std::string read_file(const fs::path &path, const std::string &name) {
    const auto fail = [&](const std::string &why) { throw InputError(name + ": " + why); };
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (status.type() == fs::file_type::not_found)
        fail("no such file");
    if (error)
        fail(error.message());
    // A pipe would wait for ever and a device may have no end.
    if (!fs::is_regular_file(status))
        fail(fs::is_directory(status) ? "is a folder; a file is allowed" : "is not a regular file");
    std::unique_ptr<std::FILE, int (*)(std::FILE *)> file(std::fopen(path.c_str(), "rb"), std::fclose);
    if (!file)
        fail(std::strerror(errno));
    std::string bytes;
    bytes.reserve(static_cast<size_t>(fs::file_size(path)));
    for (char block[1 << 16];;) {
        const size_t count = std::fread(block, 1, sizeof block, file.get());
        bytes.append(block, count);
        if (count < sizeof block)
            break;
    }
    if (std::ferror(file.get()))
        fail("cannot be read: " + std::string(std::strerror(errno)));
    return bytes;
}

SceneFolder::SceneFolder(const fs::path &scene_file)
    : folder_(fs::canonical(scene_file.has_parent_path() ? scene_file.parent_path() : fs::path("."))) {}

SceneFolder::File SceneFolder::read(const Value &value) {
    const std::string name = value.text();
    const auto refuse = [&](const std::string &why) {
        value.fail(in_quotes(name) + " " + why + "; files stand in the scene's folder and are named relative to it");
    };
    if (name.empty() || name.find('\0') != std::string::npos)
        refuse("is not a file name");
    const fs::path relative(name);
    if (relative.is_absolute())
        refuse("is an absolute path");
    if (std::find(relative.begin(), relative.end(), "..") != relative.end())
        refuse("has \"..\" in it");
    std::error_code error;
    const fs::path path = fs::canonical(folder_ / relative, error);
    if (error)
        value.fail(in_quotes(name) + ": " +
                   (error == std::errc::no_such_file_or_directory ? "no such file" : error.message()));
    if (std::mismatch(folder_.begin(), folder_.end(), path.begin(), path.end()).first != folder_.end())
        refuse("is a link out of the scene's folder");
    File file{path, name, read_file(path, value.where() + ": " + in_quotes(name))};
    hashes_[name] = hash_bytes(file.bytes);
    return file;
}

namespace {

/// The same JSON with sorted keys and every number a float64, so that 1 and 1.0 are one scene.
nlohmann::json canonical(const Json &value) {
    if (value.is_object()) {
        nlohmann::json result = nlohmann::json::object();
        for (const auto &[key, member] : value.items())
            result[key] = canonical(member);
        return result;
    }
    if (value.is_array()) {
        nlohmann::json result = nlohmann::json::array();
        for (const Json &element : value)
            result.push_back(canonical(element));
        return result;
    }
    if (value.is_number())
        return value.get<double>();
    if (value.is_string())
        return value.get<std::string>();
    return value.is_boolean() ? nlohmann::json(value.get<bool>()) : nlohmann::json();
}

} // namespace

std::string SceneFolder::content_hash(const Json &scene) const {
    uint64_t hash = hash_bytes(canonical(scene).dump());
    for (const auto &[name, file_hash] : hashes_) {
        hash = hash_bytes(name, hash);
        hash = hash_bytes({reinterpret_cast<const char *>(&file_hash), sizeof file_hash}, hash);
    }
    char text[32];
    std::snprintf(text, sizeof text, "xxh64:%016llx", static_cast<unsigned long long>(hash));
    return text;
}

} // namespace glimmer
