// SPDX-License-Identifier: GPL-3.0-or-later
// The tiles that changed since they were last handed out, each once, in the order in which they first changed. Not
// locked.
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <vector>

namespace glimmer {

class ChangedTiles {
  public:
    explicit ChangedTiles(size_t tiles) : waiting_(tiles, false) {}

    void add(size_t tile) {
        if (waiting_[tile])
            return;
        waiting_[tile] = true;
        order_.push_back(tile);
    }
    std::optional<size_t> take() {
        if (order_.empty())
            return std::nullopt;
        const size_t tile = order_.front();
        order_.pop_front();
        waiting_[tile] = false;
        return tile;
    }

  private:
    std::vector<bool> waiting_;
    std::deque<size_t> order_;
};

} // namespace glimmer
