// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrator/path.h"

#include "integrator/glass_crossing.h"
#include "integrator/light_pool.h"
#include "integrator/mis.h"
#include "integrator/path_state.h"
#include "integrator/surroundings.h"
#include "light/line_sampler.h"
#include "medium/phase.h"

#include <array>
#include <cmath>

namespace glimmer {

namespace {

constexpr uint32_t kAllLights = 16; // up to here every light is sampled at what the camera sees
constexpr uint32_t kManyLights = 4; // beyond, so many choices
constexpr size_t kBranches = 24;    // unfinished branches of one camera sample; beyond, segments are no longer split
constexpr uint64_t kVertexGuard = 1u << 22; // of one camera sample; reached only where light is shut in without end

// Stratified sample sets of the camera's own segment; everything later draws independent numbers.
enum Set : uint32_t { kSetCollision = 2, kSetPhase, kSetLobe, kSetBsdf, kSetLine = 16, kSetLight = 80 };

/// Kept from sample to sample, so that the path loop allocates nothing.
std::vector<PathState> &thread_stack() {
    thread_local std::vector<PathState> stack;
    return stack;
}

/// The work on one camera sample.
class PathSample {
  public:
    PathSample(const Scene &scene, const DepthLimits &limits, const PathOptions &options, const LightPoolBlock *pool,
               Sampler &sampler, RayCounter &rays)
        : scene_(scene), limits_(limits), options_(options), pool_(pool), sampler_(sampler), rays_(rays) {
        if (scene_.medium) {
            const Rgb &s = scene_.medium->sigma_t;
            sigma_ = std::min(s.r, std::min(s.g, s.b));
        }
    }

    FilmSample run(const PathState &camera) {
        stack_.clear();
        push(camera);
        uint64_t vertices = 0;
        while (!stack_.empty() && ++vertices < kVertexGuard) {
            const PathState next = stack_.back();
            stack_.pop_back();
            follow(next);
        }
        return result_;
    }

  private:
    // -- One segment ---------------------------------------------------------------------------------------------

    void follow(PathState state) {
        const Homogeneous *fog = scene_.medium && state.glass.empty() ? &*scene_.medium : nullptr;
        if (state.compensates())
            return compensate(state, *fog);
        const std::optional<Hit> hit = intersect(state.ray);
        const float end = hit ? hit->t : kInfinity;

        add_lamps(state, end, fog);
        std::optional<Interaction> surface;
        if (hit) {
            surface = scene_.interaction(state.ray, *hit);
            if (state.direct_view() && state.depth == 0)
                note_first_surface(*surface);
            add_emission(state, *hit, *surface, fog);
        } else {
            add_infinity(state, fog);
        }
        if (state.depth >= limits_.depth)
            return;

        if (fog && fog->scatters() && state.scatter < limits_.scatter) {
            const bool split = pool_ || (options_.split && state.direct_view() && stack_.size() < kBranches);
            if (lights_along(state))
                sample_lights_along(state, end, *fog, split);
            if (pool_)
                gather_along(state, end, *fog);
            else if (split)
                split_into_fog(state, end, *fog);
            else if (fly_into_fog(state, end, *fog))
                return;
            if (split && surface)
                state.beta *= fog->transmittance(end);
        } else if (fog && surface) {
            state.beta *= fog->transmittance(end);
        }
        if (!surface)
            return;
        if (fog && state.direct_view()) // an absorber in front of everything dims the picture, not what is behind it
            state.exempt *= least_absorbed(*fog, end);
        scatter_at_surface(state, *surface);
    }

    // -- Light vertices ------------------------------------------------------------------------------------------

    /// Points in the fog of the segment that are joined to the pool; several where the camera sees it directly.
    void gather_along(const PathState &state, float end, const Homogeneous &fog) {
        const uint32_t n = state.direct_view() ? pool_->settings.gathers : 1;
        const uint64_t stratum = ~0ull / n;
        for (uint32_t k = 0; k < n; ++k) {
            const uint64_t bits = stratum * k + sampler_.next_bits() / n;
            const Collision c = sample_collision(fog, state.beta, end, fog.grey ? 0 : sampler_.next_1d(), bits);
            if (!(c.pdf > 0))
                return;
            PathState at = state;
            at.beta *= c.weight * (1 / float(n));
            at.ray.origin = state.ray.origin + state.ray.direction * c.t;
            at.first = state.direct_view() ? PathState::First::fog : state.first;
            gather(at, float(n));
        }
    }

