// SPDX-License-Identifier: GPL-3.0-or-later
// The work on one camera sample of the path integrator. Its steps stand in a file each: path_segment.h (one segment,
// and light met by chance), path_fog.h, path_surface.h, path_vertices.h (light vertices shared by all pixels).
#pragma once

#include "integrator/path/kernels.h"
#include "integrator/path/path_state.h"
#include "integrator/roulette.h"
#include "light/equiangular_table.h"
#include "sampling/dimensions.h"

#include <cmath>
#include <vector>

namespace glimmer {

inline constexpr uint32_t kAllLights = 16;    // up to here every light is sampled at what the camera sees
inline constexpr uint32_t kManyLights = 4;    // beyond, so many choices
inline constexpr uint32_t kRisCandidates = 4; // compete for being lit where bevels glint
inline constexpr size_t kBranches =
    24; // unfinished branches of one camera sample; beyond, segments are no longer split

static_assert(kAllLights <= dimension_count(Dimension::segment_distance) &&
              kAllLights <= dimension_count(Dimension::segment_light) &&
              kAllLights <= dimension_count(Dimension::surface_light));
static_assert(kManyLights <= kAllLights);
static_assert(kRisCandidates <= dimension_count(Dimension::candidate_film));

/// The closures of a segment's end, kept likewise.
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

    PathSample(const PathContext &work, Sampler &sampler, TraceContext &rays)
        : scene_(work.scene), limits_(work.limits), flags_(work.options), plan_(work.plan), pool_(work.pool),
          pixel_x_(work.pixel_x), pixel_y_(work.pixel_y), seen_part_(work.primary_weight), sampler_(sampler),
          rays_(rays) {
        if (F.medium && scene_.medium) {
            const Rgb &s = scene_.medium->sigma_t;
            sigma_ = std::min(s.r, std::min(s.g, s.b));
        }
    }

    FilmSample run(const State &camera) {
        stack_.clear();
        push(camera);
        if constexpr (F.surfaces)
            if (plan_.pixel_ris)
                pixel_ris();
        uint64_t vertices = 0;
        while (!stack_.empty() && ++vertices < kMaxVertices && (vertices % kCancelCheckInterval || !rays_.stopped())) {
            State next = stack_.back();
            stack_.pop_back();
            follow(next);
        }
        result_.unfinished = !stack_.empty();
        return result_;
    }

  private:
    // -- One segment
    // -----------------------------------------------------------------------------------------------------
    void follow(State &state);
    const EstimatorFlags &options() const {
        if constexpr (F.flags)
            return flags_;
        else
            return kAllEstimators;
    }
    /// Of the segment; null where there is none.
    const HomogeneousMedium *medium_of(const State &state) const {
        return F.medium && scene_.medium && state.glass.empty() ? &*scene_.medium : nullptr;
    }
    /// Whether the medium's light comes from the pool; asked only where medium scatters.
    bool pooled() const { return !F.medium_walks || pool_; }

    // -- Light vertices
    // --------------------------------------------------------------------------------------------------
    /// Points in the medium of the segment that are joined to the pool; several where the camera sees it directly.
    void gather_along(const State &state, float end, const HomogeneousMedium &medium);
    /// All light that reaches state.ray.origin scattered, as the medium scatters it there: from the pool, and by a
    /// short ray for what the pool's bounded connections leave out: false where that ends. `scale`: the point is one of
    /// so many. `t`: from where the camera's ray starts, 0 off it, where no splats are.
    bool gather(State &state, float scale, float t, float roulette_scale);
    /// The share 1 - w(d) of the vertex that a ray from a gather meets; beyond, what no vertex holds
    /// (bounded_fraction.h).
    void compensate(State &state, const HomogeneousMedium &medium);
    /// The largest transmittance of a channel as far as absorption goes.
    static float least_absorbed(const HomogeneousMedium &medium, float t) {
        return std::exp(-optical_depth(std::min(medium.sigma_a.r, std::min(medium.sigma_a.g, medium.sigma_a.b)), t));
    }

