// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrator/vpl/light_subpaths.h"

#include "camera/camera_sample.h"
#include "integrator/dielectric_crossing.h"
#include "integrator/return_bound.h"
#include "integrator/shading_frame.h"
#include "integrator/vpl/bounded_fraction.h"
#include "light/emission.h"
#include "medium/phase.h"

#include <cmath>

namespace glimmer {

namespace {

constexpr float kGuidedStart = 0.85f; // of the paths start by importance, the rest at any light
constexpr uint32_t kBeams = 32;       // of what no vertex holds, at a surface; times the path's weight, up to so much:
constexpr float kMostBeams = 64;      // a path straight from a moon far off in the haze may be worth thousands
constexpr float kSplitAbove = 1.5f, kMostBranches = 8;
// Paths live on with that much less than the window asks for, and split the sooner: at equal cost the error of pixels
// is the same, .92 in thick medium, that of blocks, which all come from the same paths, .74 there and .9 over plates.
constexpr float kWindowScale = 1.5f;

/// One path. All of its decisions follow the flux, so refraction scales nothing. Light that comes from a point by way
/// of mirrors and glass alone is left out: no path from the camera meets it, and so nothing would give back what
/// bounded connections take away of it.
class LightSubpath {
  public:
    LightSubpath(const Scene &scene, const ImportanceMap &importance, const VplSettings &settings, Sampler &sampler,
                 TraceContext &rays, LightVertices &out)
        : scene_(scene), importance_(importance), settings_(settings), sampler_(sampler), rays_(rays), out_(out) {}

    void trace(const Emission &start, bool from_delta, const InteriorStack &around, float target) {
        target_ = target;
        branches_.push_back({start.ray, start.power, around, from_delta});
        for (uint64_t i = 1; i < kMaxVertices && !branches_.empty() && (i % kCancelCheckInterval || !rays_.stopped());
             ++i) {
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
        InteriorStack glass;
        bool from_delta;             ///< straight from a light without size
        uint32_t specular_depth = 0; ///< mirrors and glass in a row
        float remainder = 0; ///< the part of the power that no vertex holds where the ray began; 0 but on surfaces
    };

    void segment(Branch path) {
        const auto hit = scene_.accel->intersect(path.ray);
        ++rays_.rays;
        const float own = path.ray.t_max; // finite only within a see-through ball, where it ends
        path.ray.t_max = kInfinity;
        if (scene_.medium && path.glass.empty()) {
            const FreeFlight flight = sample_free_flight(*scene_.medium, path.power, hit ? hit->t : own, sampler_);
            path.power *= flight.weight;
            if (flight.scattered)
                return scatter_in_medium(path, path.ray.origin + path.ray.direction * flight.t);
        }
        if (hit)
            scatter_at_surface(path, *hit);
    }

    /// What no vertex holds of the light that leaves a surface, seen in the medium.
    void splat_segment(const Branch &path) {
        if (!(path.remainder > 0) || !is_seen(scene_, path.ray))
            return;
        SubpathSegment beam{path.ray, path.power, path.remainder};
        ++rays_.rays;
        if (const auto hit = scene_.accel->intersect(path.ray))
            beam.ray.t_max = hit->t;
        splat(scene_, beam, settings_, sampler_, rays_, out_.splats);
    }

    /// The weight window: what a path carries to x, relative to what the importance of the place asks for. Below 1 it
    /// lives on with that probability; far above, it is worth several paths.
    float survive(Branch &path, const Vec3f &x) {
        const float weight =
            kWindowScale * max_component(path.power) * importance_(x) * return_bound(scene_, x) / target_;
        if (!(weight > 0) || (weight < 1 && sampler_.next_1d() >= weight))
            return 0;
        if (weight >= 1)
            return weight;
        path.power *= 1 / weight;
        return 1;
    }

    /// Goes on as one path, or as several that share its power.
    template <class GoOn>
    void split(Branch &path, float weight, const GoOn &go_on) {
        const uint32_t n = weight > kSplitAbove ? uint32_t(std::min(weight + 0.5f, kMostBranches)) : 1;
        path.power *= 1 / float(n);
        for (uint32_t i = 0; i < n; ++i)
            go_on(path);
    }

    void scatter_in_medium(Branch &path, const Vec3f &x) {
        const float weight = survive(path, x);
        if (weight == 0)
            return;
        const Vec3f before = path.ray.direction;
        out_.medium.add(x, path.power, before);
        split(path, weight, [&](Branch &next) {
            next.from_delta = false;
            next.specular_depth = 0;
            next.remainder = 0;
            next.ray = {x, HenyeyGreenstein{scene_.medium->g}.sample(before, sampler_.next_2d()).direction};
            branches_.push_back(next);
        });
    }

    void scatter_at_surface(Branch &path, const Hit &hit) {
        Interaction surface = scene_.interaction(path.ray, hit);
        const Material &material = scene_.materials[surface.material];
        if (material.kind == MaterialKind::glass)
            return cross_dielectric(path, surface, material);
        arena_.clear();
        const Bsdf bsdf = scene_.materials.shade(surface, {-path.ray.direction}, arena_).bsdf;
        const float weight = bsdf.empty() ? 0 : survive(path, surface.position);
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
                        surface.v};
        if (!(dot(incoming, v.geometric) > 0))
            return;
        if (!is_specular(bsdf))
            out_.surface.push_back(v);
        if (scene_.medium && path.glass.empty() && !is_bounded(max_value(bsdf))) {
            const auto beams = uint32_t(float(kBeams) * std::min(weight, kMostBeams));
            for (uint32_t k = 0; k < beams; ++k) {
                Branch beam = path;
                beam.power *= 1 / float(beams);
                if (reflect(beam, v, surface, bsdf))
                    splat_segment(beam);
            }
        }
        split(path, weight, [&](Branch next) {
            if (reflect(next, v, surface, bsdf))
                branches_.push_back(next);
        });
    }

