// SPDX-License-Identifier: GPL-3.0-or-later
// The work on one camera sample of the path integrator. `follow` in segment.inl is the table of contents; the steps
// stand in a file each:
//   segment.inl     one segment: what ends it, and the emission that it meets
//   medium.inl      scattering in the medium along it
//   vpl_gather.inl  light scattered more than once, from the light vertices of the wave (../vpl)
//   surface.inl     scattering at its end
//   pixel_ris.inl   direct light of what the camera sees, resampled among several points of the pixel
//   passes.inl      what the passes of PassSample show
// They are compiled together, for several sets of features, by kernel.inl. docs/method.md derives the estimator; its
// section 2 says which of them brings which paths.
#pragma once

#include "integrator/path/kernels.h"
#include "integrator/path/path_state.h"
#include "integrator/path/tuning.h"
#include "integrator/roulette.h"
#include "integrator/shadow_terminator.h"
#include "integrator/visibility.h"
#include "light/equiangular_table.h"
#include "medium/phase.h"
#include "sampling/defensive_mixture.h"
#include "sampling/dimensions.h"

#include <cmath>
#include <utility>
#include <vector>

namespace glimmer {

/// The closures of a segment's end, kept from sample to sample so that shading allocates nothing.
inline ClosureArena &thread_arena() {
    thread_local ClosureArena arena;
    return arena;
}

/// The branches of one sample, kept from sample to sample so that the path loop allocates nothing.
template <class State>
std::vector<State> &thread_stack() {
    thread_local std::vector<State> stack;
    return stack;
}

template <KernelFeatures F>
class PathSample {
  public:
    using State = PathState<F>;

    PathSample(const PathContext &context, Sampler &sampler, TraceContext &trace)
        : context_(context), sampler_(sampler), trace_(trace) {
        if (F.medium && scene().medium) {
            sigma_ = scene().medium->least_extinction();
            if constexpr (F.varying_media)
                media_vary_ = scene().medium->bounded() && scene().medium->bounded()->varies();
        }
    }

    FilmSample run(const State &camera) {
        stack_.clear();
        bool resampled = false;
        if constexpr (F.surfaces)
            if (context_.plan.pixel_ris) {
                resampled = true;
                pixel_ris(camera.ray.time);
            }
        if (!resampled)
            push(camera);
        WalkGuard guard(trace_);
        for (;;) { // one call of follow(), since all of it is inlined
            while (!stack_.empty() && guard.goes_on()) {
                State next = stack_.back();
                stack_.pop_back();
                follow(next);
            }
            if (!resampled || !stack_.empty())
                break;
            resampled = false;
            if (context_.parts)
                swap_with(context_.parts->resampled, context_.parts->resampled_passes);
            push(camera);
        }
        result_.unfinished = !stack_.empty();
        return result_;
    }

  private:
    const Scene &scene() const { return context_.scene; }
    const EstimatorFlags &flags() const {
        if constexpr (F.estimator_flags)
            return context_.flags;
        else
            return kAllEstimators;
    }

    // One segment

    void follow(State &state);
    /// The medium along the segment; null where there is none.
    const Medium *medium_of(const State &state) const {
        return F.medium ? state.interior.medium(scene().outside()) : nullptr;
    }

    // The AOV that light counts for

    /// A path's first scattering decides; light that reaches a first surface straight from a light is `direct`.
    Rgb &light_aov(PathClass path_class, bool direct) {
        switch (path_class) {
        case PathClass::none:
            return result_.emission;
        case PathClass::medium:
            return result_.medium;
        case PathClass::surface:
            break;
        }
        return direct ? result_.direct : result_.indirect;
    }
    /// The AOV that emission met by the segment counts for.
    Rgb &aov_of_emission(const State &state) { return light_aov(state.path_class, state.depth_since_first == 1); }
    /// The AOV of light that a vertex on the segment or at its end scatters towards the camera.
    Rgb &aov_of_scattering(const State &state, PathClass vertex) {
        return state.seen_directly() ? light_aov(vertex, true) : light_aov(state.path_class, false);
    }

