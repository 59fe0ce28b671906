// SPDX-License-Identifier: GPL-3.0-or-later
// Arrays of the scene: in place, as lists of lists, or the name of an .npy file.
#pragma once

#include "npy.h"
#include "scene_folder.h"
#include "value.h"

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

} // namespace glimmer
