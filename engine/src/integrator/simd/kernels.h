// SPDX-License-Identifier: GPL-3.0-or-later
// The inner loops over light vertices and over the nodes of line tables, sixteen lanes at a time. Compiled for AVX2 and
// for AVX-512, with the same bits; the processor decides which is run.
#pragma once

#include <cstddef>

namespace glimmer {

inline constexpr size_t kSimdLanes = 16; ///< counts are multiples of it

/// What the loops ask of a medium. Extinction by channel, per length.
struct SimdMedium {
    float sigma_r, sigma_g, sigma_b;
    float g;
    bool monochromatic; ///< only sigma_r is read
};

/// Vertices of light paths in the medium, a column for each number; see MediumVertices.
struct VertexColumns {
    const float *x, *y, *z;
    const float *r, *g, *b;
    const float *dx, *dy, *dz; ///< null: the medium scatters evenly
};

/// A place in the medium, and which way the camera looks there.
struct SeenPoint {
    float x, y, z;
    float seen_x, seen_y, seen_z;
};

/// The bounded connections of a point to so many vertices.
struct ConnectionSums {
    float r, g, b;
    float part;                ///< of the means over the channels
    float by_lane[kSimdLanes]; ///< the same, of the vertices lane, lane + 16, lane + 32, ...
};

/// A segment and a light, as the table of EquiangularTable needs them. Lengths.
struct TableShape {
    double t_foot;          ///< of the light's centre on the line
    double h;               ///< softened distance of the centre to the line
    double h2;              ///< squared distance, as it is
    double radius;          ///< of the light
    double distance;        ///< of its centre from where the segment starts
    double cut;             ///< where the table ends
    double x_first, x_step; ///< of its nodes
};

inline constexpr size_t kTableNodes = 16;

struct SimdKernels {
    const char *name; ///< of the instruction set
    /// count: a multiple of 16. Writes the parts, and returns the sums, of
    /// power e^(-sigma d) / (d^2 + bound^2) and the phase functions at both ends.
    ConnectionSums (*connect)(const SimdMedium &medium, const VertexColumns &vertices, size_t count,
                              const SeenPoint &point, float bound, float *parts);
    /// count: a multiple of 16. What each vertex would bring to all points, per unit of its power, at mean extinction
    /// and with bounds `soften`.
    void (*weigh)(const SimdMedium &medium, const VertexColumns &vertices, size_t count, const SeenPoint *points,
                  size_t point_count, float soften, float *targets);
    /// Writes the density per x at the nodes (kTableNodes,) and returns that per t / h at the cut, up to one common
    /// factor.
    float (*table_nodes)(const SimdMedium &medium, const TableShape &shape, float *density);
};

extern const SimdKernels kSimdKernelsAvx2, kSimdKernelsAvx512;

/// Null where this processor has no AVX-512.
const SimdKernels *simd_kernels_avx512();
/// The widest that this processor has.
const SimdKernels &simd_kernels();

} // namespace glimmer
