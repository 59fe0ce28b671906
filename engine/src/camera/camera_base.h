// SPDX-License-Identifier: GPL-3.0-or-later
// What the kinds of cameras have in common, and the words in which they answer (camera.h).
#pragma once

#include "camera/aperture.h"
#include "geometry/ray.h"
#include "math/constants.h"
#include "math/vec.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace glimmer {

struct CameraRay {
    Ray ray;                   ///< t_max: the far clipping plane along this ray
    uint32_t pixel_x, pixel_y; ///< of the whole picture

    /// Of a place of the film that sees nothing, black: a ray that meets nothing.
    static CameraRay blind(const Vec3f &direction, ShutterTime time) { return {{{}, direction, time, -1}, 0, 0}; }
    bool is_blind() const { return ray.t_max < 0; }
};

/// A point as the camera sees it.
struct Projection {
    Vec2f film;             ///< as for Camera::generate; may lie outside 0 to 1
    Vec3f start, direction; ///< of the ray to it
    float t;                ///< of the point from `start`
    float spread;           ///< area across the ray at the point, per unit of `extent`
    float extent;           ///< of the whole film, were all of it as this place is: the solid angle seen from the lens

    /// Across the ray at the point: what an equal share of the film, one of `parts`, sees.
    float area(float parts) const { return spread * (extent / parts); }
};

/// A part of the film, x right, y down; all of it is 0 to 1.
struct FilmRectangle {
    Vec2f begin, end;
};

/// Where a sphere is seen, in the camera's own terms (Camera::silhouette).
struct Silhouette {
    Vec3f middle;
    float reach;
};

/// A sphere within which all rays start.
struct StartRegion {
    Vec3f center;
    float radius = 0;
};

/// A point on a ray and the density per length that it was drawn with.
struct PointOnRay {
    float t, pdf;
};

/// One eye of a pair whose head turns to every direction, about the camera's own upright axis in a panorama, else the
/// world's: rays start beside the camera, and meet those of the other eye at `convergence`. Up and down, where the head
/// cannot turn, the eyes come together.
struct SphericalStereo {
    float offset = 0;                       ///< to the right, a length; below 0 to the left; 0: no stereo
    float convergence = kInfinity;          ///< distance; infinite: parallel
    float merge_from = kPi, merge_to = kPi; ///< heights above the horizon, in radians, between which they come together

    /// axis: unit, the one that the head turns about.
    void apply(Vec3f &origin, Vec3f &direction, const Vec3f &axis) const {
        const float height = std::abs(std::asin(std::clamp(dot(direction, axis), -1.0f, 1.0f)));
        float left = offset;
        if (height > merge_to)
            left = 0;
        else if (height > merge_from)
            left *= std::cos((height - merge_from) / (merge_to - merge_from) * (kPi / 2));
        const Vec3f side = cross(direction, axis);
        if (!(length_squared(side) > 0))
            return;
        const Vec3f moved = normalize(side) * left;
        origin += moved;
        if (convergence < kInfinity)
            direction = normalize(direction * convergence - moved);
    }
};

/// A frame at the scene's origin, where the camera stands; the part of the image plane that the film shows; a lens
/// about the origin; two clipping planes across the axis.
struct CameraBase {
    Vec3f right{1, 0, 0}, up{0, 1, 0}, forward{0, 0, -1}; ///< orthonormal
    float half_width = 1;                                 ///< of the film on the image plane
    float aspect = 1;                                     ///< height / width
    Vec2f shift;                                          ///< in widths
    float lens_radius = 0, focus_distance = 0;            ///< lengths; within the radius lies all of the aperture, the
                                                          ///< distance is along the axis
    float clip_start = 0, clip_end = kInfinity;           ///< lengths along the axis
    SphericalStereo stereo;                               ///< not of an orthographic camera
    Aperture aperture;

    bool has_lens() const { return lens_radius > 0; }
    float depth(const Vec3f &x) const { return dot(x, forward); }

    /// function(film) for each place of the film where what is seen at `film` is seen.
    template <class Function>
    void for_each_place(Vec2f film, const Function &function) const {
        function(film);
    }
    bool is_invertible(Vec2f) const { return stereo.offset == 0; }
    bool has_blind_places() const { return false; }

    /// Uniform points of the unit disk give uniform ones of the aperture.
    Vec3f lens_point(Vec2f disk) const {
        const Vec2f lens = aperture.point(disk);
        return (right * lens.x + up * lens.y) * lens_radius;
    }

    /// Where on the image plane a point of the film is, along `right` and `up`, and the inverse.
    Vec2f image_point(Vec2f film) const {
        return {(2 * film.x - 1 + 2 * shift.x) * half_width, ((1 - 2 * film.y) * aspect + 2 * shift.y) * half_width};
    }
    Vec2f film_point(Vec2f image) const {
        const float x = image.x / half_width, y = image.y / half_width;
        return {(x + 1) / 2 - shift.x, (1 - (y - 2 * shift.y) / aspect) / 2};
    }
};

/// Cuts from a part of a ray what is not on the side of a plane where p.normal >= offset.
inline void clip_to_side(RayInterval &part, const Ray &ray, const Vec3f &normal, float offset) {
    const float at = dot(ray.origin, normal) - offset, slope = dot(ray.direction, normal);
    if (slope > 0)
        part.begin = std::max(part.begin, -at / slope);
    else if (slope < 0)
        part.end = std::min(part.end, -at / slope);
    else if (at < 0)
        part.end = -1;
}

} // namespace glimmer
