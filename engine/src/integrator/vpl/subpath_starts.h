// SPDX-License-Identifier: GPL-3.0-or-later
// Where light subpaths start: at which light, and which way they leave it (docs/method.md, sections 6 and 14).
#pragma once

#include "integrator/trace_context.h"
#include "integrator/vpl/importance_map.h"
#include "light/interface.h"
#include "medium/interior_stack.h"
#include "sampling/sampler.h"
#include "scene/scene.h"

#include <optional>
#include <vector>

namespace glimmer {

// All kinds of rays but the camera's see the same wherever there is a cache.
inline constexpr RayKind kSubpathKind = RayKind::diffuse;

struct SubpathStart {
    Emission emission;
    bool delta;           ///< comes from a light without size
    float target;         ///< power times importance, with which the weight window compares what becomes of them
    InteriorStack around; ///< what the ray starts in
};

class SubpathStarts {
  public:
    /// paths: the number of all subpaths. All references must live on.
    SubpathStarts(const Scene &scene, const ImportanceMap &importance, uint32_t paths);

    /// Whether there is a light that can start one.
    bool any() const { return !shares_.empty(); }
    /// Of all subpaths, by the light's power times the importance of its place.
    double share(uint32_t light) const { return shares_[light]; }
    /// Nothing where no light leaves.
    std::optional<SubpathStart> sample(uint32_t light, ShutterTime time, Sampler &sampler, TraceContext &rays) const;

  private:
    struct Disk {
        Vec3f center;
        float radius;
    };
    /// To which side of a light's surface the rays go that may come into the picture.
    enum class Side { outwards, inwards, both };
    /// Where a light that is not infinite sends its rays.
    struct Aim {
        Side side = Side::outwards;
        Vec3f axis; ///< to the media
        std::vector<float>
            cones; ///< about it: 1 - cos of their half angles, from narrow to wide; none unless it is far
    };

    Side side(uint32_t light) const;
    void add_cones(Aim &aim, const LightBound &bound) const;
    double brightness(const LightBound &bound, bool is_far) const;
    float weight(uint32_t light) const { return float(1 / (shares_[light] * paths_)); }
    std::optional<SubpathStart> from_infinity(uint32_t light, ShutterTime time, Sampler &sampler) const;
    std::optional<SubpathStart> from_light(uint32_t light, ShutterTime time, Sampler &sampler,
                                           TraceContext &rays) const;
    float disk_density(const Vec3f &x, const Vec3f &direction, size_t own) const;

    const Scene &scene_;
    const ImportanceMap &importance_;
    const BoundedMedia *media_;
    uint32_t paths_;
    float importance_of_media_ = 0; ///< of their centre
    std::vector<Disk> disks_;       ///< across light from infinity
    std::vector<Aim> aims_;         ///< of each light
    std::vector<double> shares_;
};

} // namespace glimmer
