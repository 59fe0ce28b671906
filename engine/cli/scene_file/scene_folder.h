// SPDX-License-Identifier: GPL-3.0-or-later
// The folder of the scene file, the only place that a scene may read from, and the hash of what it read.
#pragma once

#include "value.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

namespace glimmer {

/// XXH64 of bytes, continued from `seed`.
uint64_t hash_bytes(std::string_view bytes, uint64_t seed = 0);

/// All bytes of a regular file. Throws InputError "NAME: why".
std::string read_file(const std::filesystem::path &path, const std::string &name);

class SceneFolder {
  public:
    explicit SceneFolder(const std::filesystem::path &scene_file);

    struct File {
        std::filesystem::path path;
        std::string name; ///< as the scene has it
        std::string bytes;
    };
    /// The file that a value names, relative to the folder: not absolute, without "..", no link that leads out, a
    /// regular file. Its bytes enter the hash.
    File read(const Value &name);

    /// XXH64 of the scene's text (keys sorted, numbers as float64, no white space) and of every file read, as
    /// "xxh64:" and 16 hexadecimal digits.
    std::string content_hash(const Json &scene) const;

  private:
    std::filesystem::path folder_; ///< without links
    std::map<std::string, uint64_t> hashes_;
};

} // namespace glimmer