    // -- Light met by chance
    // ---------------------------------------------------------------------------------------------
    void add_emission(const State &state, const Hit &hit, const Interaction &surface, const Rgb &emission,
                      const HomogeneousMedium *medium);
    void add_lamps(const State &state, float end, const HomogeneousMedium *medium);
    void add_infinity(const State &state, const HomogeneousMedium *medium);
    void add_seen(const State &state, const Rgb &radiance, float distance, const HomogeneousMedium *medium);
    /// False only where it certainly does not.
    bool may_meet_light(const Ray &ray) const;
    /// The weight of a light met by chance against having been sampled from the vertex before.
    float emission_mis_weight(const State &state, uint32_t light, uint32_t triangle, float distance,
                              float cosine) const;

    // -- Choice of lights: the expected number of samples of a light takes the place of its probability --------
    /// Whether light is sampled along this segment, or at the collision that ends it.
    bool lights_along(const State &state) const {
        return state.direct_view() ? options().segment_lights : options().deep_segment_lights;
    }
    bool every_light(bool all) const { return all && options().all_lights && scene_.lights.size() <= kAllLights; }
    uint32_t choices(bool all) const {
        return every_light(all) ? scene_.lights.size() : all && options().all_lights ? kManyLights : 1;
    }
    /// The i-th choice at a place: x, or the segment (origin, direction, end).
    template <class... Place>
    LightChoice choose(uint32_t i, bool all, const Place &...place) {
        if (every_light(all))
            return {i, 1};
        const float u = sampler_.next_1d(), n = float(scene_.lights.size());
        LightChoice choice = options().guided_choice ? scene_.lights.choose(place..., sigma_, u)
                                                     : LightChoice{std::min(uint32_t(u * n), uint32_t(n) - 1), 1 / n};
        choice.probability *= float(choices(all));
        return choice;
    }
    template <class... Place>
    float expected_samples(bool all, uint32_t light, const Place &...place) const {
        if (every_light(all))
            return 1;
        const float probability = options().guided_choice ? scene_.lights.probability(light, place..., sigma_)
                                                          : 1 / float(scene_.lights.size());
        return float(choices(all)) * probability;
    }
    std::optional<LightSample> sample_light(uint32_t light, const Vec3f &x, Vec2f u) const {
        if constexpr (F.other_lights)
            return glimmer::sample_light(scene_.lights[light], x, u);
        else
            return glimmer::sample_light(std::get<SphereLight>(scene_.lights[light]), x, u);
    }
    EquiangularTable equiangular_table(uint32_t light, const Vec3f &origin, const Vec3f &direction, float end) const {
        const LightBound &b = scene_.lights.bound(light);
        return {*scene_.medium, origin, direction, end, b.center, b.radius};
    }

    // -- Fog
    // -------------------------------------------------------------------------------------------------------------
    /// The light that the medium scatters once into the segment.
    void sample_lights_along(const State &state, float end, const HomogeneousMedium &medium, bool split);
    /// One path that goes on from within the segment, given that it scatters there.
    void split_into_medium(const State &state, float end, const HomogeneousMedium &medium);
    /// True when the path scattered before the surface; else its throughput is that of a path that passed.
    bool fly_into_medium(State &state, float end, const HomogeneousMedium &medium);
    void scatter_in_medium(const State &state, float end, const HomogeneousMedium &medium, float t, const Rgb &weight,
                           float pdf);
    /// One light at a collision; by_chance: against the phase function that goes on from there and may meet it too.
    void sample_light_in_medium(const State &state, const Vec3f &x, const HomogeneousMedium &medium, bool by_chance);

