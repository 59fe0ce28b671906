// SPDX-License-Identifier: GPL-3.0-or-later
// JSON text to a tree that keeps the file's order.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace glimmer {

/// Keys stay in the order of the file: materials are numbered in it.
using Json = nlohmann::ordered_json;

/// "objects[2].mesh" for objects -> 2 -> mesh.
std::string child_path(const std::string &path, std::string_view key);
std::string child_path(const std::string &path, size_t index);

/// Parses UTF-8 JSON. Duplicate keys, nesting deeper than 64 and numbers beyond float64 are errors as syntax is.
/// Throws InputError whose line starts with `file`.
Json parse_json(std::string_view text, const std::string &file);

} // namespace glimmer
