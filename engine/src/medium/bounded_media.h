// SPDX-License-Identifier: GPL-3.0-or-later
// Media within closed surfaces, any number, nested and overlapping, and one around them all: along a ray the
// coefficients are constant piece by piece, or vary as shader programs say. Where bodies overlap their media add up.
#pragma once

#include "geometry/boundaries.h"
#include "medium/homogeneous_medium.h"
#include "medium/majorant_grid.h"
#include "medium/phase.h"
#include "medium/varying_coefficients.h"

#include <atomic>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace glimmer {

/// A medium that may also shine.
struct InteriorMedium {
    HomogeneousMedium coefficients;              ///< of one that varies the means, for choices alone
    Rgb emission;                                ///< radiance that a length adds
    bool varies = false;                         ///< VaryingBodies say what it is at a point
    bool may_scatter = false, may_shine = false; ///< of one that varies: for all that is known
};

/// What belongs to the bodies whose media vary.
struct VaryingBodies {
    std::shared_ptr<const VaryingCoefficients> coefficients;
    std::vector<std::unique_ptr<const MajorantGrid>> grids; ///< by body; null where nothing varies
    std::vector<BodyFrame> frames;                          ///< by body, of those that keep still
    mutable std::atomic<uint64_t> exceeded{0};              ///< how often a medium was denser than its majorant
};

/// A medium of a body; body kNone: everywhere.
struct MediumPart {
    uint32_t medium, body;
};

/// A piece of a ray along which the same media are.
struct MediumPiece {
    float begin, end;
    Rgb sigma_a, sigma_s, sigma_t, emission; ///< sums of those that do not vary
    uint32_t first, count;                   ///< of the media that add up there, in RayMedia::parts
    bool scatters;
    bool varies; ///< one of them does
    bool shines; ///< one of them may
};

/// What a ray goes through, piece by piece; where there is no piece there is no medium.
struct RayMedia {
    std::vector<MediumPiece> pieces;
    std::vector<MediumPart> parts;
};

/// How light goes on from a point where it is scattered: by one of the media there, chosen at random.
struct ScatteringPoint {
    Rgb weight; ///< of that choice, over its probability
    HenyeyGreenstein phase;
};

class BoundedMedia {
  public:
    /// bodies: of each body of the boundaries, which of `media` fills it. everywhere: that of `media` which fills all
    /// space, or kNone. varying: null where no medium varies.
    BoundedMedia(std::shared_ptr<const Boundaries> boundaries, std::vector<uint32_t> bodies,
                 std::vector<InteriorMedium> media, uint32_t everywhere, std::shared_ptr<const VaryingBodies> varying);

    bool scatters() const { return scatters_; }
    bool emits() const { return emits_; }
    /// Whether any medium differs from place to place. Then only the estimate_ functions, scattering_range() and
    /// scattering_point() may be asked about a ray; what the others say is true of the media that do not vary.
    bool varies() const { return varying_ != nullptr; }
    /// How often a medium that varies was found denser than its majorant.
    uint64_t exceeded() const { return varying_ ? varying_->exceeded.load(std::memory_order_relaxed) : 0; }
    /// Whether one medium fills one convex body, and nothing else does: what two points in it see of each other they
    /// see through that medium alone, as if it had no end.
    bool is_one_convex_body() const { return convex_; }
    /// A sphere that holds all bodies.
    const Vec3f &bounds_center() const { return bounds_center_; }
    float bounds_radius() const { return bounds_radius_; }

    Rgb transmittance(const Ray &ray, float t) const;
    Rgb transmittance(const Ray &first, float t, const Ray &second, float t_second) const;
    Rgb scattering(const Ray &ray, float t) const;
    float least_absorbed(const Ray &ray, float t) const;
    /// Radiance that the media along the ray up to t send back to its origin by themselves.
    Rgb emitted(const Ray &ray, float t) const;
    /// From the first to the last point up to t at which anything scatters; empty if nothing does.
    RayInterval scattering_range(const Ray &ray, float t) const;
    ScatteringPoint scattering_point(const Ray &ray, float t, Sampler &sampler) const;

