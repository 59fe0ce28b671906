// SPDX-License-Identifier: GPL-3.0-or-later
// What fills space: one of a closed set of kinds of media, each in a file of its own. Everything else asks here, by the
// place: along a ray, from its origin on.
#pragma once

#include "medium/bounded_media.h"
#include "medium/height_haze.h"
#include "medium/homogeneous_medium.h"
#include "medium/phase.h"

#include <variant>

namespace glimmer {

class Medium {
    template <class Function>
    decltype(auto) visit(const Function &function) const {
        return std::visit(function, kind_);
    }

  public:
    using Kind = std::variant<HomogeneousMedium, BoundedMedia, HeightHaze>;

    Medium(const HomogeneousMedium &medium) : kind_(medium) {}
    Medium(const HeightHaze &medium) : kind_(medium) {}
    Medium(BoundedMedia media) : kind_(std::move(media)) {}

    /// The media within surfaces, which differ from place to place; null where one fills all space.
    const BoundedMedia *bounded() const { return std::get_if<BoundedMedia>(&kind_); }
    /// Haze that thins out with height; null for other kinds.
    const HeightHaze *height_haze() const { return std::get_if<HeightHaze>(&kind_); }
    /// Whether light comes in from infinitely far: nothing comes through a medium without end.
    bool lets_in() const { return !std::holds_alternative<HomogeneousMedium>(kind_); }

    bool scatters() const {
        return visit([](const auto &m) { return m.scatters(); });
    }
    /// Whether all channels are alike: no random number picks one then.
    bool monochromatic() const {
        return visit([](const auto &m) { return m.monochromatic; });
    }
    HenyeyGreenstein phase() const {
        return visit([](const auto &m) { return HenyeyGreenstein{m.g}; });
    }

    /// What the length t of a ray leaves of light.
    Rgb transmittance(const Ray &ray, float t) const {
        return visit([&](const auto &m) { return m.transmittance(ray, t); });
    }
    /// The same by way of two legs, with one exponential where that is enough.
    Rgb transmittance(const Ray &first, float t, const Ray &second, float t_second) const {
        return visit([&](const auto &m) { return m.transmittance(first, t, second, t_second); });
    }
    /// By length, t along the ray: sigma_s.
    Rgb scattering(const Ray &ray, float t) const {
        return visit([&](const auto &m) { return m.scattering(ray, t); });
    }
    /// Transmittance as far as absorption alone goes, of the channel that is absorbed least.
    float least_absorbed(const Ray &ray, float t) const {
        return visit([&](const auto &m) { return m.least_absorbed(ray, t); });
    }

    /// See the functions of these names in homogeneous_medium.h.
    FreeFlight sample_free_flight(const Ray &ray, const Rgb &beta, float t_max, Sampler &sampler) const {
        return visit([&](const auto &m) { return glimmer::sample_free_flight(m, ray, beta, t_max, sampler); });
    }
    float free_flight_pdf(const Ray &ray, const Rgb &beta, float t) const {
        return visit([&](const auto &m) { return glimmer::free_flight_pdf(m, ray, beta, t); });
    }
    /// u_channel is not read of a monochromatic medium.
    Collision sample_collision(const Ray &ray, const Rgb &beta, float t_max, float u_channel, uint64_t bits_t) const {
        return visit([&](const auto &m) { return glimmer::sample_collision(m, ray, beta, t_max, u_channel, bits_t); });
    }
    Collision sample_collision(const Ray &ray, const Rgb &beta, float t_max, Sampler &sampler) const {
        return visit([&](const auto &m) { return glimmer::sample_collision(m, ray, beta, t_max, sampler); });
    }
    float collision_pdf(const Ray &ray, const Rgb &beta, float t_max, float t) const {
        return visit([&](const auto &m) { return glimmer::collision_pdf(m, ray, beta, t_max, t); });
    }

    // One number for an extinction that differs by channel and place: each purpose has one of its own. Per length.

    /// Of the channel that carries light furthest. For the choice of lights, where too much of a far one is no harm.
    float least_extinction() const {
        return visit([](const auto &m) { return m.least_extinction(); });
    }
    /// The same of the channels that scatter; infinite where none does. How far a segment matters.
    float least_scattering_extinction() const {
        return visit([](const auto &m) { return m.least_scattering_extinction(); });
    }
    /// No channel is extinguished faster anywhere. Its inverse is the shortest mean free path.
    float majorant() const {
        return visit([](const auto &m) { return m.majorant(); });
    }
    /// Of the channels, for weights by brightness.
    float mean_extinction() const {
        return visit([](const auto &m) { return m.mean_extinction(); });
    }
    /// How fast light scattered many times dies away, in the channel that carries it furthest; 0 where none scatters.
    float effective_attenuation() const {
        return visit([](const auto &m) { return m.effective_attenuation(); });
    }
    /// A bound on the chance that light `distance` away from the middle of a sphere of that radius comes back to it, if
    /// the medium has no end.
    float return_probability(float radius, float distance) const {
        return visit([&](const auto &m) { return m.return_probability(radius, distance); });
    }

    /// Constant coefficients for the loops over many vertices or nodes.
    SimdMedium simd_view() const {
        return visit([](const auto &m) { return glimmer::simd_view(m); });
    }

  private:
    Kind kind_;
};

/// Of the way through a medium, or through none.
inline Rgb transmittance(const Medium *medium, const Ray &ray, float t) {
    return medium ? medium->transmittance(ray, t) : Rgb(1);
}

} // namespace glimmer
