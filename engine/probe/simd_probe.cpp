// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrator/vpl/connect_simd.h"
#include "light/equiangular_table.h"
#include "probe.h"

#include <vector>

using namespace glimmer;
using namespace glimmer::probe;

static SimdMedium medium(const float *m) {
    return {m[0], m[1], m[2], m[3], m[0] == m[1] && m[1] == m[2]};
}
/// columns [6 or 9, n]: position, power, direction of flight.
static VertexColumns columns(const float *c, int directed, uint64_t n) {
    const float *d = directed ? c + 6 * n : nullptr;
    return {c, c + n, c + 2 * n, c + 3 * n, c + 4 * n, c + 5 * n, d, directed ? d + n : d, directed ? d + 2 * n : d};
}
static const ConnectKernels &connect_of(int wide) {
    return wide ? kConnectAvx512 : kConnectAvx2;
}

PROBE int probe_has_avx512() {
    return has_avx512();
}

/// m [4]: extinction by channel, g; point [6]; n a multiple of 16; means [n]; sums [20]: r, g, b, mean, mean by lane.
PROBE void probe_connect(int wide, const float *m, const float *vertices, int directed, uint64_t n, const float *point,
                         float clamp_distance, float *means, float *sums) {
    const GatherPoint p{point[0], point[1], point[2], point[3], point[4], point[5]};
    const ConnectionSums s = connect_of(wide).connect(medium(m), columns(vertices, directed, n), n, p, clamp_distance,
                                                      {means, nullptr, nullptr, nullptr});
    sums[0] = s.r, sums[1] = s.g, sums[2] = s.b, sums[3] = s.mean;
    for (size_t i = 0; i < kSimdLanes; ++i)
        sums[4 + i] = s.by_lane[i];
}

/// points [point_count, 6]; targets [n].
PROBE void probe_pick_targets(int wide, const float *m, const float *vertices, int directed, uint64_t n,
                              const float *points, uint64_t point_count, float clamp_distance, float *targets) {
    std::vector<GatherPoint> seen(point_count);
    for (size_t i = 0; i < point_count; ++i)
        seen[i] = {points[6 * i], points[6 * i + 1], points[6 * i + 2], 0, 0, 0};
    connect_of(wide).pick_targets(medium(m), columns(vertices, directed, n), n, seen.data(), point_count,
                                  clamp_distance, targets);
}

/// shape [8]: t_foot, h, h2, radius, distance, cut, x_first, x_step; density [17]: at the nodes, and the last source.
PROBE void probe_equiangular_nodes(int wide, const float *m, const double *shape, float *density) {
    const TableShape s{shape[0], shape[1], shape[2], shape[3], shape[4], shape[5], shape[6], shape[7]};
    const EquiangularNodes nodes = wide ? kEquiangularNodesAvx512 : kEquiangularNodesAvx2;
    density[kTableNodes] = nodes(medium(m), s, density);
}

/// sigma [2, 3]: absorption, scattering; segment [7]: origin, direction, t_max; light [4]: centre, radius; u, t, pdf
/// [n].
PROBE void probe_equiangular_table(const float *sigma, float g, const float *segment, const float *light,
                                   const float *u, uint64_t n, float *t, float *pdf) {
    const EquiangularTable table(HomogeneousMedium(load_rgb(sigma), load_rgb(sigma + 3), g), load3(segment),
                                 load3(segment + 3), segment[6], load3(light), light[3]);
    for (uint64_t i = 0; i < n; ++i) {
        const DistanceSample s = table.sample(u[i]);
        t[i] = s.t;
        pdf[i] = s.pdf;
    }
}
PROBE void probe_equiangular_table_pdf(const float *sigma, float g, const float *segment, const float *light,
                                       const float *t, uint64_t n, float *pdf) {
    const EquiangularTable table(HomogeneousMedium(load_rgb(sigma), load_rgb(sigma + 3), g), load3(segment),
                                 load3(segment + 3), segment[6], load3(light), light[3]);
    for (uint64_t i = 0; i < n; ++i)
        pdf[i] = table.pdf(t[i]);
}
