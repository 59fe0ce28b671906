// SPDX-License-Identifier: GPL-3.0-or-later
// What the engine's tables say, for lists and for checking names.
#pragma once

#include <string>
#include <vector>

namespace glimmer {

std::vector<std::string> integrator_names();
/// The present name of an integrator that was called `name` before; empty where none was.
std::string renamed_integrator(const std::string &name);
/// In the order of glimmer_pass.
std::vector<std::string> pass_names();

/// Lines for the standard output, each ended.
std::string version_text();
std::string integrator_list();
std::string aov_list();

} // namespace glimmer
