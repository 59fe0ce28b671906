// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes: every description is checked here, whole, before anything is kept.
#include "api/handles.h"
#include "math/constants.h"

#include <algorithm>
#include <array>
#include <string_view>

using namespace glimmer;

namespace {

constexpr double kIdentity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

template <class T, size_t N>
void check_each_least(const T (&values)[N], double low, const std::string &what) {
    for (T v : values)
        check_least(double(v), low, what);
}

/// Rotation and translation alone, to 1e-4: what comes out of float32 matrices passes.
void check_rigid(const double *m, const std::string &what) {
    check_affine(m, what);
    const Linear l = affine_from_rows(m).linear;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j <= i; ++j)
            if (std::abs(dot(l.column(i), l.column(j)) - (i == j)) > 1e-4)
                fail_argument(what + " must be rigid (rotation and translation, no scale or shear)");
}

uint32_t checked_matte(uint32_t matte, const std::string &what) {
    check_range(matte, 0, 1u << 24, what + ": matte");
    return matte;
}

uint8_t checked_light_group(uint32_t group, const std::string &what) {
    check_range(group, 0, GLIMMER_MAX_LIGHT_GROUPS, what + ": light_group");
    return uint8_t(group);
}

void check_visible(uint32_t visible, const std::string &what) {
    check_range(visible, 0, GLIMMER_RAY_ALL, what + ": visible");
}

/// The coefficients of a medium, checked.
MediumDescription checked_medium(const double (&sigma_a)[3], const double (&sigma_s)[3], double g,
                                 const std::string &what) {
    for (int c = 0; c < 3; ++c) {
        check_range(sigma_a[c], 0, 1e30, what + ": sigma_a");
        check_range(sigma_s[c], 0, 1e30, what + ": sigma_s");
    }
    if (!(g > -1 && g < 1))
        fail_argument(what + ": g is " + text(g) + "; allowed: above -1, below 1");
    return {{sigma_a[0], sigma_a[1], sigma_a[2]}, {sigma_s[0], sigma_s[1], sigma_s[2]}, g, {}, {}};
}

constexpr std::array<std::string_view, 4> kMediumKeys{"sigma_a", "sigma_s", "emission", "g"}; // of MediumKey

/// What programs give of a medium, checked: bindings of one program stand together.
std::vector<MediumBinding> checked_bindings(const glimmer_medium_desc &d,
                                            const std::vector<std::shared_ptr<Program>> &programs,
                                            const std::string &what) {
    if (d.binding_count > kMediumKeys.size() || (d.binding_count && !d.bindings))
        fail_argument(what + ": " + (d.bindings ? std::to_string(d.binding_count) : "null") +
                      " bindings; allowed: up to " + std::to_string(kMediumKeys.size()));
    std::vector<MediumBinding> out;
    for (size_t i = 0; i < d.binding_count; ++i) {
        const glimmer_medium_binding &b = d.bindings[i];
        const auto key = std::ranges::find(kMediumKeys, std::string_view(b.key ? b.key : ""));
        if (key == kMediumKeys.end())
            fail_argument(what + ": " + (b.key ? "\"" + std::string(b.key) + "\"" : "null") +
                          " cannot be bound; allowed: sigma_a, sigma_s, emission, g");
        const std::string where = what + ": " + b.key;
        const auto number = MediumKey(key - kMediumKeys.begin());
        if (std::ranges::any_of(out, [&](const MediumBinding &known) { return known.key == number; }))
            fail_argument(where + " is bound twice");
        if (b.program >= programs.size())
            fail_argument(where + ": program " + std::to_string(b.program) + " was not added");
        if (b.output >= programs[b.program]->output_count())
            fail_argument(where + ": output " + std::to_string(b.output) + " of " +
                          std::to_string(programs[b.program]->output_count()) + " of its program");
        if (programs[b.program]->is_number(b.output) != (number == MediumKey::g))
            fail_argument(where + " is bound to a " +
                          (number == MediumKey::g ? "vector; allowed: a number" : "number; allowed: a vector"));
        out.push_back({number, b.program, b.output});
    }
    std::ranges::stable_sort(out, {}, &MediumBinding::program);
    return out;
}

