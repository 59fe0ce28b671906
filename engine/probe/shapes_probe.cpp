// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/shapes/ellipse.h"
#include "light/shapes/rectangle.h"
#include "light/shapes/sphere.h"
#include "light/shapes/sun.h"
#include "light/shapes/triangle.h"
#include "probe.h"

using namespace glimmer;
using namespace glimmer::probe;

enum Shape { Sphere, Rectangle, Ellipse, Triangle, Sun };

/// shape [9]: sphere: centre, radius; rectangle: corner, two edges; ellipse: centre, two half axes; triangle: corners;
/// sun: the direction its light travels in, full angle in degrees.
static std::optional<DirectionSample> draw(int kind, const double *shape, Vec2f u) {
    switch (kind) {
    case Sphere:
        return sample_sphere(load3(shape), shape[3], u);
    case Rectangle:
        return sample_rectangle({load3(shape), load3(shape + 3), load3(shape + 6)}, u);
    case Ellipse:
        return sample_ellipse({load3(shape), load3(shape + 3), load3(shape + 6)}, u);
    case Triangle:
        return sample_triangle(load3(shape), load3(shape + 3), load3(shape + 6), u);
    default:
        return sample_sun(SunDisk(load3(shape), shape[3]), u);
    }
}
static float density(int kind, const double *shape, const Vec3f &wi) {
    switch (kind) {
    case Sphere:
        return pdf_sphere(load3(shape), shape[3]);
    case Rectangle:
        return pdf_rectangle({load3(shape), load3(shape + 3), load3(shape + 6)}, wi);
    case Ellipse:
        return pdf_ellipse({load3(shape), load3(shape + 3), load3(shape + 6)}, wi);
    case Triangle:
        return pdf_triangle(load3(shape), load3(shape + 3), load3(shape + 6), wi);
    default:
        return pdf_sun(SunDisk(load3(shape), shape[3]), wi);
    }
}

PROBE void probe_shape_sample(int kind, const double *shape, const float *u, uint64_t n, float *wi, float *distance,
                              float *pdf, int32_t *found) {
    for (uint64_t i = 0; i < n; ++i) {
        const auto s = draw(kind, shape, load2(u + 2 * i));
        found[i] = s.has_value();
        if (!s)
            continue;
        store(wi + 3 * i, s->wi);
        distance[i] = s->distance;
        pdf[i] = s->pdf;
    }
}
PROBE void probe_shape_pdf(int kind, const double *shape, const float *wi, uint64_t n, float *pdf) {
    for (uint64_t i = 0; i < n; ++i)
        pdf[i] = density(kind, shape, load3(wi + 3 * i));
}
PROBE double probe_solid_angle(const double *shape) {
    return SphericalRectangle({load3(shape), load3(shape + 3), load3(shape + 6)}).solid_angle();
}
PROBE double probe_sun_projected_solid_angle(const double *shape) {
    return SunDisk(load3(shape), shape[3]).projected_solid_angle();
}
