// SPDX-License-Identifier: GPL-3.0-or-later
// Files that are either whole or not there.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace glimmer {

/// A name beside the file to write. Write to path(), then commit(); without commit() nothing is left.
class AtomicFile {
  public:
    explicit AtomicFile(std::filesystem::path target);
    ~AtomicFile();
    AtomicFile(const AtomicFile &) = delete;
    AtomicFile &operator=(const AtomicFile &) = delete;

    const std::filesystem::path &path() const { return temporary_; }
    /// Moves the file to its place, through to the disk. Throws ResultError.
    void commit();

  private:
    std::filesystem::path target_, temporary_;
    bool committed_ = false;
};

/// Writes bytes to a file in one piece. Throws ResultError "FILE: why".
void write_file(const std::filesystem::path &path, std::string_view bytes);

} // namespace glimmer