    /// Adds emission that the segment met. is_environment: of what lies beyond everything.
    void add_met(const State &state, const Rgb &value, uint8_t group, bool is_environment = false) {
        if (!is_environment || !leaves_empty(state))
            aov_of_emission(state) += value;
        if constexpr (F.passes)
            pass_met(state, value, group, is_environment);
    }
    /// Adds light that a vertex on the segment or at its end scatters towards the camera, straight from a light.
    void add_scattered(const State &state, PathClass vertex, const Rgb &value, uint8_t group,
                       const PassState *shares = nullptr) {
        aov_of_scattering(state, vertex) += value;
        if constexpr (F.passes)
            pass_scattered(state, vertex, value, group, shares);
    }

    // Passes of PassSample

    void pass_met(const State &state, const Rgb &value, uint8_t group, bool is_environment);
    void pass_scattered(const State &state, PathClass vertex, const Rgb &value, uint8_t group, const PassState *shares);
    /// The group of a light that was sampled.
    uint8_t group_of(uint32_t light, const LightSample &sample) const {
        if constexpr (F.passes)
            return sample.group ? sample.group : scene().lights.flags(light).group;
        else
            return 0;
    }
    /// Adds light to the passes of the vertex that scattered it last before the camera.
    void pass_light(const PassState &first, const Rgb &value, bool direct);
    /// What the first surface is, whatever it looks like.
    void pass_first_surface(const Interaction &surface, ShutterTime time);
    /// What a surface's material gives to the AOV passes.
    void pass_aovs(const State &state, const Interaction &surface, float distance);
    /// What a surface looks like that the camera sees, if only through others.
    void pass_surface(const State &state, const Hit &hit, const Interaction &surface, const Shading &shading);
    /// Whether the picture is empty where the state's segment meets the environment.
    bool leaves_empty(const State &state) const {
        if constexpr (F.passes)
            return state.passes.sees_environment && scene().film.transparent;
        else
            return false;
    }
    /// The picture is empty at the end of the segment.
    void pass_empty(const State &state, float end, const Medium *medium);
    /// How the lobes share the light that they reflect from wi, or transmit.
    static PassState shares_of(const Bsdf &bsdf, const Vec3f &wo, const Vec3f &wi, RayMask visible = kEveryRay);
    /// The same of a sampled direction, as the path that goes on there takes it along.
    static void set_shares(State &next, const State &state, const Bsdf &bsdf, const Vec3f &wo, const BsdfSample &s,
                           const Scene &scene);

    // Light vertices

    /// Whether light that was scattered before reaches the medium by light vertices. Only asked where it scatters.
    bool has_light_vertices() const { return !F.medium_walks || context_.light_vertices; }
    /// Samples gather points in the medium along the segment, several where the camera sees it, and gathers at each.
    void gather_along(const State &state, float end, const Medium &medium);
    /// Adds the light that the medium at state.ray.origin scatters back along the ray after it was scattered before:
    /// the bounded connections to the light vertices now, what they leave out by the compensation ray that `state`
    /// becomes. False if roulette or a depth limit ended it. points: the number of gather points of the segment.
    /// subset: of the light vertices. t: the distance of the point from where the camera's ray starts, 0 where the
    /// point is not on that ray and so no splats count.
    bool gather(State &state, float points, uint32_t subset, float t, float roulette_scale);
    /// Adds the light that arrives at a gather point straight from infinitely far. certain: the camera sees the point.
    void light_gather_point_from_infinity(const State &at, const Medium &medium, bool certain);
    /// Follows a compensation ray to the next vertex.
    void compensate(State &state, const Medium &medium);

    // Emission that a segment meets

