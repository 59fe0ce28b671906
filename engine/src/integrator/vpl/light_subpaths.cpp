// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrator/vpl/light_subpaths.h"

#include "integrator/dielectric_crossing.h"
#include "integrator/dielectrics_at.h"
#include "integrator/return_bound.h"
#include "integrator/roulette.h"
#include "integrator/shading_frame.h"
#include "integrator/visibility.h"
#include "integrator/vpl/bounded_fraction.h"
#include "integrator/vpl/connection.h"
#include "integrator/vpl/tuning.h"
#include "light/light.h"
#include "medium/phase.h"
#include "sampling/warp.h"

#include <array>
#include <cmath>

namespace glimmer {

namespace {

// All kinds but the camera's see the same wherever there is a cache.
constexpr RayKind kSubpathKind = RayKind::diffuse;

/// One light subpath. It carries flux, so refraction scales nothing. Light from a point light that has met only mirrors
/// and dielectrics is left out: no camera path can meet it, so nothing would compensate what bounded connections take
/// away of it.
class LightSubpath {
  public:
    LightSubpath(const Scene &scene, const ImportanceMap &importance, const VplSettings &settings, Sampler &sampler,
                 TraceContext &rays, LightVertices &out)
        : scene_(scene), importance_(importance), settings_(settings), sampler_(sampler), rays_(rays), out_(out) {}

    void trace(const Emission &start, bool from_delta, const InteriorStack &around, float target, uint8_t group) {
        target_ = target;
        group_ = group;
        branches_.push_back({start.ray, start.power, around, from_delta});
        WalkGuard guard(rays_);
        while (!branches_.empty() && guard.goes_on()) {
            const Branch next = branches_.back();
            branches_.pop_back();
            segment(next);
        }
        out_.unfinished |= !branches_.empty();
        branches_.clear();
    }

  private:
    struct Branch {
        Ray ray;
        Rgb power;
        InteriorStack interior;
        bool from_delta;             ///< comes from a light without size and has not been scattered yet
        uint32_t specular_depth = 0; ///< mirrors and dielectrics in a row
        float remainder =
            0; ///< fraction of the power that connections of the last vertex do not carry; 0 in the medium
        VertexDepth depth = {}; ///< of the last vertex
    };

    /// Whether the depth limits let a gather point join a vertex of this depth.
    bool may_be_joined(const VertexDepth &depth) const {
        return depth.depth < settings_.limits.depth && depth.scatter < settings_.limits.scatter;
    }

    void segment(Branch path) {
        ++path.depth.depth;
        if (!may_be_joined(path.depth))
            return;
        const auto hit = scene_.accel->intersect(path.ray, kSubpathKind);
        ++rays_.rays;
        const float own_end = path.ray.t_max; // finite only within a see-through sphere light, where the ray ends
        path.ray.t_max = kInfinity;
        if (const Medium *medium = path.interior.medium(scene_.outside())) {
            const float end = hit ? hit->t : own_end;
            if (may_be_joined({path.depth.depth, path.depth.scatter + 1})) {
                const FreeFlight flight = medium->sample_free_flight(path.ray, path.power, end, sampler_);
                path.power *= flight.weight;
                if (flight.scattered)
                    return scatter_in_medium(path, *medium, path.ray.origin + path.ray.direction * flight.t);
            } else {
                path.power *= medium->transmittance(path.ray, end);
            }
        }
        if (hit)
            meet_surface(path, *hit, own_end - hit->t);
    }

    /// Splats what connections do not carry of the light that has just left a surface.
    void splat_remainder(const Branch &path) {
        if (!(path.remainder > 0) || !is_in_picture(scene_, path.ray))
            return;
        SubpathSegment segment{path.ray, path.power, path.remainder, group_};
        for (;;) { // and behind surfaces that let some of it straight through
            ++rays_.rays;
            const auto hit = scene_.accel->intersect(segment.ray, kSubpathKind);
            if (hit)
                segment.ray.t_max = hit->t;
            splat(scene_, segment, settings_, sampler_, rays_, out_.splats);
            if (!hit || !scene_.has_transparency)
                return;
            Interaction surface = scene_.interaction(segment.ray, *hit);
            splat_arena_.clear();
            const View view{-segment.ray.direction, 0, segment.ray.time, kFromDiffuse};
            const Rgb through = scene_.materials.shade(surface, view, splat_arena_).transparency;
            if (is_black(through))
                return;
            segment.power *= through * scene_.medium->transmittance(segment.ray, hit->t);
            segment.ray = {surface.origin_towards(segment.ray.direction), segment.ray.direction, segment.ray.time};
        }
    }

