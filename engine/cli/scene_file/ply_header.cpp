// SPDX-License-Identifier: GPL-3.0-or-later
#include "ply_header.h"

#include "errors.h"
#include "text.h"

#include <charconv>
#include <optional>
#include <sstream>

namespace glimmer {
namespace {

std::optional<PlyType> type_named(std::string_view name) {
    struct Entry {
        std::string_view name, other_name;
        PlyType type;
    };
    constexpr Entry table[] = {{"char", "int8", PlyType::Int8},        {"uchar", "uint8", PlyType::Uint8},
                               {"short", "int16", PlyType::Int16},     {"ushort", "uint16", PlyType::Uint16},
                               {"int", "int32", PlyType::Int32},       {"uint", "uint32", PlyType::Uint32},
                               {"float", "float32", PlyType::Float32}, {"double", "float64", PlyType::Float64}};
    for (const Entry &entry : table)
        if (name == entry.name || name == entry.other_name)
            return entry.type;
    return std::nullopt;
}

std::vector<std::string> words_of(std::string_view line) {
    std::istringstream stream{std::string(line)};
    std::vector<std::string> words;
    for (std::string word; stream >> word;)
        words.push_back(word);
    return words;
}

} // namespace

size_t ply_size(PlyType type) {
    constexpr size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
    return sizes[static_cast<size_t>(type)];
}

PlyHeader parse_ply_header(std::string_view bytes, const std::string &name) {
    const auto fail = [&](const std::string &what) { throw InputError(name + ": " + what); };
    PlyHeader header;
    bool has_format = false;
    for (size_t at = 0, line_number = 1;; ++line_number) {
        const size_t end = bytes.find('\n', at);
        if (line_number == 1 && !bytes.starts_with("ply\n") && !bytes.starts_with("ply\r\n"))
            fail("is not a .ply file");
        if (end == std::string_view::npos)
            fail("the .ply header has no end_header");
        const std::string_view line = bytes.substr(at, end - at);
        const auto words = words_of(line);
        at = end + 1;
        const auto fail_line = [&](const std::string &what) {
            fail("line " + std::to_string(line_number) + ": " + what);
        };
        if (line_number == 1 || words.empty() || words[0] == "comment" || words[0] == "obj_info")
            continue;
        if (words[0] == "end_header") {
            header.size = at;
            break;
        }
        if (words[0] == "format" && words.size() == 3) {
            has_format = true;
            if (words[1] == "ascii")
                header.format = PlyHeader::Ascii;
            else if (words[1] == "binary_little_endian")
                header.format = PlyHeader::LittleEndian;
            else if (words[1] == "binary_big_endian")
                header.format = PlyHeader::BigEndian;
            else
                fail_line("format " + in_quotes(words[1]) +
                          " is not known; ascii, binary_little_endian and binary_big_endian are");
        } else if (words[0] == "element" && words.size() == 3) {
            uint64_t count = 0;
            const auto [last, error] = std::from_chars(words[2].data(), words[2].data() + words[2].size(), count);
            if (error != std::errc() || last != words[2].data() + words[2].size())
                fail_line(in_quotes(words[2]) + " is not a count of elements");
            header.elements.push_back({words[1], count, {}});
        } else if (words[0] == "property" && !header.elements.empty() &&
                   (words.size() == 3 || (words.size() == 5 && words[1] == "list"))) {
            const bool is_list = words.size() == 5;
            const auto type = type_named(words[words.size() - 2]);
            const auto count_type = is_list ? type_named(words[2]) : PlyType::Uint8;
            if (!type || !count_type || *count_type >= PlyType::Float32)
                fail_line("a type of " + in_quotes(line) + " is not known");
            header.elements.back().properties.push_back({words.back(), *type, is_list, *count_type});
        } else {
            fail_line(in_quotes(line) + " is not understood; format, element, property and comment lines are");
        }
    }
    if (!has_format)
        fail("the .ply header has no format line");
    return header;
}

} // namespace glimmer
