// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrator/vpl/subpath_starts.h"

#include "integrator/dielectrics_at.h"
#include "integrator/visibility.h"
#include "integrator/vpl/tuning.h"
#include "light/light.h"
#include "sampling/warp.h"

#include <algorithm>
#include <cmath>

namespace glimmer {

// Light from afar is aimed at bounded media. Rays that start as the light shines would seldom meet a small cloud, or
// the ground close to it; those that did would leave vertices of thousands of times the power of others, bright spots
// in it. So they are aimed at the media alone, at all that there is, and at regions between the two that grow by the
// same factor, as what lies beside the media lights them the more the nearer it is.

namespace {

/// What is left of a start's light behind the length in which no vertex may stand.
Rgb passes_dark(const Scene &scene, const Emission &start, TraceContext &rays) {
    const Vec3f &direction = start.ray.direction;
    const Ray dark{start.ray.origin - direction * start.dark, direction, start.ray.time, start.dark};
    return visibility(scene, dark, kSubpathKind, rays) * transmittance(scene.outside(), dark, start.dark);
}

} // namespace

SubpathStarts::SubpathStarts(const Scene &scene, const ImportanceMap &importance, uint32_t paths)
    : scene_(scene), importance_(importance), media_(scene.medium ? scene.medium->bounded() : nullptr), paths_(paths),
      aims_(scene.lights.size()) {
    if (media_) {
        importance_of_media_ = importance(media_->bounds_center());
        const float all = scene.bounds_radius;
        for (float radius = media_->bounds_radius(); disks_.empty() || (radius > 0 && radius < all / 2);
             radius *= tuning::kAimGrowth)
            disks_.push_back({media_->bounds_center(), radius});
        disks_.push_back({scene.bounds_center, all});
    }
    const LightSet &lights = scene.lights;
    std::vector<double> shares(lights.size());
    double total = 0;
    uint32_t started = 0;
    for (uint32_t i = 0; i < lights.size(); ++i) {
        const LightBound &b = lights.bound(i);
        if (b.infinite && !media_) // it has no way into a medium without end
            continue;
        if (!b.infinite)
            aims_[i].side = side(i);
        if (media_ && !b.infinite && aims_[i].side == Side::outwards)
            add_cones(aims_[i], b);
        const bool is_far = b.infinite || !aims_[i].cones.empty();
        total += shares[i] = brightness(b, is_far) * double(is_far ? importance_of_media_ : importance(b.center));
        ++started;
    }
    if (!started)
        return;
    // A defensive mixture with the uniform distribution.
    const double by_importance = double(tuning::kStartsByImportance);
    const double uniform = double(1 - tuning::kStartsByImportance);
    for (uint32_t i = 0; i < lights.size(); ++i)
        if (!lights.bound(i).infinite || media_)
            shares[i] = total > 0 ? by_importance * shares[i] / total + uniform / started : 1.0 / started;
    shares_ = std::move(shares);
}

std::optional<SubpathStart> SubpathStarts::sample(uint32_t light, ShutterTime time, Sampler &sampler,
                                                  TraceContext &rays) const {
    auto start = scene_.lights.bound(light).infinite ? from_infinity(light, time, sampler)
                                                     : from_light(light, time, sampler, rays);
    if (!start || is_black(start->emission.power))
        return std::nullopt;
    if (!start->emission.group)
        start->emission.group = scene_.lights.flags(light).group;
    return start;
}

/// An intensity; of light from afar that of what enters the media: E pi R^2 is the power 4 pi I.
double SubpathStarts::brightness(const LightBound &bound, bool is_far) const {
    if (!is_far)
        return double(bound.strength);
    const double radius = double(media_->bounds_radius());
    const double distance = bound.infinite ? 1 : double(length(media_->bounds_center() - bound.center));
    return double(bound.strength) * (radius / distance) * (radius / distance) / 4;
}

/// A sphere shines towards the side that the camera is on; towards both where camera rays may start on both, and where
/// what shines inwards comes out again.
SubpathStarts::Side SubpathStarts::side(uint32_t light) const {
    const LightBound &b = scene_.lights.bound(light);
    const StartRegion camera = scene_.camera.start_region();
    const float distance = length(b.center - camera.center);
    if (const auto *sphere = std::get_if<SphereLight>(&scene_.lights[light])) {
        const bool clear = scene_.materials.bounds(scene_.sphere_materials[sphere->index]).transparent;
        if (clear || std::abs(distance - b.radius) <= camera.radius)
            return Side::both;
    }
    return distance < b.radius ? Side::inwards : Side::outwards;
}

void SubpathStarts::add_cones(Aim &aim, const LightBound &bound) const {
    const Vec3f to_media = media_->bounds_center() - bound.center;
    const float distance = length(to_media);
    aim.axis = distance > 0 ? to_media / distance : Vec3f{0, 0, 1};
    const float reach = media_->bounds_radius() + bound.radius;
    for (float radius = reach; radius > 0 && radius < distance * tuning::kWidestCone; radius *= tuning::kAimGrowth)
        aim.cones.push_back(one_minus_cos_of_sine(radius / distance));
}

std::optional<SubpathStart> SubpathStarts::from_infinity(uint32_t light, ShutterTime time, Sampler &sampler) const {
    const Vec2f u_position = sampler.next_2d(), u_direction = sampler.next_2d();
    const float u_disk = sampler.next_1d();
    const auto from = sample_light(scene_.lights[light], media_->bounds_center(), u_direction);
    if (!from)
        return std::nullopt;
    const size_t own = std::min(size_t(u_disk * float(disks_.size())), disks_.size() - 1);
    const auto &[center, radius] = disks_[own];
    const Vec2f p = sample_uniform_disk(u_position);
    const Frame frame(from->direction);
    const Vec3f target = center + (frame.x * p.x + frame.y * p.y) * radius;
    const Rgb irradiance =
        from->radiance * (1 / from->pdf) * scene_.lights.profile(light, from->direction, -from->direction, kInfinity);
    const Ray ray{target + from->direction * (2 * scene_.bounds_radius), -from->direction, time};
    const float on_media = max_component(irradiance) * kPi * media_->bounds_radius() * media_->bounds_radius();
    const Rgb power = irradiance * (1 / disk_density(target, from->direction, own));
    return SubpathStart{{ray, power * weight(light)}, from->delta, on_media * weight(light) * importance_of_media_, {}};
}

/// Of all disks together, per area across the direction, at a point of one of them.
float SubpathStarts::disk_density(const Vec3f &x, const Vec3f &direction, size_t own) const {
    float sum = 0;
    for (size_t i = 0; i < disks_.size(); ++i)
        if (const auto &[center, radius] = disks_[i]; i == own || length(cross(x - center, direction)) <= radius)
            sum += 1 / (kPi * radius * radius);
    return sum / float(disks_.size());
}

std::optional<SubpathStart> SubpathStarts::from_light(uint32_t light, ShutterTime time, Sampler &sampler,
                                                      TraceContext &rays) const {
    const LightBound &bound = scene_.lights.bound(light);
    const auto &[sides, axis, cones] = aims_[light];
    const Vec2f u_position = sampler.next_2d(), u_direction = sampler.next_2d();
    EmissionDirection to{u_direction};
    float choices = 1;
    // Each cone without the one before, and all other directions as the light shines, are chosen equally often.
    if (!cones.empty()) {
        choices = float(cones.size() + 1);
        if (const auto cone = size_t(sampler.next_1d() * choices); cone < cones.size()) {
            const float from = cone ? cones[cone - 1] : 0, extent = cones[cone] - from;
            const float one_minus_cos = from + u_direction.x * extent;
            const Vec2f p = circle_point(std::sqrt(one_minus_cos * (2 - one_minus_cos)), u_direction.y);
            to.direction = normalize(Frame(axis).to_world({p.x, p.y, 1 - one_minus_cos}));
            to.pdf = pdf_uniform_cone(extent);
        }
    }
    const bool inwards = sides == Side::both ? sampler.next_1d() < 0.5f : sides == Side::inwards;
    auto start = sample_emission(scene_.lights[light], inwards, u_position, to, sampler.next_1d());
    if (!start)
        return std::nullopt;
    if (!cones.empty() && !to.is_given() && 1 - dot(start->ray.direction, axis) < cones.back())
        return std::nullopt;
    start->ray.time = time;
    start->power *= scene_.lights.profile(light, start->ray.origin, start->ray.direction, 0);
    if (is_black(start->power))
        return std::nullopt;
    if (start->dark > 0)
        start->power *= passes_dark(scene_, *start, rays);
    const float per_choice = sides == Side::both ? 2 : choices; // spheres that shine to both sides have no cones
    start->power *= float(double(per_choice) / (shares_[light] * paths_));
    float target = max_component(start->power) * importance_(bound.center);
    if (!cones.empty())
        target = bound.strength * (2 * kPi * cones.front()) * weight(light) * importance_of_media_;
    return SubpathStart{*start, traits(scene_.lights[light]).delta, target,
                        dielectrics_at(scene_, start->ray.origin, time, kSubpathKind)};
}

} // namespace glimmer