    /// The weight window: the subpath's power times the importance of x, relative to where the subpath started. Below 1
    /// the subpath survives with that probability. Returns the weight after roulette, 0 where the subpath ends; well
    /// above 1, it is worth several subpaths.
    float apply_window(Branch &path, const Vec3f &x) {
        const float weight =
            tuning::kWindowScale * max_component(path.power) * importance_(x) * return_bound(scene_, x) / target_;
        if (!(weight > 0) || (weight < 1 && sampler_.next_1d() >= weight))
            return 0;
        if (weight >= 1)
            return weight;
        path.power *= 1 / weight;
        return 1;
    }

    /// Goes on as one subpath, or as several that share its power.
    template <class GoOn>
    void split(Branch &path, float weight, const GoOn &go_on) {
        const uint32_t n = weight > tuning::kSplitAbove ? uint32_t(std::min(weight + 0.5f, tuning::kMostParts)) : 1;
        path.power *= 1 / float(n);
        for (uint32_t i = 0; i < n; ++i)
            go_on(path);
    }

    void scatter_in_medium(Branch &path, const Medium &medium, const Vec3f &x) {
        ++path.depth.scatter;
        const float weight = apply_window(path, x);
        if (weight == 0)
            return;
        const Vec3f before = path.ray.direction;
        out_.medium.add(x, path.power, before, path.depth, group_);
        split(path, weight, [&](Branch &next) {
            next.from_delta = false;
            next.specular_depth = 0;
            next.remainder = 0;
            next.ray = {x, medium.phase().sample(before, sampler_.next_2d()).direction, next.ray.time};
            branches_.push_back(next);
        });
    }

    /// t_max: how far behind the surface the light would still be that of its sphere light.
    void meet_surface(Branch &path, const Hit &hit, float t_max) {
        Interaction surface = scene_.interaction(path.ray, hit);
        arena_.clear();
        const Shading shading =
            scene_.materials.shade(surface, {-path.ray.direction, 0, path.ray.time, kFromDiffuse}, arena_);
        if (const float through = max_component(shading.transparency); through > 0) {
            const float share = through / (through + max_component(albedo(shading.bsdf)));
            if (share == 1 || sampler_.next_1d() < share) {
                path.power *= shading.transparency * (1 / share);
                path.ray = {surface.origin_towards(path.ray.direction), path.ray.direction, path.ray.time, t_max};
                --path.depth.depth; // no vertex: the next segment counts its end again
                branches_.push_back(path);
                return;
            }
            path.power *= 1 / (1 - share);
        }
        if (is_smooth_dielectric(shading.bsdf))
            return cross_dielectric(path, surface, shading);
        scatter_at_surface(path, surface, shading);
    }

    void scatter_at_surface(Branch &path, const Interaction &surface, const Shading &shading) {
        Bsdf bsdf = shading.bsdf;
        std::optional<DielectricCrossing> crossing; // of the boundary of a body
        if (shading.interior_ior > 0) {
            crossing.emplace(surface, shading.interior_ior, path.ray.direction, path.interior, scene_.within_glass());
            bsdf.eta = crossing->eta;
        }
        const float weight = bsdf.empty() ? 0 : apply_window(path, surface.position);
        if (weight == 0)
            return;
        const Vec3f incoming = -path.ray.direction;
        const float side = dot(incoming, surface.geometric_normal) < 0 ? -1.0f : 1.0f;
        SurfaceVertex v{surface.position,
                        surface.geometric_normal * side,
                        surface.shading_normal * side,
                        incoming,
                        surface.error,
                        path.power,
                        mean_component(path.power * albedo(bsdf)),
                        surface.instance,
                        surface.primitive,
                        surface.u,
                        surface.v,
                        bsdf.eta,
                        transmits(bsdf) && !crossing,
                        path.depth,
                        group_};
        if (!(dot(incoming, v.geometric) > 0))
            return;
        if (!is_specular(bsdf))
            out_.surface.push_back(v);
        const auto scatter = [&](Branch &branch) {
            return transmits(bsdf) ? scatter_to_both_sides(branch, v, surface, bsdf, crossing)
                                   : reflect(branch, v, surface, bsdf);
        };
        const Medium *outside = scene_.outside();
        if ((path.interior.medium(outside) || (outside && crossing)) && !is_bounded(max_value(bsdf))) {
            const auto directions =
                uint32_t(float(tuning::kSplatDirections) * std::min(weight, tuning::kMostSplatWeight));
            for (uint32_t k = 0; k < directions; ++k) {
                Branch part = path;
                part.power *= 1 / float(directions);
                if (scatter(part) && part.interior.medium(outside))
                    splat_remainder(part);
            }
        }
        split(path, weight, [&](Branch next) {
            if (scatter(next))
                branches_.push_back(next);
        });
    }

