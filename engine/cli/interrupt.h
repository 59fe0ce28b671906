// SPDX-License-Identifier: GPL-3.0-or-later
// SIGINT and SIGTERM as a flag.
#pragma once

namespace glimmer {

/// From here on the first SIGINT or SIGTERM only sets a flag, and so does what follows within a second of it; a later
/// one ends the process as usual.
void catch_interrupts();
bool interrupted();

} // namespace glimmer
