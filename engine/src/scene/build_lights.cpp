// SPDX-License-Identifier: GPL-3.0-or-later
// The lights: emissive spheres, all emissive triangles as one, lamps, the environment.
#include "base/error.h"
#include "math/rounding.h"
#include "scene/builder.h"

#include <cmath>

namespace glimmer {

namespace {

constexpr float kDimmest = 1e-3f;               // radiance for which a triangle is chosen that seems to be dark
constexpr uint32_t kSkyWidth = 1024;            // of the picture by which a program's sky is sampled
constexpr size_t kMostLookedAtClosely = 50'000; // triangles whose light varies; of more, each is looked at once

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
    cone.times_cosine = light.times_cosine != 0;
    return cone;
}

/// A point lamp or a spot that has a size.
Light round_lamp(const LightDescription &light, const Vec3d &position, const Rgb &radiance) {
    if (light.disk)
        return DiskLamp{position, light.radius, radiance, cone_of(light)};
    return SphereLamp{{position, light.radius}, radiance, cone_of(light)};
}

LightFlags flags_of(const LightDescription &light) {
    return {RayMask(light.visible | mask_of(RayKind::shadow)), light.shadows != 0, light.max_bounces,
            uint8_t(light.light_group)};
}

/// Where the instance, as it is in float32, has a point of its mesh: rounded there, the edges of a small and distant
/// triangle would be noise.
Vec3d in_float64(const Instance &instance, const Vec3f &point) {
    const Vec3d p(point);
    return Vec3d(dot(Vec3d(instance.linear[0]), p), dot(Vec3d(instance.linear[1]), p),
                 dot(Vec3d(instance.linear[2]), p)) +
           Vec3d(instance.translation);
}

/// Sets what an environment's pixels are sampled by. Returns their mean over the sphere.
Rgb distribute(EnvironmentLight &light) {
    const uint32_t width = light.width, height = light.height;
    // Interpolation carries a texel's light to its neighbours: their weights must not be 0.
    std::vector<float> weights(light.pixels.size());
    Vec3d sum;
    double sines = 0;
    for (uint32_t y = 0; y < height; ++y) {
        const double sine = std::sin(kPiDouble * (y + 0.5) / height);
        for (uint32_t x = 0; x < width; ++x) {
            float around = 0;
            for (int dy = -1; dy <= 1; ++dy)
                for (int dx = -1; dx <= 1; ++dx) {
                    const uint32_t ny = uint32_t(std::clamp(int(y) + dy, 0, int(height) - 1));
                    const uint32_t nx = uint32_t((int64_t(x) + dx + width) % width);
                    around = std::max(around, mean_component(light.pixels[size_t(ny) * width + nx]));
                }
            const Rgb &pixel = light.pixels[size_t(y) * width + x];
            weights[size_t(y) * width + x] = std::max(mean_component(pixel), 0.25f * around) * float(sine);
            sum += Vec3d(double(pixel.r), double(pixel.g), double(pixel.b)) * sine;
            sines += sine;
        }
    }
    const Rgb mean(float(sum.x / sines), float(sum.y / sines), float(sum.z / sines));
    if (light.varying) // which may shine where no texel's middle does
        for (uint32_t i = 0; i < weights.size(); ++i)
            weights[i] += 1e-2f * mean_component(mean) * float(std::sin(kPiDouble * (i / width + 0.5) / height));
    light.distribution = Distribution2d(weights, width, height);
    return mean;
}

} // namespace

void SceneBuilder::add_sphere_lights(LightList &lights) const {
    const std::vector<Sphere> &spheres = scene_.accel->spheres();
    for (uint32_t i = 0; i < spheres.size(); ++i) {
        const uint32_t m = scene_.sphere_materials[i];
        const LightFlags flags{.visible = scene_.accel->visible_sphere(i),
                               .group = scene_.sphere_passes[i].light_group};
        if (scene_.materials[m].varying != Material::kConstant) {
            if (!shines_varying(m))
                continue;
            const Rgb mean = shaders()->mean_of_sphere(i);
            scene_.materials.set_mean_emission(m, max_component(mean) > kDimmest ? mean : Rgb(kDimmest));
            lights.add(SphereLight{spheres[i], scene_.materials.bounds(m).emission, i, shaders()}, flags);
            continue;
        }
        const Rgb &emission = scene_.materials.bounds(m).emission;
        if (!is_black(emission))
            lights.add(SphereLight{spheres[i], emission, i}, flags);
    }
}

ShaderScene *SceneBuilder::shaders() const {
    return scene_.materials.shaders.get();
}

