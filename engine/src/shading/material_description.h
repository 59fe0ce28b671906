// SPDX-License-Identifier: GPL-3.0-or-later
// A material as a caller describes it: its type and the values of its parameters, checked but not yet built.
#pragma once

#include "bsdf/bump.h"
#include "bsdf/burley.h"
#include "bsdf/ggx.h"
#include "bsdf/sheen.h"
#include "bsdf/subsurface.h"
#include "math/vec.h"

#include <cstdint>
#include <string>
#include <vector>

namespace glimmer {

enum class MaterialType : uint8_t {
    lambert,
    mirror,
    conductor,
    glass,
    report_metal,
    mix,
    light,
    null,
    add,
    transparent,
    translucent,
    burley,
    sheen,
    layer,
    subsurface,
    holdout,
    count
};

enum class DielectricFresnel : uint8_t { exact, schlick };
enum class DielectricLobes : uint8_t { both, refraction };
enum class FacetScattering : uint8_t { single, multiple, tinted };

/// A parameter that an output of a program gives.
struct ParameterBinding {
    /// The shading normal, which is no parameter; the last two soften the terminator of what it turns (bsdf/bump.h).
    static constexpr uint32_t kNormal = 0xffffffffu, kBumpedNormal = kNormal - 1, kBumpedNormalCubic = kNormal - 2;

    uint32_t row; ///< of kParameters (material_schema.h), or one of those
    uint32_t program, output;

    bool is_normal() const { return row >= kBumpedNormalCubic; }
    BumpSoftening softening() const {
        return row == kBumpedNormal        ? BumpSoftening::microfacet
               : row == kBumpedNormalCubic ? BumpSoftening::cubic
                                           : BumpSoftening::none;
    }
};

/// The values of the parameters of all types under the names that they have in scene files. material_schema.h says
/// which of them a type has; the others keep their defaults and mean nothing.
struct MaterialDescription {
    std::string label;
    MaterialType type = MaterialType::lambert;
    uint32_t alternative = 0; ///< of the type's alternative parameters: which were given (see MaterialRow)

    Rgb albedo, reflectance, radiance, emission;
    float alpha = 0; ///< GGX width
    Rgb eta, k, f0, f90{1}, f82{1};
    float aspect = 1, rotation = 0; ///< of a conductor: alpha across the tangent / geometric mean; turns
    Rgb tangent;                    ///< its direction in the world
    Masking masking = Masking::Smith;
    float ior = 1;
    float curve_ior = 0; ///< of a conductor's curve from f0 to f90
    DielectricFresnel fresnel = DielectricFresnel::exact;
    float roughness = 0;
    FacetScattering facets = FacetScattering::single;
    Rgb reflection{1}, transmission{1}, transmittance;
    DielectricLobes lobes = DielectricLobes::both;
    Rgb color{1};
    SheenModel model = SheenModel::fibers;
    BurleyPart part = BurleyPart::whole;
    Rgb radius; ///< of subsurface scattering, lengths
    float anisotropy = 0, entry_ior = 1.4f, entry_alpha = 1;
    SubsurfaceModel walk = SubsurfaceModel::random_walk;
    SubsurfaceEntry entry = SubsurfaceEntry::refracted;
    SubsurfaceBoundary boundary = SubsurfaceBoundary::lambert;
    float weight = 0;
    uint32_t a = 0, b = 0; ///< materials before this one

    std::vector<ParameterBinding> bindings;
    std::vector<ParameterBinding> aovs; ///< values for the AOV passes; row: which of them, from 0
};

} // namespace glimmer
