// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrator/path/kernel.inl"

namespace glimmer {

template FilmSample sample_path<kSpheres>(const PathContext &, const Ray &, const InteriorStack &, Sampler &,
                                          TraceContext &);

} // namespace glimmer
