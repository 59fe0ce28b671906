// SPDX-License-Identifier: GPL-3.0-or-later
// Rays against 20 000 instanced plates: Embree alone, Accel, and Accel with the surface that the integrators want of a
// hit. The same rays for all: half from a camera, half scattered from random places between the plates.
#include "geometry/accel.h"
#include "inputs.h"
#include "plates.h"
#include "scene/scene.h"

#include <benchmark/benchmark.h>
#include <cmath>
#include <vector>

namespace glimmer {
namespace {

constexpr int kSide = 142; // plates along an edge of the field: 20 164
constexpr size_t kRays = 1 << 16;

std::vector<Ray> make_rays() {
    std::vector<Ray> rays(kRays);
    for (size_t i = 0; i < kRays; ++i) {
        const float u = uniform(3, i), v = uniform(4, i), w = uniform(5, i);
        if (i % 2 == 0) {
            rays[i].origin = {0, -4, 7.5f};
            rays[i].direction = normalize(Vec3f{1.3f * u - 0.65f, 1, 0.5f * v - 0.45f});
        } else {
            rays[i].origin = {200 * u - 100, 250 * v, 1.5f};
            const float z = 2 * w - 1, phi = 6.2831853f * uniform(6, i), r = std::sqrt(1 - z * z);
            rays[i].direction = {r * std::cos(phi), r * std::sin(phi), z};
        }
    }
    return rays;
}

struct World {
    Scene scene{plates(kSide), 0};
    std::vector<Ray> rays = make_rays();

    static const World &get() {
        static const World world;
        return world;
    }
};

/// The same instances in a scene of Embree's own, and nothing around it.
Bvh raw_scene(const Accel &accel) {
    const auto device = embree_device(0);
    const Bvh scene = new_bvh(*device);
    for (const Instance &instance : accel.instances()) {
        RTCGeometry geometry = rtcNewGeometry(device->handle(), RTC_GEOMETRY_TYPE_INSTANCE);
        rtcSetGeometryInstancedScene(geometry, instance.mesh->bvh(device).get());
        float rows[12];
        for (size_t r = 0; r < 3; ++r) {
            const Vec3f &row = instance.linear[r];
            rows[4 * r] = row.x, rows[4 * r + 1] = row.y, rows[4 * r + 2] = row.z;
            rows[4 * r + 3] = instance.translation[int(r)];
        }
        rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, rows);
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(scene.get(), geometry, unsigned(&instance - accel.instances().data()));
        rtcReleaseGeometry(geometry);
    }
    rtcCommitScene(scene.get());
    device->check("the benchmark's scene");
    return scene;
}

RTCRay embree_ray(const Ray &ray) {
    RTCRay r{};
    r.org_x = ray.origin.x, r.org_y = ray.origin.y, r.org_z = ray.origin.z;
    r.dir_x = ray.direction.x, r.dir_y = ray.direction.y, r.dir_z = ray.direction.z;
    r.tfar = ray.t_max;
    r.mask = ~0u;
    return r;
}

/// Runs trace(ray) -> bool over all rays; counts rays and the share of hits, which is to be the same for all.
template <class Trace>
void run(benchmark::State &state, const Trace &trace) {
    const std::vector<Ray> &rays = World::get().rays;
    size_t hits = 0;
    for (auto _ : state) {
        hits = 0;
        for (const Ray &ray : rays)
            hits += trace(ray);
        benchmark::DoNotOptimize(hits);
    }
    state.SetItemsProcessed(state.iterations() * int64_t(rays.size()));
    state.counters["hits"] = double(hits) / double(rays.size());
}

void embree_intersect(benchmark::State &state) {
    const Bvh scene = raw_scene(*World::get().scene.accel);
    const auto intersect = rtcIntersect1;
    run(state, [&](const Ray &ray) {
        RTCRayHit query;
        query.ray = embree_ray(ray);
        query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        intersect(scene.get(), &context, &query);
        return query.hit.geomID != RTC_INVALID_GEOMETRY_ID;
    });
}
BENCHMARK(embree_intersect);

void accel_intersect(benchmark::State &state) {
    const Accel &accel = *World::get().scene.accel;
    run(state, [&](const Ray &ray) { return accel.intersect(ray, RayKind::camera).has_value(); });
}
BENCHMARK(accel_intersect);

void accel_intersect_and_interaction(benchmark::State &state) {
    const Scene &scene = World::get().scene;
    run(state, [&](const Ray &ray) {
        const auto hit = scene.accel->intersect(ray, RayKind::camera);
        if (hit)
            benchmark::DoNotOptimize(scene.interaction(ray, *hit));
        return hit.has_value();
    });
}
BENCHMARK(accel_intersect_and_interaction);

void embree_occluded(benchmark::State &state) {
    const Bvh scene = raw_scene(*World::get().scene.accel);
    const auto occluded = rtcOccluded1;
    run(state, [&](const Ray &ray) {
        RTCRay query = embree_ray(ray);
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        occluded(scene.get(), &context, &query);
        return query.tfar < 0;
    });
}
BENCHMARK(embree_occluded);

void accel_occluded(benchmark::State &state) {
    const Accel &accel = *World::get().scene.accel;
    run(state, [&](const Ray &ray) { return accel.occluded(ray, RayKind::shadow); });
}
BENCHMARK(accel_occluded);

} // namespace
} // namespace glimmer
