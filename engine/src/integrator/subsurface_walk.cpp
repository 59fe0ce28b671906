// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrator/subsurface_walk.h"

#include "geometry/body.h"
#include "medium/phase.h"
#include "sampling/exponential.h"

#include <algorithm>
#include <cmath>

namespace glimmer {

namespace {

/// From this step on scattering is isotropic, with coefficients reduced by the mean cosine, as in Cycles.
constexpr uint32_t kStepsOfPhase = 10;
/// Walks of more steps end with a probability that grows as slowly as the number of walks that are left falls.
constexpr uint32_t kStepsForAll = 256;
/// A walk whose weight fell below this part of what it began with ends with a probability.
constexpr float kSparedWeight = 0.1f;
/// Outside of the body's bounds, which a walk leaves only by way of a hole, it goes on with this probability.
constexpr float kSurvivalOutside = 0.75f;
/// The part of the directions that is drawn towards the surface: half, and fewer the more scattering has a direction of
/// its own, which the guide does not know.
float guided_part(float g) {
    return 1 - std::max(0.5f, std::pow(std::abs(g), 0.125f));
}
/// A mean free path of fewer rounding errors leads nowhere.
constexpr float kLeastErrors = 16;

Rgb attenuation(const Rgb &sigma, float t) {
    return {std::exp(-sigma.r * t), std::exp(-sigma.g * t), std::exp(-sigma.b * t)};
}

/// Directions and distances that lead back to the surface of a half-space (Dwivedi's sampling: Krivanek and d'Eon 2014,
/// "A Zero-Variance-Based Sampling Scheme for Monte Carlo Subsurface Scattering"; the length by d'Eon and Krivanek
/// 2020, "Zero-Variance Theory for Efficient Subsurface Scattering").
class Guide {
  public:
    Guide(float alpha, const Vec3f &outward)
        : length_(1 / std::sqrt(1 - std::pow(alpha, 2.44294f - 0.0215813f * alpha + 0.578637f / alpha))),
          log_(std::log((length_ + 1) / (length_ - 1))), frame_(outward) {}

    Vec3f sample(Vec2f u) const {
        const float cosine = std::clamp(length_ - (length_ + 1) * std::exp(-u.x * log_), -1.0f, 1.0f);
        const Vec2f p = circle_point(std::sqrt(1 - cosine * cosine), u.y);
        return normalize(frame_.to_world({p.x, p.y, cosine}));
    }
    float pdf(const Vec3f &direction) const { return 1 / (2 * kPi * log_ * (length_ - dot(direction, frame_.z))); }
    /// The factor of the extinction that distances are drawn by.
    float stretch(const Vec3f &direction) const { return 1 - dot(direction, frame_.z) / length_; }

  private:
    float length_, log_;
    Frame frame_;
};

class Walk {
  public:
    /// beta: of any sign.
    Walk(const Body &body, const SubsurfaceMedium &medium, const Vec3f &outward, const Rgb &beta, Sampler &sampler,
         TraceContext &trace)
        : body_(body), medium_(medium), beta_(std::abs(beta.r), std::abs(beta.g), std::abs(beta.b)), outward_(outward),
          guide_(max_component(medium.alpha), outward), phase_{medium.g}, sampler_(sampler), trace_(trace),
          guided_(guided_part(medium.g)), weight_(medium.weight) {
        set_coefficients(medium.sigma_t);
    }

    /// The hit by which the walk leaves the body. `position`, the entry, and `direction` become those of the last
    /// segment.
    std::optional<Hit> run(Vec3f &position, Vec3f &direction) {
        const float start = max_component(weight_ * beta_);
        for (uint32_t step = 0; start > 0; ++step) {
            if (step == kStepsOfPhase && medium_.g != 0)
                become_isotropic();
            bool guided = false;
            float factor = 0, stretch = 1; // of the guided density, relative to the phase function's
            if (step > 0) {
                guided = sampler_.next_1d() < guided_;
                turn(direction, guided, factor);
                stretch = guide_.stretch(direction);
            }
            const Rgb chances = channel_chances();
            const float sigma = sigma_t_[pick(chances)] * (guided ? stretch : 1);
            const float t = sampler_.next_exponential() / sigma;
            const float begun = step > 0 ? 0 : begin(position, direction, t);
            ++trace_.rays;
            const auto hit = body_.intersect(position, direction, t - begun);
            advance(hit ? begun + hit->t : t, hit.has_value(), chances, step > 0 ? guided_ : 0, factor, stretch);
            if (hit)
                return hit;
            position += direction * (t - begun);
            if (!survives(step, position, start))
                return std::nullopt;
        }
        return std::nullopt;
    }
    const Rgb &weight() const { return weight_; }

