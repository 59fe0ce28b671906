// SPDX-License-Identifier: GPL-3.0-or-later
// Where a camera stands while the shutter is open.
#pragma once

#include "camera/camera_base.h"

#include <algorithm>
#include <vector>

namespace glimmer {

/// Where a camera stands: its axes as in CameraBase, and its place from the scene's origin.
struct CameraPose {
    Vec3f right, up, forward, position;
};

/// Poses at moments evenly spaced from when the shutter opens to when it closes. In between, places and axes are
/// interpolated linearly and the axes made orthonormal again: neighbours must turn by less than a right angle. Empty:
/// the camera keeps still.
class CameraMotion {
  public:
    CameraMotion() = default;
    explicit CameraMotion(std::vector<CameraPose> steps) : steps_(std::move(steps)) {}

    bool empty() const { return steps_.empty(); }
    const std::vector<CameraPose> &steps() const { return steps_; }

    CameraPose at(ShutterTime time) const {
        const float moment = time.value * float(steps_.size() - 1);
        const size_t first = std::min(size_t(moment), steps_.size() - 2);
        const CameraPose &a = steps_[first], &b = steps_[first + 1];
        const float f = moment - float(first), g = 1 - f;
        CameraPose out;
        out.position = a.position * g + b.position * f;
        out.forward = normalize(a.forward * g + b.forward * f);
        out.right = a.right * g + b.right * f;
        out.right = normalize(out.right - out.forward * dot(out.right, out.forward));
        out.up = cross(out.right, out.forward);
        if (dot(out.up, a.up) < 0) // a mirrored camera stays so
            out.up = -out.up;
        return out;
    }

  private:
    std::vector<CameraPose> steps_;
};

} // namespace glimmer
