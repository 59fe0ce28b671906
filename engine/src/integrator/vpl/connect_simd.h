// SPDX-License-Identifier: GPL-3.0-or-later
// Connections between gather points and light vertices in the medium, sixteen vertices at a time; how such code is
// compiled and chosen: math/simd/instruction_set.h.
#pragma once

#include "math/simd/instruction_set.h"
#include "medium/simd_medium.h"

#include <cstddef>

namespace glimmer {

/// Light vertices in the medium, one array for each number; see MediumVertices.
struct VertexColumns {
    const float *x, *y, *z;    ///< position
    const float *r, *g, *b;    ///< power
    const float *dx, *dy, *dz; ///< unit direction of flight; null in an isotropic medium
};

/// Places alone, as three arrays.
struct PointColumns {
    const float *x, *y, *z;
};

/// A gather point, and the direction in which the camera path looks there.
struct GatherPoint {
    float x, y, z;
    float view_x, view_y, view_z; ///< unit
};

/// The bounded connections of one gather point to a number of vertices.
struct ConnectionSums {
    float r, g, b;
    float mean;                ///< sum of the vertices' means over the channels
    float by_lane[kSimdLanes]; ///< the same, of the vertices lane, lane + 16, lane + 32, ...
};

/// Where the connections to each vertex go, one array for each number.
struct ConnectionParts {
    float *mean;                ///< over the channels
    float *r, *g, *b = nullptr; ///< null: not wanted
};

struct ConnectKernels {
    const char *name; ///< of the instruction set
    /// Equation (1) of docs/method.md for `count` vertices, a multiple of 16: power times e^(-sigma d) / (d^2 + d0^2)
    /// times the phase functions at both ends. Returns the sums.
    ConnectionSums (*connect)(const SimdMedium &medium, const VertexColumns &vertices, size_t count,
                              const GatherPoint &point, float clamp_distance, const ConnectionParts &parts);
    /// For each of `count` vertices, a multiple of 16: what it would bring to all points together per unit of its
    /// power, at the mean extinction of the channels and whatever the points' view.
    void (*pick_targets)(const SimdMedium &medium, const VertexColumns &vertices, size_t count,
                         const GatherPoint *points, size_t point_count, float clamp_distance, float *targets);
    /// sum_q e^(-kappa |x - q|) / sqrt(|x - q|^2 + softening2) over `count` points q, a multiple of 16
    /// (importance_map.h).
    float (*diffuse)(const PointColumns &points, size_t count, float x, float y, float z, float kappa,
                     float softening2);
};

extern const ConnectKernels kConnectAvx2, kConnectAvx512;

/// Those for the widest instruction set that this processor has.
const ConnectKernels &connect_kernels();

} // namespace glimmer