    void add_emission(const State &state, const Hit &hit, const Interaction &surface, const Rgb &emission,
                      const Medium *medium);
    /// Whether the inside of an emissive sphere that is not opaque was met through its near side, from without. Light
    /// sampling knows the near side alone.
    bool is_far_side(const State &state, const Hit &hit, const Interaction &surface) const;
    void add_lamps(const State &state, float end, const Medium *medium);
    void add_infinity(const State &state, const Medium *medium);
    void add_emitted(const State &state, const Rgb &radiance, float distance, const Medium *medium, uint8_t group,
                     bool is_environment = false);
    /// Whether the ray could meet a light; false only where it certainly does not.
    bool may_meet_light(const Ray &ray) const;
    /// The weight of emission met at the end of a segment against light sampling at, or before, its beginning.
    float emission_mis_weight(const State &state, uint32_t light, const LightHit &hit) const;

    // Choice of lights. `several`: a place that the camera sees, where all lights are sampled, or several choices.

    /// Whether light is sampled along this segment, or else at the point where the path scatters on it.
    bool samples_lights_along(const State &state) const {
        if (F.varying_media && media_vary_) // the density of free flights is not known
            return false;
        return state.seen_directly() ? flags().equiangular : flags().deep_equiangular;
    }
    bool every_light(bool several) const {
        return several && flags().all_lights && scene().lights.size() <= tuning::kMaxLightsSampledEach;
    }
    uint32_t choices(bool several) const {
        return every_light(several)            ? scene().lights.size()
               : several && flags().all_lights ? tuning::kLightsChosenOfMany
                                               : 1;
    }
    /// The i-th choice of a light at a place: a point, or a segment (origin, direction, end). Its `probability` is the
    /// expected number of samples of that light there.
    template <class... Place>
    LightChoice choose(uint32_t i, bool several, const Place &...place) {
        if (every_light(several))
            return {i, 1};
        const float u = sampler_.next_1d(), n = float(scene().lights.size());
        LightChoice choice = flags().guided_choice ? scene().lights.choose(place..., sigma_, u)
                                                   : LightChoice{std::min(uint32_t(u * n), uint32_t(n) - 1), 1 / n};
        choice.probability *= float(choices(several));
        return choice;
    }
    /// The expected number of samples that choose() spends on a given light.
    template <class... Place>
    float expected_samples(bool several, uint32_t light, const Place &...place) const {
        if (every_light(several))
            return 1;
        const float probability = flags().guided_choice ? scene().lights.probability(light, place..., sigma_)
                                                        : 1 / float(scene().lights.size());
        return float(choices(several)) * probability;
    }
    std::optional<LightSample> sample_light(uint32_t light, const Vec3f &x, Vec2f u) const {
        if constexpr (F.visibility) {
            auto s = glimmer::sample_light(scene().lights[light], x, u);
            if (s) {
                const LightFlags &own = scene().lights.flags(light);
                s->visible &= own.visible;
                s->shadows = own.shadows;
                if (own.profile != kNone)
                    s->radiance *= scene().lights.profile(light, at_light(x, *s), -s->direction, s->distance);
            }
            return s;
        } else if constexpr (F.other_lights) {
            return glimmer::sample_light(scene().lights[light], x, u);
        } else {
            return sample_emissive_sphere(scene().lights[light], x, u);
        }
    }
    /// What a lamp's light is multiplied by where the path's ray meets it.
    Rgb profile(const State &state, uint32_t light, const Vec3f &position, float distance) const {
        if constexpr (F.visibility)
            return scene().lights.profile(light, position, -state.ray.direction, distance);
        else
            return Rgb(1);
    }
    /// f |cos_i| towards a light, of the lobes that it is visible to.
    static Rgb eval_for(const LightSample &light, const Bsdf &bsdf, const Vec3f &wo, const Vec3f &wi) {
        if (F.visibility && !is_visible_beyond_camera(light.visible))
            return eval(bsdf, wo, wi, light.visible & mask_of(RayKind::diffuse),
                        light.visible & mask_of(RayKind::glossy), light.visible & mask_of(RayKind::transmission));
        return eval(bsdf, wo, wi);
    }
    static bool lights_medium(const LightSample &light) {
        return !F.visibility || light.visible & mask_of(RayKind::volume);
    }
    /// Whether light from infinitely far reaches the medium at all: nothing comes through an endless one.
    bool is_lit_from_infinity(const Medium &medium) const {
        return F.bounded_media && medium.lets_in() && !scene().lights.infinite().empty();
    }
    EquiangularTable equiangular_table(uint32_t light, const Vec3f &origin, const Vec3f &direction, float end) const {
        const LightBound &b = scene().lights.bound(light);
        return {*scene().medium, origin, direction, end, b.center, b.radius};
    }

