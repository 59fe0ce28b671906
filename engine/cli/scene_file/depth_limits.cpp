// SPDX-License-Identifier: GPL-3.0-or-later
#include "parts.h"

namespace glimmer {

DepthLimits read_depth_limits(const Value &value) {
    value.expect_object({"max_depth", "max_scatter"});
    const auto limit = [&](const char *key) -> int64_t {
        const auto found = value.find(key);
        if (!found || found->json().is_null())
            return -1;
        if (!found->json().is_number())
            found->refuse("null or an integer of 0 or more");
        return found->integer(0, INT64_MAX);
    };
    return {limit("max_depth"), limit("max_scatter")};
}

} // namespace glimmer