    /// All light that reaches state.ray.origin scattered, as the fog scatters it there: from the pool, and by a short
    /// ray for what the pool's bounded connections leave out. `scale`: the point is one of so many.
    void gather(PathState &state, float scale) {
        const Vec3f x = state.ray.origin;
        state.exempt /= scale;
        if (!survives(state, x))
            return;
        state.exempt *= scale;
        const Rgb value = state.beta * pool_->pool.gather(x, sampler_, rays_);
        (state.first == PathState::First::surface ? result_.indirect : result_.fog) += value;
        const float u = sampler_.next_1d(), k = std::sqrt((1 - u) / std::max(u, 1e-12f)); // P(k d0 > d) = 1 - w(d)
        state.fog_reach = k * pool_->settings.fog_bound;
        state.surface_reach = k * pool_->settings.surface_bound;
        state.ray = {x, sample_uniform_sphere(sampler_.next_2d())};
        state.origin = {};
        ++state.depth;
        ++state.scatter;
        ++state.order;
        push(state);
    }

    /// The share 1 - w(d) of the vertex that a ray from a gather meets. Specular surfaces hold no vertices: they are
    /// passed in full.
    void compensate(PathState &state, const Homogeneous &fog) {
        const float fog_reach = state.fog_reach, surface_reach = state.surface_reach;
        state.fog_reach = state.surface_reach = kInfinity;
        const float reach = scene_.has_specular ? kInfinity : std::max(fog_reach, surface_reach);
        state.ray.t_max = reach;
        const std::optional<Hit> hit = intersect(state.ray);
        const float end = hit ? hit->t : reach;
        state.ray.t_max = kInfinity;
        const FreeFlight flight = sample_free_flight(fog, state.beta, end, sampler_);
        state.beta *= flight.weight;
        if (flight.scattered) {
            if (flight.t > fog_reach)
                return;
            state.ray.origin = state.ray.origin + state.ray.direction * flight.t;
            sample_light_in_fog(state, state.ray.origin, fog, false);
            gather(state, 1);
        } else if (hit) {
            const Interaction surface = scene_.interaction(state.ray, *hit);
            scatter_at_surface(state, surface, hit->t <= surface_reach);
        }
    }

    /// The largest transmittance of a channel as far as absorption goes.
    static float least_absorbed(const Homogeneous &fog, float t) {
        return std::exp(-optical_depth(std::min(fog.sigma_a.r, std::min(fog.sigma_a.g, fog.sigma_a.b)), t));
    }

    // -- Light met by chance -------------------------------------------------------------------------------------

    void add_emission(const PathState &state, const Hit &hit, const Interaction &surface, const Homogeneous *fog) {
        const Rgb &emission = scene_.materials[surface.material].emission;
        if (is_black(emission))
            return;
        float weight = 1;
        if (hit.instance == kNone) {
            const uint32_t light = scene_.lights.of_sphere(hit.primitive);
            weight = direction_weight(state, light, kNone, hit.t, 1);
        } else if (scene_.lights.of_meshes() != kNone) {
            const auto &mesh = std::get<MeshLight>(scene_.lights[scene_.lights.of_meshes()]);
            const uint32_t triangle = mesh.triangle_of[mesh.first_of_instance[hit.instance] + hit.primitive];
            if (triangle != kNone)
                weight = direction_weight(state, scene_.lights.of_meshes(), triangle, hit.t,
                                          std::abs(dot(surface.geometric_normal, state.ray.direction)));
        }
        add_seen(state, emission * weight, hit.t, fog);
    }

    void add_lamps(const PathState &state, float end, const Homogeneous *fog) {
        if (state.depth == 0) // the camera does not see lamps
            return;
        Ray ray = state.ray;
        ray.t_max = end;
        for (uint32_t light : scene_.lights.lamps())
            if (const auto lamp = intersect_lamp(scene_.lights[light], ray))
                add_seen(state, lamp->radiance * direction_weight(state, light, kNone, lamp->t, 1), lamp->t, fog);
    }

    void add_infinity(const PathState &state, const Homogeneous *fog) {
        for (uint32_t light : scene_.lights.infinite()) {
            const bool sun = std::holds_alternative<SunLamp>(scene_.lights[light]);
            if (sun && state.depth == 0)
                continue;
            const Rgb radiance = radiance_from_infinity(scene_.lights[light], state.ray.direction);
            if (!is_black(radiance))
                add_seen(state, radiance * direction_weight(state, light, kNone, kInfinity, 1), kInfinity, fog);
        }
    }