bool SceneBuilder::shines_varying(uint32_t material) const {
    const uint32_t varying = scene_.materials[material].varying;
    return varying != Material::kConstant && shaders()->materials[varying].shines;
}

/// A triangle that shows nothing where it was looked at may shine elsewhere: every one gets a small chance.
Rgb SceneBuilder::mean_for_choice(uint32_t instance, uint32_t triangle, int side) const {
    const Rgb mean = shaders()->mean_of_triangle(instance, triangle, side);
    return max_component(mean) > kDimmest ? mean : Rgb(kDimmest);
}

void SceneBuilder::add_mesh_light(LightList &lights) const {
    MeshLight light;
    std::vector<double> power;
    const std::vector<Instance> &instances = scene_.accel->instances();
    light.first_of_instance.assign(instances.size(), kNone);
    Vec3d low(HUGE_VAL, HUGE_VAL, HUGE_VAL), high = -low;
    size_t varying = 0;
    for (const Instance &instance : instances)
        if (std::ranges::any_of(scene_.object_materials[instance.object],
                                [&](uint32_t m) { return shines_varying(m); }))
            varying += instance.mesh->triangles.size();
    const int side = varying > kMostLookedAtClosely ? 1 : 4;
    for (uint32_t i = 0; i < instances.size(); ++i) {
        const Instance &instance = instances[i];
        const std::vector<uint32_t> &materials = scene_.object_materials[instance.object];
        const auto varies = [&](uint32_t t) { return shines_varying(materials[instance.mesh->slot(t)]); };
        const auto emission = [&](uint32_t t) -> Rgb {
            if (varies(t))
                return mean_for_choice(i, t, side);
            return scene_.materials.bounds(materials[instance.mesh->slot(t)]).emission;
        };
        bool shines = false;
        for (uint32_t m : materials)
            shines |= !is_black(scene_.materials.bounds(m).emission) || shines_varying(m);
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
            out.visible = instance.visible;
            out.group = scene_.object_passes[instance.object].light_group;
            out.error = kSampledPointRounding * (local + max_abs(instance.translation));
            const double strength = area * double(mean_component(out.radiance));
            if (!(strength > 0)) {
                light.triangle_of.push_back(kNone);
                continue;
            }
            light.triangle_of.push_back(uint32_t(light.triangles.size()));
            light.triangles.push_back(out);
            if (scene_.materials.shaders)
                light.places.push_back(varies(t) ? MeshLight::Place{i, t} : MeshLight::Place{});
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
    light.varying = shaders();
    light.center = Vec3f((low + high) * 0.5);
    light.radius = float(length(high - low) * 0.5);
    lights.add(std::move(light), {});
}

/// Light subpaths leave a lamp before they know how far they go: what depends on that is left to camera paths.
void SceneBuilder::add_profile(uint32_t light, LightFlags &flags) {
    const std::optional<ParameterBinding> &profile = description_.lights[light].profile;
    if (!profile)
        return;
    flags.profile = light;
    flags.profile_mean = shaders()->mean_of_lamp(light);
    scene_.has_visibility = true;
    scene_.techniques_differ |= description_.programs[profile->program]->asks_ray_length();
}

void SceneBuilder::add_lamps(LightList &lights) {
    for (uint32_t i = 0; i < description_.lights.size(); ++i) {
        const LightDescription &l = description_.lights[i];
        const Rgb color = to_rgb(l.color);
        if (is_black(color)) {
            ++black_lights_;
            continue;
        }
        LightFlags flags = flags_of(l);
        add_profile(i, flags);
        const Vec3d position = to_vec(l.position) - origin_;
        switch (l.type) {
        case GLIMMER_POINT:
        case GLIMMER_SPOT:
            // So small that its radiance is beyond float32, it is a point.
            if (const double per_intensity = 1 / (kPiDouble * l.radius * l.radius);
                l.radius > 0 && per_intensity * double(max_component(color)) < 1e38)
                lights.add(round_lamp(l, position, color * float(per_intensity)), flags);
            else
                lights.add(PointLamp{Vec3f(position), color, cone_of(l)}, flags);
            break;
        case GLIMMER_SUN: {
            if (l.disk && l.angle > 0) {
                lights.add(TangentSunLamp(to_vec(l.direction), l.angle, color), flags);
                break;
            }
            SunLamp sun;
            sun.disk = SunDisk(to_vec(l.direction), l.angle);
            sun.irradiance = color;
            if (!sun.disk.is_delta())
                sun.radiance = color * float(1 / sun.disk.projected_solid_angle());
            lights.add(sun, flags);
            break;
        }
        case GLIMMER_AREA: {
            const Affine to_world = affine_from_rows(l.to_world);
            AreaLamp area{to_world.translation - origin_,
                          to_world.linear.column(0) * (l.size[0] * 0.5),
                          to_world.linear.column(1) * (l.size[1] * 0.5),
                          -normalize(to_world.linear.column(2)),
                          l.ellipse != 0,
                          color};
            if (l.spread < 180)
                area.set_spread(l.spread);
            lights.add(area, flags);
            break;
        }
        }
    }
}

/// A sky's sun as a lamp: so small a disc is not to be found by a picture of the sky.
void SceneBuilder::add_sun_of_sky(LightList &lights) {
    constexpr int kSide = 16; // of a grid on the disc
    SunLamp sun;
    sun.disk = SunDisk(description_.sky_sun->travels, description_.sky_sun->angle);
    for (int i = 0; i < kSide; ++i)
        for (int j = 0; j < kSide; ++j) {
            const Vec2f u{(float(i) + 0.5f) / kSide, (float(j) + 0.5f) / kSide};
            const Vec3f direction = sample_sun(sun.disk, u).wi;
            const Rgb with = shaders()->of_sky(direction, kFromDiffuse.flags, true),
                      without = shaders()->of_sky(direction, kFromDiffuse.flags, false);
            for (int c = 0; c < 3; ++c)
                sun.radiance[c] += std::max(with[c] - without[c], 0.0f) / (kSide * kSide);
        }
    sun.irradiance = sun.radiance * float(sun.disk.projected_solid_angle());
    if (!is_black(sun.irradiance))
        // The camera sees it in the sky.
        lights.add(sun, {.visible = RayMask(description_.environment_visible & ~mask_of(RayKind::camera)),
                         .group = description_.environment_light_group});
}

/// The program's radiance, which is sampled by a picture of it.
void SceneBuilder::add_sky(LightList &lights) {
    EnvironmentLight light;
    light.varying = shaders();
    light.color = Rgb(1);
    light.to_local = {Vec3f{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    light.width = kSkyWidth;
    light.height = kSkyWidth / 2;
    for (uint32_t y = 0; y < light.height; ++y) {
        const float theta = kPi * (float(y) + 0.5f) / float(light.height), sine = std::sin(theta);
        for (uint32_t x = 0; x < light.width; ++x) {
            const float phi = 2 * kPi * ((float(x) + 0.5f) / float(light.width) - 0.5f);
            const Vec3f direction{sine * std::sin(phi), sine * std::cos(phi), std::cos(theta)};
            light.pixels.push_back(radiance_at_infinity(light, direction, kFromDiffuse.flags));
        }
    }
    light.mean = distribute(light);
    if (is_black(light.mean)) {
        ++black_lights_;
        return;
    }
    lights.add(std::move(light),
               {.visible = description_.environment_visible, .group = description_.environment_light_group});
}

void SceneBuilder::add_environment(LightList &lights) {
    if (description_.sky) {
        if (description_.sky_sun)
            add_sun_of_sky(lights);
        add_sky(lights);
        return;
    }
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
        light.width = e.image->width;
        light.height = e.image->height;
        light.pixels = e.image->pixels;
        light.mean = e.color * distribute(light);
    }
    if (is_black(light.mean)) {
        ++black_lights_;
        return;
    }
    lights.add(std::move(light),
               {.visible = description_.environment_visible, .group = description_.environment_light_group});
}

/// usual: which rays see a light of its kind where nobody has said anything.
void SceneBuilder::note_flags(const LightFlags &flags, RayMask usual) {
    const bool limits = !flags.shadows || flags.max_bounces != kNone;
    scene_.has_visibility |= flags.visible != usual || limits;
    scene_.techniques_differ |= !is_visible_beyond_camera(flags.visible) || limits;
}

void SceneBuilder::build_lights() {
    LightList lights;
    add_sphere_lights(lights);
    add_mesh_light(lights);
    add_lamps(lights);
    add_environment(lights);
    for (size_t i = 0; i < lights.lights.size(); ++i) {
        const bool seen = traits(lights.lights[i]).camera_visible;
        note_flags(lights.flags[i], seen ? kEveryRay : RayMask(kEveryRay & ~mask_of(RayKind::camera)));
    }
    scene_.lights = LightSet(std::move(lights.lights), std::move(lights.flags), shaders());
}

} // namespace glimmer
