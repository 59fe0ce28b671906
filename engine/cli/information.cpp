// SPDX-License-Identifier: GPL-3.0-or-later
#include "information.h"

#include "glimmer.h"

#include <algorithm>

namespace glimmer {
namespace {

std::string padded(std::string text, size_t width) {
    text.resize(std::max(width, text.size() + 1), ' ');
    return text;
}

} // namespace

std::vector<std::string> integrator_names() {
    std::vector<std::string> names;
    for (uint32_t i = 0; const auto *info = glimmer_integrator_info(i); ++i)
        names.emplace_back(info->name);
    return names;
}

std::string renamed_integrator(const std::string &name) {
    for (uint32_t i = 0; const auto *info = glimmer_integrator_info(i); ++i)
        if (info->former_name && name == info->former_name)
            return info->name;
    return {};
}

std::vector<std::string> pass_names() {
    std::vector<std::string> names;
    for (uint32_t i = 0; const auto *info = glimmer_pass_info(i); ++i)
        names.emplace_back(info->name);
    return names;
}

std::string version_text() {
    return "glimmer " + std::string(glimmer_version()) + "\n";
}

std::string integrator_list() {
    std::string text;
    for (uint32_t i = 0; const auto *info = glimmer_integrator_info(i); ++i)
        text += padded(info->name, 24) + info->help + (i == 0 ? " (default)\n" : "\n");
    return text;
}

std::string aov_list() {
    std::string text;
    for (uint32_t i = 0; const auto *info = glimmer_pass_info(i); ++i)
        text += padded(info->name, 16) + padded(info->channels, 5) + info->help + "\n";
    return text;
}

} // namespace glimmer