    void add_seen(const PathState &state, const Rgb &radiance, float distance, const Homogeneous *fog) {
        const Rgb value = state.beta * radiance * (fog ? fog->transmittance(distance) : Rgb(1));
        switch (state.first) {
        case PathState::First::none:
            result_.emission += value;
            break;
        case PathState::First::fog:
            result_.fog += value;
            break;
        case PathState::First::surface:
            (state.order == 1 ? result_.direct : result_.indirect) += value;
        }
    }

    /// The weight of a light met by chance against having been sampled from the vertex before.
    float direction_weight(const PathState &state, uint32_t light, uint32_t triangle, float distance,
                           float cosine) const {
        const DirectionOrigin &o = state.origin;
        if (o.kind == DirectionOrigin::Kind::specular || light == kNone)
            return 1;
        const float at_light =
            light_pdf(scene_.lights[light], o.position, state.ray.direction, triangle, distance, cosine);
        if (o.kind == DirectionOrigin::Kind::surface)
            return balance(o.pdf, expected_samples(o.all_lights, light, o.position) * at_light);
        if (scene_.lights.bound(light).infinite)
            return 1;
        if (!o.along)
            return balance(o.pdf, expected_samples(false, light, o.position) * at_light);
        const LineSampler line = line_sampler(light, o.segment_origin, o.segment_direction, o.segment_end);
        const float samples =
            expected_samples(o.all_lights, light, o.segment_origin, o.segment_direction, o.segment_end);
        return balance(o.distance_pdf * o.pdf, samples * line.pdf(o.distance) * at_light);
    }

    // -- Choice of lights: the expected number of samples that a light gets takes the place of its probability -------

    /// Whether light is sampled along this segment, or at the collision that ends it.
    bool lights_along(const PathState &state) const {
        return state.direct_view() ? options_.line_lights : options_.deep_line_lights;
    }
    bool every_light(bool all) const { return all && options_.all_lights && scene_.lights.size() <= kAllLights; }
    uint32_t choices(bool all) const {
        return every_light(all) ? scene_.lights.size() : all && options_.all_lights ? kManyLights : 1;
    }

    /// The i-th choice at a place: x, or the segment (origin, direction, end).
    template <class... Place>
    LightChoice choose(uint32_t i, bool all, const Place &...place) {
        if (every_light(all))
            return {i, 1};
        const float u = sampler_.next_1d(), n = float(scene_.lights.size());
        LightChoice choice = options_.guided_choice ? scene_.lights.choose(place..., sigma_, u)
                                                    : LightChoice{std::min(uint32_t(u * n), uint32_t(n) - 1), 1 / n};
        choice.probability *= float(choices(all));
        return choice;
    }
    template <class... Place>
    float expected_samples(bool all, uint32_t light, const Place &...place) const {
        if (every_light(all))
            return 1;
        const float probability = options_.guided_choice ? scene_.lights.probability(light, place..., sigma_)
                                                         : 1 / float(scene_.lights.size());
        return float(choices(all)) * probability;
    }

    LineSampler line_sampler(uint32_t light, const Vec3f &origin, const Vec3f &direction, float end) const {
        const LightBound &b = scene_.lights.bound(light);
        return {*scene_.medium, origin, direction, end, b.center, b.radius};
    }

    // -- Fog -----------------------------------------------------------------------------------------------------

