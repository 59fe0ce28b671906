// SPDX-License-Identifier: GPL-3.0-or-later
// Shader programs that give the coefficients of media at a point.
#pragma once

#include "geometry/boundaries.h"
#include "geometry/mesh.h"
#include "medium/varying_coefficients.h"
#include "shading/program.h"

#include <memory>
#include <optional>
#include <vector>

namespace glimmer {

enum class MediumKey : uint8_t { sigma_a, sigma_s, emission, g };

/// A coefficient of a medium that an output of a program gives.
struct MediumBinding {
    MediumKey key;
    uint32_t program, output;
};

/// What a medium is where no program says otherwise, and what programs say.
struct MediumSources {
    MediumPoint constants;
    std::vector<MediumBinding> bindings;

    bool gives(MediumKey key) const;
};

/// What programs may know of a body.
struct MediumBody {
    ObjectFrame frame; ///< where it stands, if it keeps still
    bool moves = false;
    std::vector<MeshAttribute> values;     ///< of its object's instances
    std::vector<AttributeView> attributes; ///< views of them, by the scene's numbers of names
    uint32_t instance = 0;                 ///< of its object
};

class MediumPrograms : public VaryingCoefficients {
  public:
    std::vector<std::shared_ptr<const Program>> programs;
    std::vector<MediumSources> media;
    std::vector<MediumBody> bodies;
    std::shared_ptr<const Boundaries> boundaries;
    CameraFrame camera;
    Vec3d origin;

    MediumPoint at(uint32_t medium, uint32_t body, const Vec3f &x, ShutterTime time) const override;
};

} // namespace glimmer
