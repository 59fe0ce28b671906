// SPDX-License-Identifier: GPL-3.0-or-later
// Small pieces of text for messages.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace glimmer {

/// In double quotes, what is not printable UTF-8 escaped, cut after some 80 bytes: any text as part of a one-line
/// message.
std::string in_quotes(std::string_view text);

/// A library's message as part of a one-line message: control characters become spaces, bytes beyond ASCII "?".
std::string one_line(std::string text);

/// "\"a\", \"b\"": each quoted; after eight names "and 12 more"; "none" when there are none.
std::string quoted_list(std::span<const std::string> names);

/// The shortest text that reads back as the same number.
std::string number_text(double value);

/// "0:07", "12:03" or "3:04:05".
std::string clock_text(double seconds);

/// "3 vertices", "1 vertex".
std::string count_text(unsigned long long count, std::string_view one, std::string_view many);

} // namespace glimmer