    /// Samples the adjoint of what a camera path does: f |w_in.ns| / |w_in.ng| * |w_out.ng|, with the frame as seen
    /// along w_out (Veach 1997, 5.3). Where the normals differ, the frame of w_in has no samples for some directions
    /// that the camera can see: a part of them is drawn about the true normal.
    bool reflect(Branch &path, const SurfaceVertex &v, const Interaction &surface, Bsdf bsdf) {
        const bool bent = !(v.shading == v.geometric), about_shading = is_above_horizon(v.shading, v.incoming);
        const Frame frame(about_shading ? v.shading : v.geometric);
        const Vec3f incoming = frame.to_local(v.incoming);
        if (!(incoming.z > 0))
            return false;
        constexpr float kTrueNormal = 0.125f, kTrueMirror = 0.25f;
        const float even = bent && !is_specular(bsdf) ? kTrueNormal : 0;
        const float flat = bent && about_shading && has_specular(bsdf) && mirrors_beneath_horizon(v) ? kTrueMirror : 0;
        const float own = 1 - even - flat, u_way = bent ? sampler_.next_1d() : 1;
        if (u_way < flat) {
            const Frame true_frame(v.geometric);
            const auto s = sample(bsdf, true_frame.to_local(v.incoming), sampler_.next_1d(), sampler_.next_2d());
            return s && s->specular && reflect_as_mirror(path, v, surface, true_frame, false, *s, flat);
        }
        Vec3f direction;
        float density;
        if (u_way < flat + even) {
            path.specular_depth = 0;
            direction = normalize(Frame(v.geometric).to_world(sample_cosine_hemisphere(sampler_.next_2d())));
            density = pdf(bsdf, incoming, frame.to_local(direction));
        } else {
            const auto s = sample(bsdf, incoming, sampler_.next_1d(), sampler_.next_2d());
            if (!s)
                return false;
            if (s->specular)
                return reflect_as_mirror(path, v, surface, frame, about_shading, *s, own);
            direction = normalize(frame.to_world(s->wi));
            if (!(dot(direction, v.geometric) > 0))
                return false;
            path.specular_depth = 0;
            density = s->pdf;
            if (!bent) {
                path.power *= s->weight * scale_of_flux(frame.z, v.geometric, v.incoming, direction, s->wi.z);
                leave(path, surface, direction, 1 - bounded_fraction(bsdf, s->wi, incoming));
                return true;
            }
        }
        const float cosine = dot(direction, v.geometric);
        if (!(cosine > 0))
            return false;
        density = own * density + even * pdf_cosine_hemisphere(cosine);
        const Connection c = connect(v, bsdf, direction);
        path.power *= c.factor * (1 / density);
        leave(path, surface, direction, 1 - c.bounded);
        return true;
    }