    /// The light that the fog scatters once into the segment.
    void sample_lights_along(const PathState &state, float end, const Homogeneous &fog, bool split) {
        if (scene_.lights.size() == 0)
            return;
        const bool camera = state.depth == 0, all = state.direct_view();
        const HenyeyGreenstein phase{fog.g};
        const Vec3f &origin = state.ray.origin, &direction = state.ray.direction;
        for (uint32_t i = 0; i < choices(all); ++i) {
            const LightChoice choice = choose(i, all, origin, direction, end);
            if (scene_.lights.bound(choice.index).infinite)
                continue; // an endless fog lets nothing through from there
            const LineSampler line = line_sampler(choice.index, origin, direction, end);
            const LineSample at = line.sample(camera ? sampler_.stratified_1d(kSetLine + 2 * i) : sampler_.next_1d());
            if (!(at.pdf > 0) || !(at.t < kInfinity))
                continue;
            const Vec3f x = origin + direction * at.t;
            const auto light = sample_light(scene_.lights[choice.index], x,
                                            camera ? sampler_.stratified_2d(kSetLine + 2 * i + 1) : sampler_.next_2d());
            if (!light)
                continue;
            const float p_phase = phase.eval(direction, light->direction);
            const Rgb unshadowed = fog.sigma_s * fog.transmittance(at.t + light->distance) * light->radiance *
                                   (p_phase / light->pdf / at.pdf / choice.probability);
            if (is_black(unshadowed) || occluded(x, *light))
                continue;
            float weight = 1;
            if (!light->delta && !pool_) { // a pool's gathers are not lit by chance
                const float p_distance =
                    split ? collision_pdf(fog, state.beta, end, at.t) : free_flight_pdf(fog, state.beta, at.t);
                weight = balance(choice.probability * at.pdf * light->pdf, p_distance * p_phase);
            }
            const Rgb value = state.beta * unshadowed * weight;
            (state.first == PathState::First::surface ? result_.indirect : result_.fog) += value;
        }
    }

    /// One path that goes on from within the segment, given that it scatters there.
    void split_into_fog(const PathState &state, float end, const Homogeneous &fog) {
        const bool camera = state.depth == 0;
        const Collision c =
            camera ? sample_collision(fog, state.beta, end, sampler_.next_1d(), sampler_.stratified_bits(kSetCollision))
                   : sample_collision(fog, state.beta, end, sampler_);
        if (c.pdf > 0)
            scatter_in_fog(state, end, fog, c.t, c.weight, c.pdf);
    }

    /// True when the path scattered before the surface; else its throughput is that of a path that passed.
    bool fly_into_fog(PathState &state, float end, const Homogeneous &fog) {
        const FreeFlight flight = sample_free_flight(fog, state.beta, end, sampler_);
        if (!flight.scattered) {
            state.beta *= flight.weight;
            return false;
        }
        if (flight.pdf > 0)
            scatter_in_fog(state, end, fog, flight.t, flight.weight, flight.pdf);
        return true;
    }

    void scatter_in_fog(const PathState &state, float end, const Homogeneous &fog, float t, const Rgb &weight,
                        float pdf) {
        PathState next = state;
        next.beta *= weight;
        const Vec3f x = state.ray.origin + state.ray.direction * t;
        if (!lights_along(state))
            sample_light_in_fog(next, x, fog, true);
        if (!survives(next, x))
            return;
        const bool camera = state.depth == 0;
        const PhaseSample s = HenyeyGreenstein{fog.g}.sample(
            state.ray.direction, camera ? sampler_.stratified_2d(kSetPhase) : sampler_.next_2d());
        next.ray = {x, s.direction};
        next.origin = {DirectionOrigin::Kind::fog,
                       state.direct_view(),
                       lights_along(state),
                       s.pdf,
                       x,
                       state.ray.origin,
                       state.ray.direction,
                       end,
                       t,
                       pdf};
        ++next.depth;
        ++next.scatter;
        if (state.direct_view())
            next.first = PathState::First::fog;
        ++next.order;
        push(next);
    }

    /// One light at a collision; by_chance: against the phase function that goes on from there and may meet it too.
    void sample_light_in_fog(const PathState &state, const Vec3f &x, const Homogeneous &fog, bool by_chance) {
        if (scene_.lights.size() == 0)
            return;
        const LightChoice choice = choose(0, false, x);
        const auto light = sample_light(scene_.lights[choice.index], x, sampler_.next_2d());
        if (!light)
            return;
        const float p_phase = HenyeyGreenstein{fog.g}.eval(state.ray.direction, light->direction);
        const Rgb unshadowed =
            fog.transmittance(light->distance) * light->radiance * (p_phase / light->pdf / choice.probability);
        if (is_black(unshadowed) || occluded(x, *light))
            return;
        const float weight = light->delta || !by_chance ? 1 : balance(choice.probability * light->pdf, p_phase);
        const Rgb value = state.beta * unshadowed * weight;
        (state.first == PathState::First::surface ? result_.indirect : result_.fog) += value;
    }

    // -- Surfaces ------------------------------------------------------------------------------------------------

    void note_first_surface(const Interaction &surface) {
        result_.hit = true;
        result_.normal = surface.shading_normal;
        result_.depth = dot(surface.position, scene_.camera.forward);
        result_.object_index = surface.object_index;
        result_.material_index = surface.material + 1;
    }

