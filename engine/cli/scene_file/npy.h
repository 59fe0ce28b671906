// SPDX-License-Identifier: GPL-3.0-or-later
// NumPy's .npy arrays, format versions 1 to 3 (numpy.lib.format).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace glimmer {

/// An array of numbers, its elements in C order whatever order the file has.
struct NpyArray {
    std::string dtype; ///< as NumPy writes it: "<f4"
    std::vector<size_t> shape;
    std::vector<double> values;    ///< of a float16, float32 or float64 array
    std::vector<int64_t> integers; ///< of an integer or boolean array

    bool is_float() const { return dtype.size() > 1 && dtype[1] == 'f'; }
    /// "(3, 4)"
    std::string shape_text() const;
};

/// Throws InputError "NAME: what"; nothing is allocated before the size of the file was compared with the shape.
NpyArray parse_npy(std::string_view bytes, const std::string &name);

} // namespace glimmer
