// SPDX-License-Identifier: GPL-3.0-or-later
#include "atomic_file.h"

#include "errors.h"

#include <cerrno>
#include <fcntl.h>
#include <string>
#include <system_error>
#include <unistd.h>

namespace glimmer {

namespace {

/// 0, or the errno of what failed. The bytes are on the disk before the name is: a rename may overtake them.
int write_synced(const std::filesystem::path &path, std::string_view bytes) {
    const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (file < 0)
        return errno;
    int why = 0;
    while (why == 0 && !bytes.empty()) {
        const ssize_t count = ::write(file, bytes.data(), bytes.size());
        if (count >= 0)
            bytes.remove_prefix(static_cast<size_t>(count));
        else if (errno != EINTR)
            why = errno;
    }
    if (why == 0 && ::fsync(file) != 0)
        why = errno;
    if (::close(file) != 0 && why == 0)
        why = errno;
    return why;
}

} // namespace

void write_file(const std::filesystem::path &path, std::string_view bytes) {
    const std::filesystem::path temporary = path.string() + ".part-" + std::to_string(getpid());
    std::error_code error(write_synced(temporary, bytes), std::generic_category());
    if (!error)
        std::filesystem::rename(temporary, path, error);
    if (!error)
        return;
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    throw ResultError(path.string() + ": cannot be written: " + error.message());
}

} // namespace glimmer