    /// As reflect(), where light passes to the other side as well. The frame that a direction belongs to is the one
    /// that a camera path from there would use: each of the two is tried with the same probability, and a sample counts
    /// only if it belongs to the frame that it was drawn in.
    bool scatter_to_both_sides(Branch &path, const SurfaceVertex &v, const Interaction &surface, const Bsdf &bsdf,
                               const std::optional<DielectricCrossing> &crossing) {
        const bool bent = !(v.shading == v.geometric);
        bool about_shading = is_above_horizon(v.shading, v.incoming);
        if (bent && about_shading) {
            about_shading = sampler_.next_1d() < 0.5f;
            path.power *= 2;
        }
        const Frame frame(about_shading ? v.shading : v.geometric);
        const Vec3f incoming = frame.to_local(v.incoming);
        if (!(incoming.z > 0))
            return false;
        const auto s = sample(bsdf, incoming, sampler_.next_1d(), sampler_.next_2d());
        if (!s)
            return false;
        const Vec3f direction = normalize(frame.to_world(s->wi));
        const float side = s->transmitted ? -1.0f : 1.0f;
        if (!(dot(direction, v.geometric) * side > 0) ||
            (bent && is_above_horizon(v.shading * side, direction) != about_shading))
            return false;
        if (s->specular && (path.from_delta || !survives_specular(path)))
            return false;
        path.power *= adjoint_weight(bsdf, incoming, *s);
        if (bent)
            path.power *= scale_of_flux(frame.z, v.geometric, v.incoming, direction, std::abs(s->wi.z));
        if (s->transmitted && crossing)
            path.interior = crossing->beyond;
        if (!s->specular)
            path.specular_depth = 0;
        const bool connected = !s->specular && (!s->transmitted || v.both_sides);
        leave(path, surface, direction, connected ? 1 - connect(v, bsdf, direction).bounded : 1);
        return true;
    }