    /// Whether a camera path may come from where a mirror about the true normal sends the light.
    static bool mirrors_beneath_horizon(const SurfaceVertex &v) {
        const Vec3f mirrored = v.geometric * (2 * dot(v.incoming, v.geometric)) - v.incoming;
        return !is_above_horizon(v.shading, mirrored);
    }

    /// share: of the draws that were for a sample of this frame.
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
        path.ray = {surface.origin_towards(direction), direction};
    }

    bool survives_specular(Branch &path) {
        const float survival = specular_survival(path.specular_depth++);
        if (survival < 1 && sampler_.next_1d() >= survival)
            return false;
        path.power *= 1 / survival;
        return true;
    }

    void cross_dielectric(Branch &path, const Interaction &surface, const Material &material) {
        if (path.from_delta || !survives_specular(path))
            return;
        DielectricCrossing crossing(surface, material, path.ray.direction, path.glass);
        const bool bent = !(crossing.shading == crossing.geometric);
        if (bent && crossing.about_shading && crossing.may_leave_beneath_horizon()) {
            crossing.shade(sampler_.next_1d() < 0.5f);
            path.power *= 2;
        }
        const DielectricSample s =
            sample_dielectric(crossing.outgoing, crossing.eta, material.schlick, sampler_.next_1d());
        const Vec3f direction = crossing.to_world(s.wi);
        if (!crossing.possible(direction, s.transmitted))
            return;
        if (bent) {
            if (!crossing.holds_backwards(direction, s.transmitted) || !(dot(crossing.back, crossing.geometric) > 0))
                return;
            path.power *=
                scale_of_flux(crossing.frame.z, crossing.geometric, crossing.back, direction, std::abs(s.wi.z));
        }
        if (s.transmitted)
            path.glass = crossing.beyond;
        leave(path, surface, direction, 1);
        if (scene_.medium && path.glass.empty())
            splat_segment(path);
        branches_.push_back(path);
    }

    const Scene &scene_;
    const ImportanceMap &importance_;
    const VplSettings &settings_;
    Sampler &sampler_;
    TraceContext &rays_;
    LightVertices &out_;
    ClosureArena arena_; ///< of the vertex where the path is
    std::vector<Branch> branches_;
    float target_ = 1;
};

} // namespace

Connection connect(const SurfaceVertex &v, Bsdf bsdf, const Vec3f &direction) {
    const float cosine = dot(direction, v.geometric);
    if (!(cosine > 0))
        return {};
    const Frame frame(is_above_horizon(v.shading, direction) ? v.shading : v.geometric);
    const Vec3f incoming = frame.to_local(v.incoming), outgoing = frame.to_local(direction);
    if (!(incoming.z > 0) || !(outgoing.z > 0))
        return {};
    const Rgb f_cos = eval(bsdf, outgoing, incoming);
    return {f_cos * (cosine / dot(v.incoming, v.geometric)), bounded_fraction(f_cos, outgoing.z, incoming.z)};
}

ImportanceMap::ImportanceMap(const Scene &scene, std::vector<Vec3f> points) : points_(std::move(points)) {
    if (!scene.medium)
        return;
    soften_ = 0.25f / (max_component(scene.medium->sigma_t) * max_component(scene.medium->sigma_t));
    kappa_ = effective_attenuation(*scene.medium);
}

