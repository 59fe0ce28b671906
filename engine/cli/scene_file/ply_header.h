// SPDX-License-Identifier: GPL-3.0-or-later
// The header of a .ply file (Turk, "The PLY Polygon File Format", 1994).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace glimmer {

enum class PlyType { Int8, Uint8, Int16, Uint16, Int32, Uint32, Float32, Float64 };
size_t ply_size(PlyType type);

struct PlyProperty {
    std::string name;
    PlyType type;
    bool is_list = false;
    PlyType count_type = PlyType::Uint8; ///< of a list
};

struct PlyElement {
    std::string name;
    uint64_t count;
    std::vector<PlyProperty> properties;
};

struct PlyHeader {
    enum Format { Ascii, LittleEndian, BigEndian } format = Ascii;
    std::vector<PlyElement> elements;
    size_t size = 0; ///< bytes of the header, "end_header" and its line break included
};

/// Throws InputError "NAME: what".
PlyHeader parse_ply_header(std::string_view bytes, const std::string &name);

} // namespace glimmer