    /// Samples the adjoint of what a camera path does, f |w_in.ns| / |w_in.ng| * |w_out.ng|, with the frame that a
    /// viewer along w_out would use (Veach 1997, 5.3). Where the normals differ, the frame of w_in has no samples for
    /// some directions that the camera can see, so a share of the samples is drawn about the geometric normal. False
    /// where the subpath ends.
    bool reflect(Branch &path, const SurfaceVertex &v, const Interaction &surface, const Bsdf &bsdf) {
        const bool bent = !(v.shading == v.geometric), about_shading = is_above_horizon(v.shading, v.incoming);
        const Frame frame(about_shading ? v.shading : v.geometric);
        const Vec3f incoming = frame.to_local(v.incoming);
        if (!(incoming.z > 0))
            return false;
        const float cosine_share = bent && !is_specular(bsdf) ? tuning::kGeometricNormalShare : 0;
        const float mirror_share = bent && about_shading && has_specular(bsdf) && mirrors_beneath_horizon(v)
                                       ? tuning::kGeometricMirrorShare
                                       : 0;
        const float bsdf_share = 1 - cosine_share - mirror_share, u_way = bent ? sampler_.next_1d() : 1;
        if (u_way < mirror_share) {
            const Frame true_frame(v.geometric);
            const auto s = sample(bsdf, true_frame.to_local(v.incoming), sampler_.next_1d(), sampler_.next_2d());
            return s && s->specular && reflect_as_mirror(path, v, surface, true_frame, false, *s, mirror_share);
        }
        Vec3f direction;
        float density;
        if (u_way < mirror_share + cosine_share) {
            path.specular_depth = 0;
            direction = normalize(Frame(v.geometric).to_world(sample_cosine_hemisphere(sampler_.next_2d())));
            density = pdf(bsdf, incoming, frame.to_local(direction));
        } else {
            const auto s = sample(bsdf, incoming, sampler_.next_1d(), sampler_.next_2d());
            if (!s)
                return false;
            if (s->specular)
                return reflect_as_mirror(path, v, surface, frame, about_shading, *s, bsdf_share);
            direction = normalize(frame.to_world(s->wi));
            if (!(dot(direction, v.geometric) > 0))
                return false;
            path.specular_depth = 0;
            density = s->pdf;
            if (!bent) {
                path.power *= adjoint_weight(bsdf, incoming, *s) *
                              scale_of_flux(frame.z, v.geometric, v.incoming, direction, s->wi.z);
                leave(path, surface, direction, 1 - bounded_fraction(bsdf, s->wi, incoming));
                return true;
            }
        }
        const float cosine = dot(direction, v.geometric);
        if (!(cosine > 0))
            return false;
        density = bsdf_share * density + cosine_share * pdf_cosine_hemisphere(cosine);
        const Connection c = connect(v, bsdf, direction);
        path.power *= c.factor * (1 / density);
        leave(path, surface, direction, 1 - c.bounded);
        return true;
    }

    /// Whether a camera path may come from where a mirror about the geometric normal sends the light.
    static bool mirrors_beneath_horizon(const SurfaceVertex &v) {
        const Vec3f mirrored = v.geometric * (2 * dot(v.incoming, v.geometric)) - v.incoming;
        return !is_above_horizon(v.shading, mirrored);
    }

    /// share: the probability with which a sample of this frame was drawn.
    bool reflect_as_mirror(Branch &path, const SurfaceVertex &v, const Interaction &surface, const Frame &frame,
                           bool about_shading, const BsdfSample &s, float share) {
        const Vec3f direction = normalize(frame.to_world(s.wi));
        if (!(dot(direction, v.geometric) > 0) || is_above_horizon(v.shading, direction) != about_shading)
            return false;
        if (path.from_delta || !survives_specular(path))
            return false;
        path.power *= s.weight * (scale_of_flux(frame.z, v.geometric, v.incoming, direction, s.wi.z) / share);
        leave(path, surface, direction, 1);
        return true;
    }

    void leave(Branch &path, const Interaction &surface, const Vec3f &direction, float remainder) {
        path.from_delta = false;
        path.remainder = remainder;
        path.ray = {surface.origin_towards(direction), direction, path.ray.time};
    }

    bool survives_specular(Branch &path) {
        const float survival = specular_survival(path.specular_depth++);
        if (survival < 1 && sampler_.next_1d() >= survival)
            return false;
        path.power *= 1 / survival;
        return true;
    }

    void cross_dielectric(Branch &path, const Interaction &surface, const Shading &shading) {
        if (path.from_delta || !survives_specular(path))
            return;
        DielectricCrossing crossing(surface, shading.interior_ior, path.ray.direction, path.interior,
                                    scene_.within_glass());
        const bool bent = !(crossing.shading == crossing.geometric);
        if (bent && crossing.about_shading && crossing.may_leave_beneath_horizon()) {
            const bool on_shading = sampler_.next_1d() < 1 - tuning::kGeometricDielectricShare;
            crossing.shade(on_shading);
            path.power *= 1 / (on_shading ? 1 - tuning::kGeometricDielectricShare : tuning::kGeometricDielectricShare);
        }
        Bsdf bsdf = shading.bsdf;
        bsdf.eta = crossing.eta;
        const auto s = sample(bsdf, crossing.outgoing, sampler_.next_1d(), {});
        if (!s)
            return;
        const Vec3f direction = crossing.to_world(s->wi);
        if (!crossing.possible(direction, s->transmitted))
            return;
        path.power *= s->weight;
        if (bent) {
            if (!crossing.holds_backwards(direction, s->transmitted) || !(dot(crossing.back, crossing.geometric) > 0))
                return;
            path.power *=
                scale_of_flux(crossing.frame.z, crossing.geometric, crossing.back, direction, std::abs(s->wi.z));
        }
        if (s->transmitted)
            path.interior = crossing.beyond;
        leave(path, surface, direction, 1);
        if (path.interior.medium(scene_.outside()))
            splat_remainder(path);
        branches_.push_back(path);
    }

