// SPDX-License-Identifier: GPL-3.0-or-later
// Affine maps in float64, kept as a 3x3 linear part and a translation: L * (o - c) loses no digits far from the origin,
// where a composed 3x4 inverse would.
#pragma once

#include "math/vec.h"

#include <array>

namespace glimmer {

struct Linear {
    std::array<Vec3d, 3> rows{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

    Vec3d operator*(const Vec3d &v) const { return {dot(rows[0], v), dot(rows[1], v), dot(rows[2], v)}; }
    Vec3d column(int i) const { return {rows[0][i], rows[1][i], rows[2][i]}; }
    Linear operator*(const Linear &b) const {
        Linear m;
        for (size_t i = 0; i < 3; ++i)
            m.rows[i] = {dot(rows[i], b.column(0)), dot(rows[i], b.column(1)), dot(rows[i], b.column(2))};
        return m;
    }
    double determinant() const { return dot(rows[0], cross(rows[1], rows[2])); }
    /// Cofactor matrix = det(L) * L^-T: carries normals without a division, and flips them where L mirrors.
    Linear cofactor() const { return {{cross(rows[1], rows[2]), cross(rows[2], rows[0]), cross(rows[0], rows[1])}}; }
    Linear transposed() const { return {{column(0), column(1), column(2)}}; }
};

struct Affine {
    Linear linear;
    Vec3d translation;

    Vec3d operator*(const Vec3d &p) const { return linear * p + translation; }
    Affine operator*(const Affine &b) const { return {linear * b.linear, linear * b.translation + translation}; }
};

/// From a row-major 4x4 or 3x4 matrix (column vectors); the last row of a 4x4 is the caller's to check.
template <class T>
Affine affine_from_rows(const T *m) {
    Affine a;
    for (size_t i = 0; i < 3; ++i)
        a.linear.rows[i] = {double(m[4 * i]), double(m[4 * i + 1]), double(m[4 * i + 2])};
    a.translation = {double(m[3]), double(m[7]), double(m[11])};
    return a;
}

} // namespace glimmer
