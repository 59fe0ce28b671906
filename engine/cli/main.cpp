// SPDX-License-Identifier: GPL-3.0-or-later
// The glimmer command: a client of the C API. See SCENE_FORMAT.md beside this file.
#include "errors.h"
#include "farm_command.h"
#include "glimmer.h"
#include "merge_command.h"
#include "options.h"
#include "render_command.h"

#include <cstdio>
#include <exception>
#include <new>

namespace glimmer {
namespace {

int run(int argc, char **argv) {
    if (glimmer_abi_version() != GLIMMER_ABI_VERSION)
        throw ResultError("glimmer: libglimmer.so is of another version than this command");
    const Options options = parse_options(argc, argv);
    if (const auto *render = std::get_if<RenderOptions>(&options))
        return run_render(*render);
    if (const auto *merge = std::get_if<MergeOptions>(&options))
        return run_merge(*merge);
    if (const auto *farm = std::get_if<FarmOptions>(&options))
        return run_farm(*farm);
    const std::string &text = std::get<Information>(options).text;
    const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0;
    return written ? kDone : kNoResult;
}

} // namespace
} // namespace glimmer

int main(int argc, char **argv) {
    try {
        return glimmer::run(argc, argv);
    } catch (const glimmer::InputError &error) {
        std::fprintf(stderr, "%s\n", error.what());
        return glimmer::kBadInput;
    } catch (const std::bad_alloc &) {
        std::fprintf(stderr, "glimmer: out of memory\n");
    } catch (const std::exception &error) {
        std::fprintf(stderr, "%s\n", error.what());
    }
    return glimmer::kNoResult;
}
