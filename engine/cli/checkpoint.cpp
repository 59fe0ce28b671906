// SPDX-License-Identifier: GPL-3.0-or-later
#include "checkpoint.h"

#include "picture/atomic_file.h"
#include "scene_file/scene_folder.h"
#include "text.h"

namespace glimmer {
namespace {

/// One line of text before the engine's own bytes: what it is, the scene, the XXH64 of those bytes.
constexpr std::string_view kMagic = "glimmer checkpoint 1 ";

std::string header_of(const std::string &scene_hash, std::string_view state) {
    return std::string(kMagic) + scene_hash + " " + std::to_string(hash_bytes(state)) + "\n";
}

} // namespace

bool load_checkpoint(const std::filesystem::path &path, const std::string &scene_hash, glimmer_render *render) {
    std::error_code error;
    if (!std::filesystem::exists(path, error))
        return false;
    const std::string name = path.string(), bytes = read_file(path, name);
    const size_t line_end = bytes.find('\n');
    if (!bytes.starts_with(kMagic) || line_end == std::string::npos)
        throw InputError(name + ": is not a checkpoint of glimmer; name another file or remove it");
    const std::string_view state = std::string_view(bytes).substr(line_end + 1);
    if (!bytes.starts_with(std::string(kMagic) + scene_hash + " "))
        throw InputError(
            name + ": is a checkpoint of another scene, or the scene has changed; name another file or remove it");
    if (bytes.substr(0, line_end + 1) != header_of(scene_hash, state))
        throw InputError(name + ": is damaged; remove it to start anew");
    check(glimmer_render_load(render, state.data(), state.size()), name);
    return true;
}

void save_checkpoint(const std::filesystem::path &path, const std::string &scene_hash, glimmer_render *render) {
    const void *data = nullptr;
    size_t size = 0;
    check(glimmer_render_save(render, &data, &size), path.string());
    const std::string_view state(static_cast<const char *>(data), size);
    write_file(path, header_of(scene_hash, state) + std::string(state));
}

} // namespace glimmer
