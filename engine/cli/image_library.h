// SPDX-License-Identifier: GPL-3.0-or-later
// The library for image files, opened by whoever first needs an image.
#pragma once

#include "image_io.h"

namespace glimmer {

/// libglimmer_image.so, which stands beside libglimmer.so; opened by the first call. Throws ResultError where it cannot
/// be opened, or belongs to another build.
const ImageIo &image_io();

} // namespace glimmer
