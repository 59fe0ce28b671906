// SPDX-License-Identifier: GPL-3.0-or-later
#include "farm_command.h"

#include "errors.h"

#include <cstdlib>
#include <unistd.h>

namespace glimmer {
namespace {

constexpr const char *kPythonVariable = "GLIMMER_FARM_PYTHON";

/// The checkout that this command was built in. Throws ResultError where it lies in none.
std::filesystem::path checkout_of(const std::filesystem::path &command) {
    for (auto folder = command.parent_path(); folder != folder.root_path(); folder = folder.parent_path())
        if (std::filesystem::is_regular_file(folder / "engine" / "farm" / "__main__.py"))
            return folder;
    throw ResultError("glimmer farm: " + command.string() +
                      " lies in no checkout of Glimmer, whose engine/farm it runs");
}

std::filesystem::path python_of(const std::filesystem::path &checkout) {
    if (const char *told = std::getenv(kPythonVariable); told != nullptr && *told != '\0')
        return told;
    return checkout / "build" / "venv" / "farm" / "bin" / "python";
}

} // namespace

int run_farm(const FarmOptions &options) {
    const auto self = std::filesystem::read_symlink("/proc/self/exe");
    const auto checkout = checkout_of(self), python = python_of(checkout);
    const char *path = std::getenv("PYTHONPATH");
    setenv("PYTHONPATH", (checkout.string() + (path == nullptr ? "" : ":" + std::string(path))).c_str(), 1);
    setenv("GLIMMER_BIN", self.c_str(), 1);
    setenv("GLIMMER_LIB_DIR", (self.parent_path().parent_path() / "lib").c_str(), 1);
    std::vector<std::string> words{python.string(), "-m", "engine.farm"};
    words.insert(words.end(), options.words.begin(), options.words.end());
    std::vector<char *> arguments;
    for (std::string &word : words)
        arguments.push_back(word.data());
    arguments.push_back(nullptr);
    execv(python.c_str(), arguments.data());
    throw ResultError("glimmer farm: " + python.string() +
                      " cannot be run; `python3 build.py setup --farm` makes it, or " + kPythonVariable +
                      " names a Python that has Dask");
}

} // namespace glimmer
