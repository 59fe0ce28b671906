// SPDX-License-Identifier: GPL-3.0-or-later
#include "text.h"

#include <charconv>
#include <cmath>
#include <cstdio>

namespace glimmer {

std::string in_quotes(std::string_view text) {
    constexpr size_t limit = 80;
    std::string result = "\"";
    for (const char character : text.substr(0, limit)) {
        const auto byte = static_cast<unsigned char>(character);
        if (byte < 0x20 || byte == 0x7f) {
            char escaped[8];
            std::snprintf(escaped, sizeof escaped, "\\u%04x", byte);
            result += escaped;
        } else {
            if (character == '"' || character == '\\')
                result += '\\';
            result += character;
        }
    }
    return result + (text.size() > limit ? "...\"" : "\"");
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
