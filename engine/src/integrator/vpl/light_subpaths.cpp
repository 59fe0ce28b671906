// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrator/vpl/light_subpaths.h"

#include "integrator/dielectric_crossing.h"
#include "integrator/return_bound.h"
#include "integrator/roulette.h"
#include "integrator/shading_frame.h"
#include "integrator/vpl/bounded_fraction.h"
#include "integrator/vpl/connection.h"
#include "integrator/vpl/subpath_starts.h"
#include "integrator/vpl/tuning.h"
#include "light/light.h"
#include "medium/phase.h"
#include "sampling/warp.h"

#include <cmath>

namespace glimmer {

namespace {

/// One light subpath. It carries the adjoint of radiance (adjoint_weight). Light from a point light that has met only
/// mirrors and dielectrics is left out: no camera path can meet it, so nothing would compensate what bounded
/// connections take away of it.
class LightSubpath {
  public:
    LightSubpath(const Scene &scene, const ImportanceMap &importance, const VplSettings &settings, Sampler &sampler,
                 TraceContext &rays, LightVertices &out)
        : scene_(scene), importance_(importance), settings_(settings), sampler_(sampler), rays_(rays), out_(out) {}

    void trace(const SubpathStart &start) {
        target_ = start.target;
        group_ = start.emission.group;
        branches_.push_back({start.emission.ray, start.emission.power, start.around, start.delta});
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
        if (!(weight > 0) || (weight < 1 && !sampler_.next_bool(weight)))
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
            if (share == 1 || sampler_.next_bool(share)) {
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
            crossing.emplace(scene_, surface, shading.interior_ior, path.ray.direction, path.interior);
            bsdf.eta = crossing->eta;
        }
        if (!(max_value(bsdf) > 0)) // black: a vertex would bring nothing, and no light goes on
            return;
        const float weight = apply_window(path, surface.position);
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
        DielectricCrossing crossing(scene_, surface, shading.interior_ior, path.ray.direction, path.interior);
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
        path.power *= adjoint_weight(bsdf, crossing.outgoing, *s);
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

} // namespace

LightVertices trace_light_subpaths(const Scene &scene, const ImportanceMap &importance, const VplSettings &settings,
                                   ShutterTime time, Sampler &sampler, TraceContext &rays) {
    LightVertices out;
    out.medium.directed = scene.medium && scene.medium->phase().g != 0;
    out.medium.counted = !(settings.limits == DepthLimits{});
    out.medium.grouped = settings.grouped;
    const SubpathStarts starts(scene, importance, settings.paths);
    LightSubpath subpath(scene, importance, settings, sampler, rays, out);
    // Systematic sampling with one random number: light i starts its share of the subpaths, to within one.
    double cursor = starts.any() ? double(sampler.next_1d()) : 0, sum = 0;
    for (uint32_t i = 0; starts.any() && i < scene.lights.size(); ++i) {
        sum += starts.share(i) * settings.paths;
        for (; cursor < sum && !rays.stopped(); cursor += 1)
            if (const auto start = starts.sample(i, time, sampler, rays))
                subpath.trace(*start);
    }
    return out;
}

} // namespace glimmer
