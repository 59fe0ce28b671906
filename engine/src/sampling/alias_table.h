// SPDX-License-Identifier: GPL-3.0-or-later
// A discrete distribution sampled in constant time.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace glimmer {

struct AliasSample {
    uint32_t index;
    float pmf;
    float rest; ///< what the choice left of the random number: uniform in [0, 1) again, with fewer digits
};

/// Walker's alias method as built by Vose 1991. An entry of weight 0 is never drawn. The probability of an entry is its
/// pmf to within 2^-24/n; n is at most 2^24.
class AliasTable {
  public:
    AliasTable() = default;
    /// Weights: finite, >= 0. When all are 0 the table is empty.
    explicit AliasTable(std::span<const double> weights) {
        double total = 0;
        for (const double w : weights)
            total += w;
        if (!(total > 0))
            return;
        const size_t n = weights.size();
        entries_.resize(n);
        std::vector<double> mass(n);
        std::vector<uint32_t> small, large;
        uint32_t heaviest = 0;
        for (size_t i = 0; i < n; ++i) {
            mass[i] = weights[i] / total * static_cast<double>(n);
            entries_[i] = {1, static_cast<uint32_t>(i), static_cast<float>(weights[i] / total)};
            (mass[i] < 1 ? small : large).push_back(static_cast<uint32_t>(i));
            if (weights[i] > weights[heaviest])
                heaviest = static_cast<uint32_t>(i);
        }
        while (!small.empty() && !large.empty()) {
            const uint32_t s = small.back(), l = large.back();
            small.pop_back();
            entries_[s].threshold = static_cast<float>(mass[s]);
            entries_[s].alias = l;
            mass[l] -= 1 - mass[s];
            if (mass[l] < 1) {
                large.pop_back();
                small.push_back(l);
            }
        }
        // What rounding left over keeps its own cell whole, except that weight 0 must not be drawn.
        for (const uint32_t s : small)
            if (weights[s] == 0)
                entries_[s] = {0, heaviest, 0};
    }

    bool empty() const { return entries_.empty(); }
    size_t size() const { return entries_.size(); }
    float pmf(uint32_t index) const { return entries_[index].pmf; }

    /// Not for an empty table. u picks the cell; what is left of it, extended by `fine`, decides between the cell's two
    /// entries. A float has 24 bits: for more than a few thousand entries `fine` must be a second random number, or the
    /// cells are unequal.
    AliasSample sample(float u, float fine = 0) const {
        const double n = static_cast<double>(entries_.size());
        const double scaled = (static_cast<double>(u) + static_cast<double>(fine) * 0x1p-24) * n;
        const auto cell = std::min(static_cast<uint32_t>(scaled), static_cast<uint32_t>(entries_.size() - 1));
        const Entry &entry = entries_[cell];
        const double part = scaled - cell, threshold = static_cast<double>(entry.threshold);
        const bool own = part < threshold;
        const double rest = own ? part / threshold : (part - threshold) / (1 - threshold);
        const uint32_t index = own ? cell : entry.alias;
        return {index, entries_[index].pmf, std::min(static_cast<float>(rest), 0x1.fffffep-1f)};
    }

  private:
    struct Entry {
        float threshold; // below it the cell's own index, above it the alias
        uint32_t alias;
        float pmf;
    };
    std::vector<Entry> entries_;
};

} // namespace glimmer