    /// rough: also by the lobes that hold light vertices; else by mirrors and glass alone.
    void scatter_at_surface(PathState &state, const Interaction &surface, bool rough = true) {
        const Material &material = scene_.materials[surface.material];
        if (material.kind == MaterialKind::glass)
            return pass_glass(state, surface, material);
        const Bsdf bsdf = scene_.bsdf(material);
        if (bsdf.empty() || !(rough || has_specular(bsdf)))
            return;
        const bool camera = state.depth == 0;
        const Vec3f wo = -state.ray.direction;
        // All materials but glass are two-sided: both normals turn to the viewer.
        const float side = dot(wo, surface.geometric_normal) < 0 ? -1.0f : 1.0f;
        const Vec3f geometric = surface.geometric_normal * side;
        Vec3f shading = surface.shading_normal * side;
        if (!(dot(wo, shading) > 1e-6f))
            shading = geometric;
        const Frame frame(shading);
        const Vec3f wo_local = frame.to_local(wo);
        if (!(wo_local.z > 0))
            return;
        if (state.direct_view())
            result_.albedo = albedo(bsdf);

        const bool all = state.direct_view();
        if (rough && !is_specular(bsdf))
            sample_lights_at(state, surface, bsdf, frame, geometric, wo_local, all);

        const auto s = sample(bsdf, wo_local, camera ? sampler_.stratified_1d(kSetLobe) : sampler_.next_1d(),
                              camera ? sampler_.stratified_2d(kSetBsdf) : sampler_.next_2d());
        if (!s || !(rough || s->specular))
            return;
        const Vec3f wi = normalize(frame.to_world(s->wi));
        if (!(dot(wi, geometric) > 0)) // below the true surface: a shading normal's promise that cannot be kept
            return;
        state.beta *= s->weight;
        if (!survives(state, surface.position))
            return;
        state.ray = {surface.origin_towards(wi), wi};
        ++state.depth;
        if (s->specular) {
            state.origin = {};
            state.order += state.direct_view() ? 0 : 1;
        } else {
            state.origin = {};
            state.origin.kind = DirectionOrigin::Kind::surface;
            state.origin.all_lights = all;
            state.origin.pdf = s->pdf;
            state.origin.position = lit_point(surface, geometric);
            if (state.direct_view())
                state.first = PathState::First::surface;
            ++state.order;
        }
        push(state);
    }

    /// Where lights are sampled from: the surface, but on the viewer's side for certain where it is an emissive sphere,
    /// which would light its own outside from a point that rounding put beneath it, and not its inside from one above.
    Vec3f lit_point(const Interaction &surface, const Vec3f &geometric) const {
        const bool shining_sphere =
            surface.body >= scene_.accel->instances().size() && !is_black(scene_.materials[surface.material].emission);
        return shining_sphere ? surface.origin_towards(geometric) : surface.position;
    }

    void sample_lights_at(const PathState &state, const Interaction &surface, Bsdf bsdf, const Frame &frame,
                          const Vec3f &geometric, const Vec3f &wo, bool all) {
        if (scene_.lights.size() == 0)
            return;
        const bool camera = state.depth == 0;
        const Homogeneous *fog = scene_.medium && state.glass.empty() ? &*scene_.medium : nullptr;
        const Vec3f x = lit_point(surface, geometric);
        for (uint32_t i = 0; i < choices(all); ++i) {
            const LightChoice choice = choose(i, all, x);
            const auto light = sample_light(scene_.lights[choice.index], x,
                                            camera ? sampler_.stratified_2d(kSetLight + i) : sampler_.next_2d());
            if (!light || !(dot(light->direction, geometric) > 0))
                continue;
            const Vec3f wi = frame.to_local(light->direction);
            if (!(wi.z > 0))
                continue;
            Rgb value = eval(bsdf, wo, wi) * light->radiance * (1 / light->pdf / choice.probability);
            if (fog)
                value *= fog->transmittance(light->distance);
            if (is_black(value) || occluded(surface.origin_towards(light->direction), *light, surface.error))
                continue;
            if (!light->delta)
                value *= balance(choice.probability * light->pdf, pdf(bsdf, wo, wi));
            value *= state.beta;
            switch (state.first) {
            case PathState::First::none:
                result_.direct += value;
                break;
            case PathState::First::surface:
                result_.indirect += value;
                break;
            case PathState::First::fog:
                result_.fog += value;
            }
        }
    }

