// SPDX-License-Identifier: GPL-3.0-or-later
// A committed scene: everything a ray can ask, in float32 about an origin at the camera. Never changes.
#pragma once

#include "base/warning.h"
#include "camera/camera.h"
#include "film/pixel_filter.h"
#include "geometry/accel.h"
#include "light/light_set.h"
#include "medium/medium.h"
#include "scene/description.h"
#include "shading/materials.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace glimmer {

struct FilmSettings {
    uint32_t width = 1, height = 1;
    uint32_t crop_x = 0, crop_y = 0, crop_width = 1, crop_height = 1;
    PixelFilter filter;
    float exposure = 1;       ///< factor of all light
    bool transparent = false; ///< the camera does not see the environment
    /// Widest GGX of glass through which a transparent film is empty too; below 0: none.
    float transparent_width = -1;
    float mist_start = 5, mist_depth = 25, mist_falloff = 2;
    float occlusion_distance = 10;
    float pixel_aspect = 1; ///< width / height of a pixel

    /// height / width of the picture
    float aspect() const { return float(height) / (float(width) * pixel_aspect); }
};

/// What passes know an object, or a sphere, by.
struct BodyPasses {
    uint32_t matte = 0;
    uint8_t light_group = 0; ///< of what shines of it; 0: none
};

class Scene {
  public:
    /// Checks and builds, on `threads` threads at most (0: all). Throws Error.
    Scene(const SceneDescription &description, uint32_t threads);
    Scene(const Scene &) = delete;
    Scene &operator=(const Scene &) = delete;

    Interaction interaction(const Ray &ray, const Hit &hit) const;

    Camera camera;
    bool camera_is_invertible = true; ///< all places of the film where a point is seen are known
    Vec3d origin;                     ///< of all coordinates here, in the caller's
    FilmSettings film;
    Materials materials;
    std::vector<std::vector<uint32_t>> object_materials; ///< by object: the material of each slot
    std::vector<uint32_t> sphere_materials, sphere_indices;
    std::vector<bool> sphere_holdouts;                    ///< empty: there are none
    std::vector<BodyPasses> object_passes, sphere_passes; ///< by object, by sphere
    const BodyPasses &passes_of(const Hit &hit) const {
        return hit.instance == kNone ? sphere_passes[hit.primitive]
                                     : object_passes[accel->instances()[hit.instance].object];
    }
    /// Whether the camera sees nothing where it meets this.
    bool is_holdout(const Hit &hit) const {
        if (hit.instance != kNone)
            return accel->instances()[hit.instance].holdout;
        return !sphere_holdouts.empty() && sphere_holdouts[hit.primitive];
    }
    /// Whether the surface is glass around no body: of a mesh that is not closed, or that light may pass elsewhere.
    bool is_sheet(const Interaction &surface) const {
        return !sheets.empty() && surface.instance != kNone && sheets[surface.instance];
    }
    std::vector<bool> sheets;           ///< by instance; empty: there are none
    std::optional<Medium> medium;       ///< around all bodies of glass
    std::optional<Medium> glass_medium; ///< in them: what their interiors hold, without what fills all space
    /// The same, or null.
    const Medium *outside() const { return medium ? &*medium : nullptr; }
    const Medium *within_glass() const { return glass_medium ? &*glass_medium : nullptr; }
    std::unique_ptr<Accel> accel;
    LightSet lights;
    bool moves = false;                  ///< anything, while the shutter is open
    bool has_surfaces = false;           ///< anything that scatters light
    bool has_dielectrics = false;        ///< bodies of glass
    bool has_transmission = false;       ///< surfaces that scatter light to their other side; glass among them
    bool has_transparency = false;       ///< surfaces that let some light straight through
    bool has_subsurface = false;         ///< bodies in which light wanders beneath the surface
    bool has_shadow_terminators = false; ///< smooth meshes that lamps see as curved
    bool has_visibility = false;         ///< objects, lights or an environment that some rays do not see; holdouts
    /// Shadow rays and paths do not meet the same, or not the same lights: what one of the two finds, the other may
    /// not, and how they share the light shows in the picture (Cycles' weights, integrator/mis.h).
    bool techniques_differ = false;
    bool hides_beyond_camera = false; ///< something is hidden from other rays than the camera's
    float max_value = 0;              ///< largest of the materials in use (see MaterialBounds)
    Vec3f bounds_center;              ///< of all surfaces and finite lights
    float bounds_radius = 0;          ///< 0: there are none
    std::vector<Warning> warnings;
    std::vector<std::string> left_out;
    double build_seconds = 0;
    size_t bytes = 0; ///< of its large arrays and BVHs

  private:
    std::vector<std::shared_ptr<const Mesh>> meshes_;
    friend class SceneBuilder;
};

} // namespace glimmer
