// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/camera.h"
#include "probe.h"

using namespace glimmer;
using namespace glimmer::probe;

struct probe_camera {
    int32_t type; // 0 perspective, 1 orthographic, 2 panoramic
    float right[3], up[3], forward[3];
    float half_width, aspect, shift[2], lens_radius, focus_distance, clip_start, clip_end;
    int32_t panorama; // PanoramaType
    float longitude[2], latitude[2], half_angle, focal_length, polynomial[5], window[4];
    uint32_t blades;
    float rotation, scale[2]; // of the aperture
};

static Aperture aperture(const probe_camera &c) {
    return {c.blades, c.rotation, load2(c.scale)};
}

static Camera camera(const probe_camera &c) {
    const CameraBase base{load3(c.right), load3(c.up),      load3(c.forward), c.half_width, c.aspect, load2(c.shift),
                          c.lens_radius,  c.focus_distance, c.clip_start,     c.clip_end,   {},       aperture(c)};
    if (c.type == 1)
        return OrthographicCamera{base};
    if (c.type == 2) {
        Panorama p;
        p.type = PanoramaType(c.panorama);
        p.window = {load2(c.window), load2(c.window + 2)};
        p.aspect = c.aspect;
        std::copy_n(c.longitude, 2, p.longitude);
        std::copy_n(c.latitude, 2, p.latitude);
        p.half_angle = c.half_angle;
        p.focal_length = c.focal_length;
        std::copy_n(c.polynomial, 5, p.polynomial.begin());
        p.reach = p.farthest({});
        return PanoramicCamera{base, p};
    }
    return PerspectiveCamera{base};
}

/// film, lens [n, 2]; rays [n, 7]: origin, direction, length.
PROBE void probe_camera_generate(const probe_camera *c, const float *film, const float *lens, uint64_t n, float *rays) {
    for (uint64_t i = 0; i < n; ++i) {
        const Ray ray = camera(*c).generate(load2(film + 2 * i), load2(lens + 2 * i), {}).ray;
        store(rays + 7 * i, ray.origin);
        store(rays + 7 * i + 3, ray.direction);
        rays[7 * i + 6] = ray.t_max;
    }
}

/// disk [n, 2]; points of the aperture [n, 2].
PROBE void probe_camera_lens(const probe_camera *c, const float *disk, uint64_t n, float *points) {
    for (uint64_t i = 0; i < n; ++i) {
        const Vec2f point = aperture(*c).point(load2(disk + 2 * i));
        points[2 * i] = point.x, points[2 * i + 1] = point.y;
    }
}
/// points [n, 2]; inside [n].
PROBE void probe_camera_is_on_lens(const probe_camera *c, const float *points, uint64_t n, int32_t *inside) {
    for (uint64_t i = 0; i < n; ++i)
        inside[i] = aperture(*c).contains(load2(points + 2 * i));
}
PROBE float probe_camera_lens_area(const probe_camera *c) {
    return aperture(*c).area();
}

/// film [n, 2]; seen [n]: whether the ray is not blind.
PROBE void probe_camera_is_seeing(const probe_camera *c, const float *film, uint64_t n, int32_t *seeing) {
    for (uint64_t i = 0; i < n; ++i)
        seeing[i] = !camera(*c).generate(load2(film + 2 * i), {}, {}).is_blind();
}

/// film [2]; places [n, 2], the rest is left as it is; returns how many there are.
PROBE uint64_t probe_camera_places(const probe_camera *c, const float *film, uint64_t n, float *places) {
    uint64_t count = 0;
    camera(*c).for_each_place(load2(film), [&](Vec2f at) {
        if (count < n)
            store(places + 2 * count, at);
        ++count;
    });
    return count;
}

PROBE int32_t probe_camera_is_invertible(const probe_camera *c) {
    return camera(*c).is_invertible({});
}

/// x [n, 3], lens [n, 2]; seen [n]; film [n, 2]; rays [n, 7] as above, to the point; area [n]: of the whole film.
PROBE void probe_camera_project(const probe_camera *c, const float *x, const float *lens, uint64_t n, int32_t *seen,
                                float *film, float *rays, float *area) {
    for (uint64_t i = 0; i < n; ++i) {
        const auto p = camera(*c).project(load3(x + 3 * i), load2(lens + 2 * i), {});
        seen[i] = p.has_value();
        if (!p)
            continue;
        store(film + 2 * i, p->film);
        store(rays + 7 * i, p->start);
        store(rays + 7 * i + 3, p->direction);
        rays[7 * i + 6] = p->t;
        area[i] = p->area(1);
    }
}

/// rays [n, 7] as above; film [4]: begin and end of the part; parts [n, 2].
PROBE void probe_camera_clip(const probe_camera *c, const float *rays, const float *film, uint64_t n, float *parts) {
    for (uint64_t i = 0; i < n; ++i) {
        const float *r = rays + 7 * i;
        const RayInterval part = camera(*c).clip({load3(r), load3(r + 3), {}, r[6]}, {load2(film), load2(film + 2)});
        store(parts + 2 * i, Vec2f{part.begin, part.end});
    }
}

/// ray [7] as above, part [2], u [n]; t, pdf [n].
PROBE void probe_camera_sample_seen(const probe_camera *c, const float *ray, const float *part, float extinction,
                                    const float *u, uint64_t n, float *t, float *pdf) {
    for (uint64_t i = 0; i < n; ++i) {
        const PointOnRay at =
            camera(*c).sample_seen({load3(ray), load3(ray + 3), {}, ray[6]}, {part[0], part[1]}, extinction, u[i]);
        t[i] = at.t, pdf[i] = at.pdf;
    }
}

/// sphere [4]: centre and radius; film [n, 2]; seen [n].
PROBE void probe_camera_sees(const probe_camera *c, const float *sphere, const float *film, uint64_t n, int32_t *seen) {
    const auto silhouette = camera(*c).silhouette(load3(sphere), sphere[3], 0);
    for (uint64_t i = 0; i < n; ++i)
        seen[i] = silhouette && camera(*c).sees_any({*silhouette}, load2(film + 2 * i));
}

/// region [4]: centre and radius.
PROBE void probe_camera_start_region(const probe_camera *c, float *region) {
    const StartRegion r = camera(*c).start_region();
    store(region, r.center);
    region[3] = r.radius;
}
