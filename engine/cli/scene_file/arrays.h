// SPDX-License-Identifier: GPL-3.0-or-later
// Arrays of the scene: in place, as lists of lists, or the name of an .npy file.
#pragma once

#include "glimmer.h"
#include "npy.h"
#include "scene_folder.h"
#include "value.h"

#include <deque>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace glimmer {

/// (n, width) float64, flat, all finite.
std::vector<double> read_float_array(const Value &value, size_t width, SceneFolder &folder);

/// (n, width) integers from 0 to `limit`, flat; width 0: (n).
std::vector<uint32_t> read_index_array(const Value &value, size_t width, uint32_t limit, SceneFolder &folder);

/// An .npy file that a value names: floats, of this shape; extents of 0 may be anything, named in `allowed`.
/// All finite.
NpyArray read_float_npy(const Value &value, const std::vector<std::vector<size_t>> &shapes, const std::string &allowed,
                        SceneFolder &folder);

/// Attributes by name for shader programs, each (rows, 1 to 4) from an .npy file.
struct Attributes {
    std::deque<std::string> names;
    std::deque<std::vector<float>> values;
    std::vector<glimmer_attribute> list; ///< for the engine; looks at the others
};

/// rows_of: how many rows an attribute of a domain must have ("vertex", "corner", "face"); a table of one domain alone
/// needs no word for it.
Attributes read_attributes(const Value &table, std::span<const std::pair<std::string_view, size_t>> rows_of,
                           glimmer_attribute_domain first, SceneFolder &folder);

} // namespace glimmer
