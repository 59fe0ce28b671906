# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws DejaVu Sans as the table in glyphs.cpp: python3 make_glyphs.py DejaVuSans.ttf > glyphs.cpp

Needs freetype-py. The engine and its build need neither this script nor a font: run it for another size or font.
"""

import sys
import textwrap

import freetype

SIZE = 15  # pixels an em

HEAD = """\
// SPDX-License-Identifier: GPL-3.0-or-later
// Made by make_glyphs.py from {family} {style} at {size} pixels an em: edit that.
#include "plot/glyphs.h"

namespace glimmer {{

// clang-format off
const std::array<Glyph, 1 + kLastGlyph - kFirstGlyph> kGlyphs{{{{
"""
TAIL = """\
}};
// clang-format on

} // namespace glimmer
"""


def row(face: freetype.Face, character: str) -> str:
    face.load_char(character, freetype.FT_LOAD_RENDER)
    slot = face.glyph
    bitmap = slot.bitmap
    lines = [bitmap.buffer[y * bitmap.pitch :][: bitmap.width] for y in range(bitmap.rows)]
    digits = "".join(f"{(value * 15 + 127) // 255:x}" for line in lines for value in line)
    numbers = f"{slot.advance.x // 64}, {slot.bitmap_left}, {slot.bitmap_top}, {bitmap.width}, {bitmap.rows}"
    name = {" ": "space", "\\": "backslash"}.get(character, character)
    literals = "\n".join(f'     "{part}"' for part in textwrap.wrap(digits, 100) or [""])
    return f"    {{{numbers}, // {name}\n{literals}}},\n"


def main() -> None:
    face = freetype.Face(sys.argv[1])
    face.set_pixel_sizes(0, SIZE)
    sys.stdout.write(HEAD.format(family=face.family_name.decode(), style=face.style_name.decode(), size=SIZE))
    sys.stdout.writelines(row(face, chr(code)) for code in range(ord(" "), ord("~") + 1))
    sys.stdout.write(TAIL)


if __name__ == "__main__":
    main()
