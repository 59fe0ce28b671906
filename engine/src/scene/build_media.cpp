// SPDX-License-Identifier: GPL-3.0-or-later
// The medium that fills all space, and those within surfaces.
#include "base/error.h"
#include "scene/builder.h"

#include <algorithm>

namespace glimmer {

namespace {

Rgb to_rgb(const Vec3d &v) {
    return {float(v.x), float(v.y), float(v.z)};
}

HomogeneousMedium coefficients(const MediumDescription &m) {
    return {to_rgb(m.sigma_a), to_rgb(m.sigma_s), float(m.g)};
}

} // namespace

uint32_t SceneBuilder::add_interior(const MediumDescription &medium) {
    media_.push_back({coefficients(medium), to_rgb(medium.emission)});
    return uint32_t(media_.size()) - 1;
}

void SceneBuilder::add_boundaries(const ObjectDescription &object) {
    if (!object.interior)
        return;
    const uint32_t medium = add_interior(*object.interior);
    for (uint32_t material : object.materials)
        used_[material] = true;
    for (size_t i = 0; i < object.instances.size(); ++i)
        if (const auto instance = place(object, i, *object.mesh, boundary_motions_)) {
            boundary_instances_.push_back(*instance);
            instance_media_.push_back(medium);
        }
    scene_.meshes_.push_back(object.mesh);
}

void SceneBuilder::add_boundaries(const SpheresDescription &group) {
    if (!group.interior)
        return;
    const uint32_t medium = add_interior(*group.interior);
    used_[group.material] = true;
    for (size_t i = 0; i < group.centers.size(); ++i) {
        boundary_spheres_.push_back(
            {group.centers[i] - origin_, group.radii.size() == 1 ? group.radii[0] : group.radii[i]});
        sphere_media_.push_back(medium);
    }
}

void SceneBuilder::build_media() {
    std::optional<HomogeneousMedium> everywhere;
    if (description_.medium)
        everywhere = coefficients(*description_.medium);
    if (everywhere && is_black(everywhere->sigma_t))
        everywhere.reset();
    const bool empty = std::ranges::all_of(
        media_, [](const InteriorMedium &m) { return is_black(m.coefficients.sigma_t) && is_black(m.emission); });
    if (empty || instance_media_.size() + sphere_media_.size() == 0) {
        if (everywhere)
            scene_.medium = Medium(*everywhere);
        return;
    }
    const auto boundaries = std::make_shared<const Boundaries>(
        std::move(boundary_instances_), std::move(boundary_motions_), std::move(boundary_spheres_), threads_);
    scene_.moves |= boundaries->moves();
    scene_.bytes += boundaries->bytes();
    std::vector<uint32_t> bodies = std::move(instance_media_);
    bodies.insert(bodies.end(), sphere_media_.begin(), sphere_media_.end());
    scene_.glass_medium = Medium(BoundedMedia(boundaries, bodies, media_, kNone));
    uint32_t around = kNone;
    if (everywhere) {
        around = uint32_t(media_.size());
        media_.push_back({*everywhere, {}});
    }
    scene_.medium = Medium(BoundedMedia(boundaries, std::move(bodies), std::move(media_), around));
}

} // namespace glimmer