    // The medium

    /// What the medium leaves of light on a ray; where media vary, an estimate.
    Rgb transmittance(const Medium &medium, const Ray &ray, float t) {
        if constexpr (F.varying_media)
            if (media_vary_)
                return medium.bounded()->estimate_transmittance(ray, t, sampler_);
        return medium.transmittance(ray, t);
    }
    /// Whether a path may go on into the medium and past it: the distance to a scattering that is sure must be known.
    bool splits(const State &state) const {
        if (F.varying_media && media_vary_)
            return false;
        return has_light_vertices() ||
               (flags().split && state.seen_directly() && stack_.size() < tuning::kMaxOpenBranches);
    }
    /// Adds the light of the scene's lights that the medium scatters once into the segment. split: a path goes on from
    /// within the segment as well as from its end.
    void sample_lights_along(const State &state, float end, const Medium &medium, bool split);
    /// Lets one path go on from within the segment, as it is given that it scatters there.
    void split_into_medium(const State &state, float end, const Medium &medium);
    /// Free flight along the segment. True when the path scattered before its end; else the throughput is that of a
    /// path that passed.
    bool fly_into_medium(State &state, float end, const Medium &medium);
    /// Lets the path go on from a scattering point at t, sampled with density `pdf`.
    void scatter_in_medium(const State &state, float end, const Medium &medium, float t, const Rgb &weight, float pdf);
    /// Adds the light of one light at a scattering point. by_chance: the path that goes on from there may meet the same
    /// light by chance, so both are weighted against each other.
    void sample_light_in_medium(const State &state, const Vec3f &x, const Medium &medium, const HenyeyGreenstein &phase,
                                bool by_chance);
    /// Adds the light of the lights that are infinitely far away at a scattering point: along the segment there is
    /// nothing to choose the place by. survival: of the path that goes on, which may meet them by chance.
    void sample_infinite_lights(const State &state, const Vec3f &x, const Medium &medium, const HenyeyGreenstein &phase,
                                float survival);
    /// How many of them are sampled there, of how many that there are.
    float infinite_light_share() const {
        const size_t n = scene().lights.infinite().size();
        return n <= tuning::kInfiniteLightsSampledEach ? 1.0f : 1 / float(n);
    }
    /// Sets the phase function of a point of a ray where a path scatters: of one of the media there, chosen at random.
    /// Returns the weight of the choice.
    Rgb choose_phase(const Medium &medium, const Ray &ray, float t, HenyeyGreenstein &phase);
    /// The part of a segment on which anything scatters.
    static RayInterval scattering_range(const State &state, float end, const Medium &medium) {
        if constexpr (F.bounded_media)
            if (const BoundedMedia *bounded = medium.bounded())
                return bounded->scattering_range(state.ray, end);
        return {0, end};
    }
    /// Adds what the media along a segment emit by themselves.
    void add_medium_emission(const State &state, float end, const Medium *medium);

    // Surfaces

