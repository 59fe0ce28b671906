// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrays.h"
#include "parts.h"

namespace glimmer {

void read_spheres(const Value &value, glimmer_scene *scene, const Programs &programs, const Materials &materials,
                  SceneFolder &folder) {
    value.expect_object({"center", "centers", "radius", "radii", "material", "index", "visible", "holdout", "interior",
                         "matte", "light_group"});
    if (value.has("center") == value.has("centers"))
        value.fail("needs either center or centers");
    if (value.has("radius") == value.has("radii"))
        value.fail("needs either radius or radii");
    const std::string name = value.path();
    glimmer_spheres_desc desc;
    glimmer_spheres_init(&desc);
    desc.name = name.c_str();
    desc.material = materials.find(value.at("material"));
    const auto interior = read_interior(value, programs);
    read_body(value, interior, desc);

    std::vector<double> centers, radii;
    if (const auto center = value.find("center")) {
        const auto numbers = center->numbers<3>();
        centers.assign(numbers.begin(), numbers.end());
    } else {
        centers = read_float_array(value.at("centers"), 3, folder);
    }
    desc.count = centers.size() / 3;
    desc.centers = centers.data();
    if (const auto radius = value.find("radius")) {
        radii.push_back(radius->number(kPositive));
    } else {
        const Value list = value.at("radii");
        radii = read_float_array(list, 0, folder);
        if (radii.size() != desc.count)
            list.fail("has " + std::to_string(radii.size()) + " rows; one for each of the " +
                      std::to_string(desc.count) + " centers is allowed");
        for (size_t i = 0; i < radii.size(); ++i)
            if (!(radii[i] > 0))
                list.fail("element [" + std::to_string(i) + "] is not a number above 0");
    }
    desc.radius_count = radii.size();
    desc.radii = radii.data();
    if (desc.count == 0)
        return; // no spheres are allowed, as no instances are
    check(glimmer_scene_add_spheres(scene, &desc), value.where());
}

} // namespace glimmer