    // -- Surfaces
    // --------------------------------------------------------------------------------------------------------
    /// The light straight from lights on what the camera sees first, at one of several points of the pixel.
    void pixel_ris();
    void light_surface(const State &state, const Interaction &surface, const Shading &shading);
    /// A surface as it is seen along a ray. All materials but glass are two-sided: both normals turn to the viewer.
    struct OrientedSurface {
        Frame frame;     ///< about the normal that it is shaded with
        Vec3f geometric; ///< the true normal
        Vec3f wo;        ///< to the viewer, in the frame
    };
    static std::optional<OrientedSurface> oriented(const Interaction &surface, const Vec3f &direction);
    /// Its closures last until the next segment is followed.
    Shading shade(Interaction &surface, const Ray &ray) {
        return scene_.materials.shade(surface, {-ray.direction}, arena_);
    }
    void note_first_surface(const Interaction &surface);
    /// What of a surface is left to scatter: held, where splats bring the rest; unheld, where light vertices have
    /// brought theirs (bounded_fraction.h).
    enum class Lobes { all, bounded, remainder };
    static float fraction_of(Lobes lobes, float bounded) {
        return lobes == Lobes::all ? 1 : lobes == Lobes::bounded ? bounded : 1 - bounded;
    }
    void scatter_at_surface(State &state, const Interaction &surface, Bsdf bsdf, Lobes lobes = Lobes::all);
    /// Where lights are sampled from: the surface, but on the viewer's side for certain where it is an emissive sphere,
    /// which would light its own outside from a point that rounding put beneath it, and not its inside from one above.
    Vec3f light_sampling_origin(const Interaction &surface, const Vec3f &geometric) const {
        const bool shining_sphere = surface.body >= scene_.accel->instances().size() &&
                                    !is_black(scene_.materials.bounds(surface.material).emission);
        return shining_sphere ? surface.origin_towards(geometric) : surface.position;
    }
    /// The light of `branches` samples of the BSDF comes in beside it.
    void sample_lights_at(const State &state, const Interaction &surface, Bsdf bsdf,
                          const OrientedSurface &surface_frame, uint32_t branches, Lobes lobes);
    /// On along a sample of a rough lobe, of that density per solid angle; of a mirror or glass.
    void leave_rough(State &state, const Interaction &surface, const Vec3f &geometric, const Vec3f &wi, float pdf);
    void leave_specular(State &state, const Interaction &surface, const Vec3f &wi);
    void cross_dielectric(State &state, const Interaction &surface, const Material &material);

    // -- Shared
    // ----------------------------------------------------------------------------------------------------------
    std::optional<Hit> intersect(const Ray &ray) {
        ++rays_.rays;
        return F.bvh ? scene_.accel->intersect(ray) : scene_.accel->intersect_few(ray);
    }
    /// `moved`: how far the origin was moved off its surface at most. A triangle that shines must not shadow itself, so
    /// the ray ends short of it by all errors of both ends, seen along its plane.
    bool occluded(const Vec3f &origin, const LightSample &light, float moved = 0);
    /// Russian roulette with survival min(1, spared * weight): a ceiling below 1 would let the weights of high albedos
    /// grow without bound. spared: see roulette.h.
    bool survives(State &state, const Vec3f &x, float roulette_scale);
    /// The chance of that, for a path of throughput beta at x.
    float survival(const Rgb &beta, float rr_scale, const Vec3f &x, float roulette_scale) const;
    /// The same for one more mirror or glass.
    bool survives_specular(State &state);
    void push(const State &state) { stack_.push_back(state); }

    const Scene &scene_;
    const DepthLimits &limits_;
    const EstimatorFlags &flags_;
    const SplittingPlan &plan_;
    const LightVertexBlock *pool_; ///< null: plain paths
    uint32_t pixel_x_, pixel_y_;
    float seen_part_; ///< of the radiance of a sphere that the camera's own ray meets; other rays bring the rest
    Sampler &sampler_;
    TraceContext &rays_;
    float sigma_ = 0; ///< smallest extinction of the channels
    FilmSample result_;
    ClosureArena &arena_ = thread_arena();
    std::vector<State> &stack_ = thread_stack<State>(); ///< branches still to follow
};

} // namespace glimmer
