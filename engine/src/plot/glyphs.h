// SPDX-License-Identifier: GPL-3.0-or-later
// A font as a table of pixels: the letters of plots, wherever no font file can be relied upon.
#pragma once

#include <array>
#include <cstddef>

namespace glimmer {

struct Glyph {
    int advance;          ///< to the next letter's origin, in pixels
    int left, top;        ///< of the first pixel: right of the origin, above the baseline
    int width, height;    ///< in pixels
    const char *coverage; ///< (height, width) hexadecimal digits, 0: not covered, f: fully
};

/// Printable ASCII.
constexpr char kFirstGlyph = ' ', kLastGlyph = '~';
constexpr int kCapitalHeight = 11; ///< of letters and digits above the baseline, in pixels

extern const std::array<Glyph, 1 + kLastGlyph - kFirstGlyph> kGlyphs;

/// A question mark stands for what the table has not.
inline const Glyph &glyph(char c) {
    return kGlyphs[size_t((c >= kFirstGlyph && c <= kLastGlyph ? c : '?') - kFirstGlyph)];
}

} // namespace glimmer
