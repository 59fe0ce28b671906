// SPDX-License-Identifier: GPL-3.0-or-later
// The result of one camera sample.
#pragma once

#include "glimmer.h"
#include "math/vec.h"

#include <array>
#include <cstdint>

namespace glimmer {

/// The part of a sample that one surface takes up.
struct Cover {
    uint32_t object, material;
    float part;
};

/// Light by the group of the light that it comes from, group 1 first.
using LightGroups = std::array<Rgb, GLIMMER_MAX_LIGHT_GROUPS>;

/// What surfaces give to one of the AOV passes.
struct AovValue {
    Rgb color;
    float part = 0; ///< 1 for each surface
};

/// What only some passes show. A renderer that has been asked for none of them carries none of this.
struct PassSample {
    Rgb emit, environment;
    /// Light by the last thing that scattered it before the camera, mirrors and glass among them.
    Rgb diffuse_direct, diffuse_indirect, glossy_direct, glossy_indirect;
    Rgb transmission_direct, transmission_indirect, volume_direct, volume_indirect;
    Rgb diffuse_color, glossy_color, transmission_color; ///< albedos of what the camera sees
    Vec3f position;                                      ///< in the scene's own coordinates
    Vec3f uv;                                            ///< u, v, 1
    Rgb ambient_occlusion;
    float clearness = 0;    ///< 1 less the mist, of the part of the sample that surfaces take up
    float transparency = 0; ///< part of the sample where the picture is empty
    LightGroups light_groups;
    std::array<Cover, 8> covers; ///< what the camera sees, the nearest first; what lies behind so many is left out
    uint32_t cover_count = 0;
    std::array<AovValue, GLIMMER_MAX_AOVS> aovs;

    void add_groups(const LightGroups &groups, const Rgb &factor) {
        for (size_t i = 0; i < groups.size(); ++i)
            light_groups[i] += groups[i] * factor;
    }
    void expose(float factor) {
        for (Rgb *part : {&emit, &environment, &diffuse_direct, &diffuse_indirect, &glossy_direct, &glossy_indirect,
                          &transmission_direct, &transmission_indirect, &volume_direct, &volume_indirect})
            *part *= factor;
        for (Rgb &group : light_groups)
            group *= factor;
    }
};

struct FilmSample {
    /// Radiance by the way it came to the camera (see film/passes.h); their sum is the radiance of the sample.
    Rgb emission, direct, indirect, medium;
    Rgb albedo;
    Vec3f normal;
    float depth = 0; ///< along the camera's axis; known only where `hit`
    bool hit = false;
    /// A guard against endless paths broke the sample off: what is missing is a bias.
    bool unfinished = false;
    uint32_t object_index = 0, material_index = 0;
    PassSample *more = nullptr; ///< not null where a pass of the film shows some of it

    /// Makes all light a factor brighter.
    void expose(float factor) {
        for (Rgb *part : {&emission, &direct, &indirect, &medium})
            *part *= factor;
        if (more)
            more->expose(factor);
    }
    Rgb radiance() const { return emission + direct + indirect + medium; }
    /// Of the picture or, where it is empty, of the environment alone that one of its passes shows.
    bool has_light() const { return !is_black(radiance()) || (more && !is_black(more->environment)); }
};

/// What does not count as the rest of its sample does.
struct SampleParts {
    FilmSample seen;      ///< of emissive spheres that the camera's own ray met: each pixel has its weight for them
    FilmSample resampled; ///< light of another point of the pixel
    Vec2f resampled_at;   ///< its offset from the middle
    FilmSample own;       ///< light of many points of the pixel, drawn by its filter, which counts there alone
    PassSample seen_passes, resampled_passes, own_passes; ///< the same of what only some passes show

    /// Makes it that of a sample that has met nothing yet.
    void clear(bool has_passes) {
        seen = resampled = own = {};
        if (has_passes)
            seen_passes = resampled_passes = own_passes = {};
    }
    void show_passes() {
        seen.more = &seen_passes;
        resampled.more = &resampled_passes;
        own.more = &own_passes;
    }
};

} // namespace glimmer
