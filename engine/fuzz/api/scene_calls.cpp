// SPDX-License-Identifier: GPL-3.0-or-later
#include "api/calls.h"

#include <array>
#include <cmath>
#include <iterator>
#include <string_view>

namespace glimmer {

void create_scene(Input &in, Handles &handles) {
    glimmer_scene *scene = nullptr;
    handles.keep(glimmer_scene_create(&scene), scene, handles.scenes);
    if (in.ConsumeBool()) { // what every scene needs, so that there are whole ones
        set_camera(in, scene);
        set_film(in, scene);
        for (int i = 0; i < 3; ++i)
            add_material(in, scene);
    }
}

void add_material(Input &in, glimmer_scene *scene) {
    glimmer_material_desc desc;
    glimmer_material_init(&desc);
    desc.name = in.name();
    std::array<glimmer_parameter, 12> parameters{};
    uint32_t types = 0;
    while (glimmer_material_info(types))
        ++types;
    // All that one type has, each now and then left out, or one of another type beside them.
    const uint32_t type = in.ConsumeIntegralInRange<uint32_t>(0, types + 1);
    desc.type = type < types ? glimmer_material_info(type)->type : type == types ? "nothing" : nullptr;
    desc.parameters = parameters.data();
    for (uint32_t i = 0; const auto *info = glimmer_parameter_info(i); ++i) {
        const bool own = desc.type && std::string_view(info->type) == desc.type;
        if (desc.parameter_count == parameters.size() || own == (in.ConsumeIntegralInRange<int>(0, 15) == 0))
            continue;
        glimmer_parameter &p = parameters[desc.parameter_count++];
        p.key = info->key;
        for (float &value : p.value)
            value = in.ConsumeFloatingPointInRange<float>(-0.1f, 1.1f);
        if (in.ConsumeIntegralInRange<int>(0, 3) == 0)
            in.fill(p.value, 3);
        static constexpr const char *kWords[] = {"smith", "schlick_ggx", "exact", "schlick", "none", nullptr};
        p.word = kWords[in.ConsumeIntegralInRange<size_t>(0, std::size(kWords) - 1)];
        p.material = in.index();
    }
    in.spoil_size(desc);
    uint32_t material = 0;
    expect(glimmer_scene_add_material(scene, &desc, &material));
}

namespace {

void fill_medium(Input &in, glimmer_medium_desc &desc) {
    static constexpr glimmer_medium_binding kBindings[] = {{"sigma_s", 0, 0}, {"g", 1, 0}, {"g", 1, 1}, {"z", 0, 0}};
    glimmer_medium_init(&desc);
    if (in.ConsumeIntegralInRange<int>(0, 3) == 0) {
        desc.binding_count = in.ConsumeIntegralInRange<size_t>(0, std::size(kBindings));
        desc.bindings = in.ConsumeBool() ? kBindings : nullptr;
    }
    for (size_t c = 0; c < 3; ++c) {
        desc.sigma_a[c] = in.ConsumeIntegralInRange<int>(0, 7) ? in.ConsumeProbability<double>() : in.number();
        desc.sigma_s[c] = in.ConsumeIntegralInRange<int>(0, 7) ? in.ConsumeProbability<double>() : in.number();
        desc.emission[c] = in.ConsumeIntegralInRange<int>(0, 7) ? in.ConsumeProbability<double>() : in.number();
    }
    desc.g = in.ConsumeFloatingPointInRange<double>(-1, 1);
    in.spoil_size(desc);
}

} // namespace

void add_object(Input &in, Handles &handles, glimmer_scene *scene) {
    glimmer_object_desc desc;
    glimmer_object_init(&desc);
    std::array<uint32_t, 4> materials{}, indices{};
    std::array<double, 4 * 12> instances{};
    for (uint32_t &material : materials)
        material = in.index();
    desc.name = in.name();
    desc.mesh = handles.any(handles.meshes);
    desc.material_count = in.ConsumeIntegralInRange<size_t>(0, materials.size());
    desc.materials = materials.data();
    in.matrix(desc.to_world);
    if (in.ConsumeBool()) {
        in.fill(instances.data(), instances.size());
        desc.instances = instances.data();
        desc.instance_count = in.ConsumeIntegralInRange<size_t>(0, 4);
        desc.instance_format = in.ConsumeIntegralInRange<int>(0, 7) ? GLIMMER_FLOAT64 : in.choice<glimmer_format>(1);
        desc.object_indices = in.ConsumeBool() ? indices.data() : nullptr;
        if (in.ConsumeIntegralInRange<int>(0, 31) == 0)
            desc.instance_count = SIZE_MAX;
    }
    glimmer_medium_desc interior;
    if (in.ConsumeBool()) {
        fill_medium(in, interior);
        desc.interior = &interior;
    }
    in.spoil_size(desc);
    expect(glimmer_scene_add_object(scene, &desc));
}

void add_spheres(Input &in, glimmer_scene *scene) {
    glimmer_spheres_desc desc;
    glimmer_spheres_init(&desc);
    std::array<double, 3 * kMostElements> centers{};
    std::array<double, kMostElements> radii{};
    in.fill(centers.data(), centers.size());
    for (double &radius : radii)
        radius = in.ConsumeIntegralInRange<int>(0, 7) ? std::abs(in.number()) : in.number();
    desc.name = in.name();
    desc.count = in.ConsumeIntegralInRange<size_t>(0, kMostElements);
    desc.centers = centers.data();
    desc.radius_count = in.ConsumeBool() ? 1 : in.ConsumeIntegralInRange<size_t>(0, kMostElements);
    desc.radii = radii.data();
    desc.material = in.index();
    if (in.ConsumeIntegralInRange<int>(0, 31) == 0)
        desc.count = SIZE_MAX;
    glimmer_medium_desc interior;
    if (in.ConsumeBool()) {
        fill_medium(in, interior);
        desc.interior = &interior;
    }
    in.spoil_size(desc);
    expect(glimmer_scene_add_spheres(scene, &desc));
}

void add_light(Input &in, glimmer_scene *scene) {
    glimmer_light_desc desc;
    glimmer_light_init(&desc);
    desc.name = in.name();
    desc.type = in.choice<glimmer_light_type>(GLIMMER_AREA);
    if (in.ConsumeBool())
        in.fill(desc.color, 3);
    if (in.ConsumeBool())
        in.fill(desc.position, 3);
    if (in.ConsumeBool())
        in.fill(desc.direction, 3);
    if (in.ConsumeBool())
        in.fill(desc.size, 2);
    desc.radius = std::abs(in.number());
    desc.angle = in.number();
    desc.blend = in.ConsumeFloatingPointInRange<double>(-0.1, 1.1);
    in.matrix(desc.to_world);
    desc.ellipse = in.ConsumeBool();
    in.spoil_size(desc);
    expect(glimmer_scene_add_light(scene, &desc));
}

void set_environment(Input &in, Handles &handles, glimmer_scene *scene) {
    float color[3];
    double to_world[16];
    in.fill(color, 3);
    in.matrix(to_world);
    expect(glimmer_scene_set_environment(scene, color, in.ConsumeBool() ? handles.any(handles.images) : nullptr,
                                         in.ConsumeBool() ? to_world : nullptr));
}

void set_medium(Input &in, glimmer_scene *scene) {
    double sigma_a[3], sigma_s[3];
    for (size_t c = 0; c < 3; ++c) {
        sigma_a[c] = in.ConsumeIntegralInRange<int>(0, 7) ? in.ConsumeProbability<double>() : in.number();
        sigma_s[c] = in.ConsumeIntegralInRange<int>(0, 7) ? in.ConsumeProbability<double>() : in.number();
    }
    expect(glimmer_scene_set_medium(scene, sigma_a, sigma_s, in.ConsumeFloatingPointInRange<double>(-1, 1)));
}

void set_camera(Input &in, glimmer_scene *scene) {
    glimmer_camera_desc desc;
    glimmer_camera_init(&desc);
    in.matrix(desc.to_world);
    if (in.ConsumeBool())
        desc.fov_x = in.number();
    if (in.ConsumeBool())
        in.fill(desc.shift, 2);
    if (in.ConsumeBool())
        desc.lens_radius = in.number(), desc.focus_distance = in.number();
    if (in.ConsumeBool())
        desc.aperture_blades = in.ConsumeIntegral<uint8_t>(), desc.aperture_rotation = in.number(),
        desc.aperture_ratio = in.number();
    if (in.ConsumeBool())
        desc.clip_start = in.number(), desc.clip_end = in.number();
    if (in.ConsumeBool())
        desc.type = static_cast<glimmer_camera_type>(in.ConsumeIntegralInRange<int>(0, 9)), desc.width = in.number();
    if (in.ConsumeBool())
        in.fill(desc.window, 4), in.fill(desc.longitude, 2), in.fill(desc.latitude, 2), in.fill(desc.elevation, 2);
    if (in.ConsumeBool())
        desc.fisheye_fov = in.number(), desc.focal_length = in.number(), in.fill(desc.polynomial, 5);
    in.spoil_size(desc);
    expect(glimmer_scene_set_camera(scene, &desc));
}

void set_film(Input &in, glimmer_scene *scene) {
    glimmer_film_desc desc;
    glimmer_film_init(&desc);
    // Always small, or refused: what takes gigabytes is another test's.
    desc.width = in.ConsumeIntegralInRange<uint32_t>(0, kMostSide);
    desc.height = in.ConsumeIntegralInRange<uint32_t>(0, kMostSide);
    if (in.ConsumeIntegralInRange<int>(0, 15) == 0)
        (in.ConsumeBool() ? desc.width : desc.height) = 65537;
    if (in.ConsumeBool())
        for (uint32_t &edge : desc.crop)
            edge = in.ConsumeBool() ? in.ConsumeIntegralInRange<uint32_t>(0, kMostSide) : in.integer();
    desc.filter = in.choice<glimmer_filter>(GLIMMER_BLACKMAN_HARRIS);
    desc.filter_width = in.ConsumeBool() ? 1.5f : in.single();
    expect(glimmer_scene_set_film(scene, &desc)); // of the size known, or the default's
}

void commit(Input &in, glimmer_scene *scene) {
    if (expect(glimmer_scene_commit(scene, in.ConsumeIntegralInRange<uint32_t>(0, 3))) == GLIMMER_OK)
        require(glimmer_scene_warnings(scene) != nullptr, "no warnings of a committed scene");
}

} // namespace glimmer
