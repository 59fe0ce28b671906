// SPDX-License-Identifier: GPL-3.0-or-later
#include "atomic_file.h"

#include "errors.h"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <unistd.h>

namespace glimmer {

AtomicFile::AtomicFile(std::filesystem::path target)
    : target_(std::move(target)), temporary_(target_.string() + ".part-" + std::to_string(getpid())) {}

AtomicFile::~AtomicFile() {
    std::error_code ignored;
    if (!committed_)
        std::filesystem::remove(temporary_, ignored);
}

void AtomicFile::commit() {
    // A rename may reach the disk before the bytes do.
    const int file = ::open(temporary_.c_str(), O_RDONLY | O_CLOEXEC);
    const bool synced = file >= 0 && ::fsync(file) == 0;
    const int why = errno;
    if (file >= 0)
        ::close(file);
    if (!synced)
        throw ResultError(target_.string() + ": cannot be written: " + std::strerror(why));
    std::error_code error;
    std::filesystem::rename(temporary_, target_, error);
    if (error)
        throw ResultError(target_.string() + ": cannot be written: " + error.message());
    committed_ = true;
}

void write_file(const std::filesystem::path &path, std::string_view bytes) {
    AtomicFile file(path);
    const int handle = ::open(file.path().c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    int why = handle < 0 ? errno : 0;
    while (why == 0 && !bytes.empty()) {
        const ssize_t count = ::write(handle, bytes.data(), bytes.size());
        if (count >= 0)
            bytes.remove_prefix(static_cast<size_t>(count));
        else if (errno != EINTR)
            why = errno;
    }
    if (handle >= 0 && ::close(handle) != 0 && why == 0)
        why = errno;
    if (why != 0)
        throw ResultError(path.string() + ": cannot be written: " + std::strerror(why));
    file.commit();
}

} // namespace glimmer
