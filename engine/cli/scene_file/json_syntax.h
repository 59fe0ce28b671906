// SPDX-License-Identifier: GPL-3.0-or-later
// What is wrong with a text that is not JSON, in words for people who write scene files by hand.
#pragma once

#include <string>
#include <string_view>

namespace glimmer {

/// library: the message of nlohmann::json's parser, "... while parsing CONTEXT - DETAIL; ...". read: the text up to and
/// with the character at which it stopped. The result is one line: what is wrong, and what is allowed instead.
std::string describe_syntax_error(const std::string &library, std::string_view read);

} // namespace glimmer
