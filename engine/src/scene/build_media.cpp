// SPDX-License-Identifier: GPL-3.0-or-later
// The medium that fills all space, and those within surfaces.
#include "base/error.h"
#include "scene/builder.h"
#include "shading/medium_programs.h"
#include "shading/shader_scene.h"

#include <algorithm>

namespace glimmer {

namespace {

Rgb to_rgb(const Vec3d &v) {
    return {float(v.x), float(v.y), float(v.z)};
}

constexpr size_t kCellsOfOne = 16384, kFewestCells = 64, kMostCells = 65536; // of the grids of majorants
constexpr float kBoxMargin = 1e-4f; // of a body's size, for what rounding puts outside of it
constexpr float kMostMeans = 4096;  // points that a medium's means are taken from

HomogeneousMedium coefficients(const MediumDescription &m) {
    return {to_rgb(m.sigma_a), to_rgb(m.sigma_s), float(m.g)};
}

} // namespace

uint32_t SceneBuilder::add_interior(const MediumDescription &medium) {
    InteriorMedium out{coefficients(medium), to_rgb(medium.emission)};
    const MediumSources sources{
        {to_rgb(medium.sigma_a), to_rgb(medium.sigma_s), to_rgb(medium.emission), float(medium.g)}, medium.bindings};
    if (!sources.bindings.empty()) {
        out.varies = true;
        out.may_scatter = sources.gives(MediumKey::sigma_s) || !is_black(sources.constants.sigma_s);
        out.may_shine = sources.gives(MediumKey::emission) || !is_black(sources.constants.emission);
    }
    media_.push_back(out);
    medium_sources_.push_back(sources);
    return uint32_t(media_.size()) - 1;
}

void SceneBuilder::add_boundaries(const ObjectDescription &object) {
    if (!object.interior)
        return;
    const uint32_t medium = add_interior(*object.interior);
    for (uint32_t material : object.materials)
        used_[material] = true;
    for (size_t i = 0; i < object.instances.size(); ++i)
        if (const auto instance = place(object, i, *object.mesh, boundary_motions_)) {
            boundary_instances_.push_back(*instance);
            boundary_places_.push_back({size_t(&object - description_.objects.data()), i});
            instance_media_.push_back(medium);
        }
    scene_.meshes_.push_back(object.mesh);
}

void SceneBuilder::add_boundaries(const SpheresDescription &group) {
    if (!group.interior)
        return;
    const uint32_t medium = add_interior(*group.interior);
    used_[group.material] = true;
    for (size_t i = 0; i < group.centers.size(); ++i) {
        boundary_spheres_.push_back(
            {group.centers[i] - origin_, group.radii.size() == 1 ? group.radii[0] : group.radii[i]});
        sphere_media_.push_back(medium);
    }
}

void SceneBuilder::build_media() {
    std::optional<HomogeneousMedium> everywhere;
    if (description_.medium)
        everywhere = coefficients(*description_.medium);
    if (everywhere && is_black(everywhere->sigma_t))
        everywhere.reset();
    const bool empty = std::ranges::all_of(media_, [](const InteriorMedium &m) {
        return is_black(m.coefficients.sigma_t) && is_black(m.emission) && !m.varies;
    });
    if (empty || instance_media_.size() + sphere_media_.size() == 0) {
        if (everywhere)
            scene_.medium = description_.medium_falloff ? Medium(height_haze()) : Medium(*everywhere);
        return;
    }
    if (everywhere && description_.medium_falloff)
        fail_argument("medium: one that thins out with height cannot be together with media within surfaces");
    const auto boundaries = std::make_shared<const Boundaries>(
        std::move(boundary_instances_), std::move(boundary_motions_), std::move(boundary_spheres_), threads_);
    scene_.moves |= boundaries->moves();
    scene_.bytes += boundaries->bytes();
    std::vector<uint32_t> bodies = std::move(instance_media_);
    bodies.insert(bodies.end(), sphere_media_.begin(), sphere_media_.end());
    const auto varying = build_varying_bodies(boundaries, bodies);
    scene_.glass_medium = Medium(BoundedMedia(boundaries, bodies, media_, kNone, varying));
    uint32_t around = kNone;
    if (everywhere) {
        around = uint32_t(media_.size());
        media_.push_back({*everywhere, {}});
    }
    scene_.medium = Medium(BoundedMedia(boundaries, std::move(bodies), std::move(media_), around, varying));
}

HeightHaze SceneBuilder::height_haze() const {
    const FalloffDescription &falloff = *description_.medium_falloff;
    // Far below or above the camera too little or too much of it is there for float.
    const double density = std::clamp(std::exp((falloff.height - origin_.z) / falloff.scale_height), 0.0, 1e18);
    const MediumDescription &m = *description_.medium;
    const auto scaled = [&](const Vec3d &sigma) {
        const auto channel = [&](double c) { return float(std::min(c * density, 1e30)); };
        return Rgb(channel(sigma.x), channel(sigma.y), channel(sigma.z));
    };
    return {{scaled(m.sigma_a), scaled(m.sigma_s), float(m.g)}, float(falloff.scale_height)};
}

/// The majorants of all bodies whose media vary; their means become the media's coefficients.
std::shared_ptr<const VaryingBodies>
SceneBuilder::build_varying_bodies(const std::shared_ptr<const Boundaries> &boundaries,
                                   const std::vector<uint32_t> &bodies) {
    const auto varies = [&](uint32_t body) { return media_[bodies[body]].varies; };
    size_t count = 0;
    for (uint32_t body = 0; body < bodies.size(); ++body)
        count += varies(body);
    if (count == 0)
        return nullptr;
    auto programs = std::make_shared<MediumPrograms>();
    const AttributeNumbers names = number_attributes(description_.programs);
    programs->programs.assign(description_.programs.begin(), description_.programs.end());
    programs->media = medium_sources_;
    programs->boundaries = boundaries;
    programs->camera = camera_frame();
    programs->origin = origin_;
    auto out = std::make_shared<VaryingBodies>();
    out->grids.resize(bodies.size());
    const auto cells = uint32_t(std::clamp(kMostCells / count, kFewestCells, kCellsOfOne));
    for (uint32_t body = 0; body < bodies.size(); ++body) {
        programs->bodies.push_back(medium_body(body, *boundaries, names));
        out->frames.push_back(boundaries->frame(body, ShutterTime()));
    }
    for (uint32_t body = 0; body < bodies.size(); ++body)
        if (varies(body)) {
            out->grids[body] = majorants(*programs, bodies[body], body, cells);
            scene_.bytes += out->grids[body]->bytes();
        }
    for (uint32_t m = 0; m < media_.size(); ++m)
        if (media_[m].varies)
            media_[m].coefficients = mean_coefficients(*programs, bodies, m);
    out->coefficients = std::move(programs);
    return out;
}

MediumBody SceneBuilder::medium_body(uint32_t body, const Boundaries &boundaries, const AttributeNumbers &names) const {
    MediumBody out;
    const std::optional<Instance> instance = boundaries.instance(body, ShutterTime());
    if (!instance) {
        const Sphere &sphere = boundaries.sphere(body);
        const auto radius = float(sphere.radius);
        out.frame.to_world = {Vec3f{radius, 0, 0}, {0, radius, 0}, {0, 0, radius}};
        out.frame.to_object = boundaries.frame(body, ShutterTime()).to_local;
        out.frame.location = Vec3f(sphere.center + origin_);
        return out;
    }
    const ObjectPlace &place = boundary_places_[body];
    const ObjectDescription &object = description_.objects[place.object];
    out.frame = frame_of(*instance, origin_);
    out.frame.color = object.color;
    out.frame.alpha = object.opacity;
    out.frame.random = object.randoms.size() > 1 ? object.randoms[place.instance] : object.randoms[0];
    out.frame.index =
        float(object.object_indices.size() > 1 ? object.object_indices[place.instance] : object.object_indices[0]);
    out.moves = instance->motion != kNone;
    out.values = object.attributes; // the description does not last
    out.attributes = views_of(out.values, names);
    out.instance = uint32_t(place.instance);
    return out;
}

/// Of a body that moves, over the time that the shutter is open.
std::unique_ptr<const MajorantGrid> SceneBuilder::majorants(const MediumPrograms &programs, uint32_t medium,
                                                            uint32_t body, uint32_t cells) const {
    Vec3f low, high;
    programs.boundaries->local_bounds(body, low, high);
    const Vec3f margin = (high - low) * kBoxMargin;
    std::vector<float> moments{0};
    if (programs.bodies[body].moves)
        moments = {0, 0.25f, 0.5f, 0.75f, 1};
    return std::make_unique<const MajorantGrid>(low - margin, high + margin, cells, threads_, [&](const Vec3f &p) {
        float most = 0;
        for (const float moment : moments) {
            const ShutterTime time(moment);
            const auto instance = programs.boundaries->instance(body, time);
            const Sphere *sphere = instance ? nullptr : &programs.boundaries->sphere(body);
            const Vec3f x = instance ? instance->to_world(p) : Vec3f(sphere->center + Vec3d(p) * sphere->radius);
            most = std::max(most, max_component(programs.at(medium, body, x, time).sigma_t()));
        }
        return most;
    });
}

/// Over points of the bodies that it fills.
HomogeneousMedium SceneBuilder::mean_coefficients(const MediumPrograms &programs, const std::vector<uint32_t> &bodies,
                                                  uint32_t medium) const {
    constexpr int kSide = 6;
    Rgb sigma_a, sigma_s;
    float g = 0, count = 0;
    for (uint32_t body = 0; body < bodies.size() && count < kMostMeans; ++body) {
        if (bodies[body] != medium)
            continue;
        Vec3f low, high;
        programs.boundaries->local_bounds(body, low, high);
        const auto instance = programs.boundaries->instance(body, ShutterTime());
        for (int i = 0; i < kSide * kSide * kSide; ++i) {
            const auto part = [](int k) { return (float(k) + 0.5f) / kSide; };
            const Vec3f p{low.x + (high.x - low.x) * part(i % kSide),
                          low.y + (high.y - low.y) * part(i / kSide % kSide),
                          low.z + (high.z - low.z) * part(i / (kSide * kSide))};
            const Vec3f x = instance ? instance->to_world(p)
                                     : Vec3f(programs.boundaries->sphere(body).center +
                                             Vec3d(p) * programs.boundaries->sphere(body).radius);
            const MediumPoint point = programs.at(medium, body, x, ShutterTime());
            sigma_a += point.sigma_a, sigma_s += point.sigma_s, g += point.g;
            ++count;
        }
    }
    const float share = count > 0 ? 1 / count : 0;
    return {sigma_a * share, sigma_s * share, g * share};
}

} // namespace glimmer