/// What a surface is filled with, checked; null: nothing.
std::optional<MediumDescription> checked_interior(const glimmer_medium_desc *desc, const SceneDescription &scene,
                                                  const std::string &what) {
    if (!desc)
        return std::nullopt;
    glimmer_medium_desc defaults;
    glimmer_medium_init(&defaults);
    const std::string interior = what + ": interior";
    const glimmer_medium_desc d = checked_desc(desc, defaults, interior.c_str());
    MediumDescription out = checked_medium(d.sigma_a, d.sigma_s, d.g, interior);
    for (double e : d.emission)
        check_range(e, 0, 1e30, interior + ": emission");
    out.emission = {d.emission[0], d.emission[1], d.emission[2]};
    out.bindings = checked_bindings(d, scene.programs, interior);
    return out;
}

void check_light(const glimmer_light_desc &d, const std::string &what) {
    if (uint32_t(d.type) > GLIMMER_AREA)
        fail_argument(what + ": type " + std::to_string(int(d.type)) + " is not known; allowed: 0 to 3");
    check_each_least(d.color, 0, what + ": color");
    const bool placed = d.type == GLIMMER_POINT || d.type == GLIMMER_SPOT;
    const bool directed = d.type == GLIMMER_SPOT || d.type == GLIMMER_SUN;
    if (placed) {
        for (double v : d.position)
            check_finite(v, what + ": position");
        check_least(d.radius, 0, what + ": radius");
    }
    if (directed) {
        for (double v : d.direction)
            check_finite(v, what + ": direction");
        if (d.direction[0] == 0 && d.direction[1] == 0 && d.direction[2] == 0)
            fail_argument(what + ": direction is 0 0 0");
        check_range(d.angle, 0, 180, what + ": angle");
    }
    check_visible(d.visible, what);
    if (d.type == GLIMMER_SPOT)
        check_range(d.blend, 0, 1, what + ": blend");
    if (d.type == GLIMMER_AREA) {
        check_rigid(d.to_world, what + ": to_world");
        for (double v : d.size)
            if (!(v > 0) || !std::isfinite(v))
                fail_argument(what + ": size is " + text(v) + "; allowed: finite numbers above 0");
        if (!(d.spread > 0 && d.spread <= 180))
            fail_argument(what + ": spread is " + text(d.spread) + "; allowed: above 0, up to 180 degrees");
    }
}

std::vector<Affine> place_instances(const glimmer_object_desc &d, const Affine &to_world, const std::string &what) {
    if (!d.instances)
        return {to_world};
    std::vector<Affine> out;
    out.reserve(d.instance_count);
    for (size_t i = 0; i < d.instance_count; ++i) {
        const Affine own = d.instance_format == GLIMMER_FLOAT64
                               ? affine_from_rows(static_cast<const double *>(d.instances) + 12 * i)
                               : affine_from_rows(static_cast<const float *>(d.instances) + 12 * i);
        const Affine placed = to_world * own;
        for (const Vec3d &v : {placed.linear.rows[0], placed.linear.rows[1], placed.linear.rows[2], placed.translation})
            if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z))
                fail_argument(what + ": instance " + std::to_string(i) + " has a matrix that is not finite");
        out.push_back(placed);
    }
    return out;
}

} // namespace

