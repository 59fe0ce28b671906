// SPDX-License-Identifier: GPL-3.0-or-later
// Which bodies a point is inside of: nested glass meets the right index on its other side, and every segment knows its
// medium.
#pragma once

#include "geometry/ray.h"

#include <array>

namespace glimmer {

class Medium;

class InteriorStack {
  public:
    bool empty() const { return count_ == 0; }
    float ior() const { return count_ ? entries_[count_ - 1].ior : 1.0f; }
    /// Null where there is none. outside: of all bodies.
    const Medium *medium(const Medium *outside) const { return count_ ? entries_[count_ - 1].medium : outside; }

    /// medium: that the body is filled with, or null.
    void enter(uint32_t body, float ior, const Medium *medium = nullptr) {
        if (count_ < entries_.size())
            entries_[count_++] = {body, ior, medium};
    }
    /// Removes the innermost entry of the body; a surface that was never entered (an open mesh) changes nothing.
    void leave(uint32_t body) {
        for (size_t i = count_; i-- > 0;)
            if (entries_[i].body == body) {
                for (size_t j = i + 1; j < count_; ++j)
                    entries_[j - 1] = entries_[j];
                --count_;
                return;
            }
    }

  private:
    struct Entry {
        uint32_t body;
        float ior;
        const Medium *medium;
    };
    std::array<Entry, 8> entries_{}; // deeper nesting is treated as the eighth body going on
    uint32_t count_ = 0;
};

} // namespace glimmer
