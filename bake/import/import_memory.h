// Memory that importMeshInWorker and relief-import share: a memfd, sealed when it is whole.
#pragma once

#include <fcntl.h>

#include <cstdint>

#include "formats/base/retry.h"

namespace relief {

/// Takes the first bytes of a memfd from the system now: touching a page that cannot be had is SIGBUS.
/// \return 0 or an errno: ENOSPC and ENOMEM where the system has no more.
[[nodiscard]] inline int reserveMemory(int file, std::uint64_t bytes) {
    return bytes == 0 ? 0 : retryTransient([&] {
        return ::fallocate(file, 0, 0, static_cast<off_t>(bytes)) == 0 ? 0 : errno;
    });
}

/// Seals a memfd, of which no page may be mapped for writing any more. The kernel answers EBUSY while it has hold of a
/// page itself, which passes. \return 0 or an errno.
[[nodiscard]] inline int addSeals(int file, int seals) {
    return retryTransient([&] { return ::fcntl(file, F_ADD_SEALS, seals) == 0 ? 0 : errno; });
}

}  // namespace relief