    // Of media that vary, at random (null_collision.cpp): the means are those of the functions above and of
    // sample_free_flight(), whose pdf is not known.
    Rgb estimate_transmittance(const Ray &ray, float t, Sampler &sampler) const;
    FreeFlight estimate_free_flight(const Ray &ray, const Rgb &beta, float t_max, Sampler &sampler) const;
    Rgb estimate_emitted(const Ray &ray, float t, Sampler &sampler) const;

    // One number each, of the medium that scatters over the longest ways.
    float least_extinction() const { return everywhere_ != kNone ? around().least_extinction() : 0; }
    float least_scattering_extinction() const { return thinnest_.least_scattering_extinction(); }
    float majorant() const { return thinnest_.majorant(); }
    float mean_extinction() const { return thinnest_.mean_extinction(); }
    float effective_attenuation() const { return thinnest_.effective_attenuation(); }
    float return_probability(float radius, float distance) const {
        return everywhere_ != kNone && around().scatters() ? around().return_probability(radius, distance) : 1;
    }

    static constexpr bool monochromatic = false; ///< a random number may always pick the channel
    float g = 0;                                 ///< of that medium

    friend FreeFlight sample_free_flight(const BoundedMedia &m, const Ray &ray, const Rgb &beta, float t_max,
                                         Sampler &sampler);
    friend float free_flight_pdf(const BoundedMedia &m, const Ray &ray, const Rgb &beta, float t);
    friend Collision sample_collision(const BoundedMedia &m, const Ray &ray, const Rgb &beta, float t_max,
                                      float u_channel, uint64_t bits_t);
    friend float collision_pdf(const BoundedMedia &m, const Ray &ray, const Rgb &beta, float t_max, float t);
    const HomogeneousMedium &thinnest() const { return thinnest_; }

  private:
    const HomogeneousMedium &around() const { return media_[everywhere_].coefficients; }
    /// Valid until the thread asks for another ray.
    const RayMedia &along(const Ray &ray) const;
    void find_pieces(const Ray &ray, RayMedia &out) const;
    void add_piece(float begin, float end, std::span<const MediumPart> inside, RayMedia &out) const;
    MediumPoint at(const MediumPart &part, const Ray &ray, float t) const {
        return varying_->coefficients->at(part.medium, part.body, ray.origin + ray.direction * t, ray.time);
    }
    ScatteringPoint varying_scattering_point(const RayMedia &media, const MediumPiece &piece, const Ray &ray, float t,
                                             Sampler &sampler) const;
    /// The sum of what varies in a piece.
    MediumPoint sum_at(const RayMedia &media, const MediumPiece &piece, const Ray &ray, float t, float majorant) const;
    template <class Visit>
    void for_each_interval(const Ray &ray, float t_max, const Visit &visit) const;

    std::shared_ptr<const Boundaries> boundaries_;
    std::vector<uint32_t> bodies_;
    std::vector<InteriorMedium> media_;
    uint32_t everywhere_;
    std::shared_ptr<const VaryingBodies> varying_;
    HomogeneousMedium thinnest_; ///< of the media that scatter, if any does
    bool scatters_ = false, emits_ = false, convex_ = false;
    Vec3f bounds_center_;
    float bounds_radius_ = 0;
    uint64_t number_; ///< no two have the same
};

// As Medium asks for them; what they draw is said in homogeneous_medium.h.
FreeFlight sample_free_flight(const BoundedMedia &m, const Ray &ray, const Rgb &beta, float t_max, Sampler &sampler);
float free_flight_pdf(const BoundedMedia &m, const Ray &ray, const Rgb &beta, float t);
Collision sample_collision(const BoundedMedia &m, const Ray &ray, const Rgb &beta, float t_max, float u_channel,
                           uint64_t bits_t);
float collision_pdf(const BoundedMedia &m, const Ray &ray, const Rgb &beta, float t_max, float t);
inline Collision sample_collision(const BoundedMedia &m, const Ray &ray, const Rgb &beta, float t_max,
                                  Sampler &sampler) {
    const float u = sampler.next_1d();
    return sample_collision(m, ray, beta, t_max, u, sampler.next_bits());
}

inline SimdMedium simd_view(const BoundedMedia &m) {
    return simd_view(m.thinnest());
}

} // namespace glimmer