extern "C" {

glimmer_result glimmer_scene_create(glimmer_scene **scene) {
    return guarded([&] {
        if (!scene)
            fail_argument("scene: the output is null");
        *scene = new glimmer_scene;
    });
}

void glimmer_scene_destroy(glimmer_scene *scene) {
    destroy(scene);
}

void glimmer_medium_init(glimmer_medium_desc *desc) {
    if (!desc)
        return;
    *desc = {};
    desc->struct_size = sizeof *desc;
}

void glimmer_object_init(glimmer_object_desc *desc) {
    if (!desc)
        return;
    *desc = {};
    desc->struct_size = sizeof *desc;
    std::memcpy(desc->to_world, kIdentity, sizeof kIdentity);
    for (float &c : desc->color)
        c = 1;
    desc->visible = GLIMMER_RAY_ALL;
}

glimmer_result glimmer_scene_add_object(glimmer_scene *scene, const glimmer_object_desc *desc) {
    return guarded([&] {
        SceneDescription &s = open_scene(scene);
        glimmer_object_desc defaults;
        glimmer_object_init(&defaults);
        const glimmer_object_desc d = checked_desc(desc, defaults, "object");
        const std::string what = label_of("object", d.name);
        ObjectDescription out;
        out.name = what;
        out.mesh = checked(d.mesh, "mesh").mesh;
        check_affine(d.to_world, what + ": to_world");
        if (!d.materials || d.material_count < out.mesh->slot_count || d.material_count > 65536)
            fail_argument(what + ": " + std::to_string(d.materials ? d.material_count : 0) +
                          " material(s); its mesh needs " + std::to_string(out.mesh->slot_count));
        for (size_t i = 0; i < d.material_count; ++i) {
            if (d.materials[i] >= s.materials.size())
                fail_argument(what + ": material " + std::to_string(d.materials[i]) + " was not added");
            out.materials.push_back(d.materials[i]);
        }
        if (d.instances && d.instance_format != GLIMMER_FLOAT32 && d.instance_format != GLIMMER_FLOAT64)
            fail_argument(what + ": instance_format is " + std::to_string(int(d.instance_format)) +
                          "; allowed: float32 (0), float64 (1)");
        if (d.instances && d.instance_count > 0xfffffff0u)
            fail_argument(what + ": instance_count is " + std::to_string(d.instance_count) +
                          "; allowed: up to 4294967280");
        out.instances = place_instances(d, affine_from_rows(d.to_world), what);
        if (d.motion) {
            check_range(double(d.motion_count), 2, 1024, what + ": motion_count");
            for (size_t k = 0; k < d.motion_count; ++k) {
                const double *step = d.motion + 16 * k;
                check_affine(step, what + ": motion, step " + std::to_string(k));
                out.motion.push_back(place_instances(d, affine_from_rows(step), what));
            }
            out.instances = out.motion[0];
        }
        if (d.object_indices)
            out.object_indices.assign(d.object_indices, d.object_indices + out.instances.size());
        if (out.object_indices.size() < 2)
            out.object_indices.assign(1, d.object_indices && !out.instances.empty() ? d.object_indices[0]
                                                                                    : d.object_index);
        for (float c : d.color)
            check_finite(double(c), what + ": color");
        out.color = {d.color[0], d.color[1], d.color[2]};
        out.opacity = d.color[3];
        out.randoms.assign(1, d.random);
        if (d.randoms && d.instances)
            out.randoms.assign(d.randoms, d.randoms + out.instances.size());
        for (float r : out.randoms)
            check_finite(double(r), what + ": random");
        check_visible(d.visible, what);
        out.visible = RayMask(d.visible);
        out.holdout = d.holdout != 0;
        out.matte = checked_matte(d.matte, what);
        out.light_group = checked_light_group(d.light_group, what);
        check_range(double(d.shadow_terminator), 0, 1, what + ": shadow_terminator");
        out.shadow_terminator = d.shadow_terminator;
        out.attributes = checked_attributes(d.attribute_count, d.attributes,
                                            {kNoRows, kNoRows, kNoRows, out.instances.size()}, what);
        out.interior = checked_interior(d.interior, s, what);
        s.objects.push_back(std::move(out));
    });
}

void glimmer_spheres_init(glimmer_spheres_desc *desc) {
    if (!desc)
        return;
    *desc = {};
    desc->struct_size = sizeof *desc;
    desc->visible = GLIMMER_RAY_ALL;
}

glimmer_result glimmer_scene_add_spheres(glimmer_scene *scene, const glimmer_spheres_desc *desc) {
    return guarded([&] {
        SceneDescription &s = open_scene(scene);
        glimmer_spheres_desc defaults;
        glimmer_spheres_init(&defaults);
        const glimmer_spheres_desc d = checked_desc(desc, defaults, "spheres");
        const std::string what = label_of("spheres", d.name);
        if (!d.centers || !d.radii)
            fail_argument(what + ": " + (d.centers ? "radii" : "centers") + " is null");
        if (d.count > 0xfffffff0u)
            fail_argument(what + ": count is " + std::to_string(d.count) + "; allowed: up to 4294967280");
        if (d.radius_count != 1 && d.radius_count != d.count)
            fail_argument(what + ": radius_count is " + std::to_string(d.radius_count) + "; allowed: 1 or " +
                          std::to_string(d.count));
        if (d.material >= s.materials.size())
            fail_argument(what + ": material " + std::to_string(d.material) + " was not added");
        SpheresDescription out;
        out.name = what;
        for (size_t i = 0; i < d.count; ++i) {
            const Vec3d c{d.centers[3 * i], d.centers[3 * i + 1], d.centers[3 * i + 2]};
            if (!(max_abs(c) < 1e30) || std::isnan(c.x + c.y + c.z))
                fail_argument(what + ": center " + std::to_string(i) + " is (" + text(c.x) + ", " + text(c.y) + ", " +
                              text(c.z) + "); allowed: numbers up to 1e30");
            out.centers.push_back(c);
        }
        for (size_t i = 0; i < d.radius_count; ++i) {
            if (!(d.radii[i] > 0) || !(d.radii[i] < 1e30))
                fail_argument(what + ": radius " + std::to_string(i) + " is " + text(d.radii[i]) +
                              "; allowed: numbers above 0, up to 1e30");
            out.radii.push_back(d.radii[i]);
        }
        out.material = d.material;
        out.object_index = d.object_index;
        check_visible(d.visible, what);
        out.visible = RayMask(d.visible);
        out.holdout = d.holdout != 0;
        out.matte = checked_matte(d.matte, what);
        out.light_group = checked_light_group(d.light_group, what);
        out.interior = checked_interior(d.interior, s, what);
        s.spheres.push_back(std::move(out));
    });
}

void glimmer_light_init(glimmer_light_desc *desc) {
    if (!desc)
        return;
    *desc = {};
    desc->struct_size = sizeof *desc;
    for (float &c : desc->color)
        c = 1;
    desc->direction[2] = -1;
    std::memcpy(desc->to_world, kIdentity, sizeof kIdentity);
    desc->size[0] = desc->size[1] = 1;
    desc->visible = GLIMMER_RAY_ALL & ~GLIMMER_RAY_CAMERA;
    desc->shadows = 1;
    desc->max_bounces = UINT32_MAX;
    desc->spread = 180;
}

glimmer_result glimmer_scene_add_light(glimmer_scene *scene, const glimmer_light_desc *desc) {
    return guarded([&] {
        SceneDescription &s = open_scene(scene);
        glimmer_light_desc defaults;
        glimmer_light_init(&defaults);
        LightDescription out;
        static_cast<glimmer_light_desc &>(out) = checked_desc(desc, defaults, "light");
        check_light(out, label_of("light", out.name));
        checked_light_group(out.light_group, label_of("light", out.name));
        out.label = out.name ? out.name : "";
        s.lights.push_back(std::move(out));
    });
}

glimmer_result glimmer_scene_set_environment(glimmer_scene *scene, const float color[3], glimmer_image *image,
                                             const double to_world[16]) {
    return guarded([&] {
        SceneDescription &s = open_scene(scene);
        if (!color)
            fail_argument("environment: color is null");
        EnvironmentDescription out;
        for (int c = 0; c < 3; ++c) {
            check_least(double(color[c]), 0, "environment: radiance");
            out.color[c] = color[c];
        }
        if (image)
            out.image = checked(image, "image").image;
        if (to_world) {
            double m[16];
            std::memcpy(m, to_world, sizeof m);
            check_rigid(m, "environment: to_world");
            out.to_world = affine_from_rows(m).linear;
        }
        s.environment = std::move(out);
    });
}

glimmer_result glimmer_scene_set_environment_visible(glimmer_scene *scene, uint32_t visible) {
    return guarded([&] {
        SceneDescription &s = open_scene(scene);
        check_visible(visible, "environment");
        s.environment_visible = RayMask(visible | GLIMMER_RAY_SHADOW);
    });
}

glimmer_result glimmer_scene_set_environment_light_group(glimmer_scene *scene, uint32_t light_group) {
    return guarded([&] {
        SceneDescription &s = open_scene(scene);
        s.environment_light_group = checked_light_group(light_group, "environment");
    });
}

glimmer_result glimmer_scene_set_medium(glimmer_scene *scene, const double sigma_a[3], const double sigma_s[3],
                                        double g) {
    return guarded([&] {
        SceneDescription &s = open_scene(scene);
        if (!sigma_a || !sigma_s)
            fail_argument("medium: " + std::string(sigma_a ? "sigma_s" : "sigma_a") + " is null");
        s.medium =
            checked_medium({sigma_a[0], sigma_a[1], sigma_a[2]}, {sigma_s[0], sigma_s[1], sigma_s[2]}, g, "medium");
    });
}

glimmer_result glimmer_scene_set_medium_falloff(glimmer_scene *scene, double height, double scale_height) {
    return guarded([&] {
        SceneDescription &s = open_scene(scene);
        check_finite(height, "medium: height");
        if (!(scale_height >= 1e-30 && scale_height <= 1e30))
            fail_argument("medium: scale_height is " + text(scale_height) + "; allowed: 1e-30 to 1e30");
        s.medium_falloff = FalloffDescription{height, scale_height};
    });
}

void glimmer_camera_init(glimmer_camera_desc *desc) {
    if (!desc)
        return;
    *desc = {};
    desc->struct_size = sizeof *desc;
    std::memcpy(desc->to_world, kIdentity, sizeof kIdentity);
    desc->fov_x = 50;
    desc->clip_end = HUGE_VAL;
    desc->type = GLIMMER_PERSPECTIVE;
    desc->width = 1;
    desc->window[2] = desc->window[3] = 1;
    desc->longitude[0] = -180, desc->longitude[1] = 180;
    desc->latitude[0] = -90, desc->latitude[1] = 90;
    desc->elevation[0] = -1, desc->elevation[1] = 1;
    desc->fisheye_fov = 180;
    desc->focal_length = 0.29;
    desc->polynomial[1] = kPiDouble;
    desc->stereo_convergence = HUGE_VAL;
    desc->stereo_merge[0] = desc->stereo_merge[1] = 180;
    desc->aperture_ratio = 1;
}

static void check_stereo(const glimmer_camera_desc &d) {
    check_range(d.stereo_offset, -1e6, 1e6, "camera: stereo_offset");
    if (!(d.stereo_convergence > 0))
        fail_argument("camera: stereo_convergence is " + text(d.stereo_convergence) + "; allowed: above 0");
    for (const double v : d.stereo_merge)
        check_range(v, 0, 180, "camera: stereo_merge");
    if (d.stereo_merge[1] < d.stereo_merge[0])
        fail_argument("camera: stereo_merge ends at " + text(d.stereo_merge[1]) + "; allowed: its begin, " +
                      text(d.stereo_merge[0]) + ", at least");
}

static void check_panorama(const glimmer_camera_desc &d) {
    for (const double v : d.window)
        check_range(v, -1000, 1000, "camera: window");
    if (!(d.window[0] < d.window[2] && d.window[1] < d.window[3]))
        fail_argument("camera: the window is empty; allowed: x0 < x1, y0 < y1");
    const auto differ = [](const double(&ends)[2], double most, const std::string &what) {
        for (const double v : ends)
            check_range(v, -most, most, what);
        if (!(std::abs(ends[1] - ends[0]) > 1e-6))
            fail_argument(what + " begins and ends at " + text(ends[0]) + "; allowed: two numbers that differ");
    };
    if (d.type == GLIMMER_EQUIRECTANGULAR || d.type == GLIMMER_CYLINDRICAL)
        differ(d.longitude, 3600, "camera: longitude");
    if (d.type == GLIMMER_EQUIRECTANGULAR)
        differ(d.latitude, 90, "camera: latitude");
    if (d.type == GLIMMER_CYLINDRICAL)
        differ(d.elevation, 1e6, "camera: elevation");
    if (!(d.fisheye_fov > 0 && d.fisheye_fov <= 3600))
        fail_argument("camera: fisheye_fov is " + text(d.fisheye_fov) + "; allowed: above 0, 3600 at most");
    if (!(d.focal_length >= 1e-6 && d.focal_length <= 1e6))
        fail_argument("camera: focal_length is " + text(d.focal_length) + "; allowed: 1e-6 to 1e6");
    for (const double v : d.polynomial)
        check_range(v, -1e6, 1e6, "camera: polynomial");
    const double reach = d.lens_radius * std::max(1.0, 1 / d.aperture_ratio);
    if (reach > d.focus_distance)
        fail_argument("camera: lens_radius is " + text(reach) + "; allowed for a panorama: focus_distance, " +
                      text(d.focus_distance) + ", at most");
}

static std::vector<Affine> camera_motion(const glimmer_camera_desc &d) {
    std::vector<Affine> steps;
    if (!d.motion)
        return steps;
    check_range(double(d.motion_count), 2, 1024, "camera: motion_count");
    for (size_t k = 0; k < d.motion_count; ++k) {
        const std::string what = "camera: motion, step " + std::to_string(k);
        check_rigid(d.motion + 16 * k, what);
        steps.push_back(affine_from_rows(d.motion + 16 * k));
        for (int axis = 0; k > 0 && axis < 3; ++axis)
            if (!(dot(steps[k].linear.column(axis), steps[k - 1].linear.column(axis)) > 0))
                fail_argument(what + " turns by a right angle or more from the one before; give more steps");
    }
    return steps;
}

glimmer_result glimmer_scene_set_camera(glimmer_scene *scene, const glimmer_camera_desc *desc) {
    return guarded([&] {
        constexpr double kLongest = 1e30; // well within float
        SceneDescription &s = open_scene(scene);
        glimmer_camera_desc defaults;
        glimmer_camera_init(&defaults);
        const glimmer_camera_desc d = checked_desc(desc, defaults, "camera");
        check_rigid(d.to_world, "camera: to_world");
        if (uint32_t(d.type) > GLIMMER_CYLINDRICAL)
            fail_argument("camera: type " + std::to_string(int(d.type)) + " is not known; allowed: 0 to 8");
        const bool perspective = d.type == GLIMMER_PERSPECTIVE, orthographic = d.type == GLIMMER_ORTHOGRAPHIC;
        if (perspective && !(d.fov_x > 0 && d.fov_x < 180))
            fail_argument("camera: fov_x is " + text(d.fov_x) + "; allowed: above 0, below 180 degrees");
        if (orthographic && !(d.width > 0 && d.width <= kLongest))
            fail_argument("camera: width is " + text(d.width) + "; allowed: above 0, " + text(kLongest) + " at most");
        for (double v : d.shift)
            check_finite(v, "camera: shift");
        check_least(d.lens_radius, 0, "camera: lens_radius");
        check_least(d.focus_distance, 0, "camera: focus_distance");
        if (d.lens_radius > 0 && d.focus_distance == 0)
            fail_argument("camera: focus_distance is 0; a lens with a radius needs one above 0");
        check_range(d.aperture_blades, 0, 1024, "camera: aperture_blades");
        check_finite(d.aperture_rotation, "camera: aperture_rotation");
        check_range(d.aperture_ratio, 1e-3, 1e3, "camera: aperture_ratio");
        if (!perspective && !orthographic)
            check_panorama(d);
        check_stereo(d);
        if (!orthographic)
            check_least(d.clip_start, 0, "camera: clip_start");
        else
            check_range(d.clip_start, -kLongest, kLongest, "camera: clip_start");
        if (!(d.clip_end > d.clip_start))
            fail_argument("camera: clip_end is " + text(d.clip_end) + "; allowed: above clip_start, " +
                          text(d.clip_start));
        s.camera_motion = camera_motion(d);
        s.camera = d;
    });
}

void glimmer_film_init(glimmer_film_desc *desc) {
    if (!desc)
        return;
    *desc = {};
    desc->struct_size = sizeof *desc;
    desc->width = 480;
    desc->height = 270;
    desc->filter = GLIMMER_BOX;
    desc->filter_width = 1;
    desc->exposure = 1;
    desc->transparent_glass = -1;
    desc->mist_start = 5, desc->mist_depth = 25, desc->mist_falloff = 2;
    desc->occlusion_distance = 10;
    desc->pixel_aspect = 1;
}

glimmer_result glimmer_scene_set_film(glimmer_scene *scene, const glimmer_film_desc *desc) {
    return guarded([&] {
        SceneDescription &s = open_scene(scene);
        glimmer_film_desc defaults;
        glimmer_film_init(&defaults);
        const glimmer_film_desc d = checked_desc(desc, defaults, "film");
        check_range(d.width, 1, 65536, "film: width");
        check_range(d.height, 1, 65536, "film: height");
        const bool whole = d.crop[0] == 0 && d.crop[1] == 0 && d.crop[2] == 0 && d.crop[3] == 0;
        if (!whole &&
            !(d.crop[0] < d.crop[2] && d.crop[2] <= d.width && d.crop[1] < d.crop[3] && d.crop[3] <= d.height))
            fail_argument("film: crop is " + std::to_string(d.crop[0]) + " " + std::to_string(d.crop[1]) + " " +
                          std::to_string(d.crop[2]) + " " + std::to_string(d.crop[3]) +
                          "; allowed: x0 < x1 <= width, y0 < y1 <= height");
        if (uint32_t(d.filter) > GLIMMER_BLACKMAN_HARRIS)
            fail_argument("film: filter " + std::to_string(int(d.filter)) + " is not known; allowed: 0, 1");
        if (!(d.filter_width > 0 && d.filter_width <= 64))
            fail_argument("film: filter_width is " + text(double(d.filter_width)) +
                          "; allowed: above 0, up to 64 pixels");
        check_least(double(d.exposure), 0, "film: exposure");
        if (!(d.transparent_glass <= 1))
            fail_argument("film: transparent_glass is " + text(double(d.transparent_glass)) +
                          "; allowed: 0 to 1, or below 0 for none");
        check_least(double(d.mist_start), 0, "film: mist_start");
        check_least(double(d.mist_depth), 0, "film: mist_depth");
        check_least(double(d.mist_falloff), 0, "film: mist_falloff");
        check_least(double(d.occlusion_distance), 0, "film: occlusion_distance");
        if (!(d.pixel_aspect >= 1e-3f && d.pixel_aspect <= 1e3f))
            fail_argument("film: pixel_aspect is " + text(double(d.pixel_aspect)) + "; allowed: 0.001 to 1000");
        s.film = d;
    });
}

glimmer_result glimmer_scene_commit(glimmer_scene *scene, uint32_t threads) {
    return guarded([&] {
        SceneDescription &description = open_scene(scene);
        check_range(threads, 0, 4096, "commit: threads");
        auto built = std::make_shared<const Scene>(description, threads);
        std::string warnings;
        for (const Warning &w : built->warnings)
            warnings += (warnings.empty() ? "" : "\n") + w.text;
        scene->warnings = std::move(warnings);
        scene->scene = std::move(built);
        description = {};
    });
}

const char *glimmer_scene_warnings(glimmer_scene *scene) {
    return scene && scene->magic == glimmer_scene::kMagic ? scene->warnings.c_str() : "";
}

const char *glimmer_warning_name(uint32_t code) {
    return code < kWarningNames.size() ? kWarningNames[code] : nullptr;
}

glimmer_warning_code glimmer_scene_warning_code(glimmer_scene *scene, size_t line) {
    if (!scene || scene->magic != glimmer_scene::kMagic || !scene->scene || line >= scene->scene->warnings.size())
        return GLIMMER_WARNING_COUNT;
    return scene->scene->warnings[line].code;
}
}
