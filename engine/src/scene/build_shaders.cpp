// SPDX-License-Identifier: GPL-3.0-or-later
// Materials and skies of which shader programs give something.
#include "base/error.h"
#include "math/constants.h"
#include "scene/build_camera.h"
#include "scene/builder.h"
#include "shading/material_tree.h"

#include <algorithm>
#include <cmath>

namespace glimmer {

namespace {

using Names = AttributeNumbers;

} // namespace

AttributeNumbers number_attributes(std::span<const std::shared_ptr<Program>> programs) {
    Names names;
    for (const auto &program : programs) {
        std::vector<uint32_t> ids;
        for (const std::string &name : program->attribute_names())
            ids.push_back(names.emplace(name, uint32_t(names.size())).first->second);
        program->set_attribute_ids(std::move(ids));
    }
    return names;
}

std::vector<AttributeView> views_of(std::span<const MeshAttribute> attributes, const AttributeNumbers &names) {
    std::vector<AttributeView> views(names.size());
    for (const MeshAttribute &a : attributes)
        if (const auto found = names.find(a.name); found != names.end())
            views[found->second] = {a.values.data(), a.components, AttributeDomain(a.domain)};
    return views;
}

/// For all values in range: an albedo of 1, and of what is rough the tip of the sharpest lobe.
MaterialBounds SceneBuilder::bounds_of_varying(uint32_t material, float &interior) const {
    std::vector<Vec3f> values;
    std::vector<uint32_t> first;
    for (const auto &program : description_.programs) {
        first.push_back(uint32_t(values.size()));
        values.insert(values.end(), program->output_count(), Vec3f());
    }
    // Colours as bright, and roughness as little, as they can be; weights between, so that every part is there.
    for (size_t p = 0; p < description_.programs.size(); ++p)
        for (size_t o = 0; o < description_.programs[p]->output_count(); ++o)
            values[first[p] + o] = description_.programs[p]->is_number(o) ? Vec3f(1e-3f, 0, 0) : Vec3f(1, 1, 1);
    std::vector<std::vector<ParameterBinding>> bindings;
    for (const MaterialDescription &m : description_.materials)
        bindings.push_back(m.bindings);
    const ProgramOutputs outputs{values, first, bindings};
    FlatMaterial flat;
    flatten(description_.materials, material, &outputs, flat);
    MaterialBounds bounds;
    for (WeightedLobe &l : flat.lobes) {
        if (auto *conductor = std::get_if<Conductor>(&l.lobe); conductor && !conductor->use_f0)
            conductor->use_f0 = true, conductor->f0 = Rgb(1);
        bounds.specular |= is_specular(l.lobe);
        bounds.transmits |= transmits(l.lobe);
        bounds.max_value += max_value(l.lobe);
    }
    bounds.scatters = !flat.lobes.empty();
    bounds.transparent = !is_black(flat.transparency);
    bounds.subsurface = has_subsurface(Bsdf(flat.lobes));
    interior = interior_ior(flat.lobes);
    return bounds;
}

/// What objects know of their instances stands in the place of what their meshes know.
void SceneBuilder::add_attributes_of_instances(ShaderScene &shaders, const AttributeNumbers &names) const {
    std::vector<const ObjectDescription *> sources(shaders.attributes.size()); // absent objects have no number
    for (size_t i = 0; i < object_places_.size(); ++i)
        sources[scene_.accel->instances()[i].object] = &description_.objects[object_places_[i].object];
    shaders.of_instances.resize(sources.size());
    for (size_t object = 0; object < sources.size(); ++object) {
        if (!sources[object])
            continue;
        shaders.of_instances[object] = sources[object]->attributes;
        const std::vector<AttributeView> views = views_of(shaders.of_instances[object], names);
        for (size_t id = 0; id < views.size(); ++id)
            if (views[id].values)
                shaders.attributes[object][id] = views[id];
    }
}

CameraFrame SceneBuilder::camera_frame() const {
    CameraFrame frame;
    const glimmer_camera_desc &c = *description_.camera;
    const std::vector<Affine> &motion = description_.camera_motion; // programs know the camera of the middle
    const Affine to_world = motion.empty() ? affine_from_rows(c.to_world) : motion[motion.size() / 2];
    frame.to_camera = {Vec3f(to_world.linear.column(0)), Vec3f(to_world.linear.column(1)),
                       -Vec3f(to_world.linear.column(2))};
    frame.position = Vec3f(to_world.translation);
    frame.aspect = scene_.film.aspect();
    if (c.type > GLIMMER_ORTHOGRAPHIC) {
        frame.set_panorama(make_panorama(c, scene_.film));
        frame.half_width = 0.5f;
        return frame;
    }
    frame.orthographic = c.type == GLIMMER_ORTHOGRAPHIC;
    frame.half_width = frame.orthographic ? float(c.width / 2) : float(std::tan(c.fov_x * kPiDouble / 360));
    frame.shift = {float(c.shift[0]), float(c.shift[1])};
    return frame;
}

void SceneBuilder::add_profiles(ShaderScene &shaders) const {
    for (const LightDescription &light : description_.lights) {
        LampProfile &profile = shaders.lamps.emplace_back();
        if (!light.profile)
            continue;
        profile.output = *light.profile;
        set_axes(profile.frame, light.profile_space.linear);
        profile.frame.location = Vec3f(light.profile_space.translation);
    }
}

void SceneBuilder::build_shaders() {
    const size_t count = description_.materials.size();
    std::vector<uint32_t> varying;
    for (uint32_t i = 0; i < count; ++i)
        if (used_[i] && varies(description_.materials, i))
            varying.push_back(i);
    bool has_aovs = false;
    for (uint32_t i = 0; i < count; ++i)
        has_aovs |= used_[i] && !description_.materials[i].aovs.empty();
    const bool has_profiles =
        std::ranges::any_of(description_.lights, [](const LightDescription &light) { return bool(light.profile); });
    if (varying.empty() && !description_.sky && !has_aovs && !has_profiles)
        return;
    auto shaders = std::make_shared<ShaderScene>();
    for (const MaterialDescription &m : description_.materials) {
        shaders->bindings.push_back(m.bindings);
        shaders->nodes.push_back(m);
        shaders->nodes.back().bindings.clear();
        shaders->nodes.back().aovs.clear();
        if (has_aovs)
            shaders->aovs.push_back(m.aovs);
        shaders->nodes.back().label.clear(); // nodes are copied where they are shaded
    }
    const Names names = number_attributes(description_.programs);
    shaders->programs.assign(description_.programs.begin(), description_.programs.end());
    shaders->varying_of.assign(count, kNone);
    shaders->origin = origin_;
    shaders->geometry = scene_.accel.get();
    shaders->object_materials = scene_.object_materials;
    shaders->sphere_materials = scene_.sphere_materials;
    shaders->sky = description_.sky;
    shaders->camera = camera_frame();
    add_profiles(*shaders);
    shaders->pixel_width = 2 * shaders->camera.half_width / float(scene_.film.width);
    for (const Instance &instance : scene_.accel->instances()) {
        shaders->frames.push_back(frame_of(instance, origin_));
        const ObjectPlace &place = object_places_[shaders->frames.size() - 1];
        const ObjectDescription &object = description_.objects[place.object];
        ObjectFrame &frame = shaders->frames.back();
        frame.color = object.color;
        frame.alpha = object.opacity;
        frame.random = object.randoms.size() > 1 ? object.randoms[place.instance] : object.randoms[0];
        shaders->instance_numbers.push_back(uint32_t(place.instance));
    }
    for (const auto &mesh : scene_.meshes_)
        shaders->attributes.push_back(views_of(mesh->attributes, names));
    add_attributes_of_instances(*shaders, names);
    for (uint32_t i : varying) {
        shaders->add(i);
        float interior = 0;
        const MaterialBounds bounds = bounds_of_varying(i, interior);
        scene_.materials.set_varying(i, shaders->varying_of[i], bounds, interior);
        scene_.has_dielectrics |= interior > 0;
        scene_.has_transparency |= bounds.transparent;
        scene_.has_subsurface |= bounds.subsurface;
        scene_.has_surfaces |= scene_.materials.bounds(i).scatters;
        scene_.max_value = std::max(scene_.max_value, scene_.materials.bounds(i).max_value);
    }
    for (const auto &program : shaders->programs) {
        scene_.bytes += program->size();
        for (const auto &texture : program->textures())
            textures_.insert(texture);
    }
    for (const auto &texture : textures_)
        scene_.bytes += texture->size();
    scene_.materials.shaders = std::move(shaders);
}

} // namespace glimmer
