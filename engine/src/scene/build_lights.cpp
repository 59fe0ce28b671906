// SPDX-License-Identifier: GPL-3.0-or-later
// The lights: emissive spheres, all emissive triangles as one, lamps, the environment.
#include "base/error.h"
#include "math/rounding.h"
#include "scene/builder.h"

#include <cmath>

namespace glimmer {

namespace {

Rgb to_rgb(const float (&c)[3]) {
    return {c[0], c[1], c[2]};
}

Vec3d to_vec(const double (&v)[3]) {
    return {v[0], v[1], v[2]};
}

std::optional<SpotCone> cone_of(const LightDescription &light) {
    if (light.type != GLIMMER_SPOT)
        return std::nullopt;
    SpotCone cone;
    cone.direction = Vec3f(normalize(to_vec(light.direction)));
    const double cos_half = std::cos(light.angle * kPiDouble / 360);
    cone.cos_half = float(cos_half);
    cone.smooth = float((1 - cos_half) * light.blend);
    return cone;
}

/// Where the instance, as it is in float32, has a point of its mesh: rounded there, the edges of a small and distant
/// triangle would be noise.
Vec3d in_float64(const Instance &instance, const Vec3f &point) {
    const Vec3d p(point);
    return Vec3d(dot(Vec3d(instance.linear[0]), p), dot(Vec3d(instance.linear[1]), p),
                 dot(Vec3d(instance.linear[2]), p)) +
           Vec3d(instance.translation);
}

} // namespace

void SceneBuilder::add_sphere_lights(std::vector<Light> &lights) const {
    const std::vector<Sphere> &spheres = scene_.accel->spheres();
    for (uint32_t i = 0; i < spheres.size(); ++i) {
        const Rgb &emission = scene_.materials.bounds(scene_.sphere_materials[i]).emission;
        if (!is_black(emission))
            lights.push_back(SphereLight{spheres[i], emission, i});
    }
}

void SceneBuilder::add_mesh_light(std::vector<Light> &lights) const {
    MeshLight light;
    std::vector<double> power;
    const std::vector<Instance> &instances = scene_.accel->instances();
    light.first_of_instance.assign(instances.size(), kNone);
    Vec3d low(HUGE_VAL, HUGE_VAL, HUGE_VAL), high = -low;
    for (uint32_t i = 0; i < instances.size(); ++i) {
        const Instance &instance = instances[i];
        const std::vector<uint32_t> &materials = scene_.object_materials[instance.object];
        const auto emission = [&](uint32_t t) -> const Rgb & {
            return scene_.materials.bounds(materials[instance.mesh->slot(t)]).emission;
        };
        bool shines = false;
        for (uint32_t m : materials)
            shines |= !is_black(scene_.materials.bounds(m).emission);
        if (!shines)
            continue;
        light.first_of_instance[i] = uint32_t(light.triangle_of.size());
        for (uint32_t t = 0; t < instance.mesh->triangles.size(); ++t) {
            MeshLight::Triangle out;
            float local = 0;
            for (size_t k = 0; k < 3; ++k) {
                const Vec3f &v = instance.mesh->vertices[instance.mesh->triangles[t][k]];
                out.vertices[k] = in_float64(instance, v);
                local = std::max(local, max_abs(Vec3f(out.vertices[k])));
            }
            const auto &[a, b, c] = out.vertices;
            const double area = 0.5 * length(cross(b - a, c - a));
            out.radiance = emission(t);
            out.error = kSampledPointRounding * (local + max_abs(instance.translation));
            const double strength = area * double(mean_component(out.radiance));
            if (!(strength > 0)) {
                light.triangle_of.push_back(kNone);
                continue;
            }
            light.triangle_of.push_back(uint32_t(light.triangles.size()));
            light.triangles.push_back(out);
            light.intensity += out.radiance * float(area);
            power.push_back(strength);
            for (const Vec3d &v : {a, b, c}) {
                low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
                high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
            }
        }
    }
    if (power.empty())
        return;
    light.choice = AliasTable(power);
    light.center = Vec3f((low + high) * 0.5);
    light.radius = float(length(high - low) * 0.5);
    lights.push_back(std::move(light));
}

void SceneBuilder::add_lamps(std::vector<Light> &lights) {
    for (const LightDescription &l : description_.lights) {
        const Rgb color = to_rgb(l.color);
        if (is_black(color)) {
            ++black_lights_;
            continue;
        }
        const Vec3d position = to_vec(l.position) - origin_;
        switch (l.type) {
        case GLIMMER_POINT:
        case GLIMMER_SPOT:
            // So small that its radiance is beyond float32, it is a point.
            if (const double per_intensity = 1 / (kPiDouble * l.radius * l.radius);
                l.radius > 0 && per_intensity * double(max_component(color)) < 1e38)
                lights.push_back(SphereLamp{{position, l.radius}, color * float(per_intensity), cone_of(l)});
            else
                lights.push_back(PointLamp{Vec3f(position), color, cone_of(l)});
            break;
        case GLIMMER_SUN: {
            SunLamp sun;
            sun.disk = SunDisk(to_vec(l.direction), l.angle);
            sun.irradiance = color;
            if (!sun.disk.is_delta())
                sun.radiance = color * float(1 / sun.disk.projected_solid_angle());
            lights.push_back(sun);
            break;
        }
        case GLIMMER_AREA: {
            const Affine to_world = affine_from_rows(l.to_world);
            lights.push_back(AreaLamp{to_world.translation - origin_, to_world.linear.column(0) * (l.size[0] * 0.5),
                                      to_world.linear.column(1) * (l.size[1] * 0.5),
                                      -normalize(to_world.linear.column(2)), l.ellipse != 0, color});
            break;
        }
        }
    }
}

void SceneBuilder::add_environment(std::vector<Light> &lights) {
    if (!description_.environment)
        return;
    const EnvironmentDescription &e = *description_.environment;
    EnvironmentLight light;
    light.color = e.color;
    const Linear to_local = e.to_world.transposed();
    for (size_t r = 0; r < 3; ++r)
        light.to_local[r] = Vec3f(to_local.rows[r]);
    light.mean = e.color;
    if (e.image) {
        const Image &image = *e.image;
        light.width = image.width;
        light.height = image.height;
        light.pixels = image.pixels;
        // Interpolation carries a texel's light to its neighbours: their weights must not be 0.
        std::vector<float> weights(image.pixels.size());
        Vec3d sum;
        double sines = 0;
        for (uint32_t y = 0; y < image.height; ++y) {
            const double sine = std::sin(kPiDouble * (y + 0.5) / image.height);
            for (uint32_t x = 0; x < image.width; ++x) {
                float around = 0;
                for (int dy = -1; dy <= 1; ++dy)
                    for (int dx = -1; dx <= 1; ++dx) {
                        const uint32_t ny = uint32_t(std::clamp(int(y) + dy, 0, int(image.height) - 1));
                        const uint32_t nx = uint32_t((int64_t(x) + dx + image.width) % image.width);
                        around = std::max(around, mean_component(image.pixels[size_t(ny) * image.width + nx]));
                    }
                const Rgb &pixel = image.pixels[size_t(y) * image.width + x];
                weights[size_t(y) * image.width + x] = std::max(mean_component(pixel), 0.25f * around) * float(sine);
                sum += Vec3d(double(pixel.r), double(pixel.g), double(pixel.b)) * sine;
                sines += sine;
            }
        }
        light.distribution = Distribution2d(weights, image.width, image.height);
        light.mean = e.color * Rgb(float(sum.x / sines), float(sum.y / sines), float(sum.z / sines));
    }
    if (is_black(light.mean)) {
        ++black_lights_;
        return;
    }
    lights.push_back(std::move(light));
}

void SceneBuilder::build_lights() {
    std::vector<Light> lights;
    add_sphere_lights(lights);
    add_mesh_light(lights);
    add_lamps(lights);
    add_environment(lights);
    scene_.lights = LightSet(std::move(lights));
}

} // namespace glimmer