    /// Adds the light straight from lights on what the camera sees first, at one of several points of the pixel.
    void pixel_ris(ShutterTime time);
    void light_surface(const State &state, const Interaction &surface, const Shading &shading);
    /// A surface as it is seen along a ray. All materials but dielectrics are two-sided: both normals are turned to the
    /// side that the ray comes from.
    struct OrientedSurface {
        Frame frame;                                             ///< about the normal that it is shaded with
        Vec3f geometric;                                         ///< the true normal
        Vec3f wo;                                                ///< back along the ray, in the frame
        float eta = 1;                                           ///< Bsdf::eta
        bool bounds_interior = false;                            ///< what is transmitted enters a body or leaves it
        [[no_unique_address]] typename State::Interior beyond{}; ///< the bodies around it then
        BumpShadow bump{};                                       ///< in the frame, where a bump turned the normal
    };
    /// Whether anything is near a surface, in one direction.
    void pass_occlusion(const State &state, const Interaction &surface, const Shading &shading,
                        const OrientedSurface &at);
    /// The same where a bump turned the normal (bsdf/bump.h).
    [[gnu::noinline]] static OrientedSurface orient_bumped(const Interaction &surface, const Bsdf &bsdf,
                                                           const Vec3f &wo);
    /// Tells a BSDF what there is to know of the surface.
    static void set_surface(Bsdf &bsdf, const OrientedSurface &at) {
        bsdf.eta = at.eta;
        if (at.bump.softening != BumpSoftening::none)
            bsdf.bump = &at.bump;
    }
    std::optional<OrientedSurface> orient(const State &state, const Interaction &surface, const Shading &shading) const;
    /// Whether a sampled direction is on the side of the true surface that it claims: a shading normal may promise what
    /// cannot be kept.
    static bool is_on_side(const BsdfSample &s, const Vec3f &wi, const Vec3f &geometric);
    /// The fraction of the light from wi that light vertices bring (bounded_fraction.h): none of what comes out of a
    /// body.
    static float vertex_fraction(const OrientedSurface &at, const Rgb &f_cos, const Vec3f &wi);
    static void cross_boundary(State &state, const OrientedSurface &at);
    /// Of light that arrives from the other side of the boundary of a body.
    Rgb transmittance_beyond(const OrientedSurface &at, const Ray &ray, float distance);
    /// Lets the path go straight on behind a surface that is not opaque, with a probability, or for certain where
    /// nothing else is wanted of it. Else the state stands for what the surface scatters.
    bool passes_through(State &state, const Interaction &surface, const Shading &shading, float distance, bool certain);
    /// The closures and the emission of a surface along a ray; they last until the next segment is followed.
    Shading shade(Interaction &surface, const Ray &ray, const Arrival &arrival = {}) {
        return scene().materials.shade(surface, {-ray.direction, 0, ray.time, arrival}, arena_);
    }
    static Arrival arrival(const State &state, float distance) {
        return {state.ray_flags, float(state.depth), state.passed_length() + distance};
    }
    void note_first_surface(const Interaction &surface, ShutterTime time);
    /// The part of a BSDF (bounded_fraction.h) that is still to be scattered: its bounded fraction where splats bring
    /// the rest, the remainder where light vertices have brought the bounded fraction.
    enum class Lobes { all, bounded, remainder };
    static float fraction_of(Lobes lobes, float bounded) {
        return lobes == Lobes::all ? 1 : lobes == Lobes::bounded ? bounded : 1 - bounded;
    }
    void scatter_at_surface(State &state, const Interaction &surface, const Shading &shading, Lobes lobes = Lobes::all);
    /// Where lights are sampled from. For an emissive sphere that is a point on the viewer's side for certain: rounding
    /// can put the position itself inside, where the sphere would light its own outside, or outside, where it would not
    /// light its inside.
    Vec3f light_sampling_origin(const Interaction &surface, const Vec3f &geometric) const {
        const bool emissive_sphere = surface.body >= scene().accel->instances().size() &&
                                     !is_black(scene().materials.bounds(surface.material).emission);
        return emissive_sphere ? surface.origin_towards(geometric) : surface.position;
    }
    /// Adds the light of the scene's lights at a surface, weighted against `branches` BSDF samples that go on.
    void sample_lights_at(const State &state, const Interaction &surface, const Bsdf &bsdf,
                          const OrientedSurface &oriented_surface, uint32_t branches, Lobes lobes);
    /// Where rays to a light start at a smooth mesh; aims the light sample from there.
    [[gnu::noinline]] static Vec3f start_on_curve(const ShadowTerminator &terminator, const Interaction &surface,
                                                  const Vec3f &geometric, LightSample &light);
    /// Turns the path into one that leaves a rough lobe along wi, sampled with density `pdf` per solid angle.
    void leave_rough(State &state, const Interaction &surface, const Vec3f &geometric, const Vec3f &wi, float pdf);
    /// What programs know of a ray that was sampled: the kind of the closure that it was drawn from, as in Cycles.
    static uint8_t ray_flags(const BsdfSample &s) {
        if (s.transmitted)
            return uint8_t(kTransmissionRay | (s.specular ? kSingularRay : 0));
        if (s.specular)
            return kReflectionRay | kGlossyRay | kSingularRay;
        return kReflectionRay | (s.diffuse ? kDiffuseRay : kGlossyRay);
    }
    /// Turns the path into one that leaves a mirror or a smooth dielectric along wi.
    void leave_specular(State &state, const Interaction &surface, const Vec3f &wi);