  private:
    void set_coefficients(const Rgb &sigma_t) {
        sigma_t_ = sigma_t;
        sigma_s_ = sigma_t * medium_.alpha;
    }
    void become_isotropic() {
        const Rgb forward = sigma_s_ * medium_.g;
        sigma_t_ = sigma_t_ - forward;
        sigma_s_ = sigma_s_ - forward;
        phase_ = {};
        guided_ = guided_part(0);
    }
    /// Takes the first segment, t long, so far beneath the surface that rounding does not let its ray meet the surface
    /// where it entered. How much of the segment that is: it counts like the rest, or thin bodies would be too thin.
    float begin(Vec3f &position, const Vec3f &direction, float t) const {
        constexpr float kLeastCosine = 0.1f;
        const float cosine = -dot(direction, outward_);
        const float begun = std::min(body_.error() / std::max(cosine, kLeastCosine), t);
        position += direction * begun - outward_ * std::max(body_.error() - begun * cosine, 0.0f);
        return begun;
    }
    void turn(Vec3f &direction, bool guided, float &factor) {
        const Vec3f before = direction;
        const Vec2f u = sampler_.next_2d();
        direction = guided ? guide_.sample(u) : phase_.sample(before, u).direction;
        factor = guide_.pdf(direction) / phase_.eval(before, direction);
    }
    /// By what each channel still brings.
    Rgb channel_chances() const {
        const Rgb parts = weight_ * beta_ * medium_.alpha;
        return parts * (1 / (parts.r + parts.g + parts.b));
    }
    int pick(const Rgb &chances) {
        const float u = sampler_.next_1d();
        const int channel = u < chances.r ? 0 : u < chances.r + chances.g ? 1 : 2;
        return chances[channel] > 0 ? channel : chances.g > 0 ? 1 : 0; // rounding let u outlast the sum
    }
    /// The weight by all techniques that could have led there: three channels, guided or not.
    void advance(float t, bool hit, const Rgb &chances, float guided, float factor, float stretch) {
        const Rgb passed = attenuation(sigma_t_, t), bent = guided > 0 ? attenuation(sigma_t_ * stretch, t) : Rgb();
        Rgb density = passed * (1 - guided) + bent * (guided * factor * (hit ? 1 : stretch));
        if (!hit)
            density *= sigma_t_;
        const float all = chances.r * density.r + chances.g * density.g + chances.b * density.b;
        weight_ *= all > 0 ? (hit ? passed : passed * sigma_s_) * (1 / all) : Rgb();
    }
    bool survives(uint32_t step, const Vec3f &position, float start) {
        const float left = max_component(weight_ * beta_) / start;
        float survival = std::min(left / kSparedWeight, 1.0f);
        if (step >= kStepsForAll)
            survival *= std::sqrt(1 - 1 / float(step));
        if (length_squared(position) > body_.radius() * body_.radius())
            survival *= kSurvivalOutside;
        if (!(survival > 0) || (survival < 1 && !sampler_.next_bool(survival)))
            return false;
        weight_ *= 1 / survival;
        constexpr uint32_t kCancelCheckInterval = 1024;
        return step % kCancelCheckInterval != 0 || !trace_.stopped();
    }

    const Body &body_;
    const SubsurfaceMedium &medium_;
    const Rgb beta_;
    const Vec3f outward_;
    const Guide guide_;
    HenyeyGreenstein phase_;
    Sampler &sampler_;
    TraceContext &trace_;
    float guided_; ///< part of the directions
    Rgb weight_, sigma_t_, sigma_s_;
};

/// Light of channels that wander no farther than rounding leaves where it enters: weights for that light and for the
/// rest, one of which is chosen. Whether that light was.
bool leaves_at_once(const Subsurface &lobe, float error, SubsurfaceMedium &medium, Rgb &weight, Sampler &sampler) {
    Rgb there;
    for (int c = 0; c < 3; ++c)
        if (medium.sigma_t[c] * kLeastErrors * error > 1) {
            there[c] = lobe.albedo[c];
            medium.weight[c] = 0;
        }
    if (is_black(there))
        return false;
    const bool both = !is_black(medium.weight);
    const bool at_once = !both || sampler.next_1d() < 0.5f;
    weight = there * (both ? 2.0f : 1.0f);
    medium.weight *= 2;
    return at_once;
}

} // namespace

std::optional<SubsurfaceExit> walk_beneath(const Scene &scene, const Subsurface &lobe, const Interaction &entry,
                                           const Vec3f &outward, const Vec3f &direction, const Rgb &beta,
                                           ShutterTime time, Sampler &sampler, TraceContext &trace) {
    SubsurfaceMedium medium = subsurface_medium(lobe);
    const Body body(*scene.accel, entry.instance, entry.primitive, time);
    Rgb at_once;
    if (leaves_at_once(lobe, body.error(), medium, at_once, sampler))
        return SubsurfaceExit{entry, outward, at_once};
    Walk walk(body, medium, outward, beta, sampler, trace);
    Vec3f position = body.point(entry.primitive, entry.u, entry.v, entry.geometric_normal);
    Vec3f way = direction;
    const auto hit = walk.run(position, way);
    if (!hit)
        return std::nullopt;
    const Ray last(Vec3f(body.center() + Vec3d(position)), way, time);
    SubsurfaceExit exit{scene.interaction(last, *hit), {}, walk.weight()};
    const bool out = dot(way, exit.surface.geometric_normal) > 0;
    exit.outward = exit.surface.geometric_normal * (out ? 1.0f : -1.0f);
    return exit;
}

} // namespace glimmer
