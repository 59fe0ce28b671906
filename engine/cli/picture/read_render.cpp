// SPDX-License-Identifier: GPL-3.0-or-later
#include "read_render.h"

#include "handles.h"

namespace glimmer {

std::vector<std::string> channel_names(glimmer_pass pass) {
    const glimmer_pass_info_t *info = glimmer_pass_info(pass);
    std::vector<std::string> names;
    const bool is_main = pass == GLIMMER_PASS_COMBINED || pass == GLIMMER_PASS_ALPHA;
    for (const char *channel = info->channels; *channel != '\0'; ++channel)
        names.push_back((is_main ? "" : std::string(info->name) + ".") + *channel);
    return names;
}

Picture read_render(glimmer_render *render, const Film &film, uint64_t passes, bool has_standard_error) {
    Picture picture;
    picture.width = film.width;
    picture.height = film.height;
    picture.pixel_aspect = film.pixel_aspect;
    picture.window = film.crop;

    passes |= 1ull << GLIMMER_PASS_COMBINED;
    passes &= ~(1ull << GLIMMER_PASS_STDERR);
    passes |= film.transparent ? 1ull << GLIMMER_PASS_ALPHA : 0;
    passes |= has_standard_error ? 1ull << GLIMMER_PASS_STDERR : 0;
    std::vector<std::vector<float>> planes; // one for each pass, interleaved
    std::vector<size_t> widths;
    for (uint32_t bit = 0; bit < GLIMMER_PASS_COUNT; ++bit) {
        if ((passes >> bit & 1) == 0)
            continue;
        const auto pass = static_cast<glimmer_pass>(bit);
        const auto names = channel_names(pass);
        picture.channels.insert(picture.channels.end(), names.begin(), names.end());
        widths.push_back(names.size());
        auto &plane = planes.emplace_back(picture.pixel_count() * names.size());
        check(glimmer_render_read(render, pass, 0, 0, picture.window_width(), picture.window_height(), plane.data(),
                                  plane.size()),
              "render");
    }
    picture.pixels.reserve(picture.pixel_count() * picture.channels.size());
    for (size_t pixel = 0; pixel < picture.pixel_count(); ++pixel)
        for (size_t p = 0; p < planes.size(); ++p)
            picture.pixels.insert(picture.pixels.end(), planes[p].begin() + static_cast<ptrdiff_t>(pixel * widths[p]),
                                  planes[p].begin() + static_cast<ptrdiff_t>((pixel + 1) * widths[p]));
    return picture;
}

} // namespace glimmer