    /// Lets the path wander within the body that it met, along wi at first, and go on from where it leaves it.
    [[gnu::noinline]] void scatter_beneath(State state, const Subsurface &lobe, const Interaction &surface,
                                           const Vec3f &geometric, const Vec3f &wi);

    // Rays and roulette

    std::optional<Hit> intersect(const Ray &ray, RayKind kind) {
        ++trace_.rays;
        return F.bvh ? scene().accel->intersect(ray, kind) : scene().accel->intersect_few(ray);
    }
    static RayKind kind_of(const State &state) {
        if constexpr (F.visibility)
            return state.kind;
        else
            return RayKind::camera; // as good as any
    }
    static void set_kind(State &state, RayKind kind) {
        if constexpr (F.visibility)
            state.kind = kind;
    }
    static RayKind kind_of(const BsdfSample &s) {
        return s.transmitted ? RayKind::transmission : s.diffuse ? RayKind::diffuse : RayKind::glossy;
    }
    /// Whether what the camera sees here is a hole in the picture.
    bool is_held_out(const State &state, const Hit &hit) const {
        return F.visibility && kind_of(state) == RayKind::camera && scene().is_holdout(hit);
    }
    /// Whether the segment may meet a light that is no surface.
    bool sees_light(const State &state, uint32_t light) const {
        if constexpr (F.visibility)
            return scene().lights.flags(light).visible & mask_of(state.kind);
        else
            return state.depth > 0 || traits(scene().lights[light]).camera_visible;
    }
    /// Whether light sampling with `depth` vertices before leaves a light out.
    bool is_beyond_bounces(uint32_t light, uint32_t depth) const {
        return F.visibility && depth > scene().lights.flags(light).max_bounces;
    }
    bool uses_cycles_weights() const { return F.visibility && scene().techniques_differ; }
    /// What arrives at a point of a light sample (visibility.h). origin_offset: how far the origin was moved off its
    /// surface at most. An emissive triangle must not shadow itself: the ray ends short of it by the errors of both
    /// ends, as they are seen along its plane.
    Rgb visibility(const Vec3f &origin, const LightSample &light, ShutterTime time, float origin_offset = 0);
    /// Russian roulette, see roulette.h. The probability is capped at 1: a cap below that would let the weights of
    /// paths between surfaces of high albedo grow without bound.
    bool survives(State &state, const Vec3f &x, float roulette_scale);
    /// The probability of that for a path of throughput beta at x.
    float survival(const Rgb &beta, float rr_scale, const Vec3f &x, float roulette_scale) const;
    /// Roulette of one more mirror or dielectric.
    bool survives_specular(State &state);
    void push(const State &state) { stack_.push_back(state); }
    /// Exchanges all that the sample has so far for what a part of it has.
    void swap_with(FilmSample &part, PassSample &passes) {
        std::swap(result_, part);
        if (F.passes && trace_.passes)
            std::swap(*trace_.passes, passes);
    }

    const PathContext context_; ///< a copy: what it refers to is one step away
    Sampler &sampler_;
    TraceContext &trace_;
    float sigma_ = 0; ///< extinction of the channel that has the least, for the choice of lights
    bool media_vary_ = false;
    FilmSample result_;
    ClosureArena &arena_ = thread_arena();
    std::vector<State> &stack_ = thread_stack<State>(); ///< branches still to follow
};

} // namespace glimmer