float ImportanceMap::operator()(const Vec3f &x) const {
    float sum = 1e-30f;
    for (const Vec3f &q : points_) {
        const float d2 = length_squared(x - q);
        sum += std::exp(-kappa_ * std::sqrt(d2)) / std::sqrt(d2 + soften_);
    }
    return std::sqrt(sum * std::sqrt(sum));
}

std::vector<Vec3f> sample_visible_points(const Scene &scene, const Rectangle &pixels,
                                         const InteriorStack &around_camera, uint32_t count, Sampler &sampler,
                                         TraceContext &rays) {
    std::vector<Vec3f> points;
    if (!scene.medium || !around_camera.empty())
        return points;
    for (uint32_t i = 0; i < count; ++i) {
        const uint32_t x = pick_pixel(pixels.x, pixels.width, sampler.next_1d()),
                       y = pick_pixel(pixels.y, pixels.height, sampler.next_1d());
        const Ray ray = sample_camera_ray(scene, x, y, sampler.next_2d(), sampler.next_2d()).ray;
        const auto hit = scene.accel->intersect(ray);
        ++rays.rays;
        const float u_channel = scene.medium->monochromatic ? 0 : sampler.next_1d();
        const uint64_t bits = ~0ull / count * i + sampler.next_bits() / count;
        const Collision c = sample_collision(*scene.medium, Rgb(1), hit ? hit->t : kInfinity, u_channel, bits);
        if (c.pdf > 0)
            points.push_back(ray.origin + ray.direction * c.t);
    }
    return points;
}

LightVertices trace_light_subpaths(const Scene &scene, const ImportanceMap &importance, const VplSettings &settings,
                                   Sampler &sampler, const std::atomic<bool> &stop, TraceContext &rays) {
    const LightSet &lights = scene.lights;
    std::vector<double> shares(lights.size());
    double total = 0;
    uint32_t finite = 0;
    for (uint32_t i = 0; i < lights.size(); ++i)
        if (const LightBound &b = lights.bound(i); !b.infinite) {
            total += shares[i] = double(b.strength) * double(importance(b.center));
            ++finite;
        }
    LightVertices out;
    out.medium.directed = scene.medium && scene.medium->g != 0;
    if (!finite)
        return out;
    for (uint32_t i = 0; i < lights.size(); ++i)
        if (!lights.bound(i).infinite)
            shares[i] = (total > 0 ? double(kGuidedStart) * shares[i] / total + double(1 - kGuidedStart) / finite
                                   : 1.0 / finite);
    LightSubpath path(scene, importance, settings, sampler, rays, out);
    const StartRegion camera = scene.camera.start_region();
    // One systematic draw: light i gets its share of the paths, to within one.
    double cursor = double(sampler.next_1d()), sum = 0;
    for (uint32_t i = 0; i < lights.size(); ++i) {
        sum += shares[i] * settings.paths;
        const LightBound &b = lights.bound(i);
        // A sphere shines to the side on which the camera is; to both where its rays may start on both.
        const float distance = length(b.center - camera.center);
        const bool both =
            std::holds_alternative<SphereLight>(lights[i]) && std::abs(distance - b.radius) <= camera.radius;
        for (; cursor < sum && !stop.load(std::memory_order_relaxed); cursor += 1) {
            const Vec2f u_position = sampler.next_2d(), u_direction = sampler.next_2d();
            const bool inwards = both ? sampler.next_1d() < 0.5f : distance < b.radius;
            auto start = sample_emission(lights[i], inwards, u_position, u_direction, sampler.next_1d());
            if (!start || is_black(start->power))
                continue;
            start->power *= float((both ? 2 : 1) / (shares[i] * settings.paths));
            const float target = max_component(start->power) * importance(b.center);
            path.trace(*start, std::holds_alternative<PointLamp>(lights[i]), dielectrics_at(scene, start->ray.origin),
                       target);
        }
    }
    return out;
}

} // namespace glimmer
