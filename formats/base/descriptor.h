// SPDX-License-Identifier: Apache-2.0
// Owned file descriptors, and system calls retried after EINTR.
#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <span>
#include <utility>

namespace relief {

class Descriptor {
  public:
    explicit Descriptor(int fd = -1) : fd_(fd) {}
    Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
    Descriptor& operator=(Descriptor&& other) noexcept {
        std::swap(fd_, other.fd_);
        return *this;
    }
    ~Descriptor() {
        if (fd_ >= 0) {
            ::close(fd_);
        }
    }

    [[nodiscard]] int get() const { return fd_; }
    [[nodiscard]] explicit operator bool() const { return fd_ >= 0; }

    /// Closes the descriptor. Some file systems report a failed write only here.
    /// \return 0 or an errno. EINTR counts as success because Linux has released the descriptor.
    [[nodiscard]] int close() {
        const int result = ::close(std::exchange(fd_, -1));
        return result == 0 || errno == EINTR ? 0 : errno;
    }
    /// Closes the descriptor without reporting errors. Use it if nothing was written.
    void reset() { *this = Descriptor(); }

  private:
    int fd_;
};

/// Opens a pipe with close-on-exec. \return 0 or an errno.
[[nodiscard]] inline int makePipe(Descriptor& reading, Descriptor& writing) {
    int ends[2] = {-1, -1};
    if (::pipe2(ends, O_CLOEXEC) != 0) {
        return errno;
    }
    reading = Descriptor(ends[0]);
    writing = Descriptor(ends[1]);
    return 0;
}

inline int openRetry(const char* path, int flags, mode_t mode = 0) {
    int fd = -1;
    do {
        fd = ::open(path, flags | O_CLOEXEC | O_NOCTTY, mode);
    } while (fd < 0 && errno == EINTR);
    return fd;
}

/// Writes all bytes, with retries after EINTR. \return 0 or an errno.
inline int writeAll(int fd, std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(fd, bytes.data(), std::min(bytes.size(), std::size_t{1} << 30));
        if (written < 0) {
            if (errno == EINTR) {
                continue;
            }
            return errno;
        }
        bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    return 0;
}

/// Flushes to disk. \return 0 or an errno; 0 on file systems that do not support fsync.
inline int syncToDisk(int fd) {
    int result = 0;
    do {
        result = ::fsync(fd);
    } while (result != 0 && errno == EINTR);
    return result == 0 || errno == EINVAL || errno == EOPNOTSUPP || errno == ENOSYS ? 0 : errno;
}

}  // namespace relief
