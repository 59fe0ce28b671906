// SPDX-License-Identifier: GPL-3.0-or-later
// Panoramas: where on a picture each direction is seen, by the conventions that Blender's users know from Cycles.
// Directions are the camera's own: x right, y up, z forward, of unit length. Places are those of the whole panorama, u
// right, v up, both 0 to 1; the film shows a window of it.
#pragma once

#include "camera/camera_base.h"

#include <array>
#include <optional>

namespace glimmer {

enum class PanoramaType : uint8_t {
    equirectangular,     ///< longitude across, latitude up
    fisheye_equidistant, ///< the angle to the axis grows evenly, to `half_angle` at the picture's edge (an ellipse)
    fisheye_equisolid,   ///< equal areas show equal solid angles
    fisheye_polynomial,  ///< the angle to the axis is a polynomial of the distance from the middle
    mirror_ball,         ///< what a ball of mirror shows from far away
    cube_face,           ///< one face of a cube, by equal angles
    cylindrical          ///< longitude across, tangent of the latitude up
};

struct Panorama {
    PanoramaType type = PanoramaType::equirectangular;
    FilmRectangle window{{0, 0}, {1, 1}}; ///< what the film shows: x right, y down, all of the panorama is 0 to 1
    float aspect = 1;                     ///< height / width of the whole panorama; of fisheyes by distance
    float longitude[2]{-3.14159265f, 3.14159265f};  ///< at the left and right edge
    float latitude[2]{-1.57079633f, 1.57079633f};   ///< at the bottom and top edge; cylindrical: their tangents
    float half_angle = 1.57079633f;                 ///< fisheyes: nothing farther from the axis is seen
    float focal_length = 0.3f;                      ///< equisolid: in widths of the panorama
    std::array<float, 5> polynomial{0, 1, 0, 0, 0}; ///< of the distance from the middle in widths, to radians
    float reach = 1;                                ///< of the polynomial: the farthest distance that is shown

    /// Where the film's point (as in Camera::generate) looks; nothing outside a fisheye's or a ball's circle.
    std::optional<Vec3f> direction(Vec2f film) const;

    /// Where a direction is on the whole panorama. For a fisheye also beyond what it sees.
    Vec2f place(const Vec3f &direction) const;
    /// Where it is seen on the film; may lie outside 0 to 1. Nothing where it is not seen at all.
    std::optional<Vec2f> film(const Vec3f &direction) const;

    /// function(film) for every place of the film, and some beyond it, where the direction seen at `film` is seen too:
    /// past a full turn, and beyond the poles.
    template <class Function>
    void for_each_place(Vec2f film, const Function &function) const;

    /// Solid angle per area of the film about a direction, were all of the film (1) as this place is.
    float solid_angle(const Vec3f &direction) const;

    /// Whether there is a circle that the film sees nothing outside of.
    bool has_circle() const { return is_fisheye() || type == PanoramaType::mirror_ball; }

    /// Whether for_each_place knows all places of the film where a direction is seen. margin: of film that filters add.
    bool is_invertible(Vec2f margin) const;

    /// The largest angle between directions, per width of the film. film_aspect: its height / width. Roughly.
    float angle_per_width(float film_aspect) const;

    /// The farthest from the middle that the film shows, in widths of the panorama.
    float farthest(Vec2f margin) const;

  private:
    Vec2f window_size() const { return {window.end.x - window.begin.x, window.end.y - window.begin.y}; }
    Vec2f to_film(Vec2f place) const {
        const Vec2f size = window_size();
        return {(place.x - window.begin.x) / size.x, (1 - place.y - window.begin.y) / size.y};
    }
    bool is_fisheye() const {
        return type >= PanoramaType::fisheye_equidistant && type <= PanoramaType::fisheye_polynomial;
    }
    /// Whether the place is outside a fisheye's circle.
    bool is_beyond(float distance, float angle) const;
    /// Of a fisheye: below 0 for a polynomial that falls.
    float angle_to_axis(const Vec3f &direction) const;
    /// Of a fisheye, by the distance from the middle: in half pictures if equidistant, else in widths.
    float angle_at(float distance) const;
    float distance_at(float angle) const;
};

template <class Function>
void Panorama::for_each_place(Vec2f film, const Function &function) const {
    if (type != PanoramaType::equirectangular && type != PanoramaType::cylindrical)
        return function(film);
    constexpr int kTurns = 2; // shifts of the window by more than a whole panorama show nothing new
    const Vec2f size = window_size();
    const float turn = 2 * kPi / (longitude[1] - longitude[0]) / size.x; // in films
    for (int k = -kTurns; k <= kTurns; ++k)
        function(Vec2f{film.x + float(k) * turn, film.y});
    if (type != PanoramaType::equirectangular)
        return;
    for (const float pole : {-kPi / 2, kPi / 2}) {
        const float v = (pole - latitude[0]) / (latitude[1] - latitude[0]);
        const float y = to_film({0, v}).y;
        for (int k = -kTurns; k < kTurns; ++k)
            function(Vec2f{film.x + (float(k) + 0.5f) * turn, 2 * y - film.y});
    }
}

} // namespace glimmer