    const Scene &scene_;
    const ImportanceMap &importance_;
    const VplSettings &settings_;
    Sampler &sampler_;
    TraceContext &rays_;
    LightVertices &out_;
    ClosureArena arena_;       ///< of the vertex where the path is
    ClosureArena splat_arena_; ///< of the surfaces that splats pass
    std::vector<Branch> branches_;
    float target_ = 1;
    uint8_t group_ = 0; ///< LightFlags::group of the subpath's light
};

/// The share of the subpaths that start at each light: by its power times the importance of its place, in a defensive
/// mixture with the uniform distribution. Light from infinity counts by what of it enters the bounded media. 0 for it
/// where there are none; empty where no subpath can start.
std::vector<double> start_shares(const Scene &scene, const ImportanceMap &importance) {
    const LightSet &lights = scene.lights;
    const BoundedMedia *bounded = scene.medium ? scene.medium->bounded() : nullptr;
    std::vector<double> shares(lights.size());
    double total = 0;
    uint32_t started = 0;
    for (uint32_t i = 0; i < lights.size(); ++i) {
        const LightBound &b = lights.bound(i);
        if (b.infinite && !bounded)
            continue;
        const double radius = b.infinite ? double(bounded->bounds_radius()) : 0; // E pi R^2 is the power 4 pi I
        const double intensity = b.infinite ? double(b.strength) * radius * radius / 4 : double(b.strength);
        total += shares[i] = intensity * double(importance(b.infinite ? bounded->bounds_center() : b.center));
        ++started;
    }
    if (!started)
        return {};
    const double by_importance = double(tuning::kStartsByImportance);
    const double uniform = double(1 - tuning::kStartsByImportance);
    for (uint32_t i = 0; i < lights.size(); ++i)
        if (!lights.bound(i).infinite || bounded)
            shares[i] = total > 0 ? by_importance * shares[i] / total + uniform / started : 1.0 / started;
    return shares;
}

/// What is left of a start's light behind the length in which no vertex may stand.
Rgb passes_dark(const Scene &scene, const Emission &start, TraceContext &rays) {
    const Vec3f &direction = start.ray.direction;
    const Ray dark{start.ray.origin - direction * start.dark, direction, start.ray.time, start.dark};
    return visibility(scene, dark, kSubpathKind, rays) * transmittance(scene.outside(), dark, start.dark);
}

/// A ray of light from infinitely far.
struct InfiniteStart {
    Emission emission;
    bool delta;
    float body_power; ///< what its power would be, had all rays been aimed at the media
};

/// Disks across light from infinity that its rays are aimed at, all equally often.
struct AimedDisks {
    struct Disk {
        Vec3f center;
        float radius;
    };
    std::vector<Disk> disks;

    /// The media, all that there is, and between the two disks that grow by the same factor: surfaces beside the media
    /// light them, too, the more the nearer they are. With the two alone, few rays meet the ground about a small cloud
    /// on a wide plane, and those that are thrown from there into the cloud leave vertices of thousands of times the
    /// power of the others, bright spots in it.
    explicit AimedDisks(const Scene &scene) {
        const BoundedMedia &media = *scene.medium->bounded();
        const float all = scene.bounds_radius;
        for (float radius = media.bounds_radius(); disks.empty() || (radius > 0 && radius < all / 2);
             radius *= tuning::kDiskGrowth)
            disks.push_back({media.bounds_center(), radius});
        disks.push_back({scene.bounds_center, all});
    }

