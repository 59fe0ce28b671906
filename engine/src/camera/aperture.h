// SPDX-License-Identifier: GPL-3.0-or-later
// The shape of a lens: a disk, or the regular polygon within it that the blades of an aperture leave open, narrowed
// along one axis by an anamorphic lens.
#pragma once

#include "math/constants.h"
#include "math/vec.h"

#include <cmath>
#include <cstdint>

namespace glimmer {

struct Aperture {
    uint32_t blades = 0; ///< fewer than three: round
    float rotation = 0;  ///< of the middle of an edge from x, in radians
    Vec2f scale{1, 1};   ///< 1 at most, so that all of the shape lies in the unit disk

    bool is_disk() const { return blades < 3 && scale.x == 1 && scale.y == 1; }

    /// Its part of the area of the unit disk.
    float area() const {
        const float angle = half_angle();
        return scale.x * scale.y * (blades < 3 ? 1 : std::sin(angle) * std::cos(angle) / angle);
    }

    /// A uniform point of the unit disk to one of the shape. Each sector of the disk becomes the triangle of an edge:
    /// distances from the middle keep their ratio, and angles become lengths along the edge.
    Vec2f point(Vec2f disk) const {
        if (blades >= 3) {
            const float distance = std::sqrt(disk.x * disk.x + disk.y * disk.y), angle = half_angle();
            const Sector sector = sector_of(disk);
            disk = rotated({distance * std::cos(angle), distance * std::sin(angle) * (sector.off_middle / angle)},
                           sector.middle + rotation);
        }
        return {disk.x * scale.x, disk.y * scale.y};
    }

    bool contains(Vec2f p) const {
        p = {p.x / scale.x, p.y / scale.y};
        if (blades < 3)
            return p.x * p.x + p.y * p.y <= 1;
        p = rotated(p, -rotation);
        return rotated(p, -sector_of(p).middle).x <= std::cos(half_angle());
    }

  private:
    /// That of an edge: the angle of its middle, and how far from it a point is seen.
    struct Sector {
        float middle, off_middle;
    };

    float half_angle() const { return kPi / float(blades); }

    Sector sector_of(Vec2f p) const {
        const float whole = 2 * half_angle(), angle = std::atan2(p.y, p.x), middle = whole * std::round(angle / whole);
        return {middle, angle - middle};
    }

    static Vec2f rotated(Vec2f p, float angle) {
        const float cosine = std::cos(angle), sine = std::sin(angle);
        return {cosine * p.x - sine * p.y, sine * p.x + cosine * p.y};
    }
};

} // namespace glimmer
