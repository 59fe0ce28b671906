// SPDX-License-Identifier: GPL-3.0-or-later
#include "json_syntax.h"

#include "text.h"

#include <array>

namespace glimmer {
namespace {

constexpr std::string_view kValue = "a number, a text in double quotes, true, false, null, [...] or {...}";

struct Context {
    std::string_view name;    ///< the library's
    std::string_view allowed; ///< there
};
constexpr std::array kContexts{Context{"object key", "a key in double quotes (and no comma before a closing brace)"},
                               Context{"object separator", "a colon, between a key and its value"},
                               Context{"object", "a comma or a closing brace }"},
                               Context{"array", "a comma or a closing bracket ]"}, Context{"value", kValue}};

std::string between(const std::string &text, const std::string &start, const std::string &end) {
    const size_t mark = text.find(start);
    if (mark == std::string::npos)
        return "";
    const size_t from = mark + start.size();
    return text.substr(from, text.find(end, from) - from);
}

/// What the library calls unexpected: "string literal", "number literal", "'}'", "end of input", ...
std::string token(const std::string &kind) {
    if (kind == "end of input")
        return "the end of the file";
    if (kind == "string literal")
        return "a text";
    if (kind == "number literal")
        return "a number";
    return kind.substr(0, kind.find(" literal"));
}

} // namespace

std::string describe_syntax_error(const std::string &library, std::string_view read) {
    const std::string context = between(library, "while parsing ", " - ");
    std::string_view allowed = kValue;
    for (const Context &known : kContexts)
        if (known.name == context)
            allowed = known.allowed;
    if (library.find("; expected end of input") != std::string::npos)
        allowed = "nothing more, after the closing brace of the scene";
    const auto instead_of = [&](const std::string &what) {
        return "syntax error: " + what + " is not allowed here; allowed is " + std::string(allowed);
    };
    const std::string detail = between(library, " - ", "; last read");
    if (detail.starts_with("unexpected "))
        return one_line(instead_of(token(between(detail, "unexpected ", ";"))));
    if (detail.starts_with("invalid literal") && !read.empty())
        return one_line(instead_of(in_quotes(read.substr(read.size() - 1))));
    if (detail.find("forbidden character after backslash") != std::string::npos)
        return R"(syntax error: forbidden character after a backslash; allowed are \" \\ \/ \b \f \n \r \t and \uXXXX)";
    return one_line("syntax error: " + (detail.empty() ? library : detail));
}

} // namespace glimmer
