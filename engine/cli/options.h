// SPDX-License-Identifier: GPL-3.0-or-later
// The command line as a value.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace glimmer {

struct RenderOptions {
    std::filesystem::path scene, output;
    uint64_t samples = 0;    ///< per pixel; 0: no limit
    double seconds = 0;      ///< of rendering; 0: no limit
    double target_error = 0; ///< relMSE; 0: no limit
    std::string integrator;  ///< empty: the default
    uint64_t seed = 0;
    uint32_t threads = 0, tile = 0; ///< 0: the engine's choice
    uint64_t passes = 0;            ///< bit set of (1 << glimmer_pass)
    std::optional<std::filesystem::path> checkpoint, report, curve;
    double checkpoint_seconds = 30; ///< between two saves to the checkpoint
    bool adaptive = false;          ///< sampling
    bool independent_pixels = false;
    bool full_kernel = false; ///< not the one compiled for such scenes
    bool quiet = false;
};

struct MergeOptions {
    std::vector<std::filesystem::path> inputs;
    std::filesystem::path output;
};

/// What engine/farm understands, unread.
struct FarmOptions {
    std::vector<std::string> words;
};

/// Text for the standard output, and nothing else to do: --help, --version and the lists.
struct Information {
    std::string text;
};

using Options = std::variant<RenderOptions, MergeOptions, FarmOptions, Information>;

/// Throws InputError with one line.
Options parse_options(int argc, char **argv);

} // namespace glimmer
