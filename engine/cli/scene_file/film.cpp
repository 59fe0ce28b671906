// SPDX-License-Identifier: GPL-3.0-or-later
#include "parts.h"

#include <algorithm>

namespace glimmer {
namespace {

void read_filter(const Value &filter, glimmer_film_desc &desc) {
    constexpr std::string_view names[] = {"box", "blackman_harris"};
    constexpr glimmer_filter types[] = {GLIMMER_BOX, GLIMMER_BLACKMAN_HARRIS};
    constexpr float default_width = 1.5f;
    const bool is_name = filter.json().is_string();
    if (!is_name)
        filter.expect_object({"type", "width"});
    const Value type = is_name ? filter : filter.at("type");
    desc.filter = types[one_of(type, "a filter", "filters", names)];
    if (desc.filter == GLIMMER_BOX) {
        if (!is_name && filter.has("width"))
            filter.at("width").fail("a box is exactly one pixel and has no width; blackman_harris has");
        return;
    }
    desc.filter_width = default_width;
    if (!is_name && filter.has("width"))
        desc.filter_width = filter.at("width").single(kPositive);
}

void read_transparency(const Value &film, glimmer_film_desc &desc) {
    if (const auto transparent = film.find("transparent"))
        desc.transparent = transparent->boolean();
    if (const auto width = film.find("transparent_glass"))
        desc.transparent_glass = width->single(kUnit);
}

void read_mist(const Value &mist, glimmer_film_desc &desc) {
    mist.expect_object({"start", "depth", "falloff"});
    if (const auto start = mist.find("start"))
        desc.mist_start = start->single(kNonNegative);
    if (const auto depth = mist.find("depth"))
        desc.mist_depth = depth->single(kNonNegative);
    if (const auto falloff = mist.find("falloff"))
        desc.mist_falloff = falloff->single(kNonNegative);
}

} // namespace

Film read_film(const Value &value, glimmer_scene *scene) {
    value.expect_object({"width", "height", "filter", "crop", "exposure", "transparent", "transparent_glass", "mist",
                         "occlusion_distance", "pixel_aspect"});
    glimmer_film_desc desc;
    glimmer_film_init(&desc);
    Film film;
    film.width = desc.width = static_cast<uint32_t>(value.at("width").integer(1, 65536));
    film.height = desc.height = static_cast<uint32_t>(value.at("height").integer(1, 65536));
    film.crop = {0, 0, film.width, film.height};
    if (const auto filter = value.find("filter"))
        read_filter(*filter, desc);
    if (const auto exposure = value.find("exposure"))
        desc.exposure = exposure->single(kNonNegative);
    read_transparency(value, desc);
    film.transparent = desc.transparent != 0;
    if (const auto distance = value.find("occlusion_distance"))
        desc.occlusion_distance = distance->single(kNonNegative);
    if (const auto aspect = value.find("pixel_aspect"))
        film.pixel_aspect = desc.pixel_aspect = aspect->single(kPositive);
    if (const auto mist = value.find("mist"))
        read_mist(*mist, desc);
    if (const auto crop = value.find("crop")) {
        crop->expect_size(4);
        size_t i = 0;
        crop->for_each([&](const Value &edge) { film.crop[i++] = static_cast<uint32_t>(edge.integer(0, 65536)); });
        if (film.crop[0] >= film.crop[2] || film.crop[1] >= film.crop[3] || film.crop[2] > film.width ||
            film.crop[3] > film.height)
            crop->fail(crop->json().dump() + " is not a rectangle [x0, y0, x1, y1) of the " +
                       std::to_string(film.width) + " x " + std::to_string(film.height) +
                       " picture; x0 < x1 and y0 < y1 are allowed");
    }
    std::copy(film.crop.begin(), film.crop.end(), desc.crop);
    check(glimmer_scene_set_film(scene, &desc), value.where());
    return film;
}

} // namespace glimmer
