// SPDX-License-Identifier: GPL-3.0-or-later
// Samples that went wrong: they are counted, located and named in the report, never hidden.
#pragma once

#include <cstdint>
#include <optional>

namespace glimmer {

struct InvalidSample {
    uint32_t x, y;
    uint64_t sample;
};

struct SampleFaults {
    uint64_t invalid = 0;               ///< not finite; counted as black
    uint64_t unfinished = 0;            ///< broken off on paths without end
    std::optional<InvalidSample> first; ///< the first invalid one that was found

    void add_invalid(const InvalidSample &sample) {
        ++invalid;
        if (!first)
            first = sample;
    }
    void add(const SampleFaults &more) {
        invalid += more.invalid;
        unfinished += more.unfinished;
        if (!first)
            first = more.first;
    }
};

} // namespace glimmer
