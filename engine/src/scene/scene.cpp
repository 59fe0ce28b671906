// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/scene.h"

#include "scene/builder.h"

#include <chrono>
#include <cmath>
#include <set>

namespace glimmer {

SceneBuilder::SceneBuilder(const SceneDescription &description, Scene &scene, uint32_t threads)
    : description_(description), scene_(scene), threads_(threads) {}

/// A sphere around all that a path can meet or be lit by, infinite lights apart.
void SceneBuilder::build_bounds() {
    Vec3d low(HUGE_VAL, HUGE_VAL, HUGE_VAL), high = -low;
    const auto add = [&](const Vec3d &center, double radius) {
        low = {std::min(low.x, center.x - radius), std::min(low.y, center.y - radius),
               std::min(low.z, center.z - radius)};
        high = {std::max(high.x, center.x + radius), std::max(high.y, center.y + radius),
                std::max(high.z, center.z + radius)};
    };
    const auto add_instance = [&](const Instance &i) {
        const double stretch = double(std::max({length(i.linear[0]), length(i.linear[1]), length(i.linear[2])}));
        add(Vec3d(i.translation), 3 * stretch * double(i.mesh->radius));
    };
    for (const Instance &i : scene_.accel->instances())
        add_instance(i);
    for (const InstanceMotion &motion : scene_.accel->motions())
        for (const Instance &step : motion)
            add_instance(step);
    for (const Sphere &s : scene_.accel->spheres())
        add(s.center, s.radius);
    for (uint32_t i = 0; i < scene_.lights.size(); ++i)
        if (const LightBound &b = scene_.lights.bound(i); !b.infinite)
            add(Vec3d(b.center), double(b.radius));
    if (const BoundedMedia *media = scene_.medium ? scene_.medium->bounded() : nullptr)
        add(Vec3d(media->bounds_center()), double(media->bounds_radius()));
    if (!(low.x <= high.x))
        return;
    scene_.bounds_center = Vec3f((low + high) * 0.5);
    scene_.bounds_radius = float(length(high - low) * 0.5);
}

void SceneBuilder::list_left_out() {
    std::vector<std::string> &out = scene_.left_out;
    const auto count = [](size_t n, const std::string &what) {
        return std::to_string(n) + " " + what + (n == 1 ? "" : "s");
    };
    if (scene_.medium && !scene_.medium->scatters())
        out.push_back("fog that does not scatter: no distance sampling");
    if (scene_.medium && scene_.medium->monochromatic())
        out.push_back("grey fog: one channel of transmittance");
    if (scene_.medium && !scene_.medium->bounded() && scene_.medium->phase().g == 0)
        out.push_back("isotropic fog: no phase function");
    if (!scene_.camera.has_lens())
        out.push_back("no depth of field: no lens sampling");
    if (!scene_.materials.shaders)
        out.push_back("no textures: no shader programs");
    size_t unused = 0;
    for (size_t i = 0; i < used_.size(); ++i)
        unused += !used_[i];
    for (const MaterialDescription &m : description_.materials)
        if (has_parts(m)) // its parts are used by name only
            unused -= size_t(!used_[m.a]) + size_t(m.b != m.a && !used_[m.b]);
    if (unused > 0 && unused <= used_.size())
        out.push_back(count(unused, "material") + " of " + std::to_string(used_.size()) + " that nothing is made of");
    if (absent_objects_)
        out.push_back(count(absent_objects_, "object") + " of null material");
    if (black_lights_)
        out.push_back(count(black_lights_, "black light"));
}

Scene::Scene(const SceneDescription &description, uint32_t threads) {
    const auto start = std::chrono::steady_clock::now();
    SceneBuilder builder(description, *this, threads);
    builder.build_camera_and_film();
    builder.build_materials();
    builder.build_geometry();
    builder.build_media();
    builder.build_shaders();
    builder.find_sheets();
    builder.build_lights();
    builder.build_bounds();
    builder.list_left_out();
    if (medium && !lights.infinite().empty() && medium->least_extinction() > 0)
        warnings.push_back(
            {GLIMMER_WARNING_ENDLESS_FOG,
             "the fog has no end, so the environment and suns behind it are exactly black; light the scene with "
             "lights of a place and size, or leave out the fog"});
    if (lights.size() == 0 && !(medium && medium->bounded() && medium->bounded()->emits()))
        warnings.push_back({GLIMMER_WARNING_NO_LIGHT, "nothing in the scene shines: the picture will be black"});
    bytes += materials.bytes() + accel->bytes();
    for (const auto &mesh : std::set(meshes_.begin(), meshes_.end())) // objects may share one
        bytes += mesh->bytes();
    build_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

} // namespace glimmer