    /// Of all of them together, per area across the direction, at a point of the disk `own`.
    float density(const Vec3f &x, const Vec3f &direction, size_t own) const {
        float sum = 0;
        for (size_t i = 0; i < disks.size(); ++i)
            if (const auto &[center, radius] = disks[i]; i == own || length(cross(x - center, direction)) <= radius)
                sum += 1 / (kPi * radius * radius);
        return sum / float(disks.size());
    }
};

std::optional<InfiniteStart> start_from_infinity(const Scene &scene, const AimedDisks &aimed, const Light &light,
                                                 ShutterTime time, Vec2f u_position, Vec2f u_direction,
                                                 float u_choice) {
    const BoundedMedia &media = *scene.medium->bounded();
    const auto from = sample_light(light, media.bounds_center(), u_direction);
    if (!from)
        return std::nullopt;
    const size_t count = aimed.disks.size();
    const size_t aim = std::min(size_t(u_choice * float(count)), count - 1);
    const auto &[center, radius] = aimed.disks[aim];
    const Vec2f p = sample_uniform_disk(u_position);
    const Frame frame(from->direction);
    const Vec3f target = center + (frame.x * p.x + frame.y * p.y) * radius;
    const Rgb irradiance = from->radiance * (1 / from->pdf);
    const Ray ray{target + from->direction * (2 * scene.bounds_radius), -from->direction, time};
    const float on_media = max_component(irradiance) * kPi * media.bounds_radius() * media.bounds_radius();
    return InfiniteStart{{ray, irradiance * (1 / aimed.density(target, from->direction, aim))}, from->delta, on_media};
}

} // namespace

LightVertices trace_light_subpaths(const Scene &scene, const ImportanceMap &importance, const VplSettings &settings,
                                   ShutterTime time, Sampler &sampler, TraceContext &rays) {
    LightVertices out;
    out.medium.directed = scene.medium && scene.medium->phase().g != 0;
    out.medium.counted = !(settings.limits == DepthLimits{});
    out.medium.grouped = settings.grouped;
    const LightSet &lights = scene.lights;
    const std::vector<double> shares = start_shares(scene, importance);
    LightSubpath subpath(scene, importance, settings, sampler, rays, out);
    const StartRegion camera = scene.camera.start_region();
    std::optional<AimedDisks> aimed;
    if (scene.medium && scene.medium->bounded())
        aimed.emplace(scene);
    // Systematic sampling with one random number: light i starts its share of the subpaths, to within one.
    double cursor = shares.empty() ? 0 : double(sampler.next_1d()), sum = 0;
    for (uint32_t i = 0; i < shares.size(); ++i) {
        sum += shares[i] * settings.paths;
        const LightBound &b = lights.bound(i);
        const uint8_t group = lights.flags(i).group;
        // A sphere shines towards the side that the camera is on; towards both where camera rays may start on both, and
        // where what shines inwards comes out again.
        const auto *sphere = std::get_if<SphereLight>(&lights[i]);
        const bool clear = sphere && scene.materials.bounds(scene.sphere_materials[sphere->index]).transparent;
        const float distance = length(b.center - camera.center);
        const bool both = sphere && (clear || std::abs(distance - b.radius) <= camera.radius);
        for (; cursor < sum && !rays.stopped(); cursor += 1) {
            const Vec2f u_position = sampler.next_2d(), u_direction = sampler.next_2d();
            if (b.infinite) {
                auto start =
                    start_from_infinity(scene, *aimed, lights[i], time, u_position, u_direction, sampler.next_1d());
                if (!start || is_black(start->emission.power))
                    continue;
                const auto weight = float(1 / (shares[i] * settings.paths));
                start->emission.power *= weight;
                const float target = start->body_power * weight * importance(scene.medium->bounded()->bounds_center());
                subpath.trace(start->emission, start->delta, {}, target, group);
                continue;
            }
            const bool inwards = both ? sampler.next_1d() < 0.5f : distance < b.radius;
            auto start = sample_emission(lights[i], inwards, u_position, u_direction, sampler.next_1d());
            if (!start || is_black(start->power))
                continue;
            start->ray.time = time;
            if (start->dark > 0)
                start->power *= passes_dark(scene, *start, rays);
            start->power *= float((both ? 2 : 1) / (shares[i] * settings.paths));
            const float target = max_component(start->power) * importance(b.center);
            subpath.trace(*start, traits(lights[i]).delta, dielectrics_at(scene, start->ray.origin, time, kSubpathKind),
                          target, start->group ? start->group : group);
        }
    }
    return out;
}

} // namespace glimmer
