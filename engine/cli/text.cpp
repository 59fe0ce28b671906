// SPDX-License-Identifier: GPL-3.0-or-later
#include "text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>

namespace glimmer {

namespace {

/// Bytes of the printable UTF-8 character that a text starts with; 0 when it starts with none.
size_t character_size(std::string_view text) {
    const auto byte = [&](size_t i) { return static_cast<unsigned char>(text[i]); };
    if (byte(0) < 0x80)
        return byte(0) >= 0x20 && byte(0) != 0x7f;
    const size_t size = byte(0) >= 0xf0 ? 4 : byte(0) >= 0xe0 ? 3 : byte(0) >= 0xc2 ? 2 : 0;
    if (size == 0 || byte(0) > 0xf4 || text.size() < size)
        return 0;
    for (size_t i = 1; i < size; ++i)
        if ((byte(i) & 0xc0) != 0x80)
            return 0;
    return size;
}

} // namespace

std::string in_quotes(std::string_view text) {
    constexpr size_t limit = 80;
    std::string result = "\"";
    while (!text.empty()) {
        if (result.size() > limit)
            return result + "...\"";
        const size_t size = character_size(text);
        if (size == 0) {
            char escaped[8];
            std::snprintf(escaped, sizeof escaped, "\\x%02x", static_cast<unsigned char>(text[0]));
            result += escaped;
        } else {
            if (text[0] == '"' || text[0] == '\\')
                result += '\\';
            result += text.substr(0, size);
        }
        text.remove_prefix(std::max<size_t>(size, 1));
    }
    return result + "\"";
}

std::string one_line(std::string text) {
    while (!text.empty() && (text.back() == '\n' || text.back() == ' '))
        text.pop_back();
    for (char &character : text) {
        const auto byte = static_cast<unsigned char>(character);
        character = byte < 0x20 || byte == 0x7f ? ' ' : byte > 0x7f ? '?' : character;
    }
    return text;
}

std::string quoted_list(std::span<const std::string> names) {
    constexpr size_t limit = 8;
    if (names.empty())
        return "none";
    std::string result;
    for (size_t i = 0; i < names.size() && i < limit; ++i)
        result += (i ? ", " : "") + in_quotes(names[i]);
    if (names.size() > limit)
        result += " and " + std::to_string(names.size() - limit) + " more";
    return result;
}

std::string number_text(double value) {
    char text[32];
    const auto end = std::to_chars(text, text + sizeof text, value).ptr;
    return {text, end};
}

std::string clock_text(double seconds) {
    const auto whole = static_cast<long long>(std::llround(seconds < 0 ? 0 : seconds));
    char text[48];
    if (whole >= 3600)
        std::snprintf(text, sizeof text, "%lld:%02lld:%02lld", whole / 3600, whole / 60 % 60, whole % 60);
    else
        std::snprintf(text, sizeof text, "%lld:%02lld", whole / 60, whole % 60);
    return text;
}

std::string count_text(unsigned long long count, std::string_view one, std::string_view many) {
    return std::to_string(count) + " " + std::string(count == 1 ? one : many);
}

} // namespace glimmer