    void pass_glass(PathState &state, const Interaction &surface, const Material &material) {
        const GlassCrossing crossing(surface, material, state.ray.direction, state.glass);
        const GlassSample s = sample_glass(crossing.outgoing, crossing.eta, material.schlick, sampler_.next_1d());
        const Vec3f wi = crossing.to_world(s.wi);
        if (!crossing.possible(wi, s.transmitted))
            return;
        state.beta *= s.weight;
        state.exempt *= s.weight.r;
        if (s.transmitted)
            state.glass = crossing.beyond;
        if (!survives(state, surface.position))
            return;
        state.ray = {surface.origin_towards(wi), wi};
        state.origin = {};
        state.order += state.direct_view() ? 0 : 1;
        ++state.depth;
        push(state);
    }

    // -- Shared ----------------------------------------------------------------------------------------------------

    /// `moved`: how far the origin was moved off its surface at most. A triangle that shines must not shadow itself, so
    /// the ray ends short of it by all errors of both ends, seen along its plane.
    std::optional<Hit> intersect(const Ray &ray) {
        ++rays_.rays;
        return scene_.accel->intersect(ray);
    }

    bool occluded(const Vec3f &origin, const LightSample &light, float moved = 0) {
        ++rays_.rays;
        constexpr float direction_error = 0x1p-21f; // of a unit vector in float32, and of Embree's own arithmetic
        const float short_of_light =
            light.distance * (1 - direction_error / light.facing) - (light.error + moved) / light.facing;
        const float distance = std::max(short_of_light, 0.0f);
        return scene_.accel->occluded({origin, light.direction, distance}, light.ignored_sphere);
    }

    /// Russian roulette with survival min(1, weight): a ceiling below 1 would let the weights of high albedos grow
    /// without bound.
    bool survives(PathState &state, const Vec3f &x) {
        const float weight = max_component(state.beta) / state.exempt * surroundings_importance(scene_, x);
        if (!(weight > 0))
            return false;
        if (weight >= 1)
            return true;
        if (sampler_.next_1d() >= weight)
            return false;
        state.beta *= 1 / weight;
        return true;
    }

    void push(const PathState &state) { stack_.push_back(state); }

    const Scene &scene_;
    const DepthLimits &limits_;
    const PathOptions &options_;
    const LightPoolBlock *pool_; ///< null: plain paths
    Sampler &sampler_;
    RayCounter &rays_;
    float sigma_ = 0; ///< smallest extinction of the channels
    FilmSample result_;
    std::vector<PathState> &stack_ = thread_stack(); ///< branches still to follow
};

class PathIntegrator final : public Integrator {
  public:
    PathIntegrator(const Scene &scene, const DepthLimits &limits, const PathOptions &options)
        : scene_(scene), limits_(limits), options_(options), around_camera_(glass_around(scene, Vec3f())) {
        if (options_.light_vertices && options_.line_lights && options_.deep_line_lights)
            pool_ = plan_light_pool(scene, limits, around_camera_);
    }

    bool shares() const override { return pool_ != nullptr; }
    std::unique_ptr<const PassData> prepare_pass(uint64_t seed, uint64_t sample, RayCounter &rays) const override {
        return pool_->prepare_pass(seed, sample, rays);
    }
    std::unique_ptr<const BlockData> prepare_block(const PassData &pass, const Rectangle &block,
                                                   RayCounter &rays) const override {
        return pool_->prepare_block(pass, block, rays);
    }

    FilmSample sample(const CameraRay &camera, Sampler &sampler, const BlockData *block,
                      RayCounter &rays) const override {
        PathState state;
        state.ray = camera.ray;
        state.glass = around_camera_;
        return PathSample(scene_, limits_, options_, static_cast<const LightPoolBlock *>(block), sampler, rays)
            .run(state);
    }

    std::string kernel() const override { return pool_ ? "path with shared light vertices" : "path"; }

  private:
    const Scene &scene_;
    DepthLimits limits_;
    PathOptions options_;
    GlassStack around_camera_;
    std::unique_ptr<const LightPool> pool_;
};

} // namespace

std::unique_ptr<const Integrator> make_path_integrator(const Scene &scene, const DepthLimits &limits,
                                                       const PathOptions &options) {
    return std::make_unique<PathIntegrator>(scene, limits, options);
}

} // namespace glimmer
